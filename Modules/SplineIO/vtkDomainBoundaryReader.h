// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkDomainBoundaryReader
 * @brief   the boundary curves or faces of a domain from JSON
 *
 * An object with the list "curves" or the list "faces"; every side is a patch 0, 1, 2, ... in the
 * order of the list. The module's page has the keys. Errors: InvalidFormat with side and key, and
 * what the kernel finds wrong with degrees, knots, weights.
 */
#ifndef vtkDomainBoundaryReader_h
#define vtkDomainBoundaryReader_h
#include "vtkKnotworkSplineIOModule.h" // for export macro
#include <knotwork/SplineIO/vtkSplineFileReader.h>

class VTKKNOTWORKSPLINEIO_EXPORT vtkDomainBoundaryReader : public vtkSplineFileReader
{
public:
  static vtkDomainBoundaryReader* New();
  vtkTypeMacro(vtkDomainBoundaryReader, vtkSplineFileReader);

protected:
  vtkDomainBoundaryReader();
  ~vtkDomainBoundaryReader() override = default;
  knotwork::Result<knotwork::SplineFile> Parse(std::string_view text) override;
  bool Recognize(std::string_view beginning) override;

private:
  vtkDomainBoundaryReader(const vtkDomainBoundaryReader&) = delete;
  void operator=(const vtkDomainBoundaryReader&) = delete;
};
#endif
