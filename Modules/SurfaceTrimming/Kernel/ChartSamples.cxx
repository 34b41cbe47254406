// SPDX-License-Identifier: BSD-3-Clause
#include "ChartSamples.h"
#include <knotwork/SplineCore/Parallel.h>
#include <knotwork/SplineCore/TriangleIndex.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr std::size_t TriangleChunk = 256;
/// Of an edge of a piece against the spans, when there are as many functions as spans.
constexpr double PieceSize = 0.5;
/// A boundary counts as a strip of so many spans' width.
constexpr double BoundaryWidth = 2.0;
constexpr int MaxDepth = 48;

/// A point of a triangle: parameters, place in the net (number of the span plus the part of it, a
/// direction), point in space.
struct Place
{
  Eigen::Vector2d Parameter;
  Eigen::Vector2d Net;
  Eigen::Vector3d Point;
};

struct Rows
{
  std::vector<double> Parameters;
  std::vector<double> Points;
  std::vector<double> Weights;

  void Add(const Eigen::Vector2d& parameter, const Eigen::Vector3d& point)
  {
    this->Parameters.insert(this->Parameters.end(), parameter.data(), parameter.data() + 2);
    this->Points.insert(this->Points.end(), point.data(), point.data() + 3);
  }
};

class Sampler
{
public:
  Sampler(const ChartMesh& chart, const NetKnots& knots) : Chart(chart), Knots(knots)
  {
    double spans = 1e300;
    double functions = 1e300;
    for (const KnotVector& k : knots)
    {
      spans = std::min<double>(spans, k.NumElements());
      functions = std::min<double>(functions, k.NumFunctions());
    }
    this->Size = PieceSize * spans / functions;
  }

  void Triangle(const std::array<int, 3>& corners, Rows& inside, Rows& looked) const
  {
    const Place a = this->Corner(corners[0]);
    const Place b = this->Corner(corners[1]);
    const Place c = this->Corner(corners[2]);
    const Eigen::Vector2d ab = b.Parameter - a.Parameter;
    const Eigen::Vector2d ac = c.Parameter - a.Parameter;
    this->Halve(a, b, c, 0.5 * (ab[0] * ac[1] - ab[1] * ac[0]), 0, inside, looked);
  }

  void Edge(const std::array<int, 2>& ends, Rows& weighted) const
  {
    this->HalveEdge(this->Corner(ends[0]), this->Corner(ends[1]), 0, weighted);
  }

private:
  void Locate(Place& place) const
  {
    for (int d = 0; d < 2; ++d)
    {
      const KnotVector& knots = this->Knots[static_cast<std::size_t>(d)];
      const int e = knots.FindElement(place.Parameter[d]);
      const auto& breaks = knots.Breaks();
      const double begin = breaks[static_cast<std::size_t>(e)];
      const double end = breaks[static_cast<std::size_t>(e) + 1];
      place.Net[d] = e + (place.Parameter[d] - begin) / (end - begin);
    }
  }
  Place Corner(int point) const
  {
    Place place;
    place.Parameter = this->Chart.UV.row(point).transpose();
    place.Point = this->Chart.Points.row(point).transpose();
    this->Locate(place);
    return place;
  }
  Place Middle(const Place& a, const Place& b) const
  {
    Place place;
    place.Parameter = 0.5 * (a.Parameter + b.Parameter);
    place.Point = 0.5 * (a.Point + b.Point);
    this->Locate(place);
    return place;
  }

  void Halve(const Place& a, const Place& b, const Place& c, double area, int depth, Rows& inside,
    Rows& looked) const
  {
    const double ab = (b.Net - a.Net).squaredNorm();
    const double bc = (c.Net - b.Net).squaredNorm();
    const double ca = (a.Net - c.Net).squaredNorm();
    if (bc > ab || ca > ab) // the edge that is halved goes first
    {
      return bc >= ca ? this->Halve(b, c, a, area, depth, inside, looked)
                      : this->Halve(c, a, b, area, depth, inside, looked);
    }
    if (ab <= this->Size * this->Size || depth == MaxDepth)
    {
      inside.Add(
        (a.Parameter + b.Parameter + c.Parameter) / 3.0, (a.Point + b.Point + c.Point) / 3.0);
      inside.Weights.push_back(area);
      return;
    }
    const Place middle = this->Middle(a, b);
    looked.Add(middle.Parameter, middle.Point);
    this->Halve(a, middle, c, 0.5 * area, depth + 1, inside, looked);
    this->Halve(middle, b, c, 0.5 * area, depth + 1, inside, looked);
  }

  void HalveEdge(const Place& a, const Place& b, int depth, Rows& weighted) const
  {
    const Place middle = this->Middle(a, b);
    if ((b.Net - a.Net).squaredNorm() > this->Size * this->Size && depth < MaxDepth)
    {
      this->HalveEdge(a, middle, depth + 1, weighted);
      this->HalveEdge(middle, b, depth + 1, weighted);
      return;
    }
    double span = 1.0; // product of both directions
    for (int d = 0; d < 2; ++d)
    {
      const auto& breaks = this->Knots[static_cast<std::size_t>(d)].Breaks();
      const auto e = static_cast<std::size_t>(
        this->Knots[static_cast<std::size_t>(d)].FindElement(middle.Parameter[d]));
      span *= breaks[e + 1] - breaks[e];
    }
    weighted.Add(middle.Parameter, middle.Point);
    weighted.Weights.push_back(
      BoundaryWidth * std::sqrt(span) * (b.Parameter - a.Parameter).norm());
  }

  const ChartMesh& Chart;
  const NetKnots& Knots;
  double Size = 0.0;
};

std::size_t NumChunks(std::size_t count)
{
  return (count + TriangleChunk - 1) / TriangleChunk;
}
}

double SmallestSpan(const NetKnots& knots)
{
  double smallest = knots[0].End() - knots[0].Begin();
  for (const KnotVector& k : knots)
  {
    for (std::size_t i = 0; i + 1 < k.Breaks().size(); ++i)
    {
      smallest = std::min(smallest, k.Breaks()[i + 1] - k.Breaks()[i]);
    }
  }
  return smallest;
}

std::vector<std::array<int, 2>> BoundaryEdges(const std::vector<std::array<int, 3>>& triangles)
{
  const std::vector<MeshTriangle> neighbours = TriangleNeighbours(triangles);
  std::vector<std::array<int, 2>> edges;
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      if (neighbours[t][k] < 0)
      {
        edges.push_back({ triangles[t][k], triangles[t][(k + 1) % 3] });
      }
    }
  }
  return edges;
}

ChartSamples SampleChart(const ChartMesh& chart, const std::vector<std::array<int, 2>>& boundary,
  const NetKnots& knots, int threads)
{
  const Sampler sampler(chart, knots);
  std::vector<Rows> inside(NumChunks(chart.Triangles.size()));
  std::vector<Rows> looked(inside.size());
  ParallelFor(chart.Triangles.size(), TriangleChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t t = begin; t < end; ++t)
      {
        sampler.Triangle(
          chart.Triangles[t], inside[begin / TriangleChunk], looked[begin / TriangleChunk]);
      }
    });
  std::vector<Rows> edges(NumChunks(boundary.size()));
  ParallelFor(boundary.size(), TriangleChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t e = begin; e < end; ++e)
      {
        sampler.Edge(boundary[e], edges[begin / TriangleChunk]);
      }
    });

  ChartSamples samples;
  std::vector<Rows*> parts;
  Eigen::Index count = 0;
  const auto append = [&](std::vector<Rows>& group)
  {
    for (Rows& rows : group)
    {
      parts.push_back(&rows);
      count += static_cast<Eigen::Index>(rows.Parameters.size() / 2);
    }
    return count;
  };
  samples.NumInside = append(inside);
  samples.NumWeighted = append(edges);
  append(looked);
  samples.Parameters.resize(count + chart.UV.rows(), 2);
  samples.Points.resize(count + chart.UV.rows(), 3);
  samples.Weights.setZero(samples.Parameters.rows());
  double* parameters = samples.Parameters.data();
  double* points = samples.Points.data();
  double* weights = samples.Weights.data();
  for (Rows* rows : parts)
  {
    parameters = std::copy(rows->Parameters.begin(), rows->Parameters.end(), parameters);
    points = std::copy(rows->Points.begin(), rows->Points.end(), points);
    weights = std::copy(rows->Weights.begin(), rows->Weights.end(), weights);
    *rows = Rows(); // the samples of fine nets are most of a fit's memory
  }
  samples.Parameters.bottomRows(chart.UV.rows()) = chart.UV;
  samples.Points.bottomRows(chart.UV.rows()) = chart.Points;
  return samples;
}
}
