// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/TriangleIndex.h>
#include <knotwork/TemplateMapping/Skeleton.h>

#include <type_traits>

namespace knotwork
{
/// Columns of a place on a patch. Dim 2: the parameter t. Dim 3: the triangle, a whole number kept
/// as double, and the barycentric coordinates of its corners 1 and 2.
template <int Dim>
inline constexpr int PlaceSize = Dim == 2 ? 1 : 3;

/// Position and derivatives of a polyline patch at parameters.
class PatchCurve
{
public:
  PatchCurve() = default;
  /// The patch with its parameters, or with [0, 1] uniformly. @pre CheckSkeletons accepts it.
  explicit PatchCurve(const SkeletonPatch<2>& patch);
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

  // What MappedPatch asks of both kinds of patches.
  void Evaluate(const double* place, double* point, double* derivative) const
  {
    this->Evaluate(place[0], point, derivative);
  }
  /// Places of dense samples, n x 1. @param simplices  left empty.
  PointMatrix SamplePlaces(int count, std::vector<std::array<int, 2>>& simplices) const;
  /// Parameters of the target's points, given or uniform, clamped.
  PointMatrix FirstPlaces(const SkeletonPatch<2>& target) const;

private:
  PointMatrix Points;
  Eigen::VectorXd Parameters;
};

/// Position and derivatives of a triangle mesh patch at places.
class PatchSurface
{
public:
  PatchSurface() = default;
  /// @pre CheckSkeletons accepts the patch.
  explicit PatchSurface(const SkeletonPatch<3>& patch);

  /// The triangle mesh in the domain.
  const TriangleIndex<3>& Mesh() const { return this->Index; }

  /// Position of a place, 3 values, and its derivatives for the second and the third barycentric
  /// coordinate, 6 values. @param derivatives may be null.
  void Evaluate(const double* place, double* point, double* derivatives) const;
  /// Places of dense samples and their triangles: the mesh itself for a count of 0, else every
  /// triangle cut into k^2 alike ones, k the smallest number that gives count points. Points on
  /// edges are shared; the mesh's own points come first, in their order.
  PointMatrix SamplePlaces(int count, std::vector<MeshTriangle>& simplices) const;
  /// Places of the target's parameters in the triangulation of this patch's parameters, closest
  /// ones for those outside; 0 rows when one of the two has none.
  PointMatrix FirstPlaces(const SkeletonPatch<3>& target) const;
  /// Calls use(place) with the same point as a place of every triangle that has it: the one itself
  /// inside, two at an edge, a ring at a corner. Points at equal coordinates count as one.
  template <typename Use>
  void ForTrianglesAt(const double* place, Use&& use) const;

private:
  TriangleIndex<3> Index;
  PointMatrix Parameters;
  std::vector<MeshTriangle> Welded; // triangles with the first points of equal ones
  std::vector<int> RingStart;       // offsets into Rings, an entry a point
  std::vector<int> Rings;           // triangles around the points
};

template <typename Use>
void PatchSurface::ForTrianglesAt(const double* place, Use&& use) const
{
  constexpr double Rounding = 1e-14;
  const MeshTriangle& corners = this->Welded[static_cast<std::size_t>(place[0])];
  const std::array<double, 3> weights{ 1.0 - place[1] - place[2], place[1], place[2] };
  std::size_t first = 0; // a corner with a weight
  int numWeights = 0;
  for (std::size_t k = 0; k < 3; ++k)
  {
    if (weights[k] > Rounding)
    {
      first = k;
      ++numWeights;
    }
  }
  if (numWeights == 3)
  {
    use(place);
    return;
  }
  const auto point = static_cast<std::size_t>(corners[first]);
  for (int r = this->RingStart[point]; r < this->RingStart[point + 1]; ++r)
  {
    const int triangle = this->Rings[static_cast<std::size_t>(r)];
    const MeshTriangle& others = this->Welded[static_cast<std::size_t>(triangle)];
    std::array<double, 3> moved{};
    int found = 0;
    for (std::size_t k = 0; k < 3; ++k)
    {
      for (std::size_t other = 0; other < 3; ++other)
      {
        if (weights[k] > Rounding && others[other] == corners[k])
        {
          moved[other] = weights[k];
          ++found;
        }
      }
    }
    if (found == numWeights)
    {
      const double same[3] = { double(triangle), moved[1], moved[2] };
      use(same);
    }
  }
}

template <int Dim>
using PatchGeometry = std::conditional_t<Dim == 2, PatchCurve, PatchSurface>;
}
