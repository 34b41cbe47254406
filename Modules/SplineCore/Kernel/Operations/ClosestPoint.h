// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/BoxTree.h>

namespace knotwork
{
struct ClosestPointParams
{
  int Samples = 0;        ///< starting points per direction and element, [2, 64]; 0: degree + 2
  int MaxIterations = 50; ///< Newton steps from a start, [0, 1000]
  int Threads = 0;
  ProgressCallback Progress;
};

/// Closest points of n queries.
struct ClosestPoints
{
  std::vector<int> Patches;  ///< index into the patches of the search
  std::vector<int> Elements; ///< element of the patch
  PointMatrix Local;         ///< n x Dim in [0, 1]
  PointMatrix Points;        ///< n x c
  Eigen::VectorXd Distances; ///< n, unit of the points
};

/// Closest points on spline maps: curves in the plane or space, surfaces in space, and, with as
/// many components as parameters, the inverse of a map (distance 0 inside its image).
///
/// Every element whose control points' box (which holds the element by the convex hull property) is
/// not farther than the nearest point so far is searched, the nearest boxes first, from each of its
/// dense samples that is nearer than its neighbours, by a projected Newton iteration on the
/// squared distance: full Hessian where it is positive definite on the free parameters, else
/// Gauss-Newton, halved until the distance falls, clamped to the element. A worse point is never
/// accepted, so the result is at least as near as the nearest sample. It is the global minimum
/// unless an element hides a local minimum between its samples.
/// @source  Piegl & Tiller, The NURBS Book, 6.1 (point inversion); Bertsekas, SIAM J. Control
/// Optim. 20 (1982) 221-246 (projected Newton).
template <int Dim>
class ClosestPointSearch
{
public:
  /// @param patches  same number of components, 1..4.
  /// @return EmptyInput, SizeMismatch, InvalidParameter, NonFiniteInput.
  /// @complexity O(samples + elements log(elements)).
  static Result<ClosestPointSearch> Create(
    std::vector<BezierForm<Dim>> patches, const ClosestPointParams& params = {});

  /// @param queries  n x c, finite.
  /// @return SizeMismatch, NonFiniteInput with the row, Aborted.
  /// @complexity a few element searches a query, in parallel; the same bits for any thread count.
  Status Find(const PointMatrixView& queries, ClosestPoints& result) const;

private:
  struct Start
  {
    int Patch = 0;
    int Element = 0;
    std::size_t FirstSample = 0; ///< row of the samples; parameters are the regular grid
    std::array<int, Dim> Counts{};
  };
  struct Candidate
  {
    RealArray<Dim> Local{};
    std::array<double, 4> Point{};
    double SquaredDistance = 0.0;
  };
  /// Memory that one query leaves to the next.
  struct Workspace
  {
    std::vector<double> Distances; ///< of the samples of an element
    std::vector<int> Element;
    PointMatrix Local;
    EvaluationBatch Here;
    EvaluationBatch There; ///< where a step leads
  };
  Candidate SearchElement(const Start& start, const double* query, Workspace& work) const;
  void Improve(const Start& start, const double* query, Candidate& best, Workspace& work) const;
  double HullDistance(int item, const double* query) const;

  std::vector<BezierForm<Dim>> Patches;
  ClosestPointParams Params;
  std::vector<Start> Starts; ///< all elements
  PointMatrix Samples;       ///< of all elements, one after the other
  PointMatrix Lower;         ///< of the control points' box of every element
  PointMatrix Upper;
  BoxTree Hulls; ///< of these boxes
};
}
