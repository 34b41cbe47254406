// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSplineCombine
 * @brief   difference, average or any weighted sum of two spline surfaces, as a spline surface
 *
 * Inputs 0 and 1 are spline grids of surfaces; patches are combined in pairs in the order of their
 * ids. Both splines of a pair are brought into a common refinement, so the result is exact: a
 * tensor-product or hierarchical spline where both are of that kind and fit, else an LR spline.
 *
 * Of height fields (x and y are the parameters) z is combined. Of other surfaces the sum is taken
 * of points; their DIFFERENCE is the first surface with the field `Difference` (3 components).
 * Fields that both inputs have are combined with the same weights, others do not pass, with a
 * warning; cell arrays other than those of spline grids do not pass.
 *
 * Output 0 is the combination. Output 1 is a table with a row a patch: PatchId, Functions, and
 * MinBound and MaxBound, between which z, or each component of the difference, is proved to lie.
 */
#ifndef vtkSplineCombine_h
#define vtkSplineCombine_h
#include "vtkKnotworkSurfaceFittingModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

class VTKKNOTWORKSURFACEFITTING_EXPORT vtkSplineCombine : public vtkSplineAlgorithm
{
public:
  static vtkSplineCombine* New();
  vtkTypeMacro(vtkSplineCombine, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Modes
  {
    DIFFERENCE = 0, ///< first - second
    AVERAGE,        ///< weights a half
    WEIGHTED        ///< FirstWeight and SecondWeight
  };

  ///@{
  /** What is computed, one of Modes: first minus second, weights of a half, or any weights.
   * Default DIFFERENCE. */
  vtkSetClampMacro(Mode, int, DIFFERENCE, WEIGHTED);
  vtkGetMacro(Mode, int);
  ///@}
  ///@{
  /** Weight of the first surface. Default 0.5. For Mode WEIGHTED. */
  vtkSetMacro(FirstWeight, double);
  vtkGetMacro(FirstWeight, double);
  ///@}
  ///@{
  /** Weight of the second surface. Default 0.5. For Mode WEIGHTED. */
  vtkSetMacro(SecondWeight, double);
  vtkGetMacro(SecondWeight, double);
  ///@}
  ///@{
  /** Whether surfaces are cut to what their domains have in common; else domains that differ are
   * an error. Default off. */
  vtkSetMacro(CommonDomain, bool);
  vtkGetMacro(CommonDomain, bool);
  vtkBooleanMacro(CommonDomain, bool);
  ///@}
  ///@{
  /** The second surface (input port 1). */
  void SetSecondConnection(vtkAlgorithmOutput* output);
  void SetSecondData(vtkDataObject* surface);
  ///@}

  ///@{
  /** Functions that a combined surface may have; more is an error before memory is taken.
   * Default 1000000, valid range >= 1. Advanced. */
  vtkSetClampMacro(MaximumFunctions, int, 1, VTK_INT_MAX);
  vtkGetMacro(MaximumFunctions, int);
  ///@}

protected:
  vtkSplineCombine();
  ~vtkSplineCombine() override = default;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkSplineCombine(const vtkSplineCombine&) = delete;
  void operator=(const vtkSplineCombine&) = delete;

  int MaximumFunctions = 1000000;
  int Mode = DIFFERENCE;
  double FirstWeight = 0.5;
  double SecondWeight = 0.5;
  bool CommonDomain = false;
};
#endif
