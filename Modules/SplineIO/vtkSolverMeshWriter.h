// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSolverMeshWriter
 * @brief   cells to meshes of Gmsh (MSH 4.1) and MFEM
 *
 * Input: a vtkUnstructuredGrid of linear, quadratic and Lagrange cells of one degree in all
 * directions, with the arrays that vtkSolverMeshReader gives them: numbers, groups with their names
 * and entities are written; without `PhysicalGroup` the cell array `Attribute` is taken. What is
 * written as .msh is read again bit for bit. A mesh of MFEM (MfemWriter.h) has groups as
 * attributes, and elements that have nodes of their own. Errors: no cells (EmptyInput), cells that
 * the format does not have (InvalidTopology, InvalidParameter), a coordinate that is not finite
 * (NonFiniteInput), another ending (InvalidParameter), a file that cannot be written.
 */
#ifndef vtkSolverMeshWriter_h
#define vtkSolverMeshWriter_h
#include "vtkKnotworkSplineIOModule.h" // for export macro
#include "vtkWriter.h"
#include <knotwork/SplineCore/Status.h> // for knotwork::Status

#include <string> // for texts

class VTKKNOTWORKSPLINEIO_EXPORT vtkSolverMeshWriter : public vtkWriter
{
public:
  static vtkSolverMeshWriter* New();
  vtkTypeMacro(vtkSolverMeshWriter, vtkWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /** The file to write: .msh (Gmsh) or .mesh (MFEM). */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}
  ///@{
  /** Whether numbers of Gmsh's files are binary: smaller and faster to read. Default on. */
  vtkSetMacro(Binary, bool);
  vtkGetMacro(Binary, bool);
  vtkBooleanMacro(Binary, bool);
  ///@}

protected:
  vtkSolverMeshWriter();
  ~vtkSolverMeshWriter() override;
  void WriteData() override;
  int FillInputPortInformation(int port, vtkInformation* info) override;

  char* FileName = nullptr;
  bool Binary = true;

private:
  vtkSolverMeshWriter(const vtkSolverMeshWriter&) = delete;
  void operator=(const vtkSolverMeshWriter&) = delete;
  knotwork::Status MakeText(std::string& text);
};
#endif
