// SPDX-License-Identifier: BSD-3-Clause
#include "CompositeChart.h"

#include <Eigen/LU>

namespace knotwork
{
CompositeChart::CompositeChart(PointMatrix places, std::vector<MeshTriangle> triangles,
  std::vector<int> faces, std::vector<std::array<Eigen::Vector2d, 3>> parameters)
  : Index(std::move(places), std::move(triangles)), Faces(std::move(faces)),
    Parameters(std::move(parameters))
{
}

CompositePlace CompositeChart::At(const Eigen::Vector2d& place) const
{
  const int triangle = this->Index.Nearest(place.data()).Triangle;
  const auto t = static_cast<std::size_t>(triangle);
  const auto corner = [&](int i)
  { return Eigen::Map<const Eigen::Vector2d>(this->Index.Corner(triangle, i)); };
  Eigen::Matrix2d sides;
  sides << corner(1) - corner(0), corner(2) - corner(0);
  const auto& of = this->Parameters[t];
  Eigen::Matrix2d images;
  images << of[1] - of[0], of[2] - of[0];
  const Eigen::Matrix2d derivative = images * sides.inverse();
  return { this->Faces[t], of[0] + derivative * (place - corner(0)), derivative };
}

Eigen::Vector2d CompositeChart::Nearest(const Eigen::Vector2d& place) const
{
  const TriangleFoot foot = this->Index.Nearest(place.data());
  return foot.SquaredDistance > 0.0
    ? Eigen::Vector2d(this->Index.PointAt(foot.Triangle, foot.Second, foot.Third).transpose())
    : place;
}
}
