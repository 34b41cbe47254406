// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkCADWriter
 * @brief   trimmed faces, surfaces and volumes to STEP and IGES files
 *
 * Input 0: a spline grid or a vtkPartitionedDataSetCollection of such grids. Surfaces become faces,
 * their common sides common edges; volumes become solids of their boundary sides. Or triangles that
 * a filter gives beside the faces that they are of, as vtkAnalyticModel, vtkTrimmedSurface,
 * vtkSplineTrimToPoints and vtkCADReader do: these faces, with their curves, are written. Input 1
 * (optional): the trimming curves that belong to the surfaces, as vtkTrimmedSurface and
 * vtkCADReader give them. Nothing is written unless everything can be. Errors: those of decoding
 * and of knotwork::WriteCAD; grids of curves, or of surfaces and volumes together
 * (DimensionMismatch); triangles without faces (InvalidTopology).
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
  enum Units
  {
    Micrometre = 0,
    Millimetre,
    Centimetre,
    Metre,
    Inch,
    Foot
  };
  enum Schemas
  {
    AP214 = 0, ///< "AP214"
    AP242      ///< "AP242"
  };

  ///@{
  /** Unit of lengths, one of Units. Default Millimetre. */
  vtkSetClampMacro(Unit, int, Micrometre, Foot);
  vtkGetMacro(Unit, int);
  ///@}
  ///@{
  /** Application protocol of STEP files, one of Schemas. Default AP214. */
  vtkSetClampMacro(Schema, int, AP214, AP242);
  vtkGetMacro(Schema, int);
  ///@}
  ///@{
  /** Sides this near to each other, as share of the model's size, are one edge. Default 1e-6,
   * valid range [1e-12, 0.1]. */
  vtkSetClampMacro(SewTolerance, double, 1e-12, 0.1);
  vtkGetMacro(SewTolerance, double);
  ///@}
  ///@{
  /** Name of the product in the file; empty: Knotwork. Default empty. Advanced. */
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
  int Unit = Millimetre;
  int Schema = AP214;
  double SewTolerance = 1e-6;
  char* ProductName = nullptr;

private:
  vtkCADWriter(const vtkCADWriter&) = delete;
  void operator=(const vtkCADWriter&) = delete;
  knotwork::Status WriteModel();
};
#endif
