// SPDX-License-Identifier: BSD-3-Clause
#include "FitUpdate.h"

#include <algorithm>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Marks the functions with a Bernstein coefficient in one of the first rows from a side on.
void MarkEdge(const SplineSpace<2>& space, const ElementFunctions& functions, std::size_t side,
  int rows, std::vector<std::uint8_t>& fixed)
{
  const std::size_t d = side / 2;
  const bool isUpper = side % 2 == 1;
  const ParametricBox<2> domain = space.Domain();
  for (int e = 0; e < space.NumElements(); ++e)
  {
    const SplineSpace<2>::Element& element = space.Elements[At(e)];
    if (isUpper ? element.Box.Upper[d] < domain.Upper[d] : element.Box.Lower[d] > domain.Lower[d])
    {
      continue;
    }
    for (int k = 0; k < functions.Alive(e); ++k)
    {
      const std::size_t entry = functions.First(e) + At(k);
      const double* row = functions.Row(entry);
      for (int b = 0; b < functions.PerElement; ++b)
      {
        const int along = d == 0 ? b % (element.Degree[0] + 1) : b / (element.Degree[0] + 1);
        if (row[b] != 0.0 && (isUpper ? element.Degree[d] - along : along) < rows)
        {
          fixed[At(functions.Functions[entry])] = 1;
        }
      }
    }
  }
}
}

std::vector<std::uint8_t> FindFixedFunctions(const SplineSpace<2>& space,
  const ElementFunctions& functions, const FitPoints& points, const std::array<FitEdge, 4>& edges,
  const FitDivision& division)
{
  std::vector<std::uint8_t> hasPoints(points.Ranges.size());
  for (std::size_t e = 0; e < hasPoints.size(); ++e)
  {
    const auto at = [&](std::size_t i)
    { return points.Base.begin() + static_cast<std::ptrdiff_t>(i); };
    hasPoints[e] = std::any_of(at(points.Ranges[e].Begin), at(points.Ranges[e].End),
                     [](double w) { return w > 0.0; })
      ? 1
      : 0;
  }
  division.ShareAll([&](std::size_t e) { return std::pair(&hasPoints[e], std::size_t{ 1 }); });
  std::vector<std::uint8_t> fixed(At(functions.NumFunctions), 1);
  for (int e = 0; e < space.NumElements(); ++e)
  {
    if (hasPoints[At(e)] != 0)
    {
      for (int k = 0; k < functions.Alive(e); ++k)
      {
        fixed[At(functions.Functions[functions.First(e) + At(k)])] = 0;
      }
    }
  }
  for (std::size_t side = 0; side < 4; ++side)
  {
    if (edges[side] != FitEdge::Free)
    {
      MarkEdge(space, functions, side, edges[side] == FitEdge::Values ? 1 : 2, fixed);
    }
  }
  return fixed;
}

bool IsOnHeldEdge(const ParametricBox<2>& domain, const std::array<FitEdge, 4>& edges,
  const RealArray<2>& distance, double u, double v)
{
  return (edges[0] != FitEdge::Free && u - domain.Lower[0] < distance[0]) ||
    (edges[1] != FitEdge::Free && domain.Upper[0] - u < distance[0]) ||
    (edges[2] != FitEdge::Free && v - domain.Lower[1] < distance[1]) ||
    (edges[3] != FitEdge::Free && domain.Upper[1] - v < distance[1]);
}

FitParams WithStart(const FitParams& params)
{
  FitParams own = params;
  if (params.Start)
  {
    const SplineSpace<2>& space = *params.Start->Surface.Space;
    own.Degree = space.Elements[0].Degree;
    own.Domain = space.Domain();
    if (space.Kind != SpaceKind::Tensor)
    {
      own.Space =
        space.Kind == SpaceKind::Hierarchical ? FitSpace::Hierarchical : FitSpace::LocallyRefined;
    }
  }
  return own;
}

Status CheckStart(const PointCloud& cloud, const FitParams& params)
{
  if (!params.Start)
  {
    return {};
  }
  const Spline<2>& surface = params.Start->Surface;
  if (!surface.Space || !surface.Space->HasDomain())
  {
    return { ErrorCode::DimensionMismatch,
      "the start surface has no parameter domain; give a tensor-product, THB or LR spline" };
  }
  if (surface.IsRational())
  {
    return { ErrorCode::InvalidWeight, "the start surface is rational; fits are polynomial" };
  }
  if (const Status status = surface.Check(); !status)
  {
    return { status.Code, "the start surface: " + status.Detail };
  }
  if (surface.ControlPoints.cols() < cloud.Values.cols() ||
    params.Start->DomainPoints.rows() != surface.ControlPoints.rows() ||
    params.Start->DomainPoints.cols() != 2)
  {
    return { ErrorCode::SizeMismatch,
      "the start surface has " + std::to_string(surface.ControlPoints.cols()) + " components and " +
        std::to_string(params.Start->DomainPoints.rows()) + " domain points; at least " +
        std::to_string(cloud.Values.cols()) + " and " +
        std::to_string(surface.ControlPoints.rows()) + " are needed" };
  }
  const std::array<FitEdge, 4>& edges = params.Start->Edges;
  if (params.Side != FitSide::Both &&
    std::any_of(edges.begin(), edges.end(), [](FitEdge edge) { return edge != FitEdge::Free; }))
  {
    return { ErrorCode::InvalidParameter,
      "edges of the start surface are held, and no point may be on one side of the surface; choose "
      "one of them" };
  }
  return {};
}
}
