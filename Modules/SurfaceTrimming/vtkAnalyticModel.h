// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkAnalyticModel
 * @brief   makes a CAD model of planes, cylinders, spheres, cones and tori of a triangle mesh
 *
 * The input is a mesh of triangles (quadrilaterals and polygons are divided), closed or open, of
 * one or several parts, all of whose surfaces vtkSurfaceRecognition finds: others, of free form,
 * are an error; vtkTrimmedSurface makes spline faces of them. Every surface becomes a trimmed face;
 * edges are the curves in which neighbouring surfaces meet, lines and circles where they are, and
 * vertices are points of several surfaces.
 *
 * Output 0 are the faces as a watertight triangulation with normals and the cell arrays `FaceId`
 * and `SurfaceType` (0 plane, 1 cylinder, 2 sphere, 3 cone, 4 torus). Outputs 1 and 2 are the faces
 * themselves, their surfaces and their trimming curves as spline grids (TrimmedGrids.h), whose cell
 * array `SurfaceType` makes vtkCADWriter write planes, cylinders, ... as such. Output 3 is a table
 * of one row: Faces, Planes, Cylinders, Spheres, Cones, Tori, Edges, Lines, Circles, SharpEdges
 * (where surfaces meet at 5 degrees or more), Vertices, Loops (rims of the mesh), Tolerance,
 * MaxDeviation (of the mesh's points, and of edges from their faces), MaxSag (bound of the distance
 * of triangles from their surfaces), MaxEdgeDistance (bound between edges and those of the mesh),
 * MaxEdgeGap, WithinTolerance, MinNormalBound, Verdict (whether faces are proved regular),
 * LoopsProved, LoopVerdict, ControlPoints, Area (of output 0), MeshArea.
 *
 * @source The module's page has methods, limits and errors.
 */
#ifndef vtkAnalyticModel_h
#define vtkAnalyticModel_h
#include "vtkKnotworkSurfaceTrimmingModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

class VTKKNOTWORKSURFACETRIMMING_EXPORT vtkAnalyticModel : public vtkSplineAlgorithm
{
public:
  static vtkAnalyticModel* New();
  vtkTypeMacro(vtkAnalyticModel, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /** Distance of points from the surface of their region at most, unit of the points; 0: a
   * thousandth of the diagonal of the mesh's box. Default 0, valid range >= 0. */
  vtkSetClampMacro(Tolerance, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(Tolerance, double);
  ///@}
  ///@{
  /** Distance of edges and triangles from the surface that their corners lie on at most, in
   * tolerances: more for coarse tessellations. Default 5, valid range [0, 1000]. */
  vtkSetClampMacro(MaximumSag, double, 0.0, 1000.0);
  vtkGetMacro(MaximumSag, double);
  ///@}
  ///@{
  /** Angle in degrees by which a rim turns at a point at least to have a vertex there. Default 20,
   * valid range [1, 180]. */
  vtkSetClampMacro(CornerAngle, double, 1.0, 180.0);
  vtkGetMacro(CornerAngle, double);
  ///@}
  ///@{
  /** Largest distance between triangles and faces of output 0, unit of the points; 0: a quarter of
   * the tolerance. Default 0, valid range >= 0. Advanced. */
  vtkSetClampMacro(ChordalTolerance, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(ChordalTolerance, double);
  ///@}

protected:
  vtkAnalyticModel();
  ~vtkAnalyticModel() override = default;
  int FillInputPortInformation(int port, vtkInformation* info) override;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkAnalyticModel(const vtkAnalyticModel&) = delete;
  void operator=(const vtkAnalyticModel&) = delete;

  double Tolerance = 0.0;
  double MaximumSag = 5.0;
  double CornerAngle = 20.0;
  double ChordalTolerance = 0.0;
};
#endif
