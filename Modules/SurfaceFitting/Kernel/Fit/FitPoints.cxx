// SPDX-License-Identifier: BSD-3-Clause
#include "FitPoints.h"

#include <knotwork/SplineCore/Parallel.h>

#include <algorithm>
#include <limits>
#include <numeric>

namespace knotwork
{
namespace
{
constexpr std::size_t PointChunk = 16384;
constexpr std::size_t ElementChunk = 32;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// A box of a partition with its sides at the ends of the domain moved out of reach.
ParametricBox<2> OpenBox(const ParametricBox<2>& box, const ParametricBox<2>& domain)
{
  ParametricBox<2> open = box;
  for (std::size_t d = 0; d < 2; ++d)
  {
    if (box.Lower[d] <= domain.Lower[d])
    {
      open.Lower[d] = -std::numeric_limits<double>::infinity();
    }
    if (box.Upper[d] >= domain.Upper[d])
    {
      open.Upper[d] = std::numeric_limits<double>::infinity();
    }
  }
  return open;
}

/// Rearranges parts of all columns, with memory that is kept between calls.
class Permuter
{
public:
  /// Entry begin + i becomes what begin + from[i] was.
  void Apply(FitPoints& points, std::size_t begin, const std::vector<int>& from)
  {
    this->Move(points.U, begin, from);
    this->Move(points.V, begin, from);
    for (FitPoints::Column& column : points.Values)
    {
      this->Move(column, begin, from);
    }
    this->Move(points.Tolerance, begin, from);
    this->Move(points.Base, begin, from);
    this->Move(points.Boost, begin, from);
    this->Kept.resize(from.size());
    for (std::size_t i = 0; i < from.size(); ++i)
    {
      this->Kept[i] = points.Order[begin + At(from[i])];
    }
    std::copy(this->Kept.begin(), this->Kept.end(),
      points.Order.begin() + static_cast<std::ptrdiff_t>(begin));
  }

private:
  void Move(FitPoints::Column& column, std::size_t begin, const std::vector<int>& from)
  {
    this->Numbers.resize(from.size());
    for (std::size_t i = 0; i < from.size(); ++i)
    {
      this->Numbers[i] = column[begin + At(from[i])];
    }
    std::copy(this->Numbers.begin(), this->Numbers.end(),
      column.begin() + static_cast<std::ptrdiff_t>(begin));
  }

  std::vector<double> Numbers;
  std::vector<int> Kept;
};
}

std::vector<int> LocatePoints(
  const SplineSpace<2>& space, const PointMatrix& parameters, int threads)
{
  std::vector<int> elements(static_cast<std::size_t>(parameters.rows()));
  ParallelFor(elements.size(), PointChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      std::vector<double> local(2 * (end - begin));
      space.Locate(
        parameters.data() + 2 * begin, 2, end - begin, elements.data() + begin, local.data());
    });
  return elements;
}

FitPoints GroupPoints(const SplineSpace<2>& space, const PointCloud& cloud,
  const std::vector<double>& tolerances, double significantWeight, int threads)
{
  const auto n = static_cast<std::size_t>(cloud.Parameters.rows());
  const std::vector<int> elements = LocatePoints(space, cloud.Parameters, threads);
  // a stable counting sort in chunks: where a chunk's points of an element begin
  const std::size_t numElements = At(space.NumElements());
  const std::size_t chunk = std::max(PointChunk, numElements);
  const std::size_t chunks = (n + chunk - 1) / chunk;
  std::vector<std::size_t> next(chunks * numElements, 0);
  ParallelFor(n, chunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      std::size_t* counts = next.data() + begin / chunk * numElements;
      for (std::size_t i = begin; i < end; ++i)
      {
        ++counts[elements[i]];
      }
    });
  FitPoints points;
  points.Ranges.resize(numElements);
  std::size_t sum = 0;
  for (std::size_t e = 0; e < numElements; ++e)
  {
    points.Ranges[e].Begin = sum;
    for (std::size_t k = 0; k < chunks; ++k)
    {
      sum += std::exchange(next[k * numElements + e], sum);
    }
    points.Ranges[e].End = sum;
  }
  points.Order.resize(n);
  points.U.resize(n);
  points.V.resize(n);
  points.Tolerance.resize(n);
  points.Base.resize(n);
  points.Boost.resize(n);
  points.Distance.resize(n);
  const auto columns = static_cast<std::size_t>(cloud.Values.cols());
  points.Values.resize(columns);
  for (FitPoints::Column& column : points.Values)
  {
    column.resize(n);
  }
  ParallelFor(n, chunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      std::size_t* place = next.data() + begin / chunk * numElements;
      for (std::size_t row = begin; row < end; ++row)
      {
        const std::size_t i = place[elements[row]]++;
        points.Order[i] = static_cast<int>(row);
        points.U[i] = cloud.Parameters.data()[2 * row];
        points.V[i] = cloud.Parameters.data()[2 * row + 1];
        points.Tolerance[i] = tolerances[row];
        for (std::size_t c = 0; c < columns; ++c)
        {
          points.Values[c][i] = cloud.Values.data()[row * columns + c];
        }
        const bool significant = !cloud.Significant.empty() && cloud.Significant[row] != 0;
        points.Base[i] = significant ? significantWeight : 1.0;
        points.Boost[i] = 1.0;
        points.Distance[i] = 0.0;
      }
    });
  return points;
}

void RegroupPoints(const SplineSpace<2>& coarse, const SplineSpace<2>& fine,
  const std::vector<int>& parents, FitPoints& points, int threads)
{
  // parts of every coarse element, ascending
  std::vector<std::size_t> start(At(coarse.NumElements()) + 1, 0);
  for (const int parent : parents)
  {
    ++start[At(parent) + 1];
  }
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<int> parts(parents.size());
  {
    std::vector<std::size_t> next(start.begin(), start.end() - 1);
    for (std::size_t e = 0; e < parents.size(); ++e)
    {
      parts[next[At(parents[e])]++] = static_cast<int>(e);
    }
  }
  const ParametricBox<2> domain = coarse.Domain();
  std::vector<FitPoints::Range> ranges(parents.size());
  ParallelFor(points.Ranges.size(), ElementChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      Permuter permuter;
      std::vector<int> part;
      std::vector<int> from;
      std::vector<ParametricBox<2>> boxes;
      for (std::size_t parent = begin; parent < end; ++parent)
      {
        const FitPoints::Range range = points.Ranges[parent];
        const std::size_t first = start[parent];
        const std::size_t count = start[parent + 1] - first;
        if (count == 1)
        {
          ranges[At(parts[first])] = range;
          continue;
        }
        boxes.clear();
        for (std::size_t k = 0; k < count; ++k)
        {
          boxes.push_back(OpenBox(fine.Elements[At(parts[first + k])].Box, domain));
        }
        std::vector<std::size_t> next(count + 1, 0);
        part.resize(range.Count());
        for (std::size_t i = range.Begin; i < range.End; ++i)
        {
          std::size_t k = 0;
          while (k + 1 < count &&
            !(points.U[i] >= boxes[k].Lower[0] && points.U[i] < boxes[k].Upper[0] &&
              points.V[i] >= boxes[k].Lower[1] && points.V[i] < boxes[k].Upper[1]))
          {
            ++k;
          }
          part[i - range.Begin] = static_cast<int>(k);
          ++next[k + 1];
        }
        std::partial_sum(next.begin(), next.end(), next.begin());
        for (std::size_t k = 0; k < count; ++k)
        {
          ranges[At(parts[first + k])] = { range.Begin + next[k], range.Begin + next[k + 1] };
        }
        from.resize(range.Count());
        for (std::size_t i = 0; i < part.size(); ++i)
        {
          from[next[At(part[i])]++] = static_cast<int>(i);
        }
        permuter.Apply(points, range.Begin, from);
      }
    });
  points.Ranges = std::move(ranges);
}
}
