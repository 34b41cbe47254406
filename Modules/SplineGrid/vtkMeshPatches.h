// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkMeshPatches
 * @brief   cuts a mesh of quadrilaterals or hexahedra into grids of cells
 *
 * Input 0 is a mesh as vtkUnstructuredSpline takes it. Extraordinary points (edges of hexahedra)
 * are at corners of patches, every patch is a full grid of cells.
 *
 * Output 0 is the mesh with its data and the cell arrays `PatchId` and `PatchIndex` (place of the
 * cell in its patch, 3 components). Output 1 are the cuts: an edge, or of hexahedra a face, each,
 * and a vertex at every T-joint, with the cell array `Patches` (on both sides of a cut, lower
 * first; -1 for T-joints). Output 2 is a table with a row a patch: `PatchId`, `Size0`, `Size1`,
 * `Size2` (cells a direction, 1 for those that it does not have), `Cells`.
 *
 * @source Eppstein, Goodrich, Kim, Tamstorf (2008); Bommes, Lempfer, Kobbelt (2011). The module's
 * page has limits and errors.
 */
#ifndef vtkMeshPatches_h
#define vtkMeshPatches_h
#include "vtkKnotworkSplineGridModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

class VTKKNOTWORKSPLINEGRID_EXPORT vtkMeshPatches : public vtkSplineAlgorithm
{
public:
  static vtkMeshPatches* New();
  vtkTypeMacro(vtkMeshPatches, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Layouts
  {
    BASE_COMPLEX = 0,
    MOTORCYCLE_GRAPH
  };

  ///@{
  /** Where the mesh is cut, one of Layouts: BASE_COMPLEX, along all lines of edges, or sheets of
   * faces, from extraordinary points, so that patches meet along whole sides; MOTORCYCLE_GRAPH, of
   * quadrilaterals, along lines that end where they meet others, which makes fewer patches and
   * T-joints. Default BASE_COMPLEX. */
  vtkSetClampMacro(Layout, int, BASE_COMPLEX, MOTORCYCLE_GRAPH);
  vtkGetMacro(Layout, int);
  ///@}
  ///@{
  /** Edges between quadrilaterals whose normals differ by more than this angle in degrees are cut,
   * too. 180: none is. Of quadrilaterals only. Default 180, valid range [0, 180]. */
  vtkSetClampMacro(FeatureAngle, double, 0.0, 180.0);
  vtkGetMacro(FeatureAngle, double);
  ///@}
  ///@{
  /** Cell array; edges, or faces of hexahedra, between cells of different values are cut, too.
   * Empty or `None`: none is. Default empty. */
  vtkSetStringMacro(FeatureArray);
  vtkGetStringMacro(FeatureArray);
  ///@}

protected:
  vtkMeshPatches();
  ~vtkMeshPatches() override;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkMeshPatches(const vtkMeshPatches&) = delete;
  void operator=(const vtkMeshPatches&) = delete;

  int Layout = BASE_COMPLEX;
  double FeatureAngle = 180.0;
  char* FeatureArray = nullptr;
};
#endif
