// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "BezierForm.h"
#include "SampleIndex.h"
#include "Skeleton.h"

namespace knotwork
{
/// Points of a mapped patch closest to some points: one row or entry a query.
struct PatchFeet
{
  Eigen::VectorXd Parameters;       ///< t, parameter of the patch
  PointMatrix Feet;                 ///< s(ghat(t))
  Eigen::VectorXd SquaredDistances; ///< |p - s(ghat(t))|^2
};

/// A template patch ghat under a spline map s, and closest points on s o ghat: the nearest of dense
/// samples through a spatial index, then Newton steps on t.
template <int Dim>
class MappedPatch
{
public:
  MappedPatch() = default;
  /// @param samples  increasing parameters of the dense samples.
  /// @pre   curve lies in the domain of space (rounding outside is clamped).
  MappedPatch(PatchCurve curve, Eigen::VectorXd samples, const SplineSpace<Dim>& space);

  const PatchCurve& Curve() const { return this->Template; }
  const Eigen::VectorXd& SampleParameters() const { return this->Samples; }
  /// Elements that hold the dense samples.
  const std::vector<int>& SampleElements() const { return this->Elements; }
  /// The dense samples under the map of the last Update, n x Dim.
  const PointMatrix& MappedSamples() const { return this->Index.Samples(); }

  /// Maps the dense samples and moves the index. @param form  of a spline in the constructor's
  /// space. @complexity O(samples).
  void Update(const BezierForm<Dim>& form, int threads);

  /// Points ghat(t), n x Dim, inside the domain.
  PointMatrix DomainPoints(const Eigen::VectorXd& parameters) const;
  /// Feet and distances of points at given parameters; nothing is searched.
  PatchFeet At(const BezierForm<Dim>& form, const PointMatrixView& points,
    const Eigen::VectorXd& parameters, int threads) const;

  /// Closest points from the better one of known parameters and the nearest dense sample, then
  /// newtonSteps Gauss-Newton steps, dt = (r . g) / (g . g) with r = p - s(ghat(t)) and g = d/dt
  /// s(ghat(t)), clamped to the patch; a step to a worse point is not taken.
  /// @pre   Update(form).
  /// @source Sajavicius, Juettler, Speh (2018), step 3; squared norms in the system.
  PatchFeet Project(const BezierForm<Dim>& form, const PointMatrixView& points,
    const Eigen::VectorXd& known, int newtonSteps, int threads) const;

private:
  PatchCurve Template;
  ParametricBox<Dim> Domain;
  Eigen::VectorXd Samples;
  std::vector<int> Elements;
  PointMatrix Local; // of the dense samples in their elements
  SampleIndex Index;
};

/// Distances from points to a polyline in Dim-space.
template <int Dim>
class PolylineIndex
{
public:
  PolylineIndex() = default;
  /// @param points  n x Dim, n >= 2, finite.
  explicit PolylineIndex(PointMatrix points);

  /// Nearest segment with squared distance <= bound.
  NearestItem Nearest(
    const double* point, double bound = std::numeric_limits<double>::infinity()) const;
  /// Squared distances of a sequence of points; neighbours in the sequence should be near each
  /// other (speed only).
  Eigen::VectorXd SquaredDistances(const PointMatrixView& sequence, int threads) const;
  /// The largest of these, cheaper: exact searches only where a bound does not settle it.
  double LargestSquaredDistance(const PointMatrixView& sequence, int threads) const;

private:
  double SegmentDistance(int segment, const double* point) const;
  /// Squared distances to nearby segments found by walking along the polyline: upper bounds.
  Eigen::VectorXd Walk(const PointMatrixView& sequence, int threads) const;

  PointMatrix Points;
  std::vector<double> InverseLengths; // 1 / |b - a|^2 of the segments, 0 for those of no length
  BoxTree Tree;
};
}
