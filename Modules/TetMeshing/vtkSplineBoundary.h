// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSplineBoundary
 * @brief   triangles on the boundary of a spline, to a chordal tolerance
 *
 * Input is a spline grid (or a collection of them) of volumes, whose sides that other patches do
 * not share are the boundary; or of surfaces, trimmed (with the curves that they carry) or not.
 * The triangles meet in common edges wherever the spline is connected; where they are closed they
 * are turned outward.
 *
 * Guarantee: no point of a triangle is farther than ChordalTolerance from the spline, proven from
 * bounds of second derivatives (vtkSplineTessellate).
 *
 * Output 0 (vtkPolyData): triangles with the cell arrays PatchId and FaceId: the side of the patch
 * (2 direction + end) of volumes, the number of the face of trimmed surfaces, else 0. Output 1
 * (vtkTable): one row with Closed, Points, Triangles, Area, Volume, ChordalBound.
 */
#ifndef vtkSplineBoundary_h
#define vtkSplineBoundary_h
#include "vtkKnotworkTetMeshingModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

class VTKKNOTWORKTETMESHING_EXPORT vtkSplineBoundary : public vtkSplineAlgorithm
{
public:
  static vtkSplineBoundary* New();
  vtkTypeMacro(vtkSplineBoundary, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /** Largest distance of a triangle from the spline. Default 0.001, valid range [1e-12,
   * 1000000000000]. */
  vtkSetClampMacro(ChordalTolerance, double, 1e-12, 1e12);
  vtkGetMacro(ChordalTolerance, double);
  ///@}
  ///@{
  /** Whether ChordalTolerance is a share of the diagonal of the box of the control points, else a
   * length. Default on. */
  vtkSetMacro(RelativeTolerance, bool);
  vtkGetMacro(RelativeTolerance, bool);
  vtkBooleanMacro(RelativeTolerance, bool);
  ///@}

protected:
  vtkSplineBoundary();
  ~vtkSplineBoundary() override = default;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkSplineBoundary(const vtkSplineBoundary&) = delete;
  void operator=(const vtkSplineBoundary&) = delete;

  double ChordalTolerance = 1e-3;
  bool RelativeTolerance = true;
};
#endif
