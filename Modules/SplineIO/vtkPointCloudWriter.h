// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkPointCloudWriter
 * @brief   points to text and g2 files
 *
 * Input: a vtkPointSet; cells are not written. The ending says the format: .xyz and .txt have a
 * point a line, separated by blanks, .csv by commas, with all point arrays of numbers as columns
 * (components as `name:0`, `name:1`, ...); .g2 has point clouds (400), one a `CloudId` with its
 * `Color`, and other arrays are left out with a warning. What is written is read again bit for bit.
 * Errors: no points (EmptyInput), a coordinate that is not finite (NonFiniteInput; other numbers
 * may be NaN), another ending (InvalidParameter), a file that cannot be written.
 */
#ifndef vtkPointCloudWriter_h
#define vtkPointCloudWriter_h
#include "vtkKnotworkSplineIOModule.h" // for export macro
#include "vtkWriter.h"
#include <knotwork/SplineCore/Status.h> // for knotwork::Status

#include <string> // for texts

class VTKKNOTWORKSPLINEIO_EXPORT vtkPointCloudWriter : public vtkWriter
{
public:
  static vtkPointCloudWriter* New();
  vtkTypeMacro(vtkPointCloudWriter, vtkWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /** The file to write: .xyz, .txt, .csv or .g2. */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

protected:
  vtkPointCloudWriter();
  ~vtkPointCloudWriter() override;
  void WriteData() override;
  int FillInputPortInformation(int port, vtkInformation* info) override;

  char* FileName = nullptr;

private:
  vtkPointCloudWriter(const vtkPointCloudWriter&) = delete;
  void operator=(const vtkPointCloudWriter&) = delete;
  knotwork::Status MakeText(std::string& text);
};
#endif
