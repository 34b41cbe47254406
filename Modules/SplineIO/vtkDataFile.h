// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkDataFile
 * @brief   reads and writes a file by the ending of its name
 *
 * For scripts that do not care which reader or writer serves a format (the module's page lists
 * them): splines, trimmed faces, meshes and points of VTK, G+Smo, GoTools, STEP, IGES, STL, OBJ,
 * PLY, OFF and text. In Python knotwork.read(name) and knotwork.write(data, name) call it and raise
 * what goes wrong.
 *
 * It is no part of a pipeline: what is read is there at once. A written file takes its place when
 * all of it has been written, a .vtpc with its pieces; what was there before is kept otherwise.
 */
#ifndef vtkDataFile_h
#define vtkDataFile_h
#include "vtkKnotworkSplineIOModule.h" // for export macro
#include "vtkObject.h"
#include "vtkSmartPointer.h" // for Curves

#include <knotwork/SplineCore/Status.h> // for knotwork::Status
#include <string>                       // for Encoding
#include <vector>                       // for Warnings

class vtkDataObject;

class VTKKNOTWORKSPLINEIO_EXPORT vtkDataFile : public vtkObject
{
public:
  static vtkDataFile* New();
  vtkTypeMacro(vtkDataFile, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /** Reads a file; null: GetErrorText says why. What trims or bounds its surfaces is in Curves
   * then. The data live until the next call. */
  vtkDataObject* Read(const std::string& file);

  /** Writes data, with Curves if there are any, and takes the place of a file of that name; false:
   * GetErrorText says why. */
  bool Write(vtkDataObject* data, const std::string& file);

  ///@{
  /** Trimming curves of STEP and IGES, boundary curves of g2: of the file that was read, or to be
   * written. Default null (none). */
  void SetCurves(vtkDataObject* curves);
  vtkDataObject* GetCurves();
  ///@}
  ///@{
  /** How numbers are written in VTK's formats: ascii, binary or appended. Default binary. */
  vtkSetMacro(Encoding, std::string);
  vtkGetMacro(Encoding, std::string);
  ///@}
  ///@{
  /** Of the last call: vtkErrorCode::UserError + code of the error and its sentence, which names
   * the file; 0 and empty without any. */
  vtkGetMacro(ErrorCode, unsigned long);
  vtkGetMacro(ErrorText, std::string);
  /** Whether the file system refused, and not the format. */
  bool GetErrorIsOfFile();
  ///@}
  ///@{
  /** Warnings of the last call, and parts that were left out of what it read; one sentence each. */
  int GetNumberOfWarnings() { return static_cast<int>(this->Warnings.size()); }
  std::string GetWarning(int index) { return this->Warnings.at(static_cast<std::size_t>(index)); }
  int GetNumberOfPartsLeftOut() { return static_cast<int>(this->LeftOut.size()); }
  std::string GetPartLeftOut(int index)
  {
    return this->LeftOut.at(static_cast<std::size_t>(index));
  }
  ///@}

protected:
  vtkDataFile() = default;
  ~vtkDataFile() override = default;

private:
  vtkDataFile(const vtkDataFile&) = delete;
  void operator=(const vtkDataFile&) = delete;
  void Begin();
  bool End(const knotwork::Status& status);
  knotwork::Status Put(vtkDataObject* data, const std::string& file);

  vtkSmartPointer<vtkDataObject> Data;
  vtkSmartPointer<vtkDataObject> Curves;
  std::string Encoding = "binary";
  unsigned long ErrorCode = 0;
  std::string ErrorText;
  std::vector<std::string> Warnings;
  std::vector<std::string> LeftOut;
};
#endif
