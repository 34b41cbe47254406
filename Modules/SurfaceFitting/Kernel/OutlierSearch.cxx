// SPDX-License-Identifier: BSD-3-Clause
#include "OutlierSearch.h"

#include "Parallel.h"

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
constexpr double NormalDeviation = 1.4826; // of a normal distribution, over its median deviation
constexpr std::size_t NumNearest = 8;      // whose distances speak for a feature
constexpr int FeatureSupport = 2;          // of them, alike
constexpr double FeatureLikeness = 0.3;    // part of a point's own distance from the median
constexpr std::size_t ElementChunk = 64;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

double Median(std::vector<double>& values)
{
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}
}

OutlierSearch::OutlierSearch(const PointCloud& cloud, const ParametricBox<2>& domain)
  : Cloud(cloud), Domain(domain)
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

bool OutlierSearch::IsOutlier(
  int row, const std::vector<double>& distances, double tolerance, double scale, Work& work) const
{
  const int x = this->CellOf(0, this->Cloud.Parameters(row, 0));
  const int y = this->CellOf(1, this->Cloud.Parameters(row, 1));
  const RealArray<2> step{ (this->Domain.Upper[0] - this->Domain.Lower[0]) / this->Size[0],
    (this->Domain.Upper[1] - this->Domain.Lower[1]) / this->Size[1] };
  for (int rings = 1; rings <= MostRings; ++rings)
  {
    work.Near.clear();
    for (int j = std::max(0, y - rings); j <= std::min(this->Size[1] - 1, y + rings); ++j)
    {
      const int first = this->Start[At(j * this->Size[0] + std::max(0, x - rings))];
      const int last =
        this->Start[At(j * this->Size[0] + std::min(this->Size[0] - 1, x + rings)) + 1];
      for (int k = first; k < last; ++k)
      {
        const int other = this->Rows[At(k)];
        if (other != row)
        {
          const double du =
            (this->Cloud.Parameters(other, 0) - this->Cloud.Parameters(row, 0)) / step[0];
          const double dv =
            (this->Cloud.Parameters(other, 1) - this->Cloud.Parameters(row, 1)) / step[1];
          work.Near.push_back({ du * du + dv * dv, other });
        }
      }
    }
    if (work.Near.size() >= LeastNeighbours)
    {
      break;
    }
  }
  if (work.Near.size() < LeastNeighbours)
  {
    return false;
  }
  work.Values.clear();
  for (const auto& near : work.Near)
  {
    work.Values.push_back(distances[At(near.second)]);
  }
  const double median = Median(work.Values);
  const double off = distances[At(row)] - median;
  for (double& value : work.Values)
  {
    value = std::fabs(value - median);
  }
  if (std::fabs(off) <= tolerance ||
    std::fabs(off) <= scale * NormalDeviation * Median(work.Values))
  {
    return false;
  }
  std::nth_element(work.Near.begin(), work.Near.begin() + static_cast<std::ptrdiff_t>(NumNearest),
    work.Near.end());
  const auto alike =
    std::count_if(work.Near.begin(), work.Near.begin() + static_cast<std::ptrdiff_t>(NumNearest),
      [&](const auto& near)
      { return (distances[At(near.second)] - median) / off >= FeatureLikeness; });
  return alike < FeatureSupport;
}

std::vector<int> OutlierSearch::Update(FitPoints& points, const std::vector<double>& weights,
  double scale, std::vector<std::uint8_t>& outliers, int threads) const
{
  std::vector<double> distances(points.Size());
  for (std::size_t i = 0; i < points.Size(); ++i)
  {
    distances[At(points.Order[i])] = points.Distance[i];
  }
  std::vector<std::uint8_t> changed(points.Ranges.size(), 0);
  ParallelFor(points.Ranges.size(), ElementChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      Work work;
      for (std::size_t e = begin; e < end; ++e)
      {
        for (std::size_t i = points.Ranges[e].Begin; i < points.Ranges[e].End; ++i)
        {
          const int row = points.Order[i];
          const std::uint8_t is = std::fabs(points.Distance[i]) > points.Tolerance[i] &&
              this->IsOutlier(row, distances, points.Tolerance[i], scale, work)
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
