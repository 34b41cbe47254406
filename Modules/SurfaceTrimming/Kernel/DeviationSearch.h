// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "ChartMesh.h"
#include <knotwork/SplineCore/BezierForm.h>

namespace knotwork
{
/// A triangle of a chart: parameters and places of its corners.
struct ChartTriangle
{
  std::array<RealArray<2>, 3> UV;
  std::array<RealArray<3>, 3> Points;
};
ChartTriangle CornersOf(const ChartMesh& chart, std::size_t triangle);

struct TriangleDeviation
{
  double Bound = 0.0; ///< |S - X| is not larger on the triangle
  double Found = 0.0; ///< largest value that is met on the triangle, or proved to be reached
};

/// Bounds of |S(u) - X(u)| over triangles, X linear in each of them. The triangle's box is cut
/// by the elements; on each part S - X in Bernstein form lies in the hull of its coefficients, so
/// the longest of them is a bound. Parts with the largest bounds are halved first and what does not
/// meet the triangle is dropped. Where the triangle is only a part of the box, S - X is the linear
/// function nearest to its coefficients plus a rest: the former is longest at a corner of the
/// common polygon, the latter is bounded by its coefficients. A rational surface N / w has
/// S - X = (N - X w) / w, a convex combination of the quotients of the coefficients of numerator
/// and denominator in one degree; quotients of linear functions are longest at corners too.
/// Keeps its buffers from triangle to triangle: one object a thread.
class DeviationSearch
{
public:
  /// @param surface  of a tensor space, three components; it must outlive this.
  DeviationSearch(const BezierForm<2>& surface, double relativeGap, double enough);

  /// @param found  a value of |S - X| on the triangle, for instance at a corner.
  /// @pre the triangle is counterclockwise in the domain of the surface (up to rounding).
  TriangleDeviation Bound(const ChartTriangle& triangle, double found);

private:
  /// A box of local parameters of an element, its coefficients are those of S - X (and w).
  struct Part
  {
    double Upper = 0.0; ///< longest coefficient
    int Slot = 0;       ///< of Coefficients
    int Element = 0;    ///< of Elements
    RealArray<2> Lower{};
    RealArray<2> Size{};
  };
  /// An element that meets the triangle, in its local parameters s, t.
  struct ElementPart
  {
    int Element = 0;
    RealArray<2> Extent{}; ///< of the triangle's box
    /// Constant, s and t terms: not negative on the triangle; 1 is the triangle's longest side.
    std::array<RealArray<3>, 3> Edges;
    std::array<RealArray<3>, 3> X; ///< the same of X
  };

  void SetTriangle(const ChartTriangle& triangle);
  void AddElement(int element);
  void Fill(const Part& part, double* to);
  void FillRational(const Part& part, double* to);
  RealArray<3> PointOnTriangle(const ElementPart& element, double s, double t) const;
  /// What is common to a part and the triangle, in [0, 1]^2 of the part: a box cut by three lines.
  struct Polygon
  {
    int Size = 0;
    std::array<RealArray<2>, 16> Points; // 7, and more only when rounding bends a side
  };
  void Measure(Part& part);
  void MeasureClipped(Part& part);
  void Clip(const Part& part, Polygon& polygon) const;
  void Halve(const Part& part);
  std::size_t HalvingDirection(const Part& part);
  void Keep(const Part& part);
  int NewSlot();
  double* At(const Part& part)
  {
    return this->Coefficients.data() + static_cast<std::size_t>(part.Slot) * this->SlotSize;
  }
  bool MeetsTriangle(const Part& part) const;
  bool IsOnTriangle(const ElementPart& element, double s, double t) const;
  double Goal() const;

  const BezierForm<2>& Surface;
  double RelativeGap;
  double Enough;
  IntArray<2> Degree{}; ///< of the coefficients of a part
  int Count;            ///< of them
  int Planes;           ///< of a part
  std::size_t SlotSize; ///< values of a part
  double Largest = 0.0; ///< coordinate of the surface's control points, times the weights' ratio
  double Slope = 0.0;   ///< bound of |S_u| + |S_v|, by the surface's parameters

  ChartTriangle Triangle;
  RealArray<3> Gradient[2]; ///< of X
  RealArray<2> Lower{};     ///< box of the triangle
  RealArray<2> Upper{};
  double Rounding = 0.0;  ///< of all values on the triangle
  double EdgeSlack = 0.0; ///< of the edges' functions
  double Found = 0.0;
  double Settled = 0.0;   ///< largest bound of the parts that are not looked at again
  std::vector<Part> Open; ///< heap, largest Upper first
  std::vector<ElementPart> Elements;
  std::vector<double> Coefficients;
  std::vector<int> FreeSlots;
  int NumSlots = 0;
  std::array<std::array<std::vector<double>, 2>, 2> Halves; ///< factors: [direction][upper half]
};
}
