// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSplineFileWriter
 * @brief   base of the writers of spline files
 *
 * Input: a spline grid (vtkUnstructuredGrid) or a vtkPartitionedDataSetCollection of such grids;
 * every patch becomes one geometry; kinds of splines that the format has not are written as tensor
 * products, the same map, with a warning. Derived classes implement Format(). Nothing is written
 * unless everything can be. Point fields are left out with a warning. Errors: those of decoding, of
 * the formats, and a file that cannot be written.
 */
#ifndef vtkSplineFileWriter_h
#define vtkSplineFileWriter_h
#include "vtkKnotworkSplineIOModule.h" // for export macro
#include "vtkWriter.h"
#include <knotwork/SplineIO/SplineFile.h> // for knotwork::SplineFile

class VTKKNOTWORKSPLINEIO_EXPORT vtkSplineFileWriter : public vtkWriter
{
public:
  vtkTypeMacro(vtkSplineFileWriter, vtkWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /** The file to write. */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}
  ///@{
  /** Coordinates of the control points; 0: two when all patches are curves and surfaces in the
   * plane z = 0, else three. Coordinates that are not written must be 0. Default 0, valid range
   * [0, 3]. */
  vtkSetClampMacro(Coordinates, int, 0, 3);
  vtkGetMacro(Coordinates, int);
  ///@}

protected:
  vtkSplineFileWriter();
  ~vtkSplineFileWriter() override;
  void WriteData() override;
  int FillInputPortInformation(int port, vtkInformation* info) override;

  /** Whether the format has splines of a kind; others are written as tensor products. */
  virtual bool Holds(knotwork::SpaceKind kind) const = 0;
  /** Adds what further inputs say. */
  virtual knotwork::Status AddMore(knotwork::SplineFile&) { return {}; }
  /** The text of a file. */
  virtual knotwork::Result<std::string> Format(const knotwork::SplineFile& file) = 0;

  char* FileName = nullptr;
  int Coordinates = 0;

private:
  vtkSplineFileWriter(const vtkSplineFileWriter&) = delete;
  void operator=(const vtkSplineFileWriter&) = delete;
  knotwork::Status MakeText(std::string& text);
};
#endif
