// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkBEXTWriter
 * @brief   splines to BEXT files of Bezier extraction operators
 *
 * Patches of any kind and one dimension, by the operators of their elements: text, or JSON when the
 * name ends in .json. Control points and elements of several patches follow each other. What is
 * written is read again bit for bit. Errors: curves, surfaces and volumes in one grid
 * (DimensionMismatch).
 */
#ifndef vtkBEXTWriter_h
#define vtkBEXTWriter_h
#include "vtkKnotworkSplineIOModule.h" // for export macro
#include <knotwork/SplineIO/vtkSplineFileWriter.h>

class VTKKNOTWORKSPLINEIO_EXPORT vtkBEXTWriter : public vtkSplineFileWriter
{
public:
  static vtkBEXTWriter* New();
  vtkTypeMacro(vtkBEXTWriter, vtkSplineFileWriter);

protected:
  vtkBEXTWriter();
  ~vtkBEXTWriter() override = default;
  bool Holds(knotwork::SpaceKind kind) const override;
  knotwork::Result<std::string> Format(const knotwork::SplineFile& file) override;

private:
  vtkBEXTWriter(const vtkBEXTWriter&) = delete;
  void operator=(const vtkBEXTWriter&) = delete;
};
#endif
