// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkVolumeComparison
 * @brief   compares a spline volume and a mesh of the same solid
 *
 * Input 0 is a grid of spline volumes, input 1 a mesh of tetrahedra, wedges or hexahedra, linear,
 * quadratic, Lagrange or Bezier cells; either may be of either kind. Input 2 is the reference that
 * both are measured against: trimmed faces of a CAD file (vtkCADReader), spline surfaces or
 * volumes, or triangles; it bounds a solid. Without one it is input 0.
 *
 * Outputs 0 and 1 are triangles on the boundaries of the inputs, whose points lie on them, with the
 * point arrays Distance (from the reference, positive outside) and ReferencePoint. Output 2 is a
 * table with a row a bin of the least scaled Jacobian of the cells: From, To, and for First and
 * Second the numbers of cells by its proven lower bound (Guaranteed) and by the least value that
 * was met, which bounds it from above (Attained). Output 3 is a table with a row an input; the
 * module's page has its columns.
 */
#ifndef vtkVolumeComparison_h
#define vtkVolumeComparison_h
#include "vtkKnotworkTetMeshingModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

#include <array> // for Seconds

class VTKKNOTWORKTETMESHING_EXPORT vtkVolumeComparison : public vtkSplineAlgorithm
{
public:
  static vtkVolumeComparison* New();
  vtkTypeMacro(vtkVolumeComparison, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /** Largest distance of the boundaries' triangles from the boundaries, and of the reference's from
   * it, share of the diagonal of the reference's box. Default 0.0001, valid range [1e-12, 1]. */
  vtkSetClampMacro(ChordalTolerance, double, 1e-12, 1.0);
  vtkGetMacro(ChordalTolerance, double);
  ///@}
  ///@{
  /** Points of the reference at least. Default 20000, valid range [100, 10000000]. */
  vtkSetClampMacro(Samples, int, 100, 10000000);
  vtkGetMacro(Samples, int);
  ///@}
  ///@{
  /** Bins of the histogram from -1 to 1. Default 40, valid range [1, 10000]. */
  vtkSetClampMacro(Bins, int, 1, 10000);
  vtkGetMacro(Bins, int);
  ///@}
  ///@{
  /** Parts of a cell for the proven bound of its scaled Jacobian. Default 64, valid range [1,
   * 65536]. Advanced. */
  vtkSetClampMacro(BoundBoxes, int, 1, 65536);
  vtkGetMacro(BoundBoxes, int);
  ///@}
  ///@{
  /** The mesh (input port 1). */
  void SetMeshConnection(vtkAlgorithmOutput* output);
  void SetMeshData(vtkDataObject* mesh);
  ///@}
  ///@{
  /** The shape that both stand for (input port 2). */
  void SetReferenceConnection(vtkAlgorithmOutput* output);
  void SetReferenceData(vtkDataObject* reference);
  ///@}

  /** Seconds of the last comparison, which are in no output: of `input` 0 or 1, `step` 0
   * certificate, 1 measures, 2 distances; 0 for others. */
  double GetSeconds(int input, int step);

protected:
  vtkVolumeComparison();
  ~vtkVolumeComparison() override = default;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkVolumeComparison(const vtkVolumeComparison&) = delete;
  void operator=(const vtkVolumeComparison&) = delete;

  double ChordalTolerance = 1e-4;
  int Samples = 20000;
  int Bins = 40;
  int BoundBoxes = 64;
  std::array<std::array<double, 3>, 2> Seconds{};
};
#endif
