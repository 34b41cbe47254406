// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkGoToolsG2Reader
 * @brief   splines from GoTools g2 files
 *
 * Output 0 are the splines, output 1 the boundary curves of bounded surfaces (210) as a spline grid
 * (BoundaryGrid.h says which cell arrays it has), empty when there are none.
 *
 * Spline curves (100), surfaces (200) and volumes (700), polynomial and rational, as patches 0, 1,
 * 2, ... Errors: InvalidFormat with line and word, and what the kernel finds wrong with degrees,
 * knots, weights.
 */
#ifndef vtkGoToolsG2Reader_h
#define vtkGoToolsG2Reader_h
#include "vtkKnotworkSplineIOModule.h" // for export macro
#include <knotwork/SplineIO/vtkSplineFileReader.h>

class VTKKNOTWORKSPLINEIO_EXPORT vtkGoToolsG2Reader : public vtkSplineFileReader
{
public:
  static vtkGoToolsG2Reader* New();
  vtkTypeMacro(vtkGoToolsG2Reader, vtkSplineFileReader);

protected:
  vtkGoToolsG2Reader();
  ~vtkGoToolsG2Reader() override = default;
  knotwork::Result<knotwork::SplineFile> Parse(std::string_view text) override;
  bool Recognize(std::string_view beginning) override;
  knotwork::Status EncodeMore(
    const knotwork::SplineFile& file, vtkInformationVector* outputs) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestDataObject(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkGoToolsG2Reader(const vtkGoToolsG2Reader&) = delete;
  void operator=(const vtkGoToolsG2Reader&) = delete;
};
#endif
