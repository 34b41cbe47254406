// SPDX-License-Identifier: BSD-3-Clause
#include "FaceGrids.h"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}
}

FaceQuads MapRectangle(
  const FaceChart& chart, const ChartLoop& loop, const std::vector<int>& corners)
{
  const auto n = static_cast<int>(loop.size());
  const int columns = corners[1] - corners[0];
  const int rows = corners[2] - corners[1];
  const auto pointOf = [&](int i, int j)
  {
    const int at = j == 0 ? i
      : i == columns      ? columns + j
      : j == rows         ? columns + rows + (columns - i)
                          : 2 * columns + rows + (rows - j);
    return loop[At((corners[0] + at) % n)];
  };
  const auto placeOf = [&](int i, int j) { return pointOf(i, j).Place; };
  FaceQuads mesh;
  for (int j = 0; j <= rows; ++j)
  {
    for (int i = 0; i <= columns; ++i)
    {
      const bool side = i == 0 || j == 0 || i == columns || j == rows;
      Eigen::Vector2d place;
      if (side)
      {
        place = placeOf(i, j);
      }
      else
      {
        const double s = static_cast<double>(i) / columns;
        const double t = static_cast<double>(j) / rows;
        place = (1.0 - t) * placeOf(i, 0) + t * placeOf(i, rows) + (1.0 - s) * placeOf(0, j) +
          s * placeOf(columns, j) -
          ((1.0 - s) * (1.0 - t) * placeOf(0, 0) + s * (1.0 - t) * placeOf(columns, 0) +
            (1.0 - s) * t * placeOf(0, rows) + s * t * placeOf(columns, rows));
      }
      mesh.AddPoint(place, chart.Point(place), side ? pointOf(i, j).Node : -1);
    }
  }
  for (int j = 0; j < rows; ++j)
  {
    for (int i = 0; i < columns; ++i)
    {
      const int a = j * (columns + 1) + i;
      mesh.Quads.push_back({ a, a + 1, a + columns + 2, a + columns + 1 });
    }
  }
  return mesh;
}

namespace
{
Status DoNotFit()
{
  return { ErrorCode::InvalidTopology, "the numbers of segments along its sides allow no grids" };
}

Status TooMany(int most)
{
  return { ErrorCode::TooLarge, "more than " + std::to_string(most) + " quadrilaterals" };
}

/// Grids of several blocks between corners; blocks beside each other have the points between their
/// corners in common.
class Blocks
{
public:
  /// The points of a loop, in its order, are the first. Those of a pole are one.
  Blocks(const ChartLoop& loop, int maxQuads) : MaxQuads(maxQuads)
  {
    const std::size_t n = loop.size();
    for (std::size_t i = 0; i < n; ++i)
    {
      if (!loop[(i + n - 1) % n].BeginsPole)
      {
        const LoopPoint& behind = loop[(i + 1) % n];
        this->Uses.push_back(loop[i].BeginsPole ? behind.Use : loop[i].Use);
        this->IsCorner.push_back(loop[i].IsCorner);
        this->Mesh.AddPoint(loop[i].Place, Eigen::Vector3d::Zero(), loop[i].Node);
        this->Says.emplace_back(Eigen::Vector2d::Ones());
        if (loop[i].BeginsPole)
        {
          const Eigen::Vector2d way = (behind.Place - loop[i].Place).cwiseAbs();
          this->Says.back()[way[0] > way[1] ? 0 : 1] = 0.0;
        }
      }
    }
    this->NumLoop = static_cast<int>(this->Mesh.Places.size());
  }

  int LoopSize() const { return this->NumLoop; }
  const Eigen::Vector2d& LoopPlace(int i) const { return this->Mesh.Places[At(i)]; }
  /// Where uses begin.
  std::vector<int> Find(const std::vector<int>& uses) const
  {
    std::vector<int> found;
    for (const int use : uses)
    {
      for (int i = 0; i < this->NumLoop; ++i)
      {
        if (this->IsCorner[At(i)] && this->Uses[At(i)] == use)
        {
          found.push_back(i);
        }
      }
    }
    return found;
  }

  int AddInner()
  {
    this->Says.emplace_back(Eigen::Vector2d::Ones());
    return this->Mesh.AddPoint(Eigen::Vector2d::Zero(), Eigen::Vector3d::Zero(), -1);
  }

  /// Points along the loop between two of it are the side of a block.
  void UseLoop(int from, int count)
  {
    std::vector<int> side;
    for (int i = 0; i <= count; ++i)
    {
      side.push_back((from + i) % this->NumLoop);
    }
    this->Sides[{ side.front(), side.back() }] = side;
  }

  /// A grid between four corners, counterclockwise; none where there would be too many
  /// quadrilaterals.
  /// @param columns  segments of its first and third side.
  void AddBlock(const std::array<int, 4>& corners, int columns, int rows)
  {
    this->NumQuads += static_cast<double>(columns) * rows;
    if (!this->Fits())
    {
      return;
    }
    const std::vector<int> below = this->SideBetween(corners[0], corners[1], columns);
    const std::vector<int> right = this->SideBetween(corners[1], corners[2], rows);
    const std::vector<int> above = this->SideBetween(corners[3], corners[2], columns);
    const std::vector<int> left = this->SideBetween(corners[0], corners[3], rows);
    std::vector<int> before = below;
    for (int j = 1; j <= rows; ++j)
    {
      std::vector<int> line = above;
      for (int i = 0; j < rows && i <= columns; ++i)
      {
        line[At(i)] = i == 0 ? left[At(j)] : i == columns ? right[At(j)] : this->AddInner();
      }
      for (std::size_t i = 0; i + 1 < line.size(); ++i)
      {
        this->Mesh.Quads.push_back({ before[i], before[i + 1], line[i + 1], line[i] });
      }
      before = std::move(line);
    }
  }

  bool Fits() const { return this->NumQuads <= this->MaxQuads; }

  /// Every inner place is the mean of its neighbours.
  FaceQuads Take(const FaceChart& chart)
  {
    const auto numInner = static_cast<int>(this->Mesh.Places.size()) - this->NumLoop;
    for (int direction = 0; numInner > 0 && direction < 2; ++direction)
    {
      std::vector<Eigen::Triplet<double>> entries;
      Eigen::VectorXd right = Eigen::VectorXd::Zero(numInner);
      for (const auto& quad : this->Mesh.Quads)
      {
        for (std::size_t i = 0; i < 4; ++i)
        {
          // every side inside is there twice
          this->Join(quad[i], quad[(i + 1) % 4], direction, entries, right);
          this->Join(quad[(i + 1) % 4], quad[i], direction, entries, right);
        }
      }
      Eigen::SparseMatrix<double> matrix(numInner, numInner);
      matrix.setFromTriplets(entries.begin(), entries.end());
      const Eigen::VectorXd places =
        Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(matrix).solve(right);
      for (int i = 0; i < numInner; ++i)
      {
        this->Mesh.Places[At(this->NumLoop + i)][direction] = places[i];
      }
    }
    for (std::size_t p = 0; p < this->Mesh.Points.size(); ++p)
    {
      this->Mesh.Points[p] = chart.Point(this->Mesh.Places[p]);
    }
    return std::move(this->Mesh);
  }

private:
  std::vector<int> SideBetween(int from, int to, int count)
  {
    if (const auto known = this->Sides.find({ from, to }); known != this->Sides.end())
    {
      return known->second;
    }
    if (const auto known = this->Sides.find({ to, from }); known != this->Sides.end())
    {
      return { known->second.rbegin(), known->second.rend() };
    }
    std::vector<int> side{ from };
    for (int i = 1; i < count; ++i)
    {
      side.push_back(this->AddInner());
    }
    side.push_back(to);
    this->Sides[{ from, to }] = side;
    return side;
  }

  void Join(int point, int other, int direction, std::vector<Eigen::Triplet<double>>& entries,
    Eigen::VectorXd& right) const
  {
    const int row = point - this->NumLoop;
    const int column = other - this->NumLoop;
    const double weight = this->Says[At(other)][direction];
    if (row < 0 || weight == 0.0)
    {
      return;
    }
    entries.emplace_back(row, row, weight);
    if (column < 0)
    {
      right[row] += weight * this->Mesh.Places[At(other)][direction];
    }
    else
    {
      entries.emplace_back(row, column, -weight);
    }
  }

  int MaxQuads;
  double NumQuads = 0.0;
  FaceQuads Mesh;
  int NumLoop = 0;
  std::vector<int> Uses; ///< of points of the loop
  std::vector<bool> IsCorner;
  std::vector<Eigen::Vector2d> Says; ///< 0: a parameter that says nothing, at a pole
  std::map<std::pair<int, int>, std::vector<int>> Sides;
};

/// Numbers of segments along the sides of a polygon, from its corners on.
std::vector<int> CountsOf(const std::vector<int>& corners, int numLoop)
{
  std::vector<int> counts;
  for (std::size_t i = 0; i < corners.size(); ++i)
  {
    const int next = corners[(i + 1) % corners.size()];
    counts.push_back(next > corners[i] ? next - corners[i] : next + numLoop - corners[i]);
  }
  return counts;
}

bool MapPolygon(const std::vector<int>& corners, Blocks& blocks)
{
  const auto n = static_cast<int>(corners.size());
  const std::vector<int> counts = CountsOf(corners, blocks.LoopSize());
  // a line leads from the middle to every side, with as many segments as the grids beside the
  // sides before and behind have along these: counts[k + 1] = lines[k] + lines[k + 2]
  std::vector<int> lines;
  for (int k = 0; k < n; ++k)
  {
    const int steps = n % 2 == 0 ? n / 2 : n;
    int sum = 0;
    for (int j = 0; j < steps; ++j)
    {
      sum += (j % 2 == 0 ? 1 : -1) * counts[At((k + 1 + 2 * j) % n)];
    }
    if (sum < 2 || sum % 2 != 0)
    {
      return false;
    }
    lines.push_back(sum / 2);
  }
  const int middle = blocks.AddInner();
  std::vector<int> feet;
  for (int k = 0; k < n; ++k)
  {
    const int before = lines[At((k + n - 1) % n)];
    const int behind = lines[At((k + 1) % n)];
    feet.push_back((corners[At(k)] + before) % blocks.LoopSize());
    blocks.UseLoop(corners[At(k)], before);
    blocks.UseLoop(feet.back(), behind);
  }
  for (int k = 0; k < n; ++k)
  {
    blocks.AddBlock({ corners[At(k)], feet[At(k)], middle, feet[At((k + n - 1) % n)] },
      lines[At((k + n - 1) % n)], lines[At(k)]);
  }
  return true;
}

bool MapSegment(std::vector<int> corners, Blocks& blocks)
{
  const int n = blocks.LoopSize();
  std::vector<int> counts = CountsOf(corners, n);
  if (counts[1] < counts[0])
  {
    std::swap(corners[0], corners[1]);
    std::swap(counts[0], counts[1]);
  }
  // the grid in the middle has half of the shorter side
  const int columns = 2 * ((counts[0] + 2) / 4);
  const int around = (counts[0] - columns) / 2;
  const int rows = (counts[1] - columns) / 2;
  if (around < 1 || rows < 1)
  {
    return false;
  }
  const auto point = [&](int i) { return (corners[0] + i) % n; };
  const std::array<int, 6> at{ 0, around, around + columns, counts[0], counts[0] + rows,
    counts[0] + rows + columns };
  for (std::size_t i = 0; i < at.size(); ++i)
  {
    blocks.UseLoop(point(at[i]), (i + 1 < at.size() ? at[i + 1] : n) - at[i]);
  }
  const int right = blocks.AddInner();
  const int left = blocks.AddInner();
  blocks.AddBlock({ point(at[1]), point(at[2]), right, left }, columns, rows);
  blocks.AddBlock({ point(at[2]), point(at[3]), point(at[4]), right }, around, rows);
  blocks.AddBlock({ left, right, point(at[4]), point(at[5]) }, columns, around);
  blocks.AddBlock({ point(at[0]), point(at[1]), left, point(at[5]) }, around, rows);
  return true;
}

/// Smallest sine of the four angles, signed.
double LeastSine(const std::array<Eigen::Vector2d, 4>& corners)
{
  double least = 1.0;
  for (std::size_t i = 0; i < 4; ++i)
  {
    const Eigen::Vector2d next = corners[(i + 1) % 4] - corners[i];
    const Eigen::Vector2d before = corners[(i + 3) % 4] - corners[i];
    const double lengths = next.norm() * before.norm();
    const double cross = next[0] * before[1] - next[1] * before[0];
    least = std::min(least, lengths > 0.0 ? cross / lengths : -1.0);
  }
  return least;
}

bool MapDisc(Blocks& blocks)
{
  constexpr double Across = 0.07;  ///< quadrilaterals from the middle grid outward, of the loop's
  constexpr int Tried = 256;       ///< points where the middle grid may have its first corner
  constexpr double Unequal = 0.25; ///< what sides of unequal numbers must gain in sine
  const int n = blocks.LoopSize();
  if (n < 8 || n % 2 != 0)
  {
    return false;
  }
  const int step = std::max(1, n / Tried);
  int begin = 0;
  int columns = n / 4;
  double best = -std::numeric_limits<double>::max();
  for (int a = std::max(1, n / 8); a <= n / 4; a += step)
  {
    for (int i = 0; i < n; i += step)
    {
      const auto place = [&](int ahead) { return blocks.LoopPlace((i + ahead) % n); };
      const double score = LeastSine({ place(0), place(a), place(n / 2), place(n / 2 + a) }) -
        Unequal * (1.0 - a / (0.25 * n));
      if (score > best + 1e-9)
      {
        best = score;
        begin = i;
        columns = a;
      }
    }
  }
  const int rows = n / 2 - columns;
  const int around = std::max(1, static_cast<int>(std::lround(Across * n)));
  const std::array<int, 4> counts{ columns, rows, columns, rows };
  std::array<int, 4> outer{};
  std::array<int, 4> inner{};
  int at = begin;
  for (std::size_t i = 0; i < 4; ++i)
  {
    outer[i] = at % n;
    inner[i] = blocks.AddInner();
    blocks.UseLoop(outer[i], counts[i]);
    at += counts[i];
  }
  blocks.AddBlock(inner, columns, rows);
  for (std::size_t i = 0; i < 4; ++i)
  {
    blocks.AddBlock(
      { outer[i], outer[(i + 1) % 4], inner[(i + 1) % 4], inner[i] }, counts[i], around);
  }
  return true;
}

/// Straight lines in the chart from one loop to the other.
FaceQuads BetweenLoops(
  const FaceChart& chart, const ChartLoop& outer, const ChartLoop& inner, int rows)
{
  const auto n = static_cast<int>(outer.size());
  FaceQuads mesh;
  for (int j = 0; j <= rows; ++j)
  {
    const double share = static_cast<double>(j) / rows;
    for (int i = 0; i < n; ++i)
    {
      const Eigen::Vector2d place = (1.0 - share) * outer[At(i)].Place + share * inner[At(i)].Place;
      mesh.AddPoint(place, chart.Point(place),
        j == 0        ? outer[At(i)].Node
          : j == rows ? inner[At(i)].Node
                      : -1);
    }
  }
  for (int j = 0; j < rows; ++j)
  {
    for (int i = 0; i < n; ++i)
    {
      const int next = (i + 1) % n;
      mesh.Quads.push_back({ j * n + i, j * n + next, (j + 1) * n + next, (j + 1) * n + i });
    }
  }
  return mesh;
}

Result<FaceQuads> MapRing(
  const FaceChart& chart, const std::vector<ChartLoop>& loops, const GridSizes& sizes)
{
  constexpr int Compared = 64; ///< lines, to find where the inner loop begins
  const ChartLoop& outer = loops[0];
  const auto n = static_cast<int>(outer.size());
  if (loops[1].size() != outer.size())
  {
    return DoNotFit();
  }
  ChartLoop inner(loops[1].rbegin(), loops[1].rend());
  int shift = 0;
  double least = std::numeric_limits<double>::max();
  for (int s = 0; s < n; ++s)
  {
    double sum = 0.0;
    for (int i = 0; i < n; i += std::max(1, n / Compared))
    {
      sum += (outer[At(i)].Place - inner[At((i + s) % n)].Place).squaredNorm();
    }
    if (sum < least)
    {
      least = sum;
      shift = s;
    }
  }
  std::rotate(inner.begin(), inner.begin() + shift, inner.end());
  double across = 0.0;
  for (int i = 0; i < n; ++i)
  {
    across += chart.Length(outer[At(i)].Place, inner[At(i)].Place) / n;
  }
  const double rows = std::max<double>(sizes.LeastAcross, std::ceil(across / sizes.Length - 0.5));
  if (rows * n > sizes.MaxQuads)
  {
    return TooMany(sizes.MaxQuads);
  }
  return BetweenLoops(chart, outer, inner, static_cast<int>(rows));
}
}

Result<FaceQuads> MapShape(const FaceChart& chart, const std::vector<ChartLoop>& loops,
  const LogicalShape& shape, const GridSizes& sizes)
{
  if (shape.Kind == LogicalShapeKind::Ring)
  {
    return MapRing(chart, loops, sizes);
  }
  Blocks blocks(loops.front(), sizes.MaxQuads);
  const std::vector<int> corners = blocks.Find(shape.Corners);
  bool mapped = false;
  switch (shape.Kind)
  {
    case LogicalShapeKind::Rectangle:
    {
      const std::vector<int> counts = CountsOf(corners, blocks.LoopSize());
      if (counts[0] != counts[2] || counts[1] != counts[3])
      {
        return DoNotFit();
      }
      if (static_cast<double>(counts[0]) * counts[1] > sizes.MaxQuads)
      {
        return TooMany(sizes.MaxQuads);
      }
      return MapRectangle(chart, loops.front(), corners);
    }
    case LogicalShapeKind::Polygon:
      mapped = MapPolygon(corners, blocks);
      break;
    case LogicalShapeKind::Segment:
      mapped = MapSegment(corners, blocks);
      break;
    case LogicalShapeKind::Disc:
      mapped = MapDisc(blocks);
      break;
    case LogicalShapeKind::Ring:
    case LogicalShapeKind::Other:
      break;
  }
  if (!mapped)
  {
    return DoNotFit();
  }
  return blocks.Fits() ? Result<FaceQuads>(blocks.Take(chart))
                       : Result<FaceQuads>(TooMany(sizes.MaxQuads));
}
}
