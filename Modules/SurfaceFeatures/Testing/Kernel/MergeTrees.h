// SPDX-License-Identifier: BSD-3-Clause
// How many contours a function on a rectangle has at any level, from its critical points and from
// paths uphill and downhill between them: no contour is traced.
#pragma once
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SurfaceFeatures/CriticalPoints.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace knotwork::testing
{
/// Places about a critical point, one after the other around it, some of them outside the domain.
struct PointRing
{
  PointMatrix Parameters;
  std::vector<int> Signs; ///< -1 lower than the point, 1 not lower, 0 outside
  std::vector<double> Values;
};

/// @param size  radius, of the distance to the ends of the point's box.
inline PointRing RingAround(
  const BezierForm<2>& form, const CriticalPoint& point, int n = 720, double size = 1e-3)
{
  const ParametricBox<2> domain = form.Space->Domain();
  PointMatrix ring(n + 1, 2);
  ring.row(n) << point.Parameters[0], point.Parameters[1];
  for (int i = 0; i < n; ++i)
  {
    const double t = 2.0 * M_PI * i / n; // the axes too: on lines the second order counts
    const double c[2] = { i % (n / 2) == n / 4 ? 0.0 : std::cos(t),
      i % (n / 2) == 0 ? 0.0 : std::sin(t) };
    for (std::size_t d = 0; d < 2; ++d)
    {
      const double up = point.Box.Upper[d] - point.Parameters[d];
      const double down = point.Parameters[d] - point.Box.Lower[d];
      // on the boundary one of them is zero
      const double radius = size * (std::min(up, down) > 0.0 ? std::min(up, down) : up + down);
      ring(i, static_cast<Eigen::Index>(d)) = point.Parameters[d] + radius * c[d];
    }
  }
  EvaluationBatch batch;
  PointMatrix clamped = ring;
  for (int i = 0; i <= n; ++i)
  {
    for (Eigen::Index d = 0; d < 2; ++d)
    {
      const auto k = static_cast<std::size_t>(d);
      clamped(i, d) = std::min(std::max(ring(i, d), domain.Lower[k]), domain.Upper[k]);
    }
  }
  EXPECT_TRUE(EvaluateParameters<2>(form, clamped, {}, batch));
  PointRing result;
  for (int i = 0; i < n; ++i)
  {
    const bool outside = clamped.row(i) != ring.row(i);
    result.Signs.push_back(outside ? 0 : batch.Values(i, 0) < batch.Values(n, 0) ? -1 : 1);
    result.Values.push_back(batch.Values(i, 0));
  }
  result.Parameters = clamped.topRows(n);
  return result;
}

/// The components of {f >= level} for all levels (sign 1), or of {f <= level} (sign -1): each is
/// born at an extremum, two become one at a critical point with several ways uphill (downhill).
class MergeTree
{
public:
  MergeTree(const BezierForm<2>& form, const CriticalPoints& found, int sign)
    : Form(form), Points(found.Points), Domain(form.Space->Domain()), Sign(sign)
  {
    const std::size_t n = this->Points.size();
    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), std::size_t{ 0 });
    std::sort(order.begin(), order.end(),
      [&](std::size_t a, std::size_t b) { return this->Height(a) > this->Height(b); });
    this->Parent.resize(n);
    std::iota(this->Parent.begin(), this->Parent.end(), std::size_t{ 0 });
    for (const std::size_t p : order)
    {
      if (this->IsTop(p))
      {
        this->Births.push_back(this->Height(p));
        continue;
      }
      std::size_t first = n;
      for (const std::size_t top : this->TopsAbove(p))
      {
        const std::size_t root = this->Root(top);
        if (first < n && root != first)
        {
          this->Parent[root] = first;
          this->Merges.push_back(this->Height(p));
        }
        first = first < n ? first : root;
      }
    }
  }

  /// Number at a level that is no critical value.
  int Count(double level) const
  {
    const auto above = [&](double height) { return height > this->Sign * level; };
    return static_cast<int>(std::count_if(this->Births.begin(), this->Births.end(), above) -
      std::count_if(this->Merges.begin(), this->Merges.end(), above));
  }
  bool IsTree() const { return this->Births.size() == this->Merges.size() + 1; }

private:
  double Height(std::size_t p) const { return this->Sign * this->Points[p].Value; }
  bool IsTop(std::size_t p) const
  {
    return this->Points[p].Kind == (this->Sign > 0 ? CriticalKind::Maximum : CriticalKind::Minimum);
  }
  std::size_t Root(std::size_t p)
  {
    while (this->Parent[p] != p)
    {
      p = this->Parent[p] = this->Parent[this->Parent[p]];
    }
    return p;
  }

  /// An extremum above each of the ways up from a point.
  std::vector<std::size_t> TopsAbove(std::size_t p) const
  {
    const PointRing ring = RingAround(this->Form, this->Points[p]);
    const int n = static_cast<int>(ring.Signs.size());
    const auto up = [&](int i)
    { return ring.Signs[static_cast<std::size_t>((i + n) % n)] == this->Sign; };
    std::vector<std::size_t> tops;
    for (int i = 0; i < n; ++i)
    {
      if (!up(i) || up(i - 1))
      {
        continue;
      }
      int best = i;
      for (int k = i; k < i + n && up(k); ++k)
      {
        const auto value = [&](int at) { return ring.Values[static_cast<std::size_t>(at % n)]; };
        best = this->Sign * (value(k) - value(best)) > 0.0 ? k : best;
      }
      tops.push_back(this->Climb(p, ring.Parameters.row(best % n),
        this->Sign * ring.Values[static_cast<std::size_t>(best % n)]));
    }
    return tops;
  }

  /// Steps to the highest of sixteen places around (the axes among them: creases and the boundary
  /// run along these) to which nothing between is lower than where it starts.
  /// @param at  near point p, higher than it.
  std::size_t Climb(std::size_t p, Eigen::RowVector2d at, double height) const
  {
    constexpr int directions = 16;
    constexpr int parts = 4;
    constexpr double longest = 1.0 / 6.0; // of an element
    const Eigen::RowVector2d low(this->Domain.Lower[0], this->Domain.Lower[1]);
    const Eigen::RowVector2d high(this->Domain.Upper[0], this->Domain.Upper[1]);
    const Eigen::RowVector2d start(this->Points[p].Parameters[0], this->Points[p].Parameters[1]);
    const double bottom = this->Height(p);
    Eigen::RowVector2d size = this->SizeOf(this->Points[p].Element);
    // not over the point to its other side
    double step = std::min(longest, (at - start).cwiseQuotient(size).norm());
    PointMatrix places(directions * parts, 2);
    EvaluationBatch batch;
    for (int walk = 0; walk < 10000 && step > 1e-13; ++walk)
    {
      for (int i = 0; i < directions; ++i)
      {
        const double t = 2.0 * M_PI * i / directions;
        const Eigen::RowVector2d way(
          i % 8 == 4 ? 0.0 : std::cos(t), i % 8 == 0 ? 0.0 : std::sin(t));
        for (int k = 0; k < parts; ++k)
        {
          places.row(parts * i + k) =
            (at + step * (k + 1) / parts * way.cwiseProduct(size)).cwiseMax(low).cwiseMin(high);
        }
      }
      EXPECT_TRUE(EvaluateParameters<2>(this->Form, places, {}, batch));
      const Eigen::VectorXd heights = this->Sign * batch.Values.col(0);
      Eigen::Index best = -1;
      double highest = height;
      for (Eigen::Index i = 0; i < heights.size(); i += parts)
      {
        const Eigen::Index last = i + parts - 1;
        if (heights[last] > highest && heights.segment(i, parts).minCoeff() >= height)
        {
          best = last;
          highest = heights[last];
        }
      }
      if (best < 0)
      {
        step *= 0.5;
        continue;
      }
      at = places.row(best);
      height = highest;
      const std::size_t top = this->TopInSight(at, height);
      if (top < this->Points.size())
      {
        return top;
      }
      const Eigen::RowVector2d next = this->SizeOf(batch.Elements[static_cast<std::size_t>(best)]);
      step *= 1.5 * std::min(1.0, size.cwiseQuotient(next).minCoeff());
      step = std::min(longest, step);
      size = next;
    }
    const std::size_t top = this->TopInSight(at, bottom, true);
    EXPECT_LT(top, this->Points.size()) << "no extremum at " << at;
    return top < this->Points.size() ? top : 0;
  }

  /// The extremum in whose uniqueness box (at the end: next to which) a place lies and that can be
  /// reached straight.
  std::size_t TopInSight(const Eigen::RowVector2d& at, double bottom, bool isEnd = false) const
  {
    constexpr int parts = 32;
    for (std::size_t p = 0; p < this->Points.size(); ++p)
    {
      const CriticalPoint& point = this->Points[p];
      bool inside = this->IsTop(p);
      for (std::size_t d = 0; d < 2; ++d)
      {
        const double x = at[static_cast<Eigen::Index>(d)];
        const double slack = isEnd ? 1e-6 * (this->Domain.Upper[d] - this->Domain.Lower[d]) : 0.0;
        inside = inside && point.Box.Lower[d] - slack <= x && x <= point.Box.Upper[d] + slack;
      }
      if (!inside)
      {
        continue;
      }
      PointMatrix between(parts, 2);
      const Eigen::RowVector2d top(point.Parameters[0], point.Parameters[1]);
      for (int k = 0; k < parts; ++k)
      {
        between.row(k) = at + (top - at) * (k + 1) / parts;
      }
      EvaluationBatch batch;
      EXPECT_TRUE(EvaluateParameters<2>(this->Form, between, {}, batch));
      if ((this->Sign * batch.Values.col(0)).minCoeff() >= bottom)
      {
        return p;
      }
    }
    return this->Points.size();
  }

  Eigen::RowVector2d SizeOf(int element) const
  {
    const ParametricBox<2>& box = this->Form.Space->Elements[static_cast<std::size_t>(element)].Box;
    return { box.Upper[0] - box.Lower[0], box.Upper[1] - box.Lower[1] };
  }

  const BezierForm<2>& Form;
  const std::vector<CriticalPoint>& Points;
  ParametricBox<2> Domain;
  int Sign;
  std::vector<std::size_t> Parent;
  std::vector<double> Births;
  std::vector<double> Merges;
};

/// Numbers of contours. A contour cuts a rectangle in two; so there is one less than there are
/// components of {f >= level} and {f < level} together. Those that end on the boundary are half as
/// many as its changes of sign, between neighbouring extrema along it.
class ContourNumbers
{
public:
  ContourNumbers(const BezierForm<2>& form, const CriticalPoints& found)
    : Above(form, found, 1), Below(form, found, -1)
  {
    const ParametricBox<2> box = form.Space->Domain();
    std::vector<std::array<double, 2>> around; // place along the boundary, value
    for (const CriticalPoint& point : found.Points)
    {
      if (point.Place != CriticalPlace::Boundary && point.Place != CriticalPlace::Corner)
      {
        continue;
      }
      const double u = (point.Parameters[0] - box.Lower[0]) / (box.Upper[0] - box.Lower[0]);
      const double v = (point.Parameters[1] - box.Lower[1]) / (box.Upper[1] - box.Lower[1]);
      const bool lower = v == 0.0 || (u == 1.0 && v < 1.0);
      around.push_back({ lower ? u + v : 4.0 - u - v, point.Value });
    }
    std::sort(around.begin(), around.end());
    for (const auto& [place, value] : around)
    {
      this->Boundary.push_back(value);
    }
  }

  bool AreTrees() const { return this->Above.IsTree() && this->Below.IsTree(); }
  int All(double level) const { return this->Above.Count(level) + this->Below.Count(level) - 1; }
  int Closed(double level) const
  {
    int changes = 0;
    for (std::size_t i = 0; i < this->Boundary.size(); ++i)
    {
      const double next = this->Boundary[(i + 1) % this->Boundary.size()];
      changes += (this->Boundary[i] >= level) != (next >= level) ? 1 : 0;
    }
    return this->All(level) - changes / 2;
  }

private:
  MergeTree Above;
  MergeTree Below;
  std::vector<double> Boundary;
};
}
