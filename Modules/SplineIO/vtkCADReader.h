// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkCADReader
 * @brief   trimmed faces from STEP, IGES and BREP files
 *
 * Outputs: 0 the surfaces as spline grid (vtkUnstructuredGrid), a patch a face, with the cell
 * arrays FaceId, Body, FaceReversed, Name, Color, SurfaceType (0 plane, 1 cylinder, 2 sphere, 3
 * cone, 4 torus, 5 others, 6 extrusion, 7 revolution; not there where all are others); 1 the
 * trimming curves as spline grid, a patch a use of an edge, with the point array UV; 2 the trimmed
 * faces as triangles (vtkPolyData) with Normals, the cell arrays FaceId, PatchId, Name and Color
 * (red, green, blue as bytes; white where the file says nothing). Where faces are in composites
 * (CADComposite.h), outputs 0 and 2 have the cell array CompositeId, from 0, -1 in none. Assemblies
 * are resolved; what cannot be read is left out with a warning. Errors: those of
 * knotwork::ReadCADInProcess and TriangulateFaces.
 */
#ifndef vtkCADReader_h
#define vtkCADReader_h
#include "vtkKnotworkSplineIOModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

class VTKKNOTWORKSPLINEIO_EXPORT vtkCADReader : public vtkSplineAlgorithm
{
public:
  static vtkCADReader* New();
  vtkTypeMacro(vtkCADReader, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Units
  {
    Micrometre = 0,
    Millimetre,
    Centimetre,
    Metre,
    Inch,
    Foot
  };

  ///@{
  /** The file to read: .step, .stp, .iges, .igs or .brep. */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}
  ///@{
  /** Unit of lengths in the outputs, one of Units. Default Millimetre. */
  vtkSetClampMacro(Unit, int, Micrometre, Foot);
  vtkGetMacro(Unit, int);
  ///@}
  ///@{
  /** Distance within which edges become cubic whose curve and pcurves have no exact common form;
   * 0: a millionth of the model's size. Default 0, valid range >= 0. Advanced. */
  vtkSetClampMacro(Tolerance, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(Tolerance, double);
  ///@}
  ///@{
  /** Whether triangles of the trimmed faces are made, output 2. Default on. */
  vtkSetMacro(Triangulation, bool);
  vtkGetMacro(Triangulation, bool);
  vtkBooleanMacro(Triangulation, bool);
  ///@}
  ///@{
  /** Largest distance between triangles and faces; a share of the size of the surfaces when
   * RelativeTolerance is on. Default 0.001, valid range >= 1e-12. For Triangulation on. */
  vtkSetClampMacro(ChordalTolerance, double, 1e-12, VTK_DOUBLE_MAX);
  vtkGetMacro(ChordalTolerance, double);
  ///@}
  ///@{
  /** Whether ChordalTolerance is a share of the size of the surfaces. Default on. For
   * Triangulation on. */
  vtkSetMacro(RelativeTolerance, bool);
  vtkGetMacro(RelativeTolerance, bool);
  vtkBooleanMacro(RelativeTolerance, bool);
  ///@}
  ///@{
  /** Whether OpenCASCADE reads in a process of its own, with limits of memory and time: it does
   * not survive some damaged files. Default on. Advanced. */
  vtkSetMacro(SeparateProcess, bool);
  vtkGetMacro(SeparateProcess, bool);
  vtkBooleanMacro(SeparateProcess, bool);
  ///@}

  /** 1 when the ending is one of STEP or IGES and the file exists, else 0. */
  int CanReadFile(const char* fileName);

protected:
  vtkCADReader();
  ~vtkCADReader() override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestDataObject(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

  char* FileName = nullptr;
  int Unit = Millimetre;
  double Tolerance = 0.0;
  bool Triangulation = true;
  double ChordalTolerance = 1e-3;
  bool RelativeTolerance = true;
  bool SeparateProcess = true;

private:
  vtkCADReader(const vtkCADReader&) = delete;
  void operator=(const vtkCADReader&) = delete;
};
#endif
