// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkBEXTReader
 * @brief   splines from BEXT files of Bezier extraction operators
 *
 * Text or JSON. The elements of a file are one patch, which is known by the operators alone: it is
 * drawn, evaluated, checked and written, but not refined. Errors: InvalidFormat with line, or key
 * and element; what the numbers say: functions of an element that are negative, do not sum to one
 * or do not span its polynomials (NotInSpace), numbers out of range (InvalidTopology), weights.
 */
#ifndef vtkBEXTReader_h
#define vtkBEXTReader_h
#include "vtkKnotworkSplineIOModule.h" // for export macro
#include <knotwork/SplineIO/vtkSplineFileReader.h>

class VTKKNOTWORKSPLINEIO_EXPORT vtkBEXTReader : public vtkSplineFileReader
{
public:
  static vtkBEXTReader* New();
  vtkTypeMacro(vtkBEXTReader, vtkSplineFileReader);

protected:
  vtkBEXTReader();
  ~vtkBEXTReader() override = default;
  knotwork::Result<knotwork::SplineFile> Parse(std::string_view text) override;
  bool Recognize(std::string_view beginning) override;

private:
  vtkBEXTReader(const vtkBEXTReader&) = delete;
  void operator=(const vtkBEXTReader&) = delete;
};
#endif
