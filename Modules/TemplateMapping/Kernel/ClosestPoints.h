// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/SampleIndex.h>
#include <knotwork/TemplateMapping/PatchGeometry.h>

namespace knotwork
{
/// Points of a mapped patch closest to some points: one row or entry a query.
struct PatchFeet
{
  PointMatrix Places;               ///< n x PlaceSize, t: places on the patch
  PointMatrix Feet;                 ///< s(ghat(t)), n x Dim
  Eigen::VectorXd SquaredDistances; ///< |p - s(ghat(t))|^2
};

/// A template patch ghat under a spline map s, and closest points on s o ghat: the nearest of dense
/// samples through a spatial index, then Newton steps on the place. Dim = 3 also begins at the
/// nearest point of the triangles between the mapped samples: of the triangles around a sample only
/// one can be stepped into.
template <int Dim>
class MappedPatch
{
public:
  static constexpr int NumDirections = Dim - 1;

  MappedPatch() = default;
  /// @param samples  about how many dense samples: PatchGeometry's SamplePlaces.
  /// @pre   CheckSkeletons accepts the patch, which lies in the domain of space (rounding outside
  /// is clamped); samples is 0 or at least 2.
  MappedPatch(const SkeletonPatch<Dim>& patch, int samples, const SplineSpace<Dim>& space);

  /// Another space over the same domain: elements of the dense samples are found again. Mapped
  /// samples stay those of the last Update.
  void SetSpace(const SplineSpace<Dim>& space);

  /// Places of the dense samples, n x PlaceSize.
  const PointMatrix& SamplePlaces() const { return this->Samples; }
  /// Elements that hold the dense samples.
  const std::vector<int>& SampleElements() const { return this->Elements; }
  /// Triangles of the dense samples; empty for Dim = 2.
  const std::vector<std::array<int, Dim>>& SampleSimplices() const { return this->Simplices; }
  /// The dense samples under the map of the last Update, n x Dim.
  const PointMatrix& MappedSamples() const { return this->Index.Samples(); }

  /// Maps the dense samples and moves the index. @param form  of a spline in the present space.
  /// @complexity O(samples).
  void Update(const BezierForm<Dim>& form, int threads);

  /// Points ghat(t), n x Dim, inside the domain.
  PointMatrix DomainPoints(const PointMatrix& places) const;
  /// Places of the target's points before anything is searched: their parameters, n x PlaceSize.
  /// Dim = 2 without parameters: uniform. Dim = 3 without on either side: 0 rows.
  PointMatrix FirstPlaces(const SkeletonPatch<Dim>& target) const
  {
    return this->Template.FirstPlaces(target);
  }
  /// Feet and distances of points at given places; nothing is searched.
  PatchFeet At(const BezierForm<Dim>& form, const PointMatrixView& points,
    const PointMatrix& places, int threads) const;

  /// Closest points from the best one of known places and the nearest dense sample, then
  /// newtonSteps Gauss-Newton steps, (g_k . g_l) dt = (r . g_k) with r = p - s(ghat(t)) and g_k =
  /// d/dt_k s(ghat(t)), clamped to the patch. Dim = 3: to the triangle of the place, by the closest
  /// point of its image under the linear model; at an edge or corner, to the one of the triangles
  /// there that promises most. A step to a worse point is not taken.
  /// @param known  places, or 0 rows: nothing is known.
  /// @pre   Update(form).
  /// @source Sajavicius, Juettler, Speh (2018), step 3; squared norms in the system.
  PatchFeet Project(const BezierForm<Dim>& form, const PointMatrixView& points,
    const PointMatrix& known, int newtonSteps, int threads) const;

private:
  void Clamp(double* point) const;
  /// One step from a place towards a target; foot and first are s there and its derivatives.
  void Step(const double* place, const double* target, const double* foot, const double* first,
    double* next) const;

  PatchGeometry<Dim> Template;
  ParametricBox<Dim> Domain;
  PointMatrix Samples; // places
  std::vector<std::array<int, Dim>> Simplices;
  std::vector<int> Elements;
  PointMatrix Local; // of the dense samples in their elements
  SampleIndex Index;
  TriangleIndex<Dim> Mapped; // triangles of the mapped samples, Dim = 3
};

/// Distances from points to the polyline or triangle mesh of a target patch.
template <int Dim>
class TargetIndex
{
public:
  TargetIndex() = default;
  /// @pre CheckSkeletons accepts the patch.
  explicit TargetIndex(const SkeletonPatch<Dim>& patch);

  /// Nearest segment or triangle with squared distance <= bound.
  NearestItem Nearest(
    const double* point, double bound = std::numeric_limits<double>::infinity()) const;
  /// Squared distances of a sequence of points; neighbours in the sequence should be near each
  /// other (speed only).
  Eigen::VectorXd SquaredDistances(const PointMatrixView& sequence, int threads) const;
  /// The largest of these, cheaper: exact searches only where a bound does not settle it.
  double LargestSquaredDistance(const PointMatrixView& sequence, int threads) const;

private:
  double ItemDistance(int item, const double* point) const;
  /// Steps from an item to neighbours as long as they are nearer; returns the distance.
  double Descend(int& item, const double* point) const;
  /// Squared distances to nearby items found by walking along the patch: upper bounds.
  Eigen::VectorXd Walk(const PointMatrixView& sequence, int threads) const;

  // Dim = 2
  PointMatrix Points;
  std::vector<double> InverseLengths; // 1 / |b - a|^2 of the segments, 0 for those of no length
  BoxTree Tree;
  // Dim = 3
  TriangleIndex<Dim> Triangles;
  std::vector<MeshTriangle> Neighbours;
};
}
