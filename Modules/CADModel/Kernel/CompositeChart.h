// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/TriangleIndex.h>

#include <Eigen/Core>

namespace knotwork
{
/// Where a place of a CompositeChart is on one of its faces.
struct CompositePlace
{
  int Face = 0;
  Eigen::Vector2d Parameters;
  Eigen::Matrix2d Derivative; ///< of the parameters by the place
};

/// Common parameters of several faces: the plane that their triangles are flattened to, linear to
/// the parameters of a face in every triangle. Places beyond the rim belong to the nearest
/// triangle.
class CompositeChart
{
public:
  /// @param places      n x 2. @param triangles  counterclockwise.
  /// @param faces       one a triangle.
  /// @param parameters  of the triangles' corners on their faces.
  CompositeChart(PointMatrix places, std::vector<MeshTriangle> triangles, std::vector<int> faces,
    std::vector<std::array<Eigen::Vector2d, 3>> parameters);

  CompositePlace At(const Eigen::Vector2d& place) const;
  /// The place itself within the triangles, else the nearest of their rim.
  Eigen::Vector2d Nearest(const Eigen::Vector2d& place) const;

private:
  TriangleIndex<2> Index;
  std::vector<int> Faces;
  std::vector<std::array<Eigen::Vector2d, 3>> Parameters;
};
}
