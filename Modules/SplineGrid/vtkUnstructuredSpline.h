// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkUnstructuredSpline
 * @brief   one smooth spline on a mesh of quadrilaterals or hexahedra with extraordinary points
 *
 * Input 0 is a conforming mesh (vtkPolyData or vtkUnstructuredGrid) of linear quadrilaterals, in
 * space or in the plane, or of linear hexahedra; nothing else is in it. Any topology: closed, with
 * handles, any number of cells around a point; quadrilaterals need not be orientable.
 *
 * Output 0 is a spline grid of one patch of kind unstructured with an element a cell, C^(p-1)
 * across facets (edges of quadrilaterals, faces of hexahedra) but for creases, which extraordinary
 * points cause as Policy says, and features. Floating-point point arrays become fields in the same
 * way as the points become control points; cell arrays pass. Output 1 is a table of one row:
 * `Policy` (that was taken), `Functions`, `Elements`, `CreasedFacets`, `InnerFacets`,
 * `ExtraordinaryPoints` (of hexahedra: edges), `Repairs` (facets that are less smooth than the
 * policy says, as it has no basis there), `MaxNormalAngle` (in degrees, between normals of a
 * surface from both sides of facets that are C^0 and no features; -1 for volumes),
 * `MaxNormalAngleBefore` (what it was before TangentPlanes), `TangentPlanes` (extraordinary points
 * at which the tangent plane was made one),
 * `MaxVertexDistance` and `RmsVertexDistance` (of the mesh's points, before any moved, from the
 * spline), `FoldedCells` (of the mesh; -1 when Untangle is OFF), `StillFolded` (cells after
 * untangling), `FoldedElements` (of the spline, when Untangle is ELEMENTS; else -1), `MovedPoints`
 * and `LargestMove` (by untangling),
 * `SplitPolygons` (polygons that were no quadrilaterals), `Orientable` (0, 1).
 *
 * @source Thomas et al. (2015), (2022); Eppstein, Goodrich, Kim, Tamstorf (2008). The module's page
 * has methods, limits and errors.
 */
#ifndef vtkUnstructuredSpline_h
#define vtkUnstructuredSpline_h
#include "vtkKnotworkSplineGridModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

class VTKKNOTWORKSPLINEGRID_EXPORT vtkUnstructuredSpline : public vtkSplineAlgorithm
{
public:
  static vtkUnstructuredSpline* New();
  vtkTypeMacro(vtkUnstructuredSpline, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Policies
  {
    AUTOMATIC = 0,
    FULL,
    MOTORCYCLE,
    MINIMAL
  };
  enum Constructions
  {
    INTERPOLATION = 0,
    CONTROL_CAGE
  };
  enum SheetLengths
  {
    UNIFORM = 0,
    MEAN
  };
  enum UntanglingScopes
  {
    OFF = 0,
    CELLS,
    ELEMENTS
  };

  ///@{
  /** Degree of the spline in all directions. Default 3, valid range [1, 9]. */
  vtkSetClampMacro(Degree, int, 1, 9);
  vtkGetMacro(Degree, int);
  ///@}
  ///@{
  /** Where the spline is less smooth than C^(p-1), one of Policies: FULL, C^0 along the whole base
   * complex of the extraordinary points, the most accurate; MOTORCYCLE, of quadrilaterals, C^0
   * along tracks that end where they meet others; MINIMAL, C^0 next to extraordinary points, then
   * C^1, C^2 and so on; AUTOMATIC, FULL where that creases at most 40 % of the inner edges or
   * faces, else MOTORCYCLE or, of hexahedra, MINIMAL. Default AUTOMATIC. */
  vtkSetClampMacro(Policy, int, AUTOMATIC, MINIMAL);
  vtkGetMacro(Policy, int);
  ///@}
  ///@{
  /** What the points of the mesh are, one of Constructions: INTERPOLATION, points near which the
   * spline passes, at a distance of order p + 1; CONTROL_CAGE, a control net, which the spline
   * smooths. Default INTERPOLATION. */
  vtkSetClampMacro(Construction, int, INTERPOLATION, CONTROL_CAGE);
  vtkGetMacro(Construction, int);
  ///@}
  ///@{
  /** Knot intervals of the sheets of parallel edges, one of SheetLengths: UNIFORM, all 1; MEAN, as
   * the mean lengths of their edges. Default UNIFORM. */
  vtkSetClampMacro(Lengths, int, UNIFORM, MEAN);
  vtkGetMacro(Lengths, int);
  ///@}
  ///@{
  /** Edges between quadrilaterals whose normals differ by more than this angle in degrees are
   * features: C^0, and no part of MaxNormalAngle. 180: none is. Of quadrilaterals only. Default
   * 180, valid range [0, 180]. Group "Creases". */
  vtkSetClampMacro(FeatureAngle, double, 0.0, 180.0);
  vtkGetMacro(FeatureAngle, double);
  ///@}
  ///@{
  /** Cell array; edges, or faces of hexahedra, between cells of different values are features.
   * Empty or `None`: none is. Default empty. Group "Creases". */
  vtkSetStringMacro(FeatureArray);
  vtkGetStringMacro(FeatureArray);
  ///@}
  ///@{
  /** Whether the tangent plane of a surface is made one at extraordinary points, but for features
   * and folds, by moving the control points around them; the space stays. Not for volumes. Default
   * off. */
  vtkSetMacro(TangentPlanes, bool);
  vtkGetMacro(TangentPlanes, bool);
  vtkBooleanMacro(TangentPlanes, bool);
  ///@}
  ///@{
  /** Whether every polygon, quadrilaterals too, is split at its middle into quadrilaterals, as many
   * as it has corners; without it triangles are an error. Default off. */
  vtkSetMacro(SplitPolygons, bool);
  vtkGetMacro(SplitPolygons, bool);
  vtkBooleanMacro(SplitPolygons, bool);
  ///@}
  ///@{
  /** Where points of the mesh move first so that the spline can be valid, one of UntanglingScopes:
   * OFF, nowhere; CELLS, around cells that are folded; ELEMENTS, and around elements of the spline
   * that turn over. Points of surfaces slide on the surface that the mesh is, those of features,
   * rims and edges sharper than 45 degrees along them. A warning says how many moved
   * and how far. Default CELLS. Group "Folded Cells". */
  vtkSetClampMacro(Untangle, int, OFF, ELEMENTS);
  vtkGetMacro(Untangle, int);
  ///@}
  ///@{
  /** Cells around folded ones, ring by ring, whose points may move; more where that is not enough.
   * Default 2, valid range [0, 100]. For Untangle not OFF. Group "Folded Cells". */
  vtkSetClampMacro(UntangleRings, int, 0, 100);
  vtkGetMacro(UntangleRings, int);
  ///@}

protected:
  vtkUnstructuredSpline();
  ~vtkUnstructuredSpline() override;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkUnstructuredSpline(const vtkUnstructuredSpline&) = delete;
  void operator=(const vtkUnstructuredSpline&) = delete;

  int Degree = 3;
  int Policy = AUTOMATIC;
  int Construction = INTERPOLATION;
  int Lengths = UNIFORM;
  double FeatureAngle = 180.0;
  char* FeatureArray = nullptr;
  bool TangentPlanes = false;
  bool SplitPolygons = false;
  int Untangle = CELLS;
  int UntangleRings = 2;
};
#endif
