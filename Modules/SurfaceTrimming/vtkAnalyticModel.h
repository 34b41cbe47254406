// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkAnalyticModel
 * @brief   makes a CAD model of planes, cylinders, spheres, cones, tori and splines of a mesh
 *
 * The input is a mesh of triangles (quadrilaterals and polygons are divided), closed or open, of
 * one or several parts. Every surface that vtkSurfaceRecognition finds becomes a trimmed face; what
 * is of free form is laid into the plane in charts, which never cross sharp edges, and becomes
 * spline faces. A mesh that is mostly of free form is refused: vtkTrimmedSurface makes splines
 * alone. Between surfaces that were found
 * edges are the curves in which neighbouring surfaces meet, lines and circles where they are, and
 * vertices are points of several surfaces.
 *
 * Output 0 are the faces as a watertight triangulation with normals and the cell arrays `FaceId`
 * and `SurfaceType` (0 plane, 1 cylinder, 2 sphere, 3 cone, 4 torus, 5 free form, 6 extrusion,
 * 7 revolution). Outputs 1 and 2 are the faces themselves, their surfaces and their trimming curves
 * as spline grids (TrimmedGrids.h), whose cell array `SurfaceType` makes vtkCADWriter write planes,
 * cylinders, ... as such. Output 3 is a table of one row: Faces, Planes, Cylinders, Spheres, Cones,
 * Tori, Extrusions, Revolutions, FreeFaces, Edges, Lines, Circles, SharpEdges (of 5 degrees or
 * more, of 25 beside free form), Vertices, Loops (rims of the mesh), Tolerance, MaxDeviation (of
 * the mesh's points from analytic faces, of the mesh and spline faces both ways, and of edges from
 * their faces), MaxNormalAngle (between spline faces where the mesh is smooth), MaxSag (bound of
 * the distance of triangles from their surfaces), MaxEdgeDistance (bound between edges and those of
 * the mesh), MaxEdgeGap, WithinTolerance, MinNormalBound, Verdict (whether faces are proved
 * regular), LoopsProved, LoopVerdict, ControlPoints, SnappedSurfaces, CommonDirections,
 * CommonPositions, CommonSizes, MaxTurn (degrees), Area (of output 0), MeshArea.
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
  /** Directions, positions and sizes of surfaces that are nearly equal become equal where surfaces
   * then move by this distance at most at the points of their regions, unit of the points, up to
   * the tolerance; 0: all keep their own. Default 0, valid range >= 0. */
  vtkSetClampMacro(SnapDistance, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(SnapDistance, double);
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
  ///@{
  /** Whether regions of free form become spline faces; else they are an error. Default on. */
  vtkSetMacro(FreeForm, bool);
  vtkGetMacro(FreeForm, bool);
  vtkBooleanMacro(FreeForm, bool);
  ///@}
  ///@{
  /** Share of the area that planes, cylinders, spheres, cones and tori have at least, else the mesh
   * is refused. Default 0.1, valid range [0, 1]. Advanced. */
  vtkSetClampMacro(MinimumAnalytic, double, 0.0, 1.0);
  vtkGetMacro(MinimumAnalytic, double);
  ///@}
  ///@{
  /** Stretch of a chart of free form at most; what is stretched more is cut. Default 3, valid range
   * [1.01, 1000]. Advanced. */
  vtkSetClampMacro(MaximumStretch, double, 1.01, 1000.0);
  vtkGetMacro(MaximumStretch, double);
  ///@}
  ///@{
  /** Work for spline surfaces at most, about seconds of one core. Default 50, valid range
   * [1e-6, 1e6]. Advanced. */
  vtkSetClampMacro(Effort, double, 1e-6, 1e6);
  vtkGetMacro(Effort, double);
  ///@}
  ///@{
  /** Seconds for spline surfaces at most; 0: no limit. Default 0, valid range [0, 1e9]. Advanced.
   */
  vtkSetClampMacro(TimeLimit, double, 0.0, 1e9);
  vtkGetMacro(TimeLimit, double);
  ///@}

protected:
  vtkAnalyticModel();
  ~vtkAnalyticModel() override = default;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkAnalyticModel(const vtkAnalyticModel&) = delete;
  void operator=(const vtkAnalyticModel&) = delete;

  double Tolerance = 0.0;
  double MaximumSag = 5.0;
  double SnapDistance = 0.0;
  double CornerAngle = 20.0;
  double ChordalTolerance = 0.0;
  bool FreeForm = true;
  double MinimumAnalytic = 0.1;
  double MaximumStretch = 3.0;
  double Effort = 50.0;
  double TimeLimit = 0.0;
};
#endif
