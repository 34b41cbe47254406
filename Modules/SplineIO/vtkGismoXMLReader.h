// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkGismoXMLReader
 * @brief   splines from G+Smo XML files
 *
 * Curves, tensor-product B-splines and NURBS and (rational) THB-splines with one to three
 * parameters; PatchId is the id of the geometry. Other objects of the file are left out, geometries
 * of other types with a warning. The file is known by its root element `xml`, not by its name.
 * Errors: InvalidFormat with line and element, and what the kernel finds wrong with degrees, knots,
 * weights, boxes.
 */
#ifndef vtkGismoXMLReader_h
#define vtkGismoXMLReader_h
#include "vtkKnotworkSplineIOModule.h" // for export macro
#include <knotwork/SplineIO/vtkSplineFileReader.h>

class VTKKNOTWORKSPLINEIO_EXPORT vtkGismoXMLReader : public vtkSplineFileReader
{
public:
  static vtkGismoXMLReader* New();
  vtkTypeMacro(vtkGismoXMLReader, vtkSplineFileReader);

protected:
  vtkGismoXMLReader();
  ~vtkGismoXMLReader() override = default;
  knotwork::Result<knotwork::SplineFile> Parse(std::string_view text) override;
  bool Recognize(std::string_view beginning) override;

private:
  vtkGismoXMLReader(const vtkGismoXMLReader&) = delete;
  void operator=(const vtkGismoXMLReader&) = delete;
};
#endif
