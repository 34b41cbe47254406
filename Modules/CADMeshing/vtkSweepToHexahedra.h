// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSweepToHexahedra
 * @brief   moves quadrilaterals along a path and fills the way with hexahedra
 *
 * Input 0 is a mesh of quadrilaterals, plane or not. Input 1, which need not be given, is the path:
 * vtkPolyData with one line of straight pieces (a spline curve by vtkSplineTessellate); without one
 * it is the vector Direction. The source lies at the begin of the path or beside it, keeps its
 * place in a frame that turns with the path as little as can be, and is turned by Twist and scaled
 * by Scale on the way. A path that ends where it begins makes a ring. Hexahedra are right-handed on
 * the whole, and each is certified.
 *
 * Output 0 (vtkUnstructuredGrid): the hexahedra with the data of the quadrilaterals and points
 * that they come from, the cell arrays Layer, SourceCellId, ScaledJacobian (least sample) and
 * Verdict (as vtkSplineValidate: 1 valid, 0 undecided, -1 invalid, 2 reversed), and the point
 * arrays PointLayer and SourcePointId.
 *
 * Output 1 (vtkTable): one row with Hexahedra, Points, Layers, Ring, Verdict, ValidCells,
 * ReversedCells, InvalidCells, UndecidedCells, MinJacobianLower, LeastScaledJacobian and Volume.
 *
 * Errors: those of knotwork::SweepAlongPath.
 */
#ifndef vtkSweepToHexahedra_h
#define vtkSweepToHexahedra_h
#include "vtkKnotworkCADMeshingModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

class VTKKNOTWORKCADMESHING_EXPORT vtkSweepToHexahedra : public vtkSplineAlgorithm
{
public:
  static vtkSweepToHexahedra* New();
  vtkTypeMacro(vtkSweepToHexahedra, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /** The way from begin to end, without a path. Default 0 0 1. Components x, y, z. */
  vtkSetVector3Macro(Direction, double);
  vtkGetVector3Macro(Direction, double);
  ///@}
  ///@{
  /** Hexahedra along the way, of equal lengths; 3 or more along a closed path. Default 8, valid
   * range >= 1. */
  vtkSetClampMacro(Layers, int, 1, VTK_INT_MAX);
  vtkGetMacro(Layers, int);
  ///@}
  ///@{
  /** Degrees by which the source turns about the path until its end; along a closed path a multiple
   * of 360. Default 0. */
  vtkSetMacro(Twist, double);
  vtkGetMacro(Twist, double);
  ///@}
  ///@{
  /** Size of the end, about the path, as a share of the source's; along a closed path 1. Default 1,
   * valid range [1e-06, 1e+06]. */
  vtkSetClampMacro(Scale, double, 1e-6, 1e6);
  vtkGetMacro(Scale, double);
  ///@}
  ///@{
  /** The path (input port 1). */
  void SetPathConnection(vtkAlgorithmOutput* output);
  void SetPathData(vtkDataObject* path);
  ///@}

protected:
  vtkSweepToHexahedra();
  ~vtkSweepToHexahedra() override = default;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkSweepToHexahedra(const vtkSweepToHexahedra&) = delete;
  void operator=(const vtkSweepToHexahedra&) = delete;

  double Direction[3] = { 0.0, 0.0, 1.0 };
  int Layers = 8;
  double Twist = 0.0;
  double Scale = 1.0;
};
#endif
