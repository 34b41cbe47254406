// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>
#include <knotwork/SplineCore/Types.h>

#include <array>
#include <vector>

namespace knotwork
{
/// One patch of a skeleton in Dim-space, a (Dim - 1)-manifold: for Dim = 2 a polyline, for Dim = 3
/// a triangle mesh, open or closed. The polyline or mesh itself is the patch; between its points
/// position is linear in the parameters.
template <int Dim>
struct SkeletonPatch
{
  int Id = 0;             ///< patches of template and target belong together by id
  PointMatrix Points;     ///< n x Dim, n >= Dim
  PointMatrix Parameters; ///< n x (Dim - 1), or empty: i / (n - 1) for Dim = 2, none for Dim = 3
  PointMatrix Normals;    ///< n x Dim of any length but zero, or empty: made from the points
  /// Dim = 3: triangles as rows of Points, at least one; Dim = 2: empty, consecutive points are the
  /// segments.
  std::vector<std::array<int, Dim>> Simplices;
};

template <int Dim>
using Skeleton = std::vector<SkeletonPatch<Dim>>;

/// Everything that must hold before a template is carried onto a target: ids unique, every target
/// id in the template, all finite, sizes fit, at least Dim points and a positive length or area a
/// patch, triangles of three different points that exist, no point without a triangle, template
/// parameters strictly increasing (Dim = 3: their triangles turn the same way), target parameters
/// inside the template patch's range (Dim = 3: inside the box of its parameters), normals not zero.
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

/// The same of a triangle mesh: the given ones, or the sums of the normals of the triangles around
/// each point, weighted by area. Triangles are first turned alike across their shared edges, and
/// points at equal coordinates count as one; a point whose triangles have no area takes the normal
/// of its neighbours.
PointMatrix UnitNormals(const SkeletonPatch<3>& patch);
}
