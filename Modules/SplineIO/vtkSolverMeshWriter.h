// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSolverMeshWriter
 * @brief   cells to Gmsh MSH 4.1 files
 *
 * Input: a vtkUnstructuredGrid of linear, quadratic and Lagrange cells of one degree in all
 * directions, with the arrays that vtkSolverMeshReader gives them: numbers, groups with their names
 * and entities are written; without `PhysicalGroup` the cell array `Attribute` is taken. What is
 * written is read again bit for bit. Errors: no cells (EmptyInput), cells that Gmsh does not have
 * (InvalidTopology, InvalidParameter), a coordinate that is not finite (NonFiniteInput), another
 * ending (InvalidParameter), a file that cannot be written.
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
  /** The file to write: .msh. */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}
  ///@{
  /** Whether numbers are binary: smaller and faster to read. Default on. */
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
