// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkTemplateMapping
 * @brief   spline map that carries the patches of a planar template onto target patches
 *
 * Input 0 is the template and input 1 the target: vtkPolyData of polylines in the plane z = 0 with
 * the cell array `PatchId`. Cells of one id are one patch, joined in their order: each must begin
 * where the one before ends. Target patches go with the template patches of the same id; template
 * patches without a target are free and only follow. Optional point arrays: `Parameter` (of the
 * template increasing along each patch; of the target the parameters of the first iteration;
 * without it point i of n has i / (n - 1)), and `Normals` of the target (without it those of the
 * polyline).
 *
 * Output 0 is the map as a spline grid of one patch over the template's bounding box, with the cell
 * array `MaxError`: the largest distance of the samples in the cell, 0 where there are none. Output
 * 1 is the mapped template: polylines with the cell array `PatchId` and the point arrays `PatchId`,
 * `Parameter` and `Distance` (to the target's polyline, -1 on free patches). Output 2 is the
 * convergence table, one row an iteration: `Iteration`, `SquaredL2Error` (sum over all target
 * samples), `MaxError` (two-sided), `NegativeJacobianPercent` (of 1000 x 1000 points of the
 * domain), `Functions`, `Seconds` (since the start).
 *
 * Without points in both inputs the outputs are empty.
 *
 * @source Sajavicius, Juettler, Speh (2018). The module's page has the method, limits and errors.
 */
#ifndef vtkTemplateMapping_h
#define vtkTemplateMapping_h
#include "vtkKnotworkTemplateMappingModule.h" // for export macro
#include "vtkSplineAlgorithm.h"

class VTKKNOTWORKTEMPLATEMAPPING_EXPORT vtkTemplateMapping : public vtkSplineAlgorithm
{
public:
  static vtkTemplateMapping* New();
  vtkTypeMacro(vtkTemplateMapping, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /** What an iteration minimizes, over the samples p of the target. */
  enum Methods
  {
    FIXED = 0, ///< distance to the mapped point of the sample's own, fixed parameter
    PDM = 1,   ///< distance to the closest mapped point
    TDM = 2    ///< distance of the closest mapped point to the tangent at p
  };

  ///@{
  /** The target, as input 1. */
  void SetTargetConnection(vtkAlgorithmOutput* target) { this->SetInputConnection(1, target); }
  void SetTargetData(vtkDataObject* target) { this->SetInputData(1, target); }
  ///@}

  ///@{
  /** FIXED, PDM or TDM. Default TDM. */
  vtkSetClampMacro(Method, int, FIXED, TDM);
  vtkGetMacro(Method, int);
  ///@}
  ///@{
  /** Iterations: one least-squares step and one update of the closest points each. Default 20,
   * valid range [1, 100000]. */
  vtkSetClampMacro(Iterations, int, 1, 100000);
  vtkGetMacro(Iterations, int);
  ///@}
  ///@{
  /** Polynomial degree of the map in both directions. Default 3, valid range [1, 9]. */
  vtkSetClampMacro(Degree, int, 1, 9);
  vtkGetMacro(Degree, int);
  ///@}
  ///@{
  /** Equally spaced inner knots in each direction. Default 11, valid range [0, 4096]. */
  vtkSetClampMacro(InnerKnots, int, 0, 4096);
  vtkGetMacro(InnerKnots, int);
  ///@}
  ///@{
  /** Dense samples of each template patch, at equally spaced parameters, among which closest points
   * are searched first: 0 takes the template's own points. Default 0, valid range 0 and [2, 1e7].
   */
  vtkSetClampMacro(TemplateSamples, int, 0, 10000000);
  vtkGetMacro(TemplateSamples, int);
  ///@}
  ///@{
  /** Newton steps from the nearest dense sample. Default 2, valid range [0, 100]. */
  vtkSetClampMacro(NewtonSteps, int, 0, 100);
  vtkGetMacro(NewtonSteps, int);
  ///@}
  ///@{
  /** Weight of the squared change of the control points in an iteration. Default 0.02, not
   * negative; 0 needs samples that determine every control point. */
  vtkSetClampMacro(TikhonovWeight, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(TikhonovWeight, double);
  ///@}

protected:
  vtkTemplateMapping();
  ~vtkTemplateMapping() override = default;
  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestDataObject(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkTemplateMapping(const vtkTemplateMapping&) = delete;
  void operator=(const vtkTemplateMapping&) = delete;

  int Method = TDM;
  int Iterations = 20;
  int Degree = 3;
  int InnerKnots = 11;
  int TemplateSamples = 0;
  int NewtonSteps = 2;
  double TikhonovWeight = 2e-2;
};
#endif
