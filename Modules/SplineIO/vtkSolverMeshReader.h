// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSolverMeshReader
 * @brief   linear and curved meshes from Gmsh MSH files and Abaqus input files
 *
 * Output: vtkUnstructuredGrid of linear, quadratic and Lagrange cells with the cell arrays
 * `ElementNumber` (in the file), `PhysicalGroup` (a component for each of the most groups that an
 * element has, 0 behind the last) and, of Gmsh, `GeometricEntity`; the point arrays `NodeNumber`
 * and, where point elements have groups, `PhysicalGroup`. Names of groups are the field data
 * `PhysicalGroupNames` with `PhysicalGroupIds` (dimension, group). Sets of Abaqus are point and
 * cell arrays of 0 and 1 by their names; element sets are groups too. Errors: a file that is
 * missing or cannot be read, and those of GmshMesh.h and AbaqusInput.h, with their places.
 */
#ifndef vtkSolverMeshReader_h
#define vtkSolverMeshReader_h
#include "vtkKnotworkSplineIOModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

class VTKKNOTWORKSPLINEIO_EXPORT vtkSolverMeshReader : public vtkSplineAlgorithm
{
public:
  static vtkSolverMeshReader* New();
  vtkTypeMacro(vtkSolverMeshReader, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /** The file to read: .msh or .inp. */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  /** 1 when the beginning of a file is that of one of these, else 0; the file may still be damaged.
   */
  int CanReadFile(const char* fileName);

protected:
  vtkSolverMeshReader();
  ~vtkSolverMeshReader() override;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

  char* FileName = nullptr;

private:
  vtkSolverMeshReader(const vtkSolverMeshReader&) = delete;
  void operator=(const vtkSolverMeshReader&) = delete;
};
#endif
