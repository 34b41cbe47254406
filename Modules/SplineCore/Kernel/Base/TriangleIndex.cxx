// SPDX-License-Identifier: BSD-3-Clause
#include "TriangleIndex.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace knotwork
{
namespace
{
template <int Dim>
using Row = Eigen::Matrix<double, 1, Dim>;

/// Coordinate of the closest point of the segment from 0 to side, for a point at offset.
template <int Dim>
double AlongSegment(const Row<Dim>& side, const Row<Dim>& offset)
{
  const double length = side.squaredNorm();
  return length >= std::numeric_limits<double>::min()
    ? std::min(std::max(offset.dot(side) / length, 0.0), 1.0)
    : 0.0;
}

}

template <int Dim>
TriangleFoot ClosestOnTriangle(
  const double* a, const double* b, const double* c, const double* point, int triangle)
{
  using Map = Eigen::Map<const Row<Dim>>;
  const Row<Dim> ab = Map(b) - Map(a);
  const Row<Dim> ac = Map(c) - Map(a);
  const Row<Dim> offset = Map(point) - Map(a);
  const Row<Dim> lower = Map(a).cwiseMin(Map(b)).cwiseMin(Map(c));
  const Row<Dim> upper = Map(a).cwiseMax(Map(b)).cwiseMax(Map(c));

  TriangleFoot best;
  best.Triangle = triangle;
  const auto take = [&](double second, double third)
  {
    const Row<Dim> foot =
      PointOfTriangle<Dim>(a, b, c, second, third).cwiseMax(lower).cwiseMin(upper);
    double sum = 0.0; // summed as the tree sums its boxes
    for (int d = 0; d < Dim; ++d)
    {
      sum += (point[d] - foot(d)) * (point[d] - foot(d));
    }
    if (sum < best.SquaredDistance)
    {
      best.Second = second;
      best.Third = third;
      best.SquaredDistance = sum;
    }
  };

  // Foot in the plane, by one step of Gram and Schmidt from the longer side: however flat the
  // triangle, errors in the one coordinate are made good by the other, while normal equations would
  // square the loss of digits.
  const bool swapped = ac.squaredNorm() > ab.squaredNorm();
  const Row<Dim>& side = swapped ? ac : ab;
  const Row<Dim>& other = swapped ? ab : ac;
  const double length = side.squaredNorm();
  double first = -1.0;
  double second = -1.0;
  double third = -1.0;
  if (length >= std::numeric_limits<double>::min())
  {
    const Row<Dim> height = other - (other.dot(side) / length) * side;
    const double squaredHeight = height.squaredNorm();
    if (squaredHeight >= std::numeric_limits<double>::min())
    {
      third = offset.dot(height) / squaredHeight;
      second = (offset - third * other).dot(side) / length;
      if (swapped)
      {
        std::swap(second, third);
      }
      first = 1.0 - second - third;
    }
  }
  if (first >= 0.0 && second >= 0.0 && third >= 0.0)
  {
    take(second, third);
    return best;
  }
  // From outside, the closest point lies on an edge beyond which the query is; without area, on any
  // of the three.
  if (third < 0.0)
  {
    take(AlongSegment<Dim>(ab, offset), 0.0);
  }
  if (second < 0.0)
  {
    take(0.0, AlongSegment<Dim>(ac, offset));
  }
  if (first < 0.0)
  {
    const double share = AlongSegment<Dim>(Map(c) - Map(b), Map(point) - Map(b));
    take(1.0 - share, share);
  }
  return best;
}

std::vector<int> FirstOfEqualPoints(const PointMatrix& points)
{
  const auto n = static_cast<std::size_t>(points.rows());
  const auto before = [&](int a, int b)
  {
    for (Eigen::Index d = 0; d < points.cols(); ++d)
    {
      if (points(a, d) != points(b, d))
      {
        return points(a, d) < points(b, d);
      }
    }
    return false;
  };
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
    [&](int a, int b) { return before(a, b) || (!before(b, a) && a < b); });
  std::vector<int> first(n);
  for (std::size_t i = 0; i < n; ++i)
  {
    const bool equal = i > 0 && !before(order[i - 1], order[i]);
    first[static_cast<std::size_t>(order[i])] =
      equal ? first[static_cast<std::size_t>(order[i - 1])] : order[i];
  }
  return first;
}

std::vector<MeshTriangle> ReplaceCorners(
  std::vector<MeshTriangle> triangles, const std::vector<int>& replacement)
{
  for (MeshTriangle& corners : triangles)
  {
    for (int& corner : corners)
    {
      corner = replacement[static_cast<std::size_t>(corner)];
    }
  }
  return triangles;
}

std::vector<MeshTriangle> TriangleNeighbours(const std::vector<MeshTriangle>& triangles)
{
  struct Side
  {
    int Low;
    int High;
    int Triangle;
    std::size_t Edge;
  };
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      const int a = triangles[t][k];
      const int b = triangles[t][(k + 1) % 3];
      sides.push_back({ std::min(a, b), std::max(a, b), static_cast<int>(t), k });
    }
  }
  std::sort(sides.begin(), sides.end(),
    [](const Side& a, const Side& b)
    {
      return std::tie(a.Low, a.High, a.Triangle, a.Edge) <
        std::tie(b.Low, b.High, b.Triangle, b.Edge);
    });
  std::vector<MeshTriangle> neighbours(triangles.size(), MeshTriangle{ -1, -1, -1 });
  for (std::size_t i = 0; i < sides.size();)
  {
    std::size_t end = i + 1;
    while (end < sides.size() && sides[end].Low == sides[i].Low && sides[end].High == sides[i].High)
    {
      ++end;
    }
    const Side& one = sides[i];
    const Side& two = sides[end - 1];
    if (end == i + 2 && one.Low != one.High && one.Triangle != two.Triangle)
    {
      neighbours[static_cast<std::size_t>(one.Triangle)][one.Edge] = two.Triangle;
      neighbours[static_cast<std::size_t>(two.Triangle)][two.Edge] = one.Triangle;
    }
    i = end;
  }
  return neighbours;
}

template <int Dim>
TriangleIndex<Dim>::TriangleIndex(PointMatrix points, std::vector<MeshTriangle> triangles)
  : Corners(std::move(points)), Mesh(std::move(triangles))
{
  PointMatrix lower;
  PointMatrix upper;
  this->Boxes(lower, upper);
  this->Tree = BoxTree(lower, upper);
}

template <int Dim>
void TriangleIndex<Dim>::Move(const PointMatrixView& points)
{
  this->Corners = points;
  PointMatrix lower;
  PointMatrix upper;
  this->Boxes(lower, upper);
  this->Tree.Refit(lower, upper);
}

template <int Dim>
void TriangleIndex<Dim>::Boxes(PointMatrix& lower, PointMatrix& upper) const
{
  const auto n = static_cast<Eigen::Index>(this->Mesh.size());
  lower.resize(n, Dim);
  upper.resize(n, Dim);
  for (Eigen::Index t = 0; t < n; ++t)
  {
    const MeshTriangle& corners = this->Mesh[static_cast<std::size_t>(t)];
    const auto a = this->Corners.row(corners[0]);
    const auto b = this->Corners.row(corners[1]);
    const auto c = this->Corners.row(corners[2]);
    lower.row(t) = a.cwiseMin(b).cwiseMin(c);
    upper.row(t) = a.cwiseMax(b).cwiseMax(c);
  }
}

template <int Dim>
TriangleFoot TriangleIndex<Dim>::Nearest(const double* point, double bound) const
{
  const NearestItem nearest = this->Tree.Nearest(
    point, [&](int triangle) { return this->Foot(triangle, point).SquaredDistance; }, bound);
  return nearest.Item < 0 ? TriangleFoot{} : this->Foot(nearest.Item, point);
}

template TriangleFoot ClosestOnTriangle<2>(
  const double*, const double*, const double*, const double*, int);
template TriangleFoot ClosestOnTriangle<3>(
  const double*, const double*, const double*, const double*, int);
template class TriangleIndex<2>;
template class TriangleIndex<3>;
}
