// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSurfaceRemesh
 * @brief   makes triangles with edges of wanted lengths on a triangle mesh
 *
 * Input are triangles (quadrilaterals and polygons are divided), closed or open, of one or several
 * parts. Edges are divided, joined and turned, and points moved along the surface, until edges are
 * about as long as asked for and triangles have no small angles. Sharp edges (as vtkMeshFeatures
 * finds them on a clean mesh), rims and corners stay; how the surface hangs together does not
 * change.
 *
 * Output 0 (vtkPolyData): the triangles with the cell data of those of the input below their
 * middles, CellIds of these, RegionId (between sharp edges and rims) and PartId, and the point
 * array EdgeSize, the length that was asked for.
 *
 * Output 1 (vtkPolyData): the sharp edges and rims as lines with ChainId, the corners as vertices
 * with ChainId -1.
 *
 * Output 2 (vtkTable): one row with points, triangles, parts, Euler number, area, volume, least
 * angle and mean edge before and after, FittingEdges, Intersections, DistanceFromInput,
 * DistanceToInput, and Diagonal.
 *
 * @source Botsch, Kobbelt (2004); Dunyach et al. (2013).
 */
#ifndef vtkSurfaceRemesh_h
#define vtkSurfaceRemesh_h
#include "vtkKnotworkSurfaceRemeshingModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

class VTKKNOTWORKSURFACEREMESHING_EXPORT vtkSurfaceRemesh : public vtkSplineAlgorithm
{
public:
  static vtkSurfaceRemesh* New();
  vtkTypeMacro(vtkSurfaceRemesh, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Sizings
  {
    CONSTANT = 0,
    CURVATURE,
    ARRAY
  };

  ///@{
  /** What tells the lengths of edges, one of Sizings: CONSTANT, Size everywhere; CURVATURE, as long
   * as a chord may be for Tolerance; ARRAY, the values of SizeArray. Default CONSTANT. Group
   * "Sizes". */
  vtkSetClampMacro(Sizing, int, CONSTANT, ARRAY);
  vtkGetMacro(Sizing, int);
  ///@}
  ///@{
  /** Length of edges, unit of the points; 0: the mean length of the input's. Default 0, valid range
   * >= 0. For Sizing CONSTANT. Group "Sizes". */
  vtkSetClampMacro(Size, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(Size, double);
  ///@}
  ///@{
  /** Distance of a chord from the surface, share of the diagonal of the input's box. Default 0.001,
   * valid range [1e-6, 1]. For Sizing CURVATURE. Group "Sizes". */
  vtkSetClampMacro(Tolerance, double, 1e-6, 1.0);
  vtkGetMacro(Tolerance, double);
  ///@}
  ///@{
  /** Shortest length of edges, unit of the points; 0: 0.005 of the diagonal. Default 0, valid range
   * >= 0. For Sizing CURVATURE. Group "Sizes". */
  vtkSetClampMacro(SmallestSize, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(SmallestSize, double);
  ///@}
  ///@{
  /** Longest length of edges, unit of the points; 0: 0.1 of the diagonal. Default 0, valid range >=
   * 0. For Sizing CURVATURE. Group "Sizes". */
  vtkSetClampMacro(LargestSize, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(LargestSize, double);
  ///@}
  ///@{
  /** Point array of the input: length of edges at each point, above 0, linear between. Lengths grow
   * by half of the distance at most. Default empty. For Sizing ARRAY. Group "Sizes". */
  vtkSetStringMacro(SizeArray);
  vtkGetStringMacro(SizeArray);
  ///@}
  ///@{
  /** Angle between the normals of two sides from which on an edge is sharp, degrees. Default 40,
   * valid range [1, 179]. Group "Sharp Edges". */
  vtkSetClampMacro(SharpAngle, double, 1.0, 179.0);
  vtkGetMacro(SharpAngle, double);
  ///@}
  ///@{
  /** The same of edges that continue sharp ones, at most SharpAngle. Default 20, valid range [1,
   * 179]. Group "Sharp Edges". */
  vtkSetClampMacro(WeakAngle, double, 1.0, 179.0);
  vtkGetMacro(WeakAngle, double);
  ///@}
  ///@{
  /** Turn of a chain of sharp edges from which on it has a corner, degrees. Default 60, valid range
   * [1, 180]. Group "Sharp Edges". */
  vtkSetClampMacro(CornerAngle, double, 1.0, 180.0);
  vtkGetMacro(CornerAngle, double);
  ///@}
  ///@{
  /** Times that edges are divided, joined and turned, and points moved. Default 10, valid range [1,
   * 1000]. Advanced. */
  vtkSetClampMacro(Iterations, int, 1, 1000);
  vtkGetMacro(Iterations, int);
  ///@}
  ///@{
  /** Farthest that the result may be from the input, and the input from the result, share of the
   * diagonal of the input's box; edges stay shorter where this demands it. Default 0.01, valid
   * range [1e-6, 1]. */
  vtkSetClampMacro(Limit, double, 1e-6, 1.0);
  vtkGetMacro(Limit, double);
  ///@}

protected:
  vtkSurfaceRemesh();
  ~vtkSurfaceRemesh() override;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkSurfaceRemesh(const vtkSurfaceRemesh&) = delete;
  void operator=(const vtkSurfaceRemesh&) = delete;

  int Sizing = CONSTANT;
  double Size = 0.0;
  double Tolerance = 0.001;
  double SmallestSize = 0.0;
  double LargestSize = 0.0;
  char* SizeArray = nullptr;
  double SharpAngle = 40.0;
  double WeakAngle = 20.0;
  double CornerAngle = 60.0;
  int Iterations = 10;
  double Limit = 0.01;
};
#endif
