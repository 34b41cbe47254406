// SPDX-License-Identifier: BSD-3-Clause
#include "TileEdges.h"

#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/HeightField.h>
#include <knotwork/SplineCore/LRSpace.h>
#include <knotwork/SplineCore/Numbers.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

std::string SideName(const PatchSide& side)
{
  return "side " + std::to_string(side.Side) + " of tile " + std::to_string(side.Patch);
}

/// Moves the ends of a tile's knots in a direction; those between follow, and so do the coordinates
/// of a height field, which are its parameters.
Status MoveEnds(Spline<2>& tile, std::size_t d, double low, double high, int threads)
{
  LRBasis basis = tile.Space->LocallyRefined->Basis;
  std::vector<double>& knots = basis.Knots[d];
  const double begin = knots.front();
  const double end = knots.back();
  const auto moved = [=](double t)
  {
    const double s = (t - begin) / (end - begin);
    return t == begin ? low : t == end ? high : (1.0 - s) * low + s * high;
  };
  if (IsHeightField(MakeBezierForm(tile, threads)))
  {
    auto coordinate = tile.ControlPoints.col(static_cast<Eigen::Index>(d));
    std::transform(coordinate.begin(), coordinate.end(), coordinate.begin(), moved);
  }
  std::transform(knots.begin(), knots.end(), knots.begin(), moved);
  auto space = MakeLRSpace(std::move(basis), threads);
  if (space)
  {
    tile.Space = std::move(space.Value);
  }
  return space.Status;
}

/// Makes boxes fit that are within the tolerance of each other.
Status FitBoxes(std::vector<Spline<2>>& tiles, const StitchParams& params)
{
  for (std::size_t d = 0; d < 2; ++d)
  {
    std::vector<double> ends;
    double shortest = HUGE_VAL;
    for (const Spline<2>& tile : tiles)
    {
      const ParametricBox<2> box = tile.Space->Domain();
      ends.insert(ends.end(), { box.Lower[d], box.Upper[d] });
      shortest = std::min(shortest, box.Upper[d] - box.Lower[d]);
    }
    std::sort(ends.begin(), ends.end());
    const auto common = [&](double value)
    {
      // the first of the ends that lie close together
      auto at = std::lower_bound(ends.begin(), ends.end(), value);
      while (at != ends.begin() && *at - *(at - 1) <= params.Tolerance * shortest)
      {
        --at;
      }
      return *at;
    };
    for (std::size_t t = 0; t < tiles.size(); ++t)
    {
      const ParametricBox<2> box = tiles[t].Space->Domain();
      const double low = common(box.Lower[d]);
      const double high = common(box.Upper[d]);
      if (!(low < high))
      {
        return { ErrorCode::InvalidTopology,
          "tile " + std::to_string(t) +
            " is narrower than the tolerance of its neighbours' boundaries; choose a smaller one" };
      }
      if (low != box.Lower[d] || high != box.Upper[d])
      {
        if (Status status = MoveEnds(tiles[t], d, low, high, params.Threads); !status)
        {
          return status;
        }
      }
    }
  }
  return {};
}

Result<std::vector<TileEdge>> EdgesOfBoxes(const std::vector<Spline<2>>& tiles)
{
  std::vector<ParametricBox<2>> boxes;
  for (const Spline<2>& tile : tiles)
  {
    boxes.push_back(tile.Space->Domain());
  }
  for (std::size_t a = 0; a < boxes.size(); ++a)
  {
    for (std::size_t b = a + 1; b < boxes.size(); ++b)
    {
      std::array<double, 2> low;
      std::array<double, 2> high;
      for (std::size_t d = 0; d < 2; ++d)
      {
        low[d] = std::max(boxes[a].Lower[d], boxes[b].Lower[d]);
        high[d] = std::min(boxes[a].Upper[d], boxes[b].Upper[d]);
      }
      if (low[0] < high[0] && low[1] < high[1])
      {
        return { ErrorCode::InvalidTopology,
          "the domains of tiles " + std::to_string(a) + " and " + std::to_string(b) +
            " overlap in [" + Digits(low[0]) + ", " + Digits(high[0]) + "] x [" + Digits(low[1]) +
            ", " + Digits(high[1]) +
            "]; cut the tiles, or match them by geometry or pairs of sides" };
      }
    }
  }
  std::vector<TileEdge> edges;
  for (const PatchInterface& interface : FindInterfaces<2>(boxes))
  {
    edges.push_back({ interface });
  }
  return edges;
}

Result<std::vector<PatchInterface>> PairsOfGeometry(
  const std::vector<Spline<2>>& tiles, const StitchParams& params)
{
  const int components =
    params.NumMeasured == 0 ? tiles.front().NumComponents() : params.NumMeasured;
  Result<std::vector<SideSamples>> sides = SampleSides<2>(tiles, 3, params.Threads);
  if (!sides)
  {
    return sides.Status;
  }
  for (SideSamples& side : sides.Value)
  {
    side.Points = PointMatrix(side.Points.leftCols(components));
  }
  Eigen::RowVectorXd low = tiles.front().ControlPoints.row(0).head(components);
  Eigen::RowVectorXd high = low;
  for (const Spline<2>& tile : tiles)
  {
    low = low.cwiseMin(tile.ControlPoints.leftCols(components).colwise().minCoeff());
    high = high.cwiseMax(tile.ControlPoints.leftCols(components).colwise().maxCoeff());
  }
  const double tolerance = params.Tolerance * (high - low).maxCoeff();
  std::vector<PatchInterface> all = FindInterfaces(sides.Value, tolerance);
  std::sort(all.begin(), all.end(),
    [](const PatchInterface& a, const PatchInterface& b) { return a.Sides < b.Sides; });
  std::vector<PatchInterface> pairs;
  for (const PatchInterface& found : all)
  {
    const auto& [a, b] = found.Sides;
    if (a == b)
    {
      continue;
    }
    const auto samplesOf = [&](const PatchSide& side) -> const SideSamples&
    { return sides.Value[At(4 * side.Patch + side.Side)]; };
    if (FittingOrientations(samplesOf(b), samplesOf(a), tolerance).size() > 1)
    {
      return { ErrorCode::InvalidTopology,
        SideName(a) + " and " + SideName(b) + " are closed or points: name the pairs of sides" };
    }
    pairs.push_back(found);
  }
  return pairs;
}

Result<std::vector<TileEdge>> EdgesOfPairs(
  const std::vector<Spline<2>>& tiles, const std::vector<PatchInterface>& pairs)
{
  std::vector<TileEdge> edges;
  std::set<PatchSide> used;
  for (const PatchInterface& pair : pairs)
  {
    TileEdge edge{ pair };
    for (std::size_t i = 0; i < 2; ++i)
    {
      const PatchSide& side = pair.Sides[i];
      if (side.Patch < 0 || side.Patch >= static_cast<int>(tiles.size()) || side.Side < 0 ||
        side.Side > 3)
      {
        return { ErrorCode::InvalidParameter,
          "there is no " + SideName(side) + ": tiles count from 0 to " +
            std::to_string(tiles.size() - 1) + ", sides from 0 to 3" };
      }
      if (!used.insert(side).second)
      {
        return { ErrorCode::InvalidTopology, SideName(side) + " is in more than one pair" };
      }
      const ParametricBox<2> box = tiles[At(side.Patch)].Space->Domain();
      edge.Parts[i].Lower[0] = box.Lower[AlongSide(side.Side)];
      edge.Parts[i].Upper[0] = box.Upper[AlongSide(side.Side)];
    }
    edges.push_back(edge);
  }
  return edges;
}
}

Result<std::vector<TileEdge>> FindTileEdges(
  std::vector<Spline<2>>& tiles, const StitchParams& params)
{
  Result<std::vector<TileEdge>> edges;
  if (params.Matching == TileMatching::Domain)
  {
    const Status status = FitBoxes(tiles, params);
    edges = status ? EdgesOfBoxes(tiles) : status;
  }
  else if (params.Matching == TileMatching::Geometry)
  {
    const auto pairs = PairsOfGeometry(tiles, params);
    edges = pairs ? EdgesOfPairs(tiles, pairs.Value) : pairs.Status;
  }
  else
  {
    edges = EdgesOfPairs(tiles, params.Pairs);
  }
  if (edges && edges->empty() && tiles.size() > 1)
  {
    return { ErrorCode::InvalidTopology,
      "no two of the " + std::to_string(tiles.size()) +
        " tiles share an edge; choose a larger tolerance or name the pairs of sides" };
  }
  return edges;
}
}
