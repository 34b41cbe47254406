// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkFaceIntersections
 * @brief   proves that the faces of a model do not meet elsewhere than along edges
 *
 * The input is a spline grid of surfaces, or a collection of them; trimming curves that it carries
 * (TrimmedGrids.h) trim the faces. Every face is held against itself and against every other one.
 * Either it is proved that nothing meets, or a point where two faces meet is named; what neither
 * succeeds for is undecided. Where points of both faces lie within Tolerance of edges of theirs
 * they may meet.
 *
 * Output 0 (vtkPolyData): a vertex a pair of faces that meet or are undecided, at most one a pair,
 * with the point arrays Faces (two numbers, in the order of the input's cells), Parameters (u, v on
 * the first, u, v on the second), Verdict (1 undecided, 2 found), OpenPlaces (pairs of parts that
 * were not told from each other).
 *
 * Output 1 (vtkTable): one row with Verdict (absent, undecided, found), Found, Undecided (numbers
 * of pairs of faces), Faces, PairsOfFaces (whose boxes meet, and every face with itself), Pairs (of
 * parts that were looked at), Tolerance.
 *
 * @source Tangent cones: Sederberg and Meyers (1988). The module's page has limits and errors.
 */
#ifndef vtkFaceIntersections_h
#define vtkFaceIntersections_h
#include "vtkKnotworkSurfaceTrimmingModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

class VTKKNOTWORKSURFACETRIMMING_EXPORT vtkFaceIntersections : public vtkSplineAlgorithm
{
public:
  static vtkFaceIntersections* New();
  vtkTypeMacro(vtkFaceIntersections, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /** Distance from edges within which points of both faces may meet, unit of the points; 0: a
   * thousandth of the diagonal of the model's box. Default 0, valid range >= 0. */
  vtkSetClampMacro(Tolerance, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(Tolerance, double);
  ///@}
  ///@{
  /** Pairs of parts looked at, of a pair of faces, before it stays undecided. Default 1000000,
   * valid range [1, 1000000000]. Advanced. */
  vtkSetClampMacro(MaximumPairs, int, 1, 1000000000);
  vtkGetMacro(MaximumPairs, int);
  ///@}

protected:
  vtkFaceIntersections();
  ~vtkFaceIntersections() override = default;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkFaceIntersections(const vtkFaceIntersections&) = delete;
  void operator=(const vtkFaceIntersections&) = delete;

  double Tolerance = 0.0;
  int MaximumPairs = 1000000;
};
#endif
