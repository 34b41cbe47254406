// SPDX-License-Identifier: BSD-3-Clause
#include "OutlierSearch.h"

#include <knotwork/SplineCore/Median.h>
#include <knotwork/SplineCore/Parallel.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace knotwork
{
namespace
{
constexpr double PointsPerCell = 4.0;
constexpr std::size_t LeastNeighbours = 12;
constexpr int MostRings = 4;
constexpr double NormalDeviation = 1.4826;  // of a normal distribution, over its median deviation
constexpr std::size_t NumNearest = 8;       // whose distances speak for a feature
constexpr int LeastSupport = 2;             // of them, alike
constexpr double ChanceOfSupport = 0.002;   // at most, of an outlier
constexpr double FeatureLikeness = 0.3;     // part of a point's own distance from the median
constexpr std::ptrdiff_t CommonSupport = 6; // of them, with the value of the point
constexpr int StepDirections = 8;
constexpr std::size_t StepPoints = 24; // the nearest ones
constexpr std::size_t LeastOfSide = 4; // points
constexpr double StepClearness = 3.0;  // over the median deviations of both sides; of a slope: 2
constexpr double StepSlack = 1.5;      // of these deviations, beyond the heights of the sides
constexpr std::size_t ElementChunk = 64;
constexpr std::size_t PointChunk = 1024;
constexpr double Pi = 3.14159265358979323846;
constexpr std::int8_t Inside = -1; // no outlier, whatever its neighbours

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

double Mean(const std::vector<double>& values)
{
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double StandardDeviation(const std::vector<double>& values, double mean)
{
  double squares = 0.0;
  for (const double value : values)
  {
    squares += (value - mean) * (value - mean);
  }
  return std::sqrt(squares / static_cast<double>(values.size()));
}

/// How many of the nearest must be off alike: so many that outliers strewn at random hardly ever
/// are.
/// @param share  of the points that are outliers.
int SupportOfFeature(double share)
{
  double term = std::pow(1.0 - share, NumNearest); // of the binomial distribution
  double above = 1.0 - term;
  int k = 1;
  for (; k < static_cast<int>(NumNearest); ++k)
  {
    // above: the chance of k or more
    if (k >= LeastSupport && above <= ChanceOfSupport)
    {
      break;
    }
    term *= share / (1.0 - share) * (static_cast<double>(NumNearest) - k + 1) / k;
    above -= term;
  }
  return k;
}
}

OutlierSearch::OutlierSearch(
  const PointCloud& cloud, const ParametricBox<2>& domain, int numMeasured, FitDeviation deviation)
  : Cloud(cloud), NumMeasured(numMeasured), Deviation(deviation), Domain(domain)
{
  const auto n = cloud.Parameters.rows();
  const double width = domain.Upper[0] - domain.Lower[0];
  const double height = domain.Upper[1] - domain.Lower[1];
  const double cells = static_cast<double>(n) / PointsPerCell;
  const double aspect = std::clamp(width / height, 1e-3, 1e3);
  this->Size = { std::clamp(static_cast<int>(std::sqrt(cells * aspect)), 1, 8192),
    std::clamp(static_cast<int>(std::sqrt(cells / aspect)), 1, 8192) };
  this->Start.assign(At(this->Size[0]) * At(this->Size[1]) + 1, 0);
  std::vector<int> cellOf(static_cast<std::size_t>(n));
  for (Eigen::Index i = 0; i < n; ++i)
  {
    const int cell = this->CellOf(1, cloud.Parameters(i, 1)) * this->Size[0] +
      this->CellOf(0, cloud.Parameters(i, 0));
    cellOf[static_cast<std::size_t>(i)] = cell;
    ++this->Start[At(cell) + 1];
  }
  std::partial_sum(this->Start.begin(), this->Start.end(), this->Start.begin());
  this->Rows.resize(cellOf.size());
  std::vector<int> next(this->Start.begin(), this->Start.end() - 1);
  for (std::size_t i = 0; i < cellOf.size(); ++i)
  {
    this->Rows[At(next[At(cellOf[i])]++)] = static_cast<int>(i);
  }
}

int OutlierSearch::CellOf(std::size_t direction, double x) const
{
  const double share = (x - this->Domain.Lower[direction]) /
    (this->Domain.Upper[direction] - this->Domain.Lower[direction]);
  return std::clamp(static_cast<int>(share * this->Size[direction]), 0, this->Size[direction] - 1);
}

OutlierSearch::CellRows OutlierSearch::RowsAround(int row) const
{
  const int x = this->CellOf(0, this->Cloud.Parameters(row, 0));
  const int y = this->CellOf(1, this->Cloud.Parameters(row, 1));
  CellRows around;
  for (int rings = 1; rings <= MostRings && around.NumRows <= LeastNeighbours; ++rings)
  {
    around = {};
    for (int j = std::max(0, y - rings); j <= std::min(this->Size[1] - 1, y + rings); ++j)
    {
      const int first = this->Start[At(j * this->Size[0] + std::max(0, x - rings))];
      const int last =
        this->Start[At(j * this->Size[0] + std::min(this->Size[0] - 1, x + rings)) + 1];
      around.Ranges[At(around.Count++)] = { first, last };
      around.NumRows += At(last - first);
    }
  }
  return around;
}

bool OutlierSearch::IsNearMedian(
  const CellRows& around, const std::vector<double>& byCell, double own, double tolerance)
{
  // differences fall with the others' distances: the median is amid those that are far below or
  // above exactly when there are so many of them; the point itself is none of these
  std::size_t below = 0;
  std::size_t above = 0;
  for (int r = 0; r < around.Count; ++r)
  {
    const auto [first, last] = around.Ranges[At(r)];
    for (int k = first; k < last; ++k)
    {
      const double off = own - byCell[At(k)];
      below += off > tolerance ? 1 : 0;
      above += off < -tolerance ? 1 : 0;
    }
  }
  const std::size_t others = around.NumRows - 1;
  return below <= others / 2 && others / 2 < others - above;
}

bool OutlierSearch::FindNeighbours(int row, Workspace& work) const
{
  const RealArray<2> step{ (this->Domain.Upper[0] - this->Domain.Lower[0]) / this->Size[0],
    (this->Domain.Upper[1] - this->Domain.Lower[1]) / this->Size[1] };
  const CellRows around = this->RowsAround(row);
  work.Near.clear();
  for (int r = 0; r < around.Count; ++r)
  {
    for (int k = around.Ranges[At(r)][0]; k < around.Ranges[At(r)][1]; ++k)
    {
      const int other = this->Rows[At(k)];
      if (other != row)
      {
        const double du =
          (this->Cloud.Parameters(other, 0) - this->Cloud.Parameters(row, 0)) / step[0];
        const double dv =
          (this->Cloud.Parameters(other, 1) - this->Cloud.Parameters(row, 1)) / step[1];
        work.Near.push_back({ du * du + dv * dv, other, { du, dv } });
      }
    }
  }
  return work.Near.size() >= LeastNeighbours;
}

int OutlierSearch::CountAlike(
  int row, const Distances& distances, double tolerance, double scale, Workspace& work) const
{
  const double own = distances.ByRow[At(row)];
  const CellRows around = this->RowsAround(row);
  if (around.NumRows <= LeastNeighbours ||
    (this->Deviation == FitDeviation::Robust &&
      IsNearMedian(around, distances.ByCell, own, tolerance)))
  {
    return Inside;
  }
  this->FindNeighbours(row, work);
  work.Values.clear();
  for (const Neighbour& near : work.Near)
  {
    work.Values.push_back(distances.ByRow[At(near.Row)]);
  }
  const bool isRobust = this->Deviation == FitDeviation::Robust;
  const double middle = isRobust ? Median(work.Values) : Mean(work.Values);
  const double off = own - middle;
  if (std::fabs(off) <= tolerance ||
    std::fabs(off) <= scale *
        (isRobust ? NormalDeviation * MedianDeviation(work.Values, middle)
                  : StandardDeviation(work.Values, middle)))
  {
    return Inside;
  }
  std::nth_element(work.Near.begin(), work.Near.begin() + static_cast<std::ptrdiff_t>(NumNearest),
    work.Near.end());
  return static_cast<int>(
    std::count_if(work.Near.begin(), work.Near.begin() + static_cast<std::ptrdiff_t>(NumNearest),
      [&](const Neighbour& near)
      { return (distances.ByRow[At(near.Row)] - middle) / off >= FeatureLikeness; }));
}

bool OutlierSearch::IsCommon(int row, double tolerance, Workspace& work) const
{
  const auto eighth = work.Near.begin() + static_cast<std::ptrdiff_t>(NumNearest);
  std::nth_element(work.Near.begin(), eighth, work.Near.end());
  const auto own = this->Cloud.Values.row(row).head(this->NumMeasured);
  const auto common = std::count_if(work.Near.begin(), eighth,
    [&](const Neighbour& near)
    {
      const auto other = this->Cloud.Values.row(near.Row).head(this->NumMeasured);
      return (other - own).norm() <= tolerance;
    });
  return common >= CommonSupport;
}

bool OutlierSearch::IsOnStep(int row, double tolerance, Workspace& work) const
{
  if (work.Near.size() > StepPoints)
  {
    std::nth_element(work.Near.begin(), work.Near.begin() + static_cast<std::ptrdiff_t>(StepPoints),
      work.Near.end());
    work.Near.resize(StepPoints);
  }
  // values in space count by what they have in the direction in which the point is off
  const auto n = static_cast<Eigen::Index>(this->NumMeasured);
  Eigen::RowVectorXd off = this->Cloud.Values.row(row).head(n);
  for (Eigen::Index c = 0; c < n; ++c)
  {
    work.Values.clear();
    for (const Neighbour& near : work.Near)
    {
      work.Values.push_back(this->Cloud.Values(near.Row, c));
    }
    off[c] -= Median(work.Values);
  }
  off.normalize();
  const auto height = [&](int other) { return this->Cloud.Values.row(other).head(n).dot(off); };
  const double value = height(row);
  for (int k = 0; k < StepDirections; ++k)
  {
    const double angle = Pi * k / StepDirections;
    const double normal[2] = { std::cos(angle), std::sin(angle) };
    work.Sides[0].clear();
    work.Sides[1].clear();
    for (const Neighbour& near : work.Near)
    {
      const bool isAhead = normal[0] * near.Offset[0] + normal[1] * near.Offset[1] > 0.0;
      work.Sides[isAhead ? 1 : 0].push_back(height(near.Row));
    }
    if (std::min(work.Sides[0].size(), work.Sides[1].size()) < LeastOfSide)
    {
      continue;
    }
    const double heights[2] = { Median(work.Sides[0]), Median(work.Sides[1]) };
    const double step = std::fabs(heights[1] - heights[0]);
    const double roughness =
      MedianDeviation(work.Sides[0], heights[0]) + MedianDeviation(work.Sides[1], heights[1]);
    const double slack = tolerance + StepSlack * roughness;
    if (step > 2.0 * tolerance && step > StepClearness * roughness &&
      value >= std::min(heights[0], heights[1]) - slack &&
      value <= std::max(heights[0], heights[1]) + slack)
    {
      return true;
    }
  }
  return false;
}

std::vector<int> OutlierSearch::Update(FitPoints& points, const std::vector<double>& weights,
  double scale, std::vector<std::uint8_t>& outliers, int threads) const
{
  Distances distances{ std::vector<double>(points.Size()), std::vector<double>(points.Size()) };
  ParallelFor(points.Size(), PointChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        distances.ByRow[At(points.Order[i])] = points.Distance[i];
      }
    });
  ParallelFor(points.Size(), PointChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t k = begin; k < end; ++k)
      {
        distances.ByCell[k] = distances.ByRow[At(this->Rows[k])];
      }
    });
  // per point in the order of points: how many of its nearest are off alike
  std::vector<std::int8_t> alike(points.Size(), Inside);
  ParallelFor(points.Size(), PointChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      Workspace work;
      for (std::size_t i = begin; i < end; ++i)
      {
        if (std::fabs(points.Distance[i]) > points.Limit(i))
        {
          alike[i] = static_cast<std::int8_t>(
            this->CountAlike(points.Order[i], distances, points.Limit(i), scale, work));
        }
      }
    });
  const auto isLone = [](std::int8_t count) { return count >= 0 && count < LeastSupport; };
  const auto lone = static_cast<double>(std::count_if(alike.begin(), alike.end(), isLone));
  const int support = SupportOfFeature(lone / static_cast<double>(points.Size()));
  std::vector<std::uint8_t> changed(points.Ranges.size(), 0);
  ParallelFor(points.Ranges.size(), ElementChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      Workspace work;
      for (std::size_t e = begin; e < end; ++e)
      {
        for (std::size_t i = points.Ranges[e].Begin; i < points.Ranges[e].End; ++i)
        {
          const int row = points.Order[i];
          const std::uint8_t is = alike[i] != Inside && alike[i] < support &&
              this->FindNeighbours(row, work) && !this->IsCommon(row, points.Limit(i), work) &&
              !this->IsOnStep(row, points.Limit(i), work)
            ? 1
            : 0;
          if (is != outliers[At(row)])
          {
            outliers[At(row)] = is;
            points.Base[i] = is != 0 ? 0.0 : weights[At(row)];
            points.Boost[i] = 1.0;
            changed[e] = 1;
          }
        }
      }
    });
  std::vector<int> elements;
  for (std::size_t e = 0; e < changed.size(); ++e)
  {
    if (changed[e] != 0)
    {
      elements.push_back(static_cast<int>(e));
    }
  }
  return elements;
}
}
