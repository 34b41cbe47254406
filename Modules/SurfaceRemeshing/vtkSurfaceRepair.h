// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSurfaceRepair
 * @brief   repairs triangles to a closed, oriented surface without intersections
 *
 * Input are triangles (quadrilaterals and polygons are divided) that should bound a solid. Equal
 * points become one, triangles without area, duplicates and loose pieces go, triangles are turned
 * alike, holes are closed up to a size, and triangles that meet are divided and joined so that no
 * two sheets cross. What overlaps more deeply than OverlapDepth stays as an inner wall. Points and
 * triangles that nothing is wrong with stay as they are.
 *
 * Output 0 (vtkPolyData): the triangles with the data of the input; new points and triangles in
 * holes have none of their own (zero). The point array PointIds and the cell array CellIds tell
 * those of the input, -1 where new.
 *
 * Output 1 (vtkPolyData): a vertex an action, with the cell arrays Kind (RepairKind of the kernel),
 * Action (its name) and Size.
 *
 * Output 2 (vtkTable): one row with Changed, Closed, Wrapped, the number of actions of every kind,
 * MergedPoints, points, triangles, parts, Euler number, area and volume before and after,
 * DistanceFromInput, DistanceToInput, and Diagonal.
 *
 * What cannot be repaired within Limit is an error that names the places.
 */
#ifndef vtkSurfaceRepair_h
#define vtkSurfaceRepair_h
#include "vtkKnotworkSurfaceRemeshingModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

class VTKKNOTWORKSURFACEREMESHING_EXPORT vtkSurfaceRepair : public vtkSplineAlgorithm
{
public:
  static vtkSurfaceRepair* New();
  vtkTypeMacro(vtkSurfaceRepair, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /** Farthest that the result may be from the input, and the input from the result, share of the
   * diagonal of the input's box. Default 0.01, valid range [0, 1]. */
  vtkSetClampMacro(Limit, double, 0.0, 1.0);
  vtkGetMacro(Limit, double);
  ///@}
  ///@{
  /** Diameter of holes that are closed, share of the diagonal; 0: none are. Default 0, valid range
   * [0, 1]. */
  vtkSetClampMacro(LargestHole, double, 0.0, 1.0);
  vtkGetMacro(LargestHole, double);
  ///@}
  ///@{
  /** Whether holes may stay. Default off. */
  vtkSetMacro(AllowOpen, bool);
  vtkGetMacro(AllowOpen, bool);
  vtkBooleanMacro(AllowOpen, bool);
  ///@}
  ///@{
  /** Depth up to which sheets of overlaps go, share of the diagonal; deeper ones become inner
   * walls. Default 0.0005, valid range [0, 1]. */
  vtkSetClampMacro(OverlapDepth, double, 0.0, 1.0);
  vtkGetMacro(OverlapDepth, double);
  ///@}
  ///@{
  /** Diameter below which parts go, share of the diagonal; 0: none do. Default 0, valid range [0,
   * 1]. */
  vtkSetClampMacro(SmallestPart, double, 0.0, 1.0);
  vtkGetMacro(SmallestPart, double);
  ///@}
  ///@{
  /** What cannot be repaired gets a surface around it, an alpha wrap, with a warning. That is no
   * repair: all points are new, holes and inner parts that a ball of WrapAlpha does not reach are
   * lost, Limit does not count. Default off. */
  vtkSetMacro(AlphaWrap, bool);
  vtkGetMacro(AlphaWrap, bool);
  vtkBooleanMacro(AlphaWrap, bool);
  ///@}
  ///@{
  /** Radius of the ball that alpha wraps follow, share of the diagonal. Default 0.02, valid range
   * [0.001, 1]. For AlphaWrap on. */
  vtkSetClampMacro(WrapAlpha, double, 0.001, 1.0);
  vtkGetMacro(WrapAlpha, double);
  ///@}
  ///@{
  /** Distance of alpha wraps from the triangles, share of the diagonal. Default 0.001, valid range
   * [1e-5, 1]. For AlphaWrap on. */
  vtkSetClampMacro(WrapOffset, double, 1e-5, 1.0);
  vtkGetMacro(WrapOffset, double);
  ///@}

protected:
  vtkSurfaceRepair();
  ~vtkSurfaceRepair() override = default;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkSurfaceRepair(const vtkSurfaceRepair&) = delete;
  void operator=(const vtkSurfaceRepair&) = delete;

  double Limit = 0.01;
  double LargestHole = 0.0;
  bool AllowOpen = false;
  double OverlapDepth = 0.0005;
  double SmallestPart = 0.0;
  bool AlphaWrap = false;
  double WrapAlpha = 0.02;
  double WrapOffset = 0.001;
};
#endif
