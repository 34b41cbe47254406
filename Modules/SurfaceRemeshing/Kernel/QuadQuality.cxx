// SPDX-License-Identifier: BSD-3-Clause
#include "QuadQuality.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <utility>

namespace knotwork
{
namespace
{
constexpr double SharpCosine = 0.8660254037844387; ///< of 30 degrees
constexpr double FoldedJacobian = 0.1;             ///< normals say nothing below
constexpr double PoorJacobian = 0.3;               ///< below, more places are tried
constexpr double LeastGain = 1e-6;                 ///< of a scaled Jacobian, far above rounding

/// Numbers of the quadrilaterals at every point.
std::vector<std::vector<int>> QuadsAt(const std::vector<MeshQuad>& quads, Eigen::Index numPoints)
{
  std::vector<std::vector<int>> at(static_cast<std::size_t>(numPoints));
  for (std::size_t q = 0; q < quads.size(); ++q)
  {
    for (const int corner : quads[q])
    {
      at[static_cast<std::size_t>(corner)].push_back(static_cast<int>(q));
    }
  }
  return at;
}

/// A point and the quadrilaterals around it.
class Star
{
public:
  Star(const std::vector<MeshQuad>& quads, const std::vector<int>& around, int point)
    : Quads(quads), Around(around), Point(point)
  {
  }

  bool IsSharp(const PointMatrix& points) const
  {
    std::vector<Eigen::Vector3d> normals;
    for (const int quad : this->Around)
    {
      normals.push_back(DiagonalProduct(points, this->Quad(quad)).normalized());
      for (const Eigen::Vector3d& other : normals)
      {
        if (other.dot(normals.back()) < SharpCosine)
        {
          return true;
        }
      }
    }
    return false;
  }
  /// The least and the mean scaled Jacobian.
  std::pair<double, double> Jacobians(const PointMatrix& points) const
  {
    double least = 1.0;
    double sum = 0.0;
    for (const int quad : this->Around)
    {
      const double one = ScaledJacobian(points, this->Quad(quad));
      least = std::min(least, one);
      sum += one;
    }
    return { least, sum / static_cast<double>(this->Around.size()) };
  }
  /// Of the ends of its edges, each of which two quadrilaterals have.
  Eigen::Vector3d MiddleOfNeighbours(const PointMatrix& points) const
  {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const int number : this->Around)
    {
      const MeshQuad& quad = this->Quad(number);
      const auto k = std::find(quad.begin(), quad.end(), this->Point) - quad.begin();
      sum += points.row(quad[static_cast<std::size_t>((k + 1) % 4)]).transpose();
      sum += points.row(quad[static_cast<std::size_t>((k + 3) % 4)]).transpose();
    }
    return sum / (2.0 * static_cast<double>(this->Around.size()));
  }

  /// Steps along edges and diagonals, forth and back.
  std::vector<Eigen::Vector3d> Asides(const PointMatrix& points) const
  {
    std::vector<Eigen::Vector3d> steps;
    const Eigen::RowVector3d here = points.row(this->Point);
    for (const int number : this->Around)
    {
      const MeshQuad& quad = this->Quad(number);
      const auto k = std::find(quad.begin(), quad.end(), this->Point) - quad.begin();
      const Eigen::Vector3d edge =
        (points.row(quad[static_cast<std::size_t>((k + 1) % 4)]) - here).transpose();
      const Eigen::Vector3d diagonal =
        (points.row(quad[static_cast<std::size_t>((k + 2) % 4)]) - here).transpose();
      for (const double share : { 0.5, 0.2, -0.2 })
      {
        steps.emplace_back(share * edge);
      }
      for (const double share : { 1.0 / 3.0, 0.1, -0.1 })
      {
        steps.emplace_back(share * diagonal);
      }
    }
    return steps;
  }

private:
  const MeshQuad& Quad(int number) const { return this->Quads[static_cast<std::size_t>(number)]; }

  const std::vector<MeshQuad>& Quads;
  const std::vector<int>& Around;
  int Point;
};
}

Eigen::Vector3d DiagonalProduct(const PointMatrix& points, const MeshQuad& quad)
{
  const Eigen::Vector3d first = (points.row(quad[2]) - points.row(quad[0])).transpose();
  const Eigen::Vector3d second = (points.row(quad[3]) - points.row(quad[1])).transpose();
  return first.cross(second);
}

double ScaledJacobian(const PointMatrix& points, const MeshQuad& quad)
{
  const Eigen::Vector3d normal = DiagonalProduct(points, quad);
  const double length = normal.norm();
  double least = 1.0;
  for (std::size_t k = 0; k < 4; ++k)
  {
    const Eigen::Vector3d at = points.row(quad[k]).transpose();
    const Eigen::Vector3d next = points.row(quad[(k + 1) % 4]).transpose() - at;
    const Eigen::Vector3d last = points.row(quad[(k + 3) % 4]).transpose() - at;
    const double scale = length * next.norm() * last.norm();
    least = std::min(least, scale > 0.0 ? normal.dot(next.cross(last)) / scale : -1.0);
  }
  return least;
}

std::vector<MeshTriangle> HalvesOf(const PointMatrix& points, const std::vector<MeshQuad>& quads)
{
  std::vector<MeshTriangle> halves;
  halves.reserve(2 * quads.size());
  for (const auto& [a, b, c, d] : quads)
  {
    const bool first = (points.row(a) - points.row(c)).squaredNorm() <=
      (points.row(b) - points.row(d)).squaredNorm();
    halves.push_back(first ? MeshTriangle{ a, b, c } : MeshTriangle{ a, b, d });
    halves.push_back(first ? MeshTriangle{ a, c, d } : MeshTriangle{ b, c, d });
  }
  return halves;
}

bool SmoothQuads(const TriangleIndex<3>& surface, const std::vector<MeshQuad>& quads, int times,
  PointMatrix& points)
{
  const auto around = QuadsAt(quads, points.rows());
  bool anyMoved = false;
  for (int time = 0; time < times; ++time)
  {
    bool moved = false;
    for (Eigen::Index i = 0; i < points.rows(); ++i)
    {
      const Star star(quads, around[static_cast<std::size_t>(i)], static_cast<int>(i));
      auto best = star.Jacobians(points);
      if (best.first > FoldedJacobian && star.IsSharp(points))
      {
        continue;
      }
      const Eigen::RowVector3d old = points.row(i);
      Eigen::RowVector3d place = old;
      const auto attempt = [&](const Eigen::Vector3d& wish)
      {
        const TriangleFoot foot = surface.Nearest(wish.data());
        points.row(i) = surface.PointAt(foot.Triangle, foot.Second, foot.Third);
        const auto found = star.Jacobians(points);
        // of several folded ones a point may mend one only
        if (found.first > best.first + LeastGain ||
          (found.first >= best.first && best.first <= FoldedJacobian &&
            found.second > best.second + LeastGain))
        {
          best = found;
          place = points.row(i);
          moved = true;
        }
        points.row(i) = old;
      };
      const Eigen::Vector3d middle = star.MiddleOfNeighbours(points);
      attempt(middle);
      if (best.first < PoorJacobian)
      {
        for (const Eigen::Vector3d& aside : star.Asides(points))
        {
          attempt(old.transpose() + aside);
        }
      }
      points.row(i) = place;
    }
    anyMoved = anyMoved || moved;
    if (!moved)
    {
      break;
    }
  }
  return anyMoved;
}
}
