// SPDX-License-Identifier: BSD-3-Clause
// Triangles and parts of them between points whose places are exact, private to the kernel.
#pragma once
#include <knotwork/SplineCore/TriangleIndex.h>

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>

#include <map>
#include <vector>

namespace knotwork
{
using ExactKernel = CGAL::Exact_predicates_exact_constructions_kernel;
using ExactPoint = ExactKernel::Point_3;

/// Points by their exact place.
class ExactPoints
{
public:
  explicit ExactPoints(const PointMatrix& points)
  {
    for (Eigen::Index i = 0; i < points.rows(); ++i)
    {
      this->Places.emplace_back(points(i, 0), points(i, 1), points(i, 2));
    }
    this->NumGiven = static_cast<int>(points.rows());
  }
  /// Corners of triangles that are divided are found by their places.
  void Register(int point)
  {
    this->Numbers.emplace(this->Places[static_cast<std::size_t>(point)], point);
  }
  /// Number of the point at a place, a new one if none is registered there.
  int Number(const ExactPoint& place)
  {
    const auto [found, isNew] = this->Numbers.emplace(place, static_cast<int>(this->Places.size()));
    if (isNew)
    {
      place.exact(); // the tree of its making is not needed any more
      this->Places.push_back(place);
    }
    return found->second;
  }
  const ExactPoint& operator[](int point) const
  {
    return this->Places[static_cast<std::size_t>(point)];
  }
  int Size() const { return static_cast<int>(this->Places.size()); }
  int NumGiven = 0; ///< lower numbers are those of points that were given

private:
  std::vector<ExactPoint> Places;
  std::map<ExactPoint, int, ExactKernel::Less_xyz_3> Numbers;
};

/// The nearest floating-point numbers.
inline Eigen::RowVector3d Rounded(const ExactPoint& p)
{
  return { CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z()) };
}

/// A triangle of the input, or a part of one.
struct TrianglePart
{
  MeshTriangle Corners; ///< numbers of exact points
  int Source;           ///< triangle of the input
};
}
