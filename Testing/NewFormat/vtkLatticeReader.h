// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkLatticeReader
 * @brief   splines from lattices, a format that new_format.py adds to a copy of the tree
 */
#ifndef vtkLatticeReader_h
#define vtkLatticeReader_h
#include "vtkKnotworkSplineIOModule.h" // for export macro
#include <knotwork/SplineIO/vtkSplineFileReader.h>

class VTKKNOTWORKSPLINEIO_EXPORT vtkLatticeReader : public vtkSplineFileReader
{
public:
  static vtkLatticeReader* New();
  vtkTypeMacro(vtkLatticeReader, vtkSplineFileReader);

protected:
  vtkLatticeReader();
  ~vtkLatticeReader() override = default;
  knotwork::Result<knotwork::SplineFile> Parse(std::string_view text) override;
  bool Recognize(std::string_view beginning) override;

private:
  vtkLatticeReader(const vtkLatticeReader&) = delete;
  void operator=(const vtkLatticeReader&) = delete;
};
#endif
