// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSplineTessellate
 * @brief   linear cells that follow a spline grid to a guaranteed tolerance
 *
 * Curves become lines, surfaces quadrilaterals and triangles, solids their outer boundary (Cells
 * SURFACE, a vtkPolyData) or hexahedra (Cells VOLUME, a vtkUnstructuredGrid, in which curves and
 * surfaces stay lines and polygons). A vtkPartitionedDataSetCollection becomes one of such
 * datasets.
 *
 * Guarantee: no point of a linear cell is farther than ChordalTolerance from the spline at the same
 * parameters, proven from bounds of second derivatives, not sampled. Points are evaluated in double
 * precision, once each. The mesh is watertight across elements, hierarchy levels and those sides of
 * patches whose control points agree. Where MaximumSubdivision stops the halving of elements the
 * guarantee is the field-data array ChordalBound (largest proven deviation), and a warning says so.
 *
 * Point arrays: fields of the grid (exact; zero on patches without the field), Normals (exact), and
 * where the point was evaluated: PatchId, ElementId, LocalParameters. A point that several elements
 * share belongs to the first of them. Cell arrays: PatchId, ElementId, Level and those of the
 * input.
 *
 * Errors: those of decoding; TooLarge above MaximumCells.
 */
#ifndef vtkSplineTessellate_h
#define vtkSplineTessellate_h
#include "vtkKnotworkSplineGridModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

class VTKKNOTWORKSPLINEGRID_EXPORT vtkSplineTessellate : public vtkSplineAlgorithm
{
public:
  static vtkSplineTessellate* New();
  vtkTypeMacro(vtkSplineTessellate, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum CellTypes
  {
    SURFACE = 0,
    VOLUME
  };

  ///@{
  /** Largest distance of a linear cell from the spline. Default 0.001, valid range [1e-12,
   * 1000000000000]. */
  vtkSetClampMacro(ChordalTolerance, double, 1e-12, 1e12);
  vtkGetMacro(ChordalTolerance, double);
  ///@}
  ///@{
  /** Whether ChordalTolerance is a share of the diagonal of the bounding box of the grid's (of
   * each block's) points, else a length. Default on. */
  vtkSetMacro(RelativeTolerance, bool);
  vtkGetMacro(RelativeTolerance, bool);
  vtkBooleanMacro(RelativeTolerance, bool);
  ///@}
  ///@{
  /** How often an element is halved in a direction at most; a warning tells when the tolerance
   * needs more. Default 8, valid range [0, 10]. Advanced. */
  vtkSetClampMacro(MaximumSubdivision, int, 0, 10);
  vtkGetMacro(MaximumSubdivision, int);
  ///@}
  ///@{
  /** What becomes of solids, one of CellTypes: their outer surface as polygons, or hexahedra.
   * Default SURFACE. */
  vtkSetClampMacro(Cells, int, SURFACE, VOLUME);
  vtkGetMacro(Cells, int);
  ///@}
  ///@{
  /** Whether polygons get the exact normals of the splines at their points (outward on solids
   * with det J > 0). Default on. */
  vtkSetMacro(Normals, bool);
  vtkGetMacro(Normals, bool);
  vtkBooleanMacro(Normals, bool);
  ///@}
  ///@{
  /** Whether points are repeated, bit for bit, between patches and at creases, so that normals
   * and fields are exact on every side; else points are shared wherever the grid is connected,
   * and the normal at a crease is the mean of its sides. Default off. */
  vtkSetMacro(Splitting, bool);
  vtkGetMacro(Splitting, bool);
  vtkBooleanMacro(Splitting, bool);
  ///@}

  ///@{
  /** Polygons, hexahedra or points of curves that the patches may become; more is an error
   * before memory is taken. Default 20000000, valid range >= 1. Advanced. */
  vtkSetClampMacro(MaximumCells, int, 1, VTK_INT_MAX);
  vtkGetMacro(MaximumCells, int);
  ///@}

  /** Of every block (of a grid) the `part`-th of `parts` parts of about as many cells alone is
   * made, for programs of several processes that all have the whole input. Parts one after the
   * other are the whole, bit for bit: points of parts before come last, and all have the numbers of
   * the whole as global ids, the array GlobalPointIds; the field array PointsByDimension has how
   * many of them are of curves, of surfaces and of solids. Default 0 of 1, without these.
   * @param together  the other parts are made at the same time by the other processes of VTK's
   * global controller, and they share the work on bounds; fails where one of them does. */
  void SetPart(int part, int parts, bool together = false);
  static const char* PointsByDimension() { return "PointsByDimension"; }

protected:
  vtkSplineTessellate();
  ~vtkSplineTessellate() override = default;
  int RequestDataObject(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  bool WorksOnPieces() const override { return true; }
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkSplineTessellate(const vtkSplineTessellate&) = delete;
  void operator=(const vtkSplineTessellate&) = delete;

  int MaximumCells = 20000000;
  double ChordalTolerance = 1e-3;
  bool RelativeTolerance = true;
  int MaximumSubdivision = 8;
  int Cells = SURFACE;
  bool Normals = true;
  bool Splitting = false;
  int Part = 0;
  int Parts = 1;
  bool Together = false;
};
#endif
