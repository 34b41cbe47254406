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

std::string SideName(int tile, int side)
{
  return "side " + std::to_string(side) + " of tile " + std::to_string(tile);
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
  std::vector<TileEdge> edges;
  const int n = static_cast<int>(tiles.size());
  std::vector<ParametricBox<2>> boxes;
  for (const Spline<2>& tile : tiles)
  {
    boxes.push_back(tile.Space->Domain());
  }
  for (int a = 0; a < n; ++a)
  {
    for (int b = a + 1; b < n; ++b)
    {
      std::array<double, 2> low;
      std::array<double, 2> high;
      for (std::size_t d = 0; d < 2; ++d)
      {
        low[d] = std::max(boxes[At(a)].Lower[d], boxes[At(b)].Lower[d]);
        high[d] = std::min(boxes[At(a)].Upper[d], boxes[At(b)].Upper[d]);
      }
      if (low[0] < high[0] && low[1] < high[1])
      {
        return { ErrorCode::InvalidTopology,
          "the domains of tiles " + std::to_string(a) + " and " + std::to_string(b) +
            " overlap in [" + Digits(low[0]) + ", " + Digits(high[0]) + "] x [" + Digits(low[1]) +
            ", " + Digits(high[1]) +
            "]; cut the tiles, or match them by geometry or pairs of sides" };
      }
      for (std::size_t d = 0; d < 2; ++d)
      {
        if (low[d] == high[d] && low[1 - d] < high[1 - d])
        {
          const bool aIsLower = boxes[At(a)].Upper[d] == low[d];
          const int side = static_cast<int>(2 * d);
          TileEdge edge;
          edge.Pair.Tiles = { a, b };
          edge.Pair.Sides = { side + (aIsLower ? 1 : 0), side + (aIsLower ? 0 : 1) };
          edge.Low.fill(low[1 - d]);
          edge.High.fill(high[1 - d]);
          edges.push_back(edge);
        }
      }
    }
  }
  return edges;
}

/// Points of a side at its lower end, its middle and its upper end.
using SidePoints = std::array<Eigen::RowVectorXd, 3>;

Result<std::array<SidePoints, 4>> PointsOfSides(const Spline<2>& tile, int components, int threads)
{
  const ParametricBox<2> box = tile.Space->Domain();
  PointMatrix at(12, 2);
  for (int side = 0; side < 4; ++side)
  {
    const std::size_t along = AlongSide(side);
    for (int k = 0; k < 3; ++k)
    {
      const double low = box.Lower[along];
      const double high = box.Upper[along];
      at(3 * side + k, static_cast<Eigen::Index>(AcrossSide(side))) = SideValue(box, side);
      at(3 * side + k, static_cast<Eigen::Index>(along)) = k == 0 ? low
        : k == 1                                                  ? 0.5 * (low + high)
                                                                  : high;
    }
  }
  EvaluationBatch batch;
  const Status status =
    EvaluateParameters(MakeBezierForm(tile, threads), at, { 0, threads }, batch);
  std::array<SidePoints, 4> points;
  for (int i = 0; i < 12 && status; ++i)
  {
    points[At(i / 3)][At(i % 3)] = batch.Values.row(i).head(components);
  }
  return status ? Result<std::array<SidePoints, 4>>(points) : status;
}

Result<std::vector<TilePair>> PairsOfGeometry(
  const std::vector<Spline<2>>& tiles, const StitchParams& params)
{
  const int all = tiles.front().NumComponents();
  const int components = params.NumMeasured == 0 ? all : params.NumMeasured;
  std::vector<std::array<SidePoints, 4>> points;
  Eigen::RowVectorXd low = tiles.front().ControlPoints.row(0).head(components);
  Eigen::RowVectorXd high = low;
  for (const Spline<2>& tile : tiles)
  {
    auto sides = PointsOfSides(tile, components, params.Threads);
    if (!sides)
    {
      return sides.Status;
    }
    points.push_back(std::move(sides.Value));
    low = low.cwiseMin(tile.ControlPoints.leftCols(components).colwise().minCoeff());
    high = high.cwiseMax(tile.ControlPoints.leftCols(components).colwise().maxCoeff());
  }
  const double tolerance = params.Tolerance * (high - low).maxCoeff();
  const auto same = [tolerance](const Eigen::RowVectorXd& a, const Eigen::RowVectorXd& b)
  { return (a - b).norm() <= tolerance; };
  std::vector<TilePair> pairs;
  const int n = 4 * static_cast<int>(tiles.size());
  for (int a = 0; a < n; ++a)
  {
    const SidePoints& x = points[At(a / 4)][At(a % 4)];
    for (int b = a + 1; b < n; ++b)
    {
      const SidePoints& y = points[At(b / 4)][At(b % 4)];
      const bool forwards = same(x[0], y[0]) && same(x[2], y[2]);
      const bool backwards = same(x[0], y[2]) && same(x[2], y[0]);
      if ((forwards || backwards) && same(x[1], y[1]))
      {
        if (forwards && backwards)
        {
          return { ErrorCode::InvalidTopology,
            SideName(a / 4, a % 4) + " and " + SideName(b / 4, b % 4) +
              " are closed or points: name the pairs of sides" };
        }
        pairs.push_back({ { a / 4, b / 4 }, { a % 4, b % 4 }, backwards });
      }
    }
  }
  return pairs;
}

Result<std::vector<TileEdge>> EdgesOfPairs(
  const std::vector<Spline<2>>& tiles, const std::vector<TilePair>& pairs)
{
  std::vector<TileEdge> edges;
  std::set<std::array<int, 2>> used;
  for (const TilePair& pair : pairs)
  {
    TileEdge edge;
    edge.Pair = pair;
    for (std::size_t i = 0; i < 2; ++i)
    {
      const int tile = pair.Tiles[i];
      const int side = pair.Sides[i];
      if (tile < 0 || tile >= static_cast<int>(tiles.size()) || side < 0 || side > 3)
      {
        return { ErrorCode::InvalidParameter,
          "there is no " + SideName(tile, side) + ": tiles count from 0 to " +
            std::to_string(tiles.size() - 1) + ", sides from 0 to 3" };
      }
      if (!used.insert({ tile, side }).second)
      {
        return { ErrorCode::InvalidTopology, SideName(tile, side) + " is in more than one pair" };
      }
      const ParametricBox<2> box = tiles[At(tile)].Space->Domain();
      edge.Low[i] = box.Lower[AlongSide(side)];
      edge.High[i] = box.Upper[AlongSide(side)];
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
