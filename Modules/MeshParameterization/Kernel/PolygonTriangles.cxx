// SPDX-License-Identifier: BSD-3-Clause
#include "PolygonTriangles.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace knotwork
{
namespace
{
using Point = std::array<double, 2>; ///< whole numbers of magnitude at most 2^50

/// A triangle must be better by so much to come before one of lower number: ties do not hang on
/// rounding.
constexpr double Better = 1.0 + 1e-9;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Sign of a b - c d, exact: products are compared, and when they are equal what rounding took.
int CompareProducts(double a, double b, double c, double d)
{
  const double p = a * b;
  const double q = c * d;
  if (p != q)
  {
    return p > q ? 1 : -1;
  }
  const double restOfP = std::fma(a, b, -p);
  const double restOfQ = std::fma(c, d, -q);
  return restOfP > restOfQ ? 1 : restOfP < restOfQ ? -1 : 0;
}

/// Sign of the area of a triangle; differences of whole numbers are exact.
int Turn(const Point& a, const Point& b, const Point& c)
{
  return CompareProducts(b[0] - a[0], c[1] - a[1], b[1] - a[1], c[0] - a[0]);
}

/// The corners in the plane of the polygon, which runs counterclockwise there; empty without area.
std::vector<Point> InPlane(const PointMatrix& corners)
{
  using Vector = Eigen::RowVector3d;
  const Eigen::Index n = corners.rows();
  const Vector origin = corners.row(0);
  Vector area = Vector::Zero();
  double size = 0.0;
  for (Eigen::Index i = 0; i < n; ++i)
  {
    const Vector side = corners.row(i) - origin;
    const Vector next = corners.row((i + 1) % n) - origin;
    area += side.cross(next);
    size = std::max(size, side.norm());
  }
  if (!(size > 0.0) || !std::isfinite(size) || !(area.norm() > 0.0))
  {
    return {};
  }
  const Vector normal = area.normalized();
  const Vector first = normal.unitOrthogonal();
  const Vector second = normal.cross(first);
  const double scale = std::ldexp(1.0, 50) / size;
  std::vector<Point> points;
  for (Eigen::Index i = 0; i < n; ++i)
  {
    const Vector side = scale * (corners.row(i) - origin);
    points.push_back({ std::nearbyint(side.dot(first)), std::nearbyint(side.dot(second)) });
  }
  return points;
}

/// Whether two sides that are not neighbours cross each other inside of both.
bool CrossesItself(const std::vector<Point>& points)
{
  const std::size_t n = points.size();
  const auto end = [&](std::size_t i) -> const Point& { return points[(i + 1) % n]; };
  std::vector<std::size_t> sides(n);
  std::iota(sides.begin(), sides.end(), std::size_t{ 0 });
  const auto left = [&](std::size_t i) { return std::min(points[i][0], end(i)[0]); };
  std::sort(sides.begin(), sides.end(),
    [&](std::size_t a, std::size_t b) { return left(a) != left(b) ? left(a) < left(b) : a < b; });
  for (std::size_t k = 0; k < n; ++k)
  {
    const std::size_t i = sides[k];
    const double right = std::max(points[i][0], end(i)[0]);
    for (std::size_t m = k + 1; m < n && left(sides[m]) <= right; ++m)
    {
      const std::size_t j = sides[m];
      if (Turn(points[i], end(i), points[j]) * Turn(points[i], end(i), end(j)) < 0 &&
        Turn(points[j], end(j), points[i]) * Turn(points[j], end(j), end(i)) < 0)
      {
        return true;
      }
    }
  }
  return false;
}

/// What is left of a polygon while corners are cut off.
class Polygon
{
public:
  explicit Polygon(std::vector<Point> points) : Points(std::move(points))
  {
    const auto n = static_cast<int>(this->Points.size());
    for (int i = 0; i < n; ++i)
    {
      this->Previous.push_back((i + n - 1) % n);
      this->Next.push_back((i + 1) % n);
    }
    this->Left.resize(At(n));
    std::iota(this->Left.begin(), this->Left.end(), 0);
    this->Qualities.assign(At(n), 0.0);
  }

  std::vector<std::array<int, 3>> Divide()
  {
    const std::size_t wanted = this->Points.size() - 2;
    std::vector<std::array<int, 3>> triangles;
    this->MeasureAll();
    while (triangles.size() < wanted)
    {
      int best = this->Best();
      if (best < 0)
      {
        this->MeasureAll();
        best = this->Best();
      }
      if (best < 0)
      {
        return {};
      }
      const int before = this->Previous[At(best)];
      const int after = this->Next[At(best)];
      triangles.push_back({ before, best, after });
      this->Next[At(before)] = after;
      this->Previous[At(after)] = before;
      this->Left.erase(std::lower_bound(this->Left.begin(), this->Left.end(), best));
      this->Qualities[At(before)] = this->Quality(before);
      this->Qualities[At(after)] = this->Quality(after);
    }
    return triangles;
  }

private:
  const Point& Of(int i) const { return this->Points[At(i)]; }
  int TurnAt(int i) const
  {
    return Turn(this->Of(this->Previous[At(i)]), this->Of(i), this->Of(this->Next[At(i)]));
  }

  void MeasureAll()
  {
    for (const int i : this->Left)
    {
      this->Qualities[At(i)] = this->Quality(i);
    }
  }

  int Best() const
  {
    int best = -1;
    for (const int i : this->Left)
    {
      const double quality = this->Qualities[At(i)];
      if (quality > 0.0 && (best < 0 || quality > Better * this->Qualities[At(best)]))
      {
        best = i;
      }
    }
    return best;
  }

  /// Area of the triangle at a corner by its squared sides; 0 when it may not be cut off.
  double Quality(int corner) const
  {
    const Point& a = this->Of(this->Previous[At(corner)]);
    const Point& b = this->Of(corner);
    const Point& c = this->Of(this->Next[At(corner)]);
    if (Turn(a, b, c) <= 0)
    {
      return 0.0;
    }
    for (const int i : this->Left)
    {
      const Point& p = this->Of(i);
      if (p != a && p != b && p != c && Turn(a, b, p) >= 0 && Turn(b, c, p) >= 0 &&
        Turn(c, a, p) >= 0)
      {
        return 0.0;
      }
    }
    const auto square = [](const Point& p, const Point& q)
    { return (p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]); };
    const double area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    // of needles the rounded area may be 0
    return std::max(area / (square(a, b) + square(b, c) + square(c, a)), 1e-300);
  }

  std::vector<Point> Points;
  std::vector<int> Previous;
  std::vector<int> Next;
  std::vector<int> Left; ///< corners that are not cut off, ascending
  std::vector<double> Qualities;
};
}

std::vector<std::array<int, 3>> DividePolygon(const PointMatrix& corners)
{
  if (corners.rows() < 3)
  {
    return {};
  }
  std::vector<Point> points = InPlane(corners);
  if (points.empty() || CrossesItself(points))
  {
    return {};
  }
  return Polygon(std::move(points)).Divide();
}
}
