// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkMFEMReader
 * @brief   linear, curved and NURBS meshes from MFEM mesh files
 *
 * Output: vtkUnstructuredGrid. A mesh with vertices alone becomes linear cells. One with `nodes`
 * becomes Bezier cells, the same polynomials, with the cell array `MeshVertices`: the numbers of
 * the vertices at the corners, by which vtkUnstructuredSpline knows how cells hang together, also
 * across the seam of a periodic mesh. A NURBS mesh becomes a spline grid, a patch an element, with
 * the topology of its patches as field data. All have the element's attribute as cell array
 * `Attribute`. Boundary elements are checked and not kept. Errors: a file that is missing or cannot
 * be read, and those of MfemMesh.h, with the line.
 */
#ifndef vtkMFEMReader_h
#define vtkMFEMReader_h
#include "vtkKnotworkSplineIOModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

class VTKKNOTWORKSPLINEIO_EXPORT vtkMFEMReader : public vtkSplineAlgorithm
{
public:
  static vtkMFEMReader* New();
  vtkTypeMacro(vtkMFEMReader, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /** The MFEM mesh file to read. */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  /** 1 when the beginning of a file is that of an MFEM mesh, else 0; the file may still be damaged.
   */
  int CanReadFile(const char* fileName);

protected:
  vtkMFEMReader();
  ~vtkMFEMReader() override;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

  char* FileName = nullptr;

private:
  vtkMFEMReader(const vtkMFEMReader&) = delete;
  void operator=(const vtkMFEMReader&) = delete;
};
#endif
