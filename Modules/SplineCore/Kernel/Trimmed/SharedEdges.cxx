// SPDX-License-Identifier: BSD-3-Clause
#include "SharedEdges.h"

#include <algorithm>
#include <map>

namespace knotwork
{
namespace
{
constexpr double Tolerance = 1e-9; ///< of the domain

/// A use of an edge that runs along a whole side.
struct SideUse
{
  PatchSide Side; ///< none: the edge does not
  Eigen::VectorXd Shares;
};

SideUse UseOfSide(int face, const ParametricBox<2>& domain, const PointMatrix& uv)
{
  PointMatrix shares(uv.rows(), 2); // of the domain
  for (Eigen::Index d = 0; d < 2; ++d)
  {
    const auto at = static_cast<std::size_t>(d);
    const double length = domain.Upper[at] - domain.Lower[at];
    shares.col(d) = (uv.col(d).array() - domain.Lower[at]) / length;
  }
  for (int side = 0; side < 4; ++side)
  {
    const auto across = shares.col(side / 2);
    const auto along = shares.col(1 - side / 2);
    const double first = along[0];
    const double last = along[along.size() - 1];
    const bool lies = (across.array() - side % 2).abs().maxCoeff() <= Tolerance;
    const bool whole = std::abs(std::min(first, last)) <= Tolerance &&
      std::abs(std::max(first, last) - 1.0) <= Tolerance;
    if (lies && whole)
    {
      return { { face, side }, along };
    }
  }
  return {};
}
}

PatchTopology SharedEdges(const TrimmedModel& model)
{
  std::map<int, std::vector<SideUse>> uses; // of edges
  for (std::size_t f = 0; f < model.Faces.size(); ++f)
  {
    const TrimmedFace& face = model.Faces[f];
    for (const TrimmedLoop& loop : face.Loops)
    {
      for (const TrimmingCurve& curve : loop.Curves)
      {
        uses[curve.Edge].push_back(
          UseOfSide(static_cast<int>(f), face.Surface.Space->Domain(), curve.UV));
      }
    }
  }
  PatchTopology topology;
  for (const auto& [edge, both] : uses)
  {
    if (both.size() != 2 || both[0].Side.Side < 0 || both[1].Side.Side < 0)
    {
      continue;
    }
    PatchInterface interface;
    interface.Sides = { both[0].Side, both[1].Side };
    for (const SideOrientation& orientation : SideOrientations(1))
    {
      interface.Orientation = orientation;
      const Eigen::ArrayXd other = orientation.Reversed[0]
        ? Eigen::ArrayXd(1.0 - both[0].Shares.array())
        : Eigen::ArrayXd(both[0].Shares.array());
      if ((both[1].Shares.array() - other).abs().maxCoeff() <= Tolerance)
      {
        topology.Interfaces.push_back(interface);
        break;
      }
    }
  }
  return topology;
}
}
