// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSplineFileReader
 * @brief   base of the readers of spline files
 *
 * Output: a spline grid (vtkUnstructuredGrid) with a PatchId for every geometry of the file, and
 * the multi-patch topology that the file states as field data (KnotworkInterfaces,
 * KnotworkBoundary). Derived classes implement Parse() and Recognize(). Errors: a file that is
 * missing or cannot be read (EmptyInput), and those of the formats, with the place in the file.
 */
#ifndef vtkSplineFileReader_h
#define vtkSplineFileReader_h
#include "vtkKnotworkSplineIOModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>
#include <knotwork/SplineIO/SplineFile.h> // for knotwork::SplineFile

#include <string_view> // for texts

class VTKKNOTWORKSPLINEIO_EXPORT vtkSplineFileReader : public vtkSplineAlgorithm
{
public:
  vtkTypeMacro(vtkSplineFileReader, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /** The file to read. */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  /** 1 when the beginning of a file looks like the format, else 0; the file may still be damaged.
   */
  int CanReadFile(const char* fileName);

protected:
  vtkSplineFileReader();
  ~vtkSplineFileReader() override;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

  /** The splines of a file's text. */
  virtual knotwork::Result<knotwork::SplineFile> Parse(std::string_view text) = 0;
  /** Fills further outputs. */
  virtual knotwork::Status EncodeMore(const knotwork::SplineFile&, vtkInformationVector*)
  {
    return {};
  }
  /** Whether a text may begin like this (its first 4096 characters). */
  virtual bool Recognize(std::string_view beginning) = 0;

  char* FileName = nullptr;

private:
  vtkSplineFileReader(const vtkSplineFileReader&) = delete;
  void operator=(const vtkSplineFileReader&) = delete;
};
#endif
