// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSplineAnalysis
 * @brief   solves Poisson's equation or linear elasticity on a spline or a mesh
 *
 * Input 0 is a body that fills a part of the plane z = 0 or of space: spline surfaces or volumes of
 * any family, a collection of them, or triangles, quadrilaterals, tetrahedra and hexahedra of any
 * order, straight or curved. Patches whose sides are one are glued. Every element is proved valid
 * before anything is solved; a folded one is an error with the place.
 *
 * Materials, sources and conditions are given as JSON (Problem, or a file: ProblemFile); the
 * module's page has the keys. Expressions are those of vtkExprTkFunctionParser in x, y, z and, of
 * loads, the outward normal nx, ny, nz.
 *
 * Output 0 is the input with the point arrays `Solution` and `Flux` (Poisson), or `Displacement`,
 * `Stress` (XX YY ZZ XY YZ XZ), `VonMisesStress` and `PrincipalStress`, of which the solution is
 * exact and the others are projected; and with the cell arrays `Energy`, `EstimatedError` (in the
 * norm of energy) and, of elasticity, `LargestVonMises` (at Gauss points). Output 1 has, with
 * GaussPoints, the Gauss points with the same values as computed. Output 2 is a table with a row a
 * condition: Facets or Functions that it chose, their measure and the reaction there. Output 3 is a
 * table of one row: energy, sizes, loads and reactions in total, the residual. Output 4 is a table
 * with a row a solution, of which there are several when refinement is adaptive: functions,
 * elements, estimated error, energy, marked elements.
 */
#ifndef vtkSplineAnalysis_h
#define vtkSplineAnalysis_h
#include "vtkKnotworkSplineAnalysisModule.h" // for export macro
#include <knotwork/SplineAnalysis/vtkAnalysisAlgorithm.h>

#include <array> // for Seconds

class VTKKNOTWORKSPLINEANALYSIS_EXPORT vtkSplineAnalysis : public vtkAnalysisAlgorithm
{
public:
  static vtkSplineAnalysis* New();
  vtkTypeMacro(vtkSplineAnalysis, vtkAnalysisAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /** Whether output 1 gets the Gauss points, some tens an element. Default on. */
  vtkSetMacro(GaussPoints, bool);
  vtkGetMacro(GaussPoints, bool);
  vtkBooleanMacro(GaussPoints, bool);
  ///@}

  ///@{
  /** Solutions at most. From 2 on the elements that the error is largest in are split between them:
   * for tensor-product and THB patches, and single LR ones. Default 1, valid range [1, 100]. Kernel
   * default 50. Group "Adaptive Refinement". */
  vtkSetClampMacro(MaxSteps, int, 1, 100);
  vtkGetMacro(MaxSteps, int);
  ///@}
  ///@{
  /** Estimated error in the norm of energy at which refinement ends. Default 0, valid range >= 0.
   * For MaxSteps not 1. Group "Adaptive Refinement".
   */
  vtkSetClampMacro(ErrorTolerance, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(ErrorTolerance, double);
  ///@}
  ///@{
  /** Functions at which refinement ends. Default 100000, valid range >= 1. Kernel default 100000.
   * For MaxSteps not 1. Group "Adaptive Refinement".
   */
  vtkSetClampMacro(MaximumFunctions, int, 1, VTK_INT_MAX);
  vtkGetMacro(MaximumFunctions, int);
  ///@}
  ///@{
  /** Share of the squared error that the elements to be split have at least (Doerfler). Default
   * 0.5, valid range [0.01, 1]. Advanced. For MaxSteps not 1. Group "Adaptive Refinement". */
  vtkSetClampMacro(Theta, double, 0.01, 1.0);
  vtkGetMacro(Theta, double);
  ///@}

  /** Seconds of the last solution, which are in no output: `step` 0 certificate, 1 assembly, 2
   * solution, 3 stresses; 0 for others. */
  double GetSeconds(int step);

protected:
  vtkSplineAnalysis();
  ~vtkSplineAnalysis() override = default;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestDataObject(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkSplineAnalysis(const vtkSplineAnalysis&) = delete;
  void operator=(const vtkSplineAnalysis&) = delete;

  bool GaussPoints = true;
  int MaxSteps = 1;
  double ErrorTolerance = 0.0;
  int MaximumFunctions = 100000;
  double Theta = 0.5;
  std::array<double, 4> Seconds{};
};
#endif
