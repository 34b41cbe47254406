// SPDX-License-Identifier: BSD-3-Clause
#include "TileCorners.h"

#include <knotwork/SplineCore/LRSpace.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace knotwork
{
namespace
{
/// Frames that agree so well are one: they are products of ratios of lengths.
constexpr double SameFrame = 1e-9;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// First position of a value among the knots (nearest one), and how often it is there.
struct KnotPlace
{
  int First = 0;
  int Count = 0;
};

KnotPlace FindKnot(const std::vector<double>& knots, double value)
{
  const auto nearest = std::min_element(knots.begin(), knots.end(),
    [value](double a, double b) { return std::fabs(a - value) < std::fabs(b - value); });
  const auto end = std::upper_bound(nearest, knots.end(), *nearest);
  return { static_cast<int>(nearest - knots.begin()), static_cast<int>(end - nearest) };
}

/// What makes a corner one and the same: its tile, the side and place on it, and the half; or the
/// tile and the number of its corner, less than 0.
struct CornerKey
{
  int Tile = 0;
  int Side = 0;
  double Place = 0.0;
  bool Upwards = false; ///< the side goes on towards larger parameters

  bool operator<(const CornerKey& b) const
  {
    return std::tie(this->Tile, this->Side, this->Place, this->Upwards) <
      std::tie(b.Tile, b.Side, b.Place, b.Upwards);
  }
};

/// Derivatives of two corners of one place: those of the second are Factor times the first's.
struct CornerLink
{
  int From = 0;
  int To = 0;
  std::array<int, 2> Direction{}; ///< of the tiles' parameters along the common curve
  double Along = 1.0;
  double Across = 1.0;
};

class CornerFinder
{
public:
  CornerFinder(const std::vector<Spline<2>>& tiles, const TileRows& rows) : Tiles(tiles), Rows(rows)
  {
  }

  void AddEdge(const TileEdge& edge)
  {
    for (const bool atHigh : { false, true })
    {
      std::array<int, 2> ids;
      for (std::size_t i = 0; i < 2; ++i)
      {
        const bool isHigh = atHigh != (i == 1 && edge.IsReversed());
        ids[i] = this->Corner(
          edge.Sides[i].Patch, edge.Sides[i].Side, isHigh ? edge.High(i) : edge.Low(i), !isHigh);
      }
      const double ratio = edge.Ratio();
      this->Links.push_back({ ids[0], ids[1],
        { static_cast<int>(AlongSide(edge.Sides[0].Side)),
          static_cast<int>(AlongSide(edge.Sides[1].Side)) },
        1.0 / ratio, -1.0 / ratio });
    }
  }

  Result<std::vector<std::vector<TileCorner>>> Finish(bool needFrames)
  {
    const std::size_t n = this->Corners.size();
    std::vector<std::vector<CornerLink>> links(n);
    for (const CornerLink& link : this->Links)
    {
      links[At(link.From)].push_back(link);
      links[At(link.To)].push_back({ link.To, link.From, { link.Direction[1], link.Direction[0] },
        1.0 / link.Along, 1.0 / link.Across });
    }
    std::vector<std::vector<TileCorner>> places;
    std::vector<char> seen(n, 0);
    for (std::size_t start = 0; start < n; ++start)
    {
      if (seen[start])
      {
        continue;
      }
      std::vector<int> place{ static_cast<int>(start) };
      seen[start] = 1;
      this->Corners[start].Axis = { 0, 1 };
      this->Corners[start].Factor = { 1.0, 1.0 };
      for (std::size_t k = 0; k < place.size(); ++k)
      {
        for (const CornerLink& link : links[At(place[k])])
        {
          const TileCorner reached = this->Follow(link);
          TileCorner& other = this->Corners[At(link.To)];
          if (!seen[At(link.To)])
          {
            seen[At(link.To)] = 1;
            place.push_back(link.To);
            other = reached;
          }
          else if (needFrames && !SameFrames(other, reached))
          {
            return { ErrorCode::InvalidTopology,
              "the tiles around a corner of tile " + std::to_string(this->Corners[start].Tile) +
                " have no common directions, as other than four of them meet there; choose C0" };
          }
        }
      }
      std::vector<TileCorner> corners;
      for (const int id : place)
      {
        corners.push_back(this->Corners[At(id)]);
      }
      places.push_back(std::move(corners));
    }
    return places;
  }

private:
  int Corner(int tile, int side, double place, bool upwards)
  {
    const ParametricBox<2> domain = this->Tiles[At(tile)].Space->Domain();
    const std::size_t along = AlongSide(side);
    const bool atLow = place == domain.Lower[along];
    const bool atHigh = place == domain.Upper[along];
    CornerKey key{ tile, side, place, upwards };
    if (atLow || atHigh)
    {
      // the four corners of a tile, whichever side they are reached by
      key = { tile, -1 - PatchCorner<2>(side, atHigh ? 1 : 0), 0.0, false };
    }
    const auto [found, isNew] = this->Ids.emplace(key, static_cast<int>(this->Corners.size()));
    const int id = found->second;
    if (isNew)
    {
      this->Corners.push_back(this->Make(tile, side, place, upwards));
      if (!atLow && !atHigh)
      {
        // the other half: the same side seen in the other direction
        const int other = this->Corner(tile, side, place, !upwards);
        const auto direction = static_cast<int>(along);
        this->Links.push_back({ id, other, { direction, direction }, -1.0, 1.0 });
      }
    }
    return id;
  }

  TileCorner Make(int tile, int side, double place, bool upwards) const
  {
    const SideRows& rows = this->Rows[At(tile)][At(side)];
    const IntArray<2>& degree = this->Tiles[At(tile)].Space->LocallyRefined->Basis.Degree;
    const std::size_t along = AlongSide(side);
    TileCorner corner;
    corner.Tile = tile;
    corner.Across = AcrossSide(side);
    corner.Degree = { degree[corner.Across], degree[along] };
    const KnotPlace knot = FindKnot(rows.Knots, place);
    const int last = knot.First + knot.Count - 1;
    const double at = rows.Knots[At(knot.First)];
    const bool hasBelow = knot.First > 0;
    const bool hasAbove = At(last) + 1 < rows.Knots.size();
    const double below = hasBelow ? at - rows.Knots[At(knot.First - 1)] : 0.0;
    const double above = hasAbove ? rows.Knots[At(last + 1)] - at : 0.0;
    corner.Span = { rows.Span, upwards ? above : below };
    corner.SpanBeyond = upwards ? below : above;
    const int p = degree[along];
    // a coefficient is the blossom at p successive knots: those at the place, or all but one
    const bool isMean = knot.Count < p;
    const int start = upwards ? last - p : knot.First - 1;
    const int inner = upwards ? start + 1 : start - 1;
    for (std::size_t r = 0; r < 2; ++r)
    {
      const std::vector<int>& f = rows.Functions[r];
      if (f.empty()) // C0
      {
        corner.Functions[r] = { -1, -1 };
        continue;
      }
      if (isMean)
      {
        corner.Functions[r] = { -1, f[At(upwards ? knot.First - 1 : knot.First - 2)] };
        corner.Beyond[r] = f[At(upwards ? knot.First - 2 : knot.First - 1)];
      }
      else
      {
        corner.Functions[r] = { f[At(start)], f[At(inner)] };
      }
    }
    return corner;
  }

  /// The corner at the other end of a link with the frame that the first one gives it.
  TileCorner Follow(const CornerLink& link) const
  {
    const TileCorner& from = this->Corners[At(link.From)];
    TileCorner to = this->Corners[At(link.To)];
    const auto alongFrom = At(link.Direction[0]);
    const auto alongTo = At(link.Direction[1]);
    to.Axis[alongTo] = from.Axis[alongFrom];
    to.Axis[1 - alongTo] = from.Axis[1 - alongFrom];
    to.Factor[alongTo] = from.Factor[alongFrom] * link.Along;
    to.Factor[1 - alongTo] = from.Factor[1 - alongFrom] * link.Across;
    return to;
  }

  static bool SameFrames(const TileCorner& a, const TileCorner& b)
  {
    return a.Axis == b.Axis &&
      std::fabs(a.Factor[0] - b.Factor[0]) <= SameFrame * std::fabs(a.Factor[0]) &&
      std::fabs(a.Factor[1] - b.Factor[1]) <= SameFrame * std::fabs(a.Factor[1]);
  }

  const std::vector<Spline<2>>& Tiles;
  const TileRows& Rows;
  std::map<CornerKey, int> Ids;
  std::vector<TileCorner> Corners;
  std::vector<CornerLink> Links;
};

/// Value and derivative inwards, along the side, that a row of coefficients has at a corner.
struct RowJet
{
  Eigen::RowVectorXd Value;
  Eigen::RowVectorXd Slope;
};

RowJet ReadRow(const PointMatrix& points, const TileCorner& corner, std::size_t row)
{
  const auto [at, next] = corner.Functions[row];
  const double p = corner.Degree[1];
  if (at >= 0)
  {
    return { points.row(at), p / corner.Span[1] * (points.row(next) - points.row(at)) };
  }
  const double whole = corner.Span[1] + corner.SpanBeyond;
  const auto beyond = points.row(corner.Beyond[row]);
  return { (corner.SpanBeyond * points.row(next) + corner.Span[1] * beyond) / whole,
    p / whole * (points.row(next) - beyond) };
}

void WriteRow(PointMatrix& points, const TileCorner& corner, std::size_t row, const RowJet& jet)
{
  const auto [at, next] = corner.Functions[row];
  if (at >= 0)
  {
    points.row(at) = jet.Value;
  }
  points.row(next) = jet.Value + corner.Span[1] / corner.Degree[1] * jet.Slope;
}

void AverageValues(std::vector<Spline<2>>& tiles, const std::vector<TileCorner>& corners)
{
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(tiles.front().NumComponents());
  double count = 0.0;
  const bool hasMean = std::any_of(corners.begin(), corners.end(),
    [](const TileCorner& corner) { return corner.Functions[0][0] < 0; });
  for (const TileCorner& corner : corners)
  {
    // a smooth side's value follows from its averaged coefficients and is the others', too
    if (!hasMean || corner.Functions[0][0] < 0)
    {
      sum += ReadRow(tiles[At(corner.Tile)].ControlPoints, corner, 0).Value;
      count += 1.0;
    }
  }
  for (const TileCorner& corner : corners)
  {
    if (const int at = corner.Functions[0][0]; at >= 0)
    {
      tiles[At(corner.Tile)].ControlPoints.row(at) = sum / count;
    }
  }
}

void AverageJets(std::vector<Spline<2>>& tiles, const std::vector<TileCorner>& corners)
{
  // value, derivatives along both axes of the common frame, mixed derivative
  PointMatrix sum = PointMatrix::Zero(4, tiles.front().NumComponents());
  for (const TileCorner& corner : corners)
  {
    const PointMatrix& points = tiles[At(corner.Tile)].ControlPoints;
    const std::size_t d = corner.Across;
    const double across = corner.Degree[0] / corner.Span[0];
    const RowJet on = ReadRow(points, corner, 0);
    const RowJet next = ReadRow(points, corner, 1);
    sum.row(0) += on.Value;
    sum.row(1 + corner.Axis[d]) += across * (next.Value - on.Value) / corner.Factor[d];
    sum.row(1 + corner.Axis[1 - d]) += on.Slope / corner.Factor[1 - d];
    sum.row(3) += across * (next.Slope - on.Slope) / (corner.Factor[0] * corner.Factor[1]);
  }
  sum /= static_cast<double>(corners.size());
  for (const TileCorner& corner : corners)
  {
    PointMatrix& points = tiles[At(corner.Tile)].ControlPoints;
    const std::size_t d = corner.Across;
    const double across = corner.Span[0] / corner.Degree[0];
    const RowJet on{ sum.row(0), corner.Factor[1 - d] * sum.row(1 + corner.Axis[1 - d]) };
    WriteRow(points, corner, 0, on);
    WriteRow(points, corner, 1,
      { on.Value + across * corner.Factor[d] * sum.row(1 + corner.Axis[d]),
        on.Slope + across * corner.Factor[0] * corner.Factor[1] * sum.row(3) });
  }
}
}

std::vector<int> EdgeFunctions(const SideRows& rows, int degree, double low, double high)
{
  const int n = static_cast<int>(rows.Knots.size()) - degree - 1;
  const KnotPlace first = FindKnot(rows.Knots, low);
  const KnotPlace last = FindKnot(rows.Knots, high);
  std::vector<int> numbers;
  int begin = 0;
  int end = n;
  if (first.First > 0)
  {
    const bool isMean = first.Count < degree;
    begin = isMean ? first.First - 1 : first.First + first.Count - 1 - degree;
    if (isMean)
    {
      numbers.push_back(-1);
    }
  }
  const bool isWithin = At(last.First + last.Count) < rows.Knots.size();
  const bool isMeanLast = isWithin && last.Count < degree;
  if (isWithin)
  {
    end = isMeanLast ? last.First - 1 : last.First;
  }
  for (int j = begin; j < end; ++j)
  {
    numbers.push_back(j);
  }
  if (isMeanLast)
  {
    numbers.push_back(-1);
  }
  return numbers;
}

Result<std::vector<std::vector<TileCorner>>> FindTileCorners(const std::vector<Spline<2>>& tiles,
  const TileRows& rows, const std::vector<TileEdge>& edges, const StitchParams& params)
{
  CornerFinder finder(tiles, rows);
  for (const TileEdge& edge : edges)
  {
    finder.AddEdge(edge);
  }
  return finder.Finish(params.Continuity == 1);
}

void AverageCorners(
  std::vector<Spline<2>>& tiles, const std::vector<TileCorner>& corners, int continuity)
{
  continuity == 0 ? AverageValues(tiles, corners) : AverageJets(tiles, corners);
}
}
