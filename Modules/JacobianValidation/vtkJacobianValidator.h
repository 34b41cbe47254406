// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkJacobianValidator
 * @brief   proves the cells of a grid valid or shows where they are not
 *
 * Input 0 is a vtkUnstructuredGrid, or a vtkPartitionedDataSetCollection of such grids, of Bezier,
 * Lagrange, linear and quadratic curves, quadrilaterals, hexahedra, triangles, tetrahedra and
 * wedges. Quadrilaterals and triangles that have an edge in common or belong to one patch are parts
 * of one surface: when all of it lies in a plane z = constant it is a map of that plane, else a
 * surface in space, of which |S_u x S_v| takes the place of det J. Curves are judged by |C_u|.
 * Other cells of the grid do not matter. All derivatives are with respect to a cell's local
 * parameters in [0, 1].
 *
 * Output 0 is the input with cell arrays: `JacobianVerdict` (1 valid, 0 undecided, -1 invalid or
 * reversed), `JacobianReversed` (1 where det J < 0 throughout), `JacobianDegenerate` (1 where det J
 * is zero at a vertex, edge or face of a valid cell and nowhere else), `JacobianLimit` (what
 * stopped the proof of an undecided cell: 1 MaximumBoxes, 2 a zero that no subdivision separates, 3
 * rounding of a conversion, 4 degenerate within the rounding of its coordinates; else 0), the
 * proven bounds `JacobianMinLower` <= min det J <= `JacobianMinUpper` and `JacobianMaxLower` <= max
 * det J <= `JacobianMaxUpper`; with Measures also `CellMeasure` (signed length, area or volume),
 * `CellMeasureError` (an estimate of its error) and
 * `ScaledJacobianMin` (smallest sampled det J / (|f_u| |f_v| |f_w|)). `JacobianVerdict` is made the
 * active scalars, of cells and points, so that it is what is drawn. Output 1
 * (vtkUnstructuredGrid) has for every invalid cell a vertex at a point where det J <= 0 is proved
 * and the sub-box of the cell around it, with the cell arrays `CellId` (of its grid), `Block`,
 * `PatchId`, `JacobianUpper` and `Kind` (one of WitnessKinds), `ElementNumber` where the input has
 * it, and the point array `LocalParameters`; an overlap of a map that is not injective is two
 * vertices. Output 2 is a table with a row a patch (column `PatchId`; one row when cells have no
 * `PatchId`) and a last row, with `PatchId` -1, for all together. `UndecidedCell` and
 * `UndecidedReason` are of the first undecided cell, `Rounding` is the length to which coordinates
 * must be exact to decide cells of JacobianLimit
 * 4. The last row also has the verdict on global injectivity (`Injective`: "injective",
 * "injective_up_to_seam", "not_injective", "undecided", and "not_applicable" when there are only
 * surfaces and curves in space; `InjectivityReason`) and on the interfaces of the patches
 * (`Interfaces`, `InterfaceGaps`, `LargestGap`).
 *
 * Of several processes (MPI) each validates the cells of its piece; numbers of cells count through
 * the pieces of a block, MaximumBoxes is for each process, output 2 is that of all in the first
 * process and empty elsewhere (sums over cells differ by rounding from those of one process). With
 * Injectivity all cells go to the first process, which proves it; points of different pieces are
 * one where their global ids say so, or else their places.
 *
 * @source Johnen, Remacle, Geuzaine (2013). The module's page has the method, limits and errors.
 */
#ifndef vtkJacobianValidator_h
#define vtkJacobianValidator_h
#include "vtkKnotworkJacobianValidationModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

#include <memory> // for the work of an update

namespace knotwork
{
struct BernsteinCells;
struct CellComplex;
struct CellMaps;
struct InjectivityCertificate;
struct JacobianCertificate;
}

class VTKKNOTWORKJACOBIANVALIDATION_EXPORT vtkJacobianValidator : public vtkSplineAlgorithm
{
public:
  static vtkJacobianValidator* New();
  vtkTypeMacro(vtkJacobianValidator, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum WitnessKinds
  {
    FOLDED_POINT = 0, ///< det J <= 0 here
    FOLDED_BOX,       ///< a sub-box of the cell with such a corner
    OVERLAP           ///< one of two points with the same image
  };

  ///@{
  /** How close the bounds of min det J are brought: upper - lower <= RelativeGap * max(|lower|,
   * |upper|). 1 asks for the sign only. Default 1, valid range [1e-12, 1]. */
  vtkSetClampMacro(RelativeGap, double, 1e-12, 1.0);
  vtkGetMacro(RelativeGap, double);
  ///@}
  ///@{
  /** Whether the bounds of max det J are brought as close. Default off. Advanced. */
  vtkSetMacro(BoundMaximum, bool);
  vtkGetMacro(BoundMaximum, bool);
  vtkBooleanMacro(BoundMaximum, bool);
  ///@}
  ///@{
  /** Sub-boxes looked at, over all cells of a kind (planar or in space, polynomial or rational),
   * before what is open stays undecided. Default 1000000, valid range [1, 1000000000]. Advanced. */
  vtkSetClampMacro(MaximumBoxes, vtkIdType, 1, 1000000000);
  vtkGetMacro(MaximumBoxes, vtkIdType);
  ///@}

  ///@{
  /** Whether the map as a whole is proved injective (planar maps and volumes), or an overlap is
   * found. Default on. */
  vtkSetMacro(Injectivity, bool);
  vtkGetMacro(Injectivity, bool);
  vtkBooleanMacro(Injectivity, bool);
  ///@}
  ///@{
  /** Whether cells are measured (signed length, area or volume) and their quality is sampled.
   * Default on. */
  vtkSetMacro(Measures, bool);
  vtkGetMacro(Measures, bool);
  vtkBooleanMacro(Measures, bool);
  ///@}
  ///@{
  /** Points along every edge of a cell at which quality is sampled, ends included. Default 5,
   * valid range [2, 64]. Advanced. For Measures on. */
  vtkSetClampMacro(SamplesPerEdge, int, 2, 64);
  vtkGetMacro(SamplesPerEdge, int);
  ///@}

  ///@{
  /** Of the last update, over all cells: 1 valid, 0 undecided, -1 invalid, 2 reversed. */
  vtkGetMacro(Verdict, int);
  ///@}

protected:
  vtkJacobianValidator();
  ~vtkJacobianValidator() override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestDataObject(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  bool WorksOnPieces() const override { return true; }
  bool SumsUpPieces() const override { return true; }
  knotwork::Status Gather(vtkInformationVector** inputs) override;
  knotwork::Status Merge(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  struct Work;
  knotwork::Status Validate(vtkDataObject* input, vtkInformationVector* outputs);
  knotwork::Result<knotwork::InjectivityCertificate> ProveInjective(
    const knotwork::BernsteinCells& cells, const knotwork::CellMaps& maps,
    const knotwork::CellComplex& complex, const knotwork::JacobianCertificate& certificate);
  std::unique_ptr<Work> Piece;

  vtkJacobianValidator(const vtkJacobianValidator&) = delete;
  void operator=(const vtkJacobianValidator&) = delete;

  double RelativeGap = 1.0;
  bool BoundMaximum = false;
  vtkIdType MaximumBoxes = 1000000;
  bool Injectivity = true;
  bool Measures = true;
  int SamplesPerEdge = 5;
  int Verdict = 0;
};
#endif
