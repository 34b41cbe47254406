// SPDX-License-Identifier: BSD-3-Clause
#include "ParameterFit.h"

#include <algorithm>
#include <cmath>

namespace knotwork::chains
{
namespace
{
constexpr int MaxRounds = 60;
/// From then on, and when there are many, knots become multiple where the tolerance does not hold.
constexpr int Patience = 40;
/// Corners that would have to be rounded within less stay corners.
constexpr double LeastRounding = 1e-7;
}

Result<Spline<1>> ParameterFit::Run()
{
  Result<Spline<1>> curve;
  for (int round = 0; round < MaxRounds; ++round)
  {
    curve = this->Fit();
    if (!curve)
    {
      return curve;
    }
    const auto pieces = CutAtCorners(curve.Value, this->Chain.Parameters);
    std::vector<double> worst(static_cast<std::size_t>(curve->Space->NumElements()), 0.0);
    this->Distance = 0.0;
    for (const CurvePiece& piece : pieces)
    {
      const double distance = this->Bound(piece);
      this->Distance = std::max(this->Distance, distance);
      double& most = worst[static_cast<std::size_t>(piece.Span)];
      most = std::max(most, distance);
    }
    if (this->Distance <= this->Tolerance)
    {
      return curve;
    }
    const std::size_t before = this->Knots.size();
    const bool multiply = round >= Patience || before > this->MaxKnots();
    const std::vector<double> breaks = curve->Space->Knots[0].Breaks();
    for (std::size_t e = 0; e < worst.size(); ++e)
    {
      if (worst[e] > this->Tolerance)
      {
        this->Refine(breaks[e], breaks[e + 1], multiply);
      }
    }
    if (this->Knots.size() == before && !this->FollowExactly())
    {
      break;
    }
    std::sort(this->Knots.begin(), this->Knots.end());
  }
  return { ErrorCode::NotConverged,
    "a boundary curve of " + std::to_string(this->Chain.Points.rows()) +
      " points stays beyond the tolerance" };
}

Result<Spline<1>> ParameterFit::Fit() const
{
  auto space = MakeSpace(this->Knots);
  if (!space)
  {
    return space.Status;
  }
  std::vector<double> t;
  std::vector<double> weights;
  std::vector<int> segments;
  const std::vector<double>& breaks = space.Value->Knots[0].Breaks();
  std::size_t e = 0;
  for (std::size_t s = 0; s + 1 < this->Chain.Parameters.size(); ++s)
  {
    double at = this->Chain.Parameters[s];
    const double end = this->Chain.Parameters[s + 1];
    while (at < end)
    {
      while (breaks[e + 1] <= at)
      {
        ++e;
      }
      const double to = std::min(end, breaks[e + 1]);
      AppendGauss(at, to, t, weights);
      segments.resize(t.size(), static_cast<int>(s));
      at = to;
    }
  }
  Samples samples;
  const Eigen::Index n = static_cast<Eigen::Index>(t.size());
  samples.Parameters = Eigen::Map<const Eigen::VectorXd>(t.data(), n);
  samples.Weights = Eigen::Map<const Eigen::VectorXd>(weights.data(), n);
  samples.Values.resize(n, this->Chain.UV.cols());
  for (Eigen::Index i = 0; i < n; ++i)
  {
    const std::size_t at = static_cast<std::size_t>(i);
    samples.Values.row(i) = PointAt(this->Chain.Parameters, this->Chain.UV, segments[at], t[at]);
  }
  const Eigen::Index last = this->Chain.UV.rows() - 1;
  auto points = ProjectOnto(*space.Value, samples, this->Chain.UV.row(0), this->Chain.UV.row(last));
  if (!points)
  {
    return points.Status;
  }
  // the boundary lies in the convex domain, so its curve need not leave it
  for (int k = 0; k < this->NumUses(); ++k)
  {
    const auto& domain = this->Surfaces[static_cast<std::size_t>(k)]->Domain();
    for (int d = 0; d < 2; ++d)
    {
      const std::size_t at = static_cast<std::size_t>(d);
      auto column = points->col(2 * k + d).array();
      column = column.max(domain.Lower[at]).min(domain.Upper[at]);
    }
  }
  return Spline<1>{ std::move(space.Value), std::move(points.Value), {} };
}

double ParameterFit::Bound(const CurvePiece& piece) const
{
  const Cubic difference = Difference(piece, this->Chain.Parameters, this->Chain.UV);
  double bound = 0.0;
  for (int k = 0; k < this->NumUses(); ++k)
  {
    bound = std::max(bound,
      this->Bound(*this->Surfaces[static_cast<std::size_t>(k)], piece.Curve.middleCols(2 * k, 2),
        difference.middleCols(2 * k, 2), 0));
  }
  return bound;
}

double ParameterFit::Bound(const SurfaceBounds& surface, const PlaneCubic& curve,
  const PlaneCubic& difference, int depth) const
{
  const auto bound = [&](const DerivativeBounds& derivatives)
  {
    return (
      derivatives.U * difference.col(0).cwiseAbs() + derivatives.V * difference.col(1).cwiseAbs())
      .maxCoeff();
  };
  const double anywhere = bound(surface.Everywhere());
  if (anywhere <= 0.5 * this->Tolerance)
  {
    return anywhere;
  }
  ParametricBox<2> box;
  double length = 0.0;
  for (int d = 0; d < 2; ++d)
  {
    const std::size_t at = static_cast<std::size_t>(d);
    const auto other = curve.col(d) - difference.col(d);
    box.Lower[at] = std::min(curve.col(d).minCoeff(), other.minCoeff());
    box.Upper[at] = std::max(curve.col(d).maxCoeff(), other.maxCoeff());
    length = std::max(length, curve.col(d).maxCoeff() - curve.col(d).minCoeff());
  }
  // halves of a piece that is shorter than its distance lie in no smaller box
  DerivativeBounds here;
  if (surface.Over(box, here) || depth >= MaxDepth || length <= difference.cwiseAbs().maxCoeff())
  {
    return bound(here);
  }
  const auto curves = Halve(curve);
  const auto differences = Halve(difference);
  return std::max(this->Bound(surface, curves[0], differences[0], depth + 1),
    this->Bound(surface, curves[1], differences[1], depth + 1));
}

double ParameterFit::Jump(std::size_t vertex) const
{
  const auto& t = this->Chain.Parameters;
  const Eigen::Index v = static_cast<Eigen::Index>(vertex);
  const Eigen::RowVectorXd jump =
    (this->Chain.UV.row(v + 1) - this->Chain.UV.row(v)) / (t[vertex + 1] - t[vertex]) -
    (this->Chain.UV.row(v) - this->Chain.UV.row(v - 1)) / (t[vertex] - t[vertex - 1]);
  double largest = 0.0;
  for (int k = 0; k < this->NumUses(); ++k)
  {
    const ParametricBox<2> point{ { this->Chain.UV(v, 2 * k), this->Chain.UV(v, 2 * k + 1) },
      { this->Chain.UV(v, 2 * k), this->Chain.UV(v, 2 * k + 1) } };
    DerivativeBounds bounds;
    this->Surfaces[static_cast<std::size_t>(k)]->Over(point, bounds);
    largest =
      std::max(largest, bounds.U * std::abs(jump[2 * k]) + bounds.V * std::abs(jump[2 * k + 1]));
  }
  return largest;
}

bool ParameterFit::FollowExactly()
{
  if (this->IsExact)
  {
    return false;
  }
  this->IsExact = true;
  this->Knots.clear();
  for (std::size_t v = 1; v + 1 < this->Chain.Parameters.size(); ++v)
  {
    this->Knots.insert(this->Knots.end(), Degree, this->Chain.Parameters[v]);
  }
  return true;
}

void ParameterFit::Multiply(
  std::vector<double>::const_iterator a, std::vector<double>::const_iterator b)
{
  for (auto vertex = a; vertex <= b; ++vertex)
  {
    if (*vertex > 0.0 && *vertex < 1.0)
    {
      const auto count = std::count(this->Knots.begin(), this->Knots.end(), *vertex);
      this->Knots.insert(this->Knots.end(), static_cast<std::size_t>(Degree - count), *vertex);
    }
  }
}

void ParameterFit::Refine(double begin, double end, bool multiply)
{
  const auto& t = this->Chain.Parameters;
  const auto first = std::upper_bound(t.begin(), t.end(), begin);
  const auto last = std::lower_bound(t.begin(), t.end(), end);
  if (multiply || end - begin < LeastSpan)
  {
    this->Multiply(first - 1, last);
    return;
  }
  if (last - first > 1)
  {
    this->InsertBetween(begin, end, first, last);
    return;
  }
  // one corner inside, or some at the ends
  bool isNew = false;
  for (auto vertex = first - 1; vertex <= last; ++vertex)
  {
    if (*vertex >= begin && *vertex <= end && *vertex > 0.0 && *vertex < 1.0)
    {
      isNew = this->Surround(static_cast<std::size_t>(vertex - t.begin())) || isNew;
    }
  }
  if (!isNew)
  {
    this->Knots.push_back(0.5 * (begin + end));
  }
}

void ParameterFit::InsertBetween(double begin, double end,
  std::vector<double>::const_iterator first, std::vector<double>::const_iterator last)
{
  const double middle = 0.5 * (begin + end);
  double knot = middle;
  double least = 0.25 * (end - begin);
  for (auto vertex = first; vertex != last; ++vertex)
  {
    if (std::abs(*vertex - middle) < least)
    {
      least = std::abs(*vertex - middle);
      knot = *vertex;
    }
  }
  this->Knots.push_back(knot);
}

bool ParameterFit::Surround(std::size_t vertex)
{
  if (!this->Surrounded.insert(vertex).second)
  {
    return false;
  }
  const auto& t = this->Chain.Parameters;
  const double h = 4.0 * this->Tolerance / std::max(this->Jump(vertex), 1e-300);
  if (!(h > LeastRounding))
  {
    const auto at = t.begin() + static_cast<std::ptrdiff_t>(vertex);
    this->Multiply(at, at);
    return true;
  }
  std::vector<double> knots{ t[vertex] };
  for (const double away : { -2.0, -1.0, 1.0, 2.0 })
  {
    const double room = away < 0.0 ? t[vertex] - t[vertex - 1] : t[vertex + 1] - t[vertex];
    if (2.0 * h < 0.45 * room)
    {
      knots.push_back(t[vertex] + away * h);
    }
  }
  bool isNew = false;
  for (const double knot : knots)
  {
    if (std::none_of(this->Knots.begin(), this->Knots.end(),
          [&](double other) { return std::abs(other - knot) < 0.25 * h; }))
    {
      this->Knots.push_back(knot);
      isNew = true;
    }
  }
  return isNew;
}
}
