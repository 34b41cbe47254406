// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "Status.h"
#include "Types.h"

#include <vector>

namespace knotwork
{
/// One patch of a skeleton in Dim-space, a (Dim - 1)-manifold with parameters: for Dim = 2 a
/// polyline. The polyline itself is the patch; between its points position is linear in the
/// parameter.
template <int Dim>
struct SkeletonPatch
{
  int Id = 0;             ///< patches of template and target belong together by id
  PointMatrix Points;     ///< n x Dim, n >= 2
  PointMatrix Parameters; ///< n x (Dim - 1), or empty: i / (n - 1)
  PointMatrix Normals;    ///< n x Dim of any length but zero, or empty: made from the points
};

template <int Dim>
using Skeleton = std::vector<SkeletonPatch<Dim>>;

/// Everything that must hold before a template is carried onto a target: ids unique, every target
/// id in the template, all finite, sizes fit, at least 2 points and a positive length a patch,
/// template parameters strictly increasing, target parameters inside the template patch's range,
/// normals not zero.
/// @return EmptyInput, InvalidTopology (ids, degenerate patches), NonFiniteInput, SizeMismatch or
/// InvalidParameter; the detail names patch and point.
template <int Dim>
Status CheckSkeletons(const Skeleton<Dim>& templateSkeleton, const Skeleton<Dim>& target);

/// Smallest box around all points.
template <int Dim>
ParametricBox<Dim> BoundingBox(const Skeleton<Dim>& skeleton);

/// The patch's parameters, or i * (end - begin) / (n - 1) from begin where it has none.
PointMatrix ParametersOrUniform(const SkeletonPatch<2>& patch, double begin, double end);

/// Unit normals of the patch: the given ones, or those of the polyline: the chord from the
/// neighbour on one side to that on the other (across the seam when the patch is closed), turned by
/// -90 degrees. Nothing depends on their sign.
PointMatrix UnitNormals(const SkeletonPatch<2>& patch);

/// Position and derivatives of a polyline patch at parameters.
class PatchCurve
{
public:
  PatchCurve() = default;
  /// @param parameters  one a point, strictly increasing.
  PatchCurve(PointMatrix points, Eigen::VectorXd parameters);

  double Begin() const { return this->Parameters(0); }
  double End() const { return this->Parameters(this->Parameters.size() - 1); }
  /// Position at t (clamped to [Begin, End]) and its derivative there, that of the piece on the
  /// right at a vertex.
  /// @param derivative  may be null. @complexity O(1) for equally spaced parameters, else O(log n).
  void Evaluate(double t, double* point, double* derivative) const;
  /// The points themselves, or count points at equally spaced parameters.
  Eigen::VectorXd SampleParameters(int count) const;

private:
  PointMatrix Points;
  Eigen::VectorXd Parameters;
};
}
