// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryEdges.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace knotwork
{
namespace
{
/// Ends of a facet's edges in its parameters.
std::vector<std::array<std::array<double, 2>, 2>> EdgesOf(CellShape shape)
{
  if (shape == CellShape::Tetrahedron)
  {
    return { { { { 0, 0 }, { 1, 0 } } }, { { { 1, 0 }, { 0, 1 } } }, { { { 0, 1 }, { 0, 0 } } } };
  }
  return { { { { 0, 0 }, { 1, 0 } } }, { { { 1, 0 }, { 1, 1 } } }, { { { 1, 1 }, { 0, 1 } } },
    { { { 0, 1 }, { 0, 0 } } } };
}

std::array<double, 3> PointOf(const ElementEdge& edge, double t)
{
  std::array<double, 3> u{};
  for (std::size_t d = 0; d < 3; ++d)
  {
    u[d] = edge.Ends[0][d] + t * (edge.Ends[1][d] - edge.Ends[0][d]);
  }
  return u;
}

void FindFunctions(const GalerkinSpace& space, FacetEdge& edge)
{
  const int cell = edge.Place.Cell;
  const CellDegree& degree = space.Degrees[static_cast<std::size_t>(cell)];
  const int count = *std::max_element(degree.begin(), degree.end()) + 1;
  PointValues values;
  // a polynomial of the edge's degree that is 0 at as many places and one more is 0
  for (int k = 0; k < count; ++k)
  {
    EvaluateFunctions(space, cell, PointOf(edge.Place, (k + 0.5) / count).data(), values);
    for (int a = 0; a < space.NumAlive(cell); ++a)
    {
      if (std::abs(values.Values[a]) > 1e-13)
      {
        edge.Functions.push_back(space.Alive(cell)[a]);
      }
    }
  }
  std::sort(edge.Functions.begin(), edge.Functions.end());
  edge.Functions.erase(
    std::unique(edge.Functions.begin(), edge.Functions.end()), edge.Functions.end());
  for (std::size_t end = 0; end < 2; ++end)
  {
    EvaluateFunctions(space, cell, edge.Place.Ends[end].data(), values);
    for (int a = 0; a < space.NumAlive(cell); ++a)
    {
      edge.Ends[end] =
        std::abs(values.Values[a] - 1.0) < 1e-9 ? space.Alive(cell)[a] : edge.Ends[end];
    }
  }
  std::sort(edge.Ends.begin(), edge.Ends.end());
}

/// Edges in the domain of a patch that have smaller ones in them.
std::vector<bool> FindCovered(const GalerkinSpace& space, const std::vector<FacetEdge>& edges)
{
  struct Interval
  {
    double Lower;
    double Upper;
    std::size_t Edge;
  };
  std::map<std::tuple<int, std::size_t, double, double>, std::vector<Interval>> lines;
  for (std::size_t i = 0; i < edges.size(); ++i)
  {
    const ElementEdge& place = edges[i].Place;
    const auto e = static_cast<std::size_t>(place.Cell);
    const ParametricBox<3>& box = space.Boxes[e];
    std::size_t along = 0;
    std::array<double, 3> at{};
    for (std::size_t d = 0; d < 3; ++d)
    {
      along = place.Ends[0][d] != place.Ends[1][d] ? d : along;
      at[d] = place.Ends[0][d] < 0.5 ? box.Lower[d] : box.Upper[d];
    }
    if (box.Lower[along] < box.Upper[along]) // else there is no domain
    {
      lines[{ space.Patches[e], along, at[(along + 1) % 3], at[(along + 2) % 3] }].push_back(
        { box.Lower[along], box.Upper[along], i });
    }
  }
  std::vector<bool> covered(edges.size(), false);
  for (const auto& line : lines)
  {
    for (const Interval& large : line.second)
    {
      for (const Interval& small : line.second)
      {
        const bool inside = small.Lower >= large.Lower && small.Upper <= large.Upper;
        covered[large.Edge] =
          covered[large.Edge] || (inside && small.Upper - small.Lower < large.Upper - large.Lower);
      }
    }
  }
  return covered;
}
}

std::vector<FacetEdge> ChooseEdges(
  const GalerkinSpace& space, const std::vector<CellSide>& facets, const EdgeFilter& filter)
{
  const double slack = 1e-9 * space.Points.cwiseAbs().maxCoeff();
  std::vector<FacetEdge> chosen;
  // edges with the same functions alone may be parts of a ring
  std::map<std::vector<int>, std::vector<Eigen::VectorXd>> middles;
  PointValues values;
  for (const CellSide& facet : facets)
  {
    const CellShape shape = space.Shapes[static_cast<std::size_t>(facet.Cell)];
    const FacetFrame frame = MakeFacetFrame(shape, facet.Side);
    for (const auto& ends : EdgesOf(shape))
    {
      FacetEdge edge;
      edge.Place = { facet.Cell, { frame.Point(ends[0]), frame.Point(ends[1]) } };
      FindFunctions(space, edge);
      const std::array<double, 3> middle = PointOf(edge.Place, 0.5);
      if (!filter(facet, edge, { edge.Place.Ends[0], middle, edge.Place.Ends[1] }))
      {
        continue;
      }
      EvaluateFunctions(space, facet.Cell, middle.data(), values);
      auto& known = middles[edge.Functions];
      if (std::none_of(known.begin(), known.end(),
            [&](const Eigen::VectorXd& other)
            { return (other - values.Position).norm() <= slack; }))
      {
        known.push_back(values.Position);
        chosen.push_back(std::move(edge));
      }
    }
  }
  const std::vector<bool> covered = FindCovered(space, chosen);
  std::vector<FacetEdge> edges;
  for (std::size_t i = 0; i < chosen.size(); ++i)
  {
    if (!covered[i])
    {
      edges.push_back(std::move(chosen[i]));
    }
  }
  return edges;
}

void VisitEdge(const GalerkinSpace& space, const ElementEdge& edge, double tolerance,
  const std::function<void(double length, const PointValues& values)>& visit)
{
  Eigen::Vector3d way;
  for (std::size_t d = 0; d < 3; ++d)
  {
    way[static_cast<Eigen::Index>(d)] = edge.Ends[1][d] - edge.Ends[0][d];
  }
  // the length of a curved edge is no polynomial: more points than elements have
  const CellRule rule =
    MakeCellRule(CellShape::Curve, std::min(24, NumRulePoints(space, edge.Cell, tolerance) + 4));
  PointValues values;
  for (std::size_t q = 0; q < rule.Points.size(); ++q)
  {
    EvaluateFunctions(space, edge.Cell, PointOf(edge, rule.Points[q][0]).data(), values);
    const Eigen::Matrix3d jacobian = Eigen::Matrix3d(values.Inverse).inverse();
    visit(rule.Weights[q] * (jacobian * way).norm(), values);
  }
}
}
