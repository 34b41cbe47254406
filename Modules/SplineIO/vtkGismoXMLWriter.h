// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkGismoXMLWriter
 * @brief   splines to G+Smo XML files
 *
 * Tensor-product and hierarchical patches, polynomial and rational; LR patches become tensor
 * products, with a warning; ids are the PatchId. A
 * MultiPatch of every parametric dimension with several patches names them with the interfaces and
 * boundaries that the grid states (field data KnotworkInterfaces, KnotworkBoundary; interfaces in
 * part are left out with a warning). What is written is read again bit for bit. Errors: patches of
 * kind Bezier (InvalidParameter).
 */
#ifndef vtkGismoXMLWriter_h
#define vtkGismoXMLWriter_h
#include "vtkKnotworkSplineIOModule.h" // for export macro
#include <knotwork/SplineIO/vtkSplineFileWriter.h>

class VTKKNOTWORKSPLINEIO_EXPORT vtkGismoXMLWriter : public vtkSplineFileWriter
{
public:
  static vtkGismoXMLWriter* New();
  vtkTypeMacro(vtkGismoXMLWriter, vtkSplineFileWriter);

protected:
  vtkGismoXMLWriter();
  ~vtkGismoXMLWriter() override = default;
  bool Holds(knotwork::SpaceKind kind) const override;
  knotwork::Result<std::string> Format(const knotwork::SplineFile& file) override;

private:
  vtkGismoXMLWriter(const vtkGismoXMLWriter&) = delete;
  void operator=(const vtkGismoXMLWriter&) = delete;
};
#endif
