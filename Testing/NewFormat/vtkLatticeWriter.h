// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkLatticeWriter
 * @brief   splines to lattices, a format that new_format.py adds to a copy of the tree
 */
#ifndef vtkLatticeWriter_h
#define vtkLatticeWriter_h
#include "vtkKnotworkSplineIOModule.h" // for export macro
#include <knotwork/SplineIO/vtkSplineFileWriter.h>

class VTKKNOTWORKSPLINEIO_EXPORT vtkLatticeWriter : public vtkSplineFileWriter
{
public:
  static vtkLatticeWriter* New();
  vtkTypeMacro(vtkLatticeWriter, vtkSplineFileWriter);

protected:
  vtkLatticeWriter();
  ~vtkLatticeWriter() override = default;
  bool Holds(knotwork::SpaceKind kind) const override;
  knotwork::Result<std::string> Format(const knotwork::SplineFile& file) override;

private:
  vtkLatticeWriter(const vtkLatticeWriter&) = delete;
  void operator=(const vtkLatticeWriter&) = delete;
};
#endif
