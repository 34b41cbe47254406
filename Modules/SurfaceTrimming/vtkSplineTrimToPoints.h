// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSplineTrimToPoints
 * @brief   trims a fitted surface to where its points are
 *
 * Input 0 is a spline grid with one surface, input 1 the points (a vtkPointSet). Of a height field
 * (x and y are the parameters) the points' parameters are x and y, else their point array `UV`, as
 * vtkSplineSurfaceFit gives it.
 *
 * The outline of the parameters, holes included, is found on a grid of cells and fitted by trimming
 * curves; every connected part becomes a face on the same surface, which is expanded to a tensor
 * product where it is not one.
 *
 * Output 0 are the faces as a watertight triangulation with normals, `FaceId` and `UV`. Outputs 1
 * and 2 are the faces themselves, their surfaces and trimming curves as spline grids, which
 * vtkCADWriter writes as STEP or IGES. Output 3 is a table of one row with all numbers.
 *
 * Faces that are not proved regular, and loops that are not proved simple, are an output with a
 * warning.
 */
#ifndef vtkSplineTrimToPoints_h
#define vtkSplineTrimToPoints_h
#include "vtkKnotworkSurfaceTrimmingModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

class VTKKNOTWORKSURFACETRIMMING_EXPORT vtkSplineTrimToPoints : public vtkSplineAlgorithm
{
public:
  static vtkSplineTrimToPoints* New();
  vtkTypeMacro(vtkSplineTrimToPoints, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /** Side of the cells that tell where points are, unit of the parameters; 0: 2.5 times the mean
   * spacing. Default 0, valid range >= 0. */
  vtkSetClampMacro(CellSize, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(CellSize, double);
  ///@}
  ///@{
  /** Holes and bays up to this width are closed, unit of the parameters, in whole cells that fit
   * into it; 0: two cells. Default 0, valid range >= 0. */
  vtkSetClampMacro(MaximumGap, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(MaximumGap, double);
  ///@}
  ///@{
  /** Separate parts with fewer cells are left out. Default 4, valid range [1, 10000000].
   * Advanced. */
  vtkSetClampMacro(MinimumCells, int, 1, 10000000);
  vtkGetMacro(MinimumCells, int);
  ///@}
  ///@{
  /** Largest distance, on the surface, between outline and trimming curves; 0: a third of a
   * cell. Default 0, valid range >= 0. Advanced. */
  vtkSetClampMacro(Tolerance, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(Tolerance, double);
  ///@}
  ///@{
  /** Largest distance between triangles and faces; 0: a quarter of the tolerance. Default 0,
   * valid range >= 0. Advanced. For Triangulation on. */
  vtkSetClampMacro(ChordalTolerance, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(ChordalTolerance, double);
  ///@}
  ///@{
  /** Whether the faces are triangulated, output 0. Default on. Advanced. */
  vtkSetMacro(Triangulation, bool);
  vtkGetMacro(Triangulation, bool);
  vtkBooleanMacro(Triangulation, bool);
  ///@}
  ///@{
  /** The points (input port 1). */
  void SetPointsConnection(vtkAlgorithmOutput* output);
  void SetPointsData(vtkDataObject* points);
  ///@}

  ///@{
  /** Functions that the surface may have as a tensor product; more is an error before memory is
   * taken. Default 1000000, valid range >= 1. Advanced. */
  vtkSetClampMacro(MaximumFunctions, int, 1, VTK_INT_MAX);
  vtkGetMacro(MaximumFunctions, int);
  ///@}

protected:
  vtkSplineTrimToPoints();
  ~vtkSplineTrimToPoints() override = default;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkSplineTrimToPoints(const vtkSplineTrimToPoints&) = delete;
  void operator=(const vtkSplineTrimToPoints&) = delete;

  double CellSize = 0.0;
  double MaximumGap = 0.0;
  int MinimumCells = 4;
  int MaximumFunctions = 1000000;
  double Tolerance = 0.0;
  double ChordalTolerance = 0.0;
  bool Triangulation = true;
};
#endif
