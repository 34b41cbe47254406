// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkGoToolsG2Writer
 * @brief   splines to GoTools g2 files
 *
 * Tensor-product curves, surfaces and volumes, polynomial and rational, and LR surfaces, in the
 * order of the patches; hierarchical patches become tensor products, with a warning; the format has
 * no ids and no topology. What is written is read again bit for bit. Errors: patches of kind Bezier
 * (InvalidParameter).
 */
#ifndef vtkGoToolsG2Writer_h
#define vtkGoToolsG2Writer_h
#include "vtkKnotworkSplineIOModule.h" // for export macro
#include <knotwork/SplineIO/vtkSplineFileWriter.h>

class VTKKNOTWORKSPLINEIO_EXPORT vtkGoToolsG2Writer : public vtkSplineFileWriter
{
public:
  static vtkGoToolsG2Writer* New();
  vtkTypeMacro(vtkGoToolsG2Writer, vtkSplineFileWriter);

  ///@{
  /** Boundary curves of the surfaces, as vtkGoToolsG2Reader gives them; optional. */
  void SetCurvesConnection(vtkAlgorithmOutput* port) { this->SetInputConnection(1, port); }
  void SetCurvesData(vtkDataObject* curves) { this->SetInputDataObject(1, curves); }
  ///@}

protected:
  vtkGoToolsG2Writer();
  ~vtkGoToolsG2Writer() override = default;
  bool Holds(knotwork::SpaceKind kind) const override;
  knotwork::Result<std::string> Format(const knotwork::SplineFile& file) override;
  knotwork::Status AddMore(knotwork::SplineFile& file) override;
  int FillInputPortInformation(int port, vtkInformation* info) override;

private:
  vtkGoToolsG2Writer(const vtkGoToolsG2Writer&) = delete;
  void operator=(const vtkGoToolsG2Writer&) = delete;
};
#endif
