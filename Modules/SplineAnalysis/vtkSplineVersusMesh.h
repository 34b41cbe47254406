// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSplineVersusMesh
 * @brief   solves one problem on a spline and on a mesh and tells how far each is off
 *
 * Inputs 0 and 1 are bodies as vtkSplineAnalysis takes them: splines, and elements of any order;
 * either may be of either kind. Input 2 is a finer body of the same shape, whose solution is what
 * the others are compared with; where the problem has the known solution (the key "exact"), that is
 * what counts, and no third body is needed. The problem is stated by conditions that select places
 * by boxes and expressions, which hold on all bodies.
 *
 * Outputs 0 and 1 are the bodies with the arrays of vtkSplineAnalysis. Output 2 is a table with a
 * row a body: Body, Elements, Functions, Unknowns, Energy, Potential, EstimatedError (in the norm
 * of energy), Peak (von Mises' stress or the length of the flux, the largest at evenly spaced
 * points) and PeakPosition; EnergyError and, with an exact solution, L2Error, and where a peak is
 * known PeakError, shares of what they are compared with.
 */
#ifndef vtkSplineVersusMesh_h
#define vtkSplineVersusMesh_h
#include "vtkKnotworkSplineAnalysisModule.h" // for export macro
#include <knotwork/SplineAnalysis/vtkAnalysisAlgorithm.h>

#include <array> // for Seconds

class VTKKNOTWORKSPLINEANALYSIS_EXPORT vtkSplineVersusMesh : public vtkAnalysisAlgorithm
{
public:
  static vtkSplineVersusMesh* New();
  vtkTypeMacro(vtkSplineVersusMesh, vtkAnalysisAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /** The known largest von Mises stress (length of the flux); 0: that of the reference. Default 0,
   * valid range >= 0. */
  vtkSetClampMacro(ReferencePeak, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(ReferencePeak, double);
  ///@}
  ///@{
  /** The mesh (input port 1). */
  void SetMeshConnection(vtkAlgorithmOutput* output);
  void SetMeshData(vtkDataObject* mesh);
  ///@}
  ///@{
  /** The finer body (input port 2). */
  void SetReferenceConnection(vtkAlgorithmOutput* output);
  void SetReferenceData(vtkDataObject* reference);
  ///@}

  /** Seconds of the last solutions, which are in no output: of `input` 0, 1 or 2, `step` 0
   * certificate, 1 assembly, 2 solution; 0 for others. */
  double GetSeconds(int input, int step);

protected:
  vtkSplineVersusMesh();
  ~vtkSplineVersusMesh() override = default;
  int RequestDataObject(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkSplineVersusMesh(const vtkSplineVersusMesh&) = delete;
  void operator=(const vtkSplineVersusMesh&) = delete;

  double ReferencePeak = 0.0;
  std::array<std::array<double, 3>, 3> Seconds{};
};
#endif
