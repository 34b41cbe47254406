// SPDX-License-Identifier: BSD-3-Clause
#include "StitchTiles.h"

#include "TileCorners.h"
#include "TileJumps.h"
#include <knotwork/SplineCore/LRSpace.h>
#include <knotwork/SplineCore/LocallyRefinedForm.h>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

Status CheckParams(const std::vector<Spline<2>>& tiles, const StitchParams& params)
{
  if (tiles.empty())
  {
    return { ErrorCode::EmptyInput, "there are no tiles to stitch" };
  }
  if (params.Continuity != 0 && params.Continuity != 1)
  {
    return { ErrorCode::InvalidParameter,
      "continuity " + std::to_string(params.Continuity) + ": choose 0 or 1" };
  }
  if (!(params.Tolerance > 0.0 && params.Tolerance <= 0.1))
  {
    return { ErrorCode::InvalidParameter, "the tolerance of boundaries must lie in (0, 0.1]" };
  }
  for (std::size_t t = 0; t < tiles.size(); ++t)
  {
    const std::string tile = "tile " + std::to_string(t);
    if (const Status status = tiles[t].Check(); !status)
    {
      return { status.Code, tile + ": " + status.Detail };
    }
    if (tiles[t].NumComponents() != tiles.front().NumComponents())
    {
      return { ErrorCode::SizeMismatch,
        tile + " has " + std::to_string(tiles[t].NumComponents()) + " components, tile 0 has " +
          std::to_string(tiles.front().NumComponents()) };
    }
  }
  if (params.NumMeasured < 0 || params.NumMeasured > tiles.front().NumComponents())
  {
    return { ErrorCode::InvalidParameter,
      "of " + std::to_string(tiles.front().NumComponents()) + " components, " +
        std::to_string(params.NumMeasured) + " cannot be measured" };
  }
  return {};
}

/// Tiles without neighbours may be rational.
Status CheckPolynomial(const std::vector<Spline<2>>& tiles, const std::vector<TileEdge>& edges)
{
  for (const TileEdge& edge : edges)
  {
    for (const auto& [tile, side] : edge.Sides)
    {
      if (tiles[At(tile)].IsRational())
      {
        return { ErrorCode::InvalidWeight,
          "tile " + std::to_string(tile) +
            " is rational: only polynomial tiles, as fits are, can be stitched" };
      }
    }
  }
  return {};
}

std::vector<BezierForm<2>> MakeForms(const std::vector<Spline<2>>& tiles, int threads)
{
  std::vector<BezierForm<2>> forms;
  for (const Spline<2>& tile : tiles)
  {
    forms.push_back(MakeBezierForm(tile, threads));
  }
  return forms;
}

/// Averages both sides of an edge, corners left out.
Status AverageEdge(
  std::vector<Spline<2>>& tiles, const TileRows& rows, const TileEdge& edge, int continuity)
{
  std::array<std::vector<int>, 2> numbers;
  std::array<const SideRows*, 2> sides;
  std::array<PointMatrix*, 2> points;
  std::array<double, 2> factors; // from the difference of two rows to the derivative
  for (std::size_t i = 0; i < 2; ++i)
  {
    const int tile = edge.Sides[i].Patch;
    const int side = edge.Sides[i].Side;
    const IntArray<2>& degree = tiles[At(tile)].Space->LocallyRefined->Basis.Degree;
    sides[i] = &rows[At(tile)][At(side)];
    points[i] = &tiles[At(tile)].ControlPoints;
    numbers[i] = EdgeFunctions(*sides[i], degree[AlongSide(side)], edge.Low(i), edge.High(i));
    factors[i] = degree[AcrossSide(side)] / sides[i]->Span * (i == 1 ? edge.Ratio() : 1.0);
  }
  if (edge.IsReversed())
  {
    std::reverse(numbers[1].begin(), numbers[1].end());
  }
  if (numbers[0].size() != numbers[1].size())
  {
    return { ErrorCode::InvalidKnots,
      "knots of tiles " + std::to_string(edge.Sides[0].Patch) + " and " +
        std::to_string(edge.Sides[1].Patch) +
        " are closer than can be told apart; fit one of them anew" };
  }
  const auto atEnds = static_cast<std::size_t>(continuity + 1);
  for (std::size_t k = atEnds; k + atEnds < numbers[0].size(); ++k)
  {
    const auto row = [&](std::size_t i, std::size_t r)
    { return points[i]->row(sides[i]->Functions[r][At(numbers[i][k])]); };
    const Eigen::RowVectorXd value = 0.5 * (row(0, 0) + row(1, 0));
    if (continuity == 1)
    {
      // inwards on the first side, so outwards on the second
      const Eigen::RowVectorXd slope =
        0.5 * (factors[0] * (row(0, 1) - row(0, 0)) - factors[1] * (row(1, 1) - row(1, 0)));
      row(0, 1) = value + slope / factors[0];
      row(1, 1) = value - slope / factors[1];
    }
    row(0, 0) = value;
    row(1, 0) = value;
  }
  return {};
}

/// The tiles as LR splines; they are let go.
Status TakeTiles(std::vector<Spline<2>>& tiles, const StitchParams& params, StitchedTiles& result)
{
  for (std::size_t t = 0; t < tiles.size(); ++t)
  {
    auto tile = MakeLocallyRefined(tiles[t], params.Threads);
    if (!tile)
    {
      return { tile.Status.Code, "tile " + std::to_string(t) + ": " + tile.Status.Detail };
    }
    result.NumFunctionsAdded -= tile->Space->NumFunctions;
    result.Tiles.push_back(std::move(tile.Value));
    tiles[t] = {};
  }
  return {};
}

void MeasureBefore(
  const std::vector<TileEdge>& edges, int measured, int threads, StitchedTiles& result)
{
  const auto forms = MakeForms(result.Tiles, threads);
  for (const TileEdge& edge : edges)
  {
    const EdgeJump jump = MeasureJump(forms, edge, measured);
    StitchedEdge stitched;
    stitched.Interface = edge;
    stitched.JumpBefore = jump.Value;
    stitched.SlopeJumpBefore = jump.Slope;
    result.Edges.push_back(stitched);
  }
}

void MeasureAfter(
  const std::vector<TileEdge>& edges, int measured, int threads, StitchedTiles& result)
{
  const auto forms = MakeForms(result.Tiles, threads);
  for (std::size_t e = 0; e < edges.size(); ++e)
  {
    StitchedEdge& edge = result.Edges[e];
    const EdgeJump jump = MeasureJump(forms, edges[e], measured);
    edge.Jump = jump.Value;
    edge.SlopeJump = jump.Slope;
    result.MaxJumpBefore = std::max(result.MaxJumpBefore, edge.JumpBefore);
    result.MaxJump = std::max(result.MaxJump, edge.Jump);
    result.MaxSlopeJumpBefore = std::max(result.MaxSlopeJumpBefore, edge.SlopeJumpBefore);
    result.MaxSlopeJump = std::max(result.MaxSlopeJump, edge.SlopeJump);
  }
}

/// Averages edges, then corners. @pre the functions along the edges are the same on both sides.
Status Average(const TileRows& rows, const std::vector<TileEdge>& edges, int measured,
  const StitchParams& params, StitchedTiles& result)
{
  auto corners = FindTileCorners(result.Tiles, rows, edges, params);
  if (!corners)
  {
    return corners.Status;
  }
  std::vector<PointMatrix> before;
  for (const Spline<2>& tile : result.Tiles)
  {
    before.push_back(tile.ControlPoints);
  }
  for (const TileEdge& edge : edges)
  {
    if (Status status = AverageEdge(result.Tiles, rows, edge, params.Continuity); !status)
    {
      return status;
    }
  }
  for (const std::vector<TileCorner>& together : corners.Value)
  {
    AverageCorners(result.Tiles, together, params.Continuity);
  }
  for (std::size_t t = 0; t < before.size(); ++t)
  {
    const double change =
      (result.Tiles[t].ControlPoints - before[t]).leftCols(measured).rowwise().norm().maxCoeff();
    result.MaxChange = std::max(result.MaxChange, change);
  }
  return {};
}
}

Result<StitchedTiles> StitchTiles(std::vector<Spline<2>> tiles, const StitchParams& params)
{
  StitchedTiles result;
  Status status = CheckParams(tiles, params);
  status = status ? TakeTiles(tiles, params, result) : status;
  if (!status)
  {
    return status;
  }
  const auto edges = FindTileEdges(result.Tiles, params);
  status = edges ? CheckPolynomial(result.Tiles, edges.Value) : edges.Status;
  status = status ? CheckTileDegrees(result.Tiles, edges.Value, params) : status;
  if (!status)
  {
    return status;
  }
  const int measured =
    params.NumMeasured > 0 ? params.NumMeasured : result.Tiles.front().NumComponents();
  MeasureBefore(edges.Value, measured, params.Threads, result);
  const auto rows = PrepareStrips(result.Tiles, edges.Value, params);
  if (!rows)
  {
    return rows.Status;
  }
  for (const Spline<2>& tile : result.Tiles)
  {
    result.NumFunctionsAdded += tile.Space->NumFunctions;
  }
  status = Average(rows.Value, edges.Value, measured, params, result);
  if (!status)
  {
    return status;
  }
  MeasureAfter(edges.Value, measured, params.Threads, result);
  if (params.Progress && !params.Progress(1.0))
  {
    return { ErrorCode::Aborted, "" };
  }
  return result;
}
}
