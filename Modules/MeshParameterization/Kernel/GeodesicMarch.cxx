// SPDX-License-Identifier: BSD-3-Clause
#include "GeodesicMarch.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
constexpr double LeastGain = 1e-12; // relative; smaller improvements are rounding
constexpr double Pi = 3.14159265358979323846;

/// Distance of c by a straight way across edge ab; infinity when there is none.
/// x, y: place of c where a is the origin and b lies on the first axis.
double AcrossEdge(double ta, double tb, double ab, double x, double y)
{
  const double sx = (ta * ta - tb * tb + ab * ab) / (2.0 * ab);
  const double square = ta * ta - sx * sx;
  if (square <= 0.0)
  {
    return std::numeric_limits<double>::infinity();
  }
  const double sy = std::sqrt(square);
  const double crossing = sx + (x - sx) * sy / (y + sy);
  const double slack = 1e-9 * ab;
  if (crossing < -slack || crossing > ab + slack)
  {
    return std::numeric_limits<double>::infinity();
  }
  return std::hypot(x - sx, y + sy);
}
}

GeodesicMarch::GeodesicMarch(const DiscMesh& mesh, GeodesicEstimator estimator)
  : Mesh(mesh), Estimator(estimator), Touched(mesh.OnBoundary.size(), 0),
    Final(mesh.OnBoundary.size(), 0), Distance(mesh.OnBoundary.size(), 0.0),
    Place(mesh.OnBoundary.size())
{
}

void GeodesicMarch::Start(int source)
{
  ++this->Run;
  this->Heap.clear();
  const auto v = static_cast<std::size_t>(source);
  this->Touched[v] = this->Run;
  this->Final[v] = 1;
  this->Distance[v] = 0.0;
  this->Place[v].setZero();
  const auto begin = static_cast<std::size_t>(this->Mesh.FanStart[v]);
  const auto end = static_cast<std::size_t>(this->Mesh.FanStart[v + 1]);
  std::vector<double> angles(end - begin + 1, 0.0);
  for (std::size_t j = begin; j < end; ++j)
  {
    double angle = 0.0;
    if (this->Mesh.Rims[j] > 0.0)
    {
      const double p = this->Mesh.Spokes[j];
      const double q = this->Mesh.Spokes[j + 1 == end ? begin : j + 1];
      const double r = this->Mesh.Rims[j];
      angle = std::acos(std::clamp((p * p + q * q - r * r) / (2.0 * p * q), -1.0, 1.0));
    }
    angles[j - begin + 1] = angles[j - begin] + angle;
  }
  const double scale = this->Mesh.OnBoundary[v] ? 1.0 : 2.0 * Pi / angles.back();
  for (std::size_t j = begin; j < end; ++j)
  {
    const double angle = scale * angles[j - begin];
    const auto w = static_cast<std::size_t>(this->Mesh.Fan[j]);
    this->Touched[w] = this->Run;
    this->Final[w] = 0;
    this->Distance[w] = this->Mesh.Spokes[j];
    this->Place[w] = this->Mesh.Spokes[j] * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    this->Heap.emplace_back(this->Distance[w], this->Mesh.Fan[j]);
  }
  std::make_heap(this->Heap.begin(), this->Heap.end(), std::greater<>());
}

bool GeodesicMarch::Next(int& vertex)
{
  while (!this->Heap.empty())
  {
    std::pop_heap(this->Heap.begin(), this->Heap.end(), std::greater<>());
    const auto [distance, v] = this->Heap.back();
    this->Heap.pop_back();
    if (distance == this->Distance[static_cast<std::size_t>(v)] &&
      !this->Final[static_cast<std::size_t>(v)])
    {
      this->Final[static_cast<std::size_t>(v)] = 1;
      vertex = v;
      return true;
    }
  }
  return false;
}

/// Tries to shorten the way to c of triangle (a, b, c), whose corner a has just become final.
void GeodesicMarch::Reach(int va, int vb, int vc, double ab, double ac, double bc, double side)
{
  const auto a = static_cast<std::size_t>(va);
  const auto b = static_cast<std::size_t>(vb);
  const auto c = static_cast<std::size_t>(vc);
  if (this->Touched[b] != this->Run)
  {
    return;
  }
  double distance = this->Distance[a] + ac;
  const double x = (ac * ac - bc * bc + ab * ab) / (2.0 * ab);
  const double y = std::sqrt(std::max(0.0, ac * ac - x * x));
  if (this->Final[b] && this->Estimator == GeodesicEstimator::Unfolding)
  {
    distance = std::min(distance, AcrossEdge(this->Distance[a], this->Distance[b], ab, x, y));
  }
  if (this->Touched[c] == this->Run && !(distance < (1.0 - LeastGain) * this->Distance[c]))
  {
    return;
  }
  const Eigen::Vector2d along = (this->Place[b] - this->Place[a]).normalized();
  this->Touched[c] = this->Run;
  this->Final[c] = 0;
  this->Distance[c] = distance;
  this->Place[c] = this->Place[a] + x * along + side * y * Eigen::Vector2d(-along[1], along[0]);
  this->Heap.emplace_back(distance, vc);
  std::push_heap(this->Heap.begin(), this->Heap.end(), std::greater<>());
}

void GeodesicMarch::CrossFan(int vertex)
{
  const auto v = static_cast<std::size_t>(vertex);
  const auto begin = static_cast<std::size_t>(this->Mesh.FanStart[v]);
  const auto end = static_cast<std::size_t>(this->Mesh.FanStart[v + 1]);
  const std::size_t triangles = end - begin - (this->Mesh.OnBoundary[v] ? 1 : 0);
  // forth and back: every neighbour is unfolded from one that has a place already
  for (std::size_t i = 0; i < 2 * triangles; ++i)
  {
    const bool forth = i < triangles;
    const std::size_t j = begin + (forth ? i : 2 * triangles - 1 - i);
    const std::size_t k = j + 1 == end ? begin : j + 1;
    const std::size_t from = forth ? j : k;
    const std::size_t to = forth ? k : j;
    this->Reach(vertex, this->Mesh.Fan[from], this->Mesh.Fan[to], this->Mesh.Spokes[from],
      this->Mesh.Spokes[to], this->Mesh.Rims[j], forth ? 1.0 : -1.0);
  }
}

std::vector<double> GeodesicMarch::Distances(int source)
{
  this->Start(source);
  int vertex = 0;
  while (this->Next(vertex))
  {
    this->CrossFan(vertex);
  }
  return this->Distance;
}

void GeodesicMarch::Nearest(int source, int count, std::vector<int>& vertices, PointMatrix& places)
{
  this->Start(source);
  vertices.assign(1, source);
  int vertex = 0;
  while (static_cast<int>(vertices.size()) <= count && this->Next(vertex))
  {
    // a distance that was shortened after it had become final comes a second time
    if (std::find(vertices.begin(), vertices.end(), vertex) == vertices.end())
    {
      vertices.push_back(vertex);
    }
    this->CrossFan(vertex);
  }
  places.resize(static_cast<Eigen::Index>(vertices.size()), 2);
  for (std::size_t i = 0; i < vertices.size(); ++i)
  {
    places.row(static_cast<Eigen::Index>(i)) =
      this->Place[static_cast<std::size_t>(vertices[i])].transpose();
  }
}
}
