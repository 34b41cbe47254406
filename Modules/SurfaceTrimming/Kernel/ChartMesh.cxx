// SPDX-License-Identifier: BSD-3-Clause
#include "ChartMesh.h"

#include <knotwork/MeshParameterization/PlaneLoops.h>

#include <string>

namespace knotwork
{
namespace
{
std::string FirstBadRow(const PointMatrix& rows)
{
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
  {
    if (!rows.row(i).allFinite())
    {
      return std::to_string(i);
    }
  }
  return "none";
}
}

Status ChartMesh::Check() const
{
  const Eigen::Index n = this->Points.rows();
  if (n == 0 || this->Triangles.empty())
  {
    return { ErrorCode::EmptyInput, "a chart without triangles" };
  }
  if (this->Points.cols() != 3 || this->UV.cols() != 2 || this->UV.rows() != n ||
    (!this->PointIds.empty() && static_cast<Eigen::Index>(this->PointIds.size()) != n))
  {
    return { ErrorCode::SizeMismatch,
      "a chart needs 3 coordinates, 2 plane coordinates and at most one id a point" };
  }
  if (!this->Points.allFinite())
  {
    return { ErrorCode::NonFiniteInput, "coordinates of point " + FirstBadRow(this->Points) };
  }
  if (!this->UV.allFinite())
  {
    return { ErrorCode::NonFiniteInput, "plane coordinates of point " + FirstBadRow(this->UV) };
  }
  int flipped = 0;
  int first = -1;
  for (std::size_t t = 0; t < this->Triangles.size(); ++t)
  {
    const auto& corners = this->Triangles[t];
    for (int corner : corners)
    {
      if (corner < 0 || corner >= n)
      {
        return { ErrorCode::InvalidTopology,
          "triangle " + std::to_string(t) + " has corner " + std::to_string(corner) +
            ", which is no point" };
      }
    }
    if (Turn(this->UV, corners[0], corners[1], corners[2]) <= 0)
    {
      first = flipped == 0 ? static_cast<int>(t) : first;
      ++flipped;
    }
  }
  if (flipped > 0)
  {
    return { ErrorCode::InvalidTopology,
      std::to_string(flipped) + " triangles are not counterclockwise in the plane (the first is " +
        std::to_string(first) + "); flatten the mesh with a method that flips none" };
  }
  return {};
}
}
