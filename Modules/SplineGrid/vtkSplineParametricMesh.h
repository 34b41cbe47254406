// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSplineParametricMesh
 * @brief   elements of spline grids as boxes in the parameter domain
 *
 * Output: a vtkUnstructuredGrid (for a collection: a collection of them) of linear lines,
 * quadrilaterals and hexahedra, one an element, in patch and element order. Elements of a patch
 * share points where their corners have the same parameters. Bezier patches have no common
 * parameter domain: their elements are unit boxes in rows of equal length.
 *
 * With SideBySide, patches follow each other along x from x = 0, Gap of the widest patch apart;
 * else coordinates are parameters and patches may overlap.
 *
 * Cell arrays: PatchId, ElementId, Level and those of the input. Point array: Parameters (three,
 * unused ones 0), which SideBySide does not move.
 */
#ifndef vtkSplineParametricMesh_h
#define vtkSplineParametricMesh_h
#include "vtkKnotworkSplineGridModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

class VTKKNOTWORKSPLINEGRID_EXPORT vtkSplineParametricMesh : public vtkSplineAlgorithm
{
public:
  static vtkSplineParametricMesh* New();
  vtkTypeMacro(vtkSplineParametricMesh, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /** Whether patches are laid beside each other along x; otherwise coordinates are parameters.
   * Default on. */
  vtkSetMacro(SideBySide, bool);
  vtkGetMacro(SideBySide, bool);
  vtkBooleanMacro(SideBySide, bool);
  ///@}
  ///@{
  /** Space between patches beside each other, as a share of the widest patch. Default 0.1, valid
   * range [0, 10]. For SideBySide on. */
  vtkSetClampMacro(Gap, double, 0.0, 10.0);
  vtkGetMacro(Gap, double);
  ///@}

protected:
  vtkSplineParametricMesh();
  ~vtkSplineParametricMesh() override = default;
  bool WorksOnPieces() const override { return true; }
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkSplineParametricMesh(const vtkSplineParametricMesh&) = delete;
  void operator=(const vtkSplineParametricMesh&) = delete;

  bool SideBySide = true;
  double Gap = 0.1;
};
#endif
