// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkCADWriter
 * @brief   trimmed faces, surfaces and volumes to STEP and IGES files
 *
 * Input 0: a spline grid or a vtkPartitionedDataSetCollection of such grids. Surfaces become faces,
 * their common sides common edges; volumes become solids of their boundary sides. Input 1
 * (optional): the trimming curves that belong to the surfaces, as vtkTrimmedSurface and
 * vtkCADReader give them. Nothing is written unless everything can be. Errors: those of decoding
 * and of knotwork::WriteCAD; grids of curves, or of surfaces and volumes together
 * (DimensionMismatch).
 */
#ifndef vtkCADWriter_h
#define vtkCADWriter_h
#include "vtkKnotworkSplineIOModule.h" // for export macro
#include "vtkWriter.h"
#include <knotwork/SplineCore/Status.h> // for knotwork::Status

class VTKKNOTWORKSPLINEIO_EXPORT vtkCADWriter : public vtkWriter
{
public:
  static vtkCADWriter* New();
  vtkTypeMacro(vtkCADWriter, vtkWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /** The file to write: .step, .stp, .iges or .igs. */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}
  ///@{
  /** Unit of lengths: 0 micrometre, 1 millimetre, 2 centimetre, 3 metre, 4 inch, 5 foot. Default 1.
   */
  vtkSetClampMacro(Unit, int, 0, 5);
  vtkGetMacro(Unit, int);
  ///@}
  ///@{
  /** Application protocol of STEP files: 0 AP214, 1 AP242. Default 0. */
  vtkSetClampMacro(Schema, int, 0, 1);
  vtkGetMacro(Schema, int);
  ///@}
  ///@{
  /** Sides this near to each other, as share of the model's size, are one. Default 1e-6, valid
   * range [1e-12, 0.1]. */
  vtkSetClampMacro(SewTolerance, double, 1e-12, 0.1);
  vtkGetMacro(SewTolerance, double);
  ///@}
  ///@{
  /** Name of the product in the file; none: "Knotwork". */
  vtkSetStringMacro(ProductName);
  vtkGetStringMacro(ProductName);
  ///@}

  /** Connects the trimming curves. */
  void SetCurvesConnection(vtkAlgorithmOutput* port) { this->SetInputConnection(1, port); }

protected:
  vtkCADWriter();
  ~vtkCADWriter() override;
  int FillInputPortInformation(int port, vtkInformation* info) override;
  void WriteData() override;

  char* FileName = nullptr;
  int Unit = 1;
  int Schema = 0;
  double SewTolerance = 1e-6;
  char* ProductName = nullptr;

private:
  vtkCADWriter(const vtkCADWriter&) = delete;
  void operator=(const vtkCADWriter&) = delete;
  knotwork::Status WriteModel();
};
#endif
