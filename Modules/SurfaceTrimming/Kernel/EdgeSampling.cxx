// SPDX-License-Identifier: BSD-3-Clause
#include "EdgeSampling.h"

#include <knotwork/SplineCore/ChordalBound.h>

#include <cmath>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Bound over the spans that have inner points of an interval.
double Largest(const CurveBounds& bounds, double begin, double end)
{
  const auto& breaks = bounds.Breaks;
  const auto above = std::upper_bound(breaks.begin(), breaks.end(), begin);
  std::size_t span =
    above == breaks.begin() ? 0 : static_cast<std::size_t>(above - breaks.begin()) - 1;
  span = std::min(span, bounds.Second.size() - 1);
  double largest = bounds.Second[span];
  for (++span; span < bounds.Second.size() && breaks[span] < end; ++span)
  {
    largest = std::max(largest, bounds.Second[span]);
  }
  return largest;
}

/// Pieces of a section without creases with equal integrals of sqrt(second derivative), so that
/// each needs as much as the others.
Result<std::vector<double>> SpreadEvenly(const CurveBounds& bounds, std::size_t firstSpan,
  std::size_t lastSpan, double tolerance, int minPieces, std::size_t maxPieces)
{
  std::vector<double> need{ 0.0 }; // in pieces, up to the end of each span
  for (std::size_t s = firstSpan; s < lastSpan; ++s)
  {
    need.push_back(need.back() +
      std::sqrt(bounds.Second[s] / (8.0 * tolerance)) * (bounds.Breaks[s + 1] - bounds.Breaks[s]));
  }
  if (!(need.back() < static_cast<double>(maxPieces)))
  {
    return { ErrorCode::TooLarge, "more than " + std::to_string(maxPieces) + " pieces of a curve" };
  }
  const int pieces = std::max(minPieces, static_cast<int>(std::ceil(need.back())));
  const double begin = bounds.Breaks[firstSpan];
  const double end = bounds.Breaks[lastSpan];
  std::vector<double> parameters{ begin };
  std::size_t s = 0;
  for (int i = 1; i < pieces; ++i)
  {
    const double share = static_cast<double>(i) / pieces;
    double t = begin + share * (end - begin);
    if (need.back() > 0.0)
    {
      const double target = share * need.back();
      while (s + 2 < need.size() && need[s + 1] < target)
      {
        ++s;
      }
      const double length = bounds.Breaks[firstSpan + s + 1] - bounds.Breaks[firstSpan + s];
      t = bounds.Breaks[firstSpan + s] + length * (target - need[s]) / (need[s + 1] - need[s]);
    }
    if (t > parameters.back() && t < end)
    {
      parameters.push_back(t);
    }
  }
  parameters.push_back(end);
  return parameters;
}
}

CurveBounds CurveBounds::Of(const BezierForm<1>& curve)
{
  CurveBounds bounds;
  bounds.Breaks = curve.Space->Knots[0].Breaks();
  for (int e = 0; e < curve.Space->NumElements(); ++e)
  {
    const double length = bounds.Breaks[At(e + 1)] - bounds.Breaks[At(e)];
    const auto second = BoundSecondDerivatives<1>(
      curve.Space->Elements[At(e)].Degree, curve.NumComponents, curve.Rational, curve.Block(e));
    bounds.Second.push_back(second[0] / (length * length));
  }
  return bounds;
}

double CurveBounds::Deviation(double begin, double end) const
{
  return Largest(*this, begin, end) * (end - begin) * (end - begin) / 8.0;
}

void CurveBounds::Include(const CurveBounds& other)
{
  for (std::size_t s = 0; s < this->Second.size(); ++s)
  {
    this->Second[s] = std::max(this->Second[s], other.Second[s]);
  }
}

PlaneCurve::PlaneCurve(const Spline<1>& curve) : Form(MakeBezierForm(curve, 1))
{
  for (int d = 0; d < 2; ++d)
  {
    this->Bounds[At(d)] = CurveBounds::Of(
      MakeBezierForm(Spline<1>{ curve.Space, curve.ControlPoints.col(d), curve.Weights }, 1));
  }
}

std::array<double, 2> PlaneCurve::Deviation(double begin, double end) const
{
  return { this->Bounds[0].Deviation(begin, end), this->Bounds[1].Deviation(begin, end) };
}

CurveBounds BoundInSpace(const PlaneCurve& curve, const SurfaceCells& cells)
{
  CurveBounds bounds;
  bounds.Breaks = curve.Bounds[0].Breaks;
  for (int e = 0; e < curve.Form.Space->NumElements(); ++e)
  {
    // The control points' box has the span (convex hull).
    const int n = curve.Form.Space->Elements[At(e)].Degree[0] + 1;
    ParametricBox<2> box;
    for (int d = 0; d < 2; ++d)
    {
      const double* values = curve.Form.Block(e) + d * n;
      const double* weights = curve.Form.Block(e) + 2 * n;
      for (int i = 0; i < n; ++i)
      {
        const double x = curve.Form.Rational ? values[i] / weights[i] : values[i];
        box.Lower[At(d)] = i == 0 ? x : std::min(box.Lower[At(d)], x);
        box.Upper[At(d)] = i == 0 ? x : std::max(box.Upper[At(d)], x);
      }
    }
    const CellBounds surface = cells.Bound(box);
    bounds.Second.push_back(surface.First[0] * curve.Bounds[0].Second[At(e)] +
      surface.First[1] * curve.Bounds[1].Second[At(e)]);
  }
  return bounds;
}

PointMatrix EvaluateCurve(const BezierForm<1>& curve, const std::vector<double>& parameters)
{
  EvaluationBatch batch;
  const Eigen::Map<const PointMatrix> rows(
    parameters.data(), static_cast<Eigen::Index>(parameters.size()), 1);
  EvaluateParameters<1>(curve, rows, { 0, 1 }, batch);
  return batch.Values;
}

Result<std::vector<double>> SampleCurve(const KnotVector& knots, const CurveBounds& bounds,
  double tolerance, int minPieces, std::size_t maxPieces)
{
  std::vector<std::size_t> sections{ 0 }; // spans at which sections begin
  for (int b = 1; b < knots.NumElements(); ++b)
  {
    if (knots.Multiplicity(b) >= knots.Degree())
    {
      sections.push_back(At(b));
    }
  }
  sections.push_back(bounds.Second.size());
  const int numSections = static_cast<int>(sections.size()) - 1;
  std::vector<double> samples;
  for (int k = 0; k < numSections; ++k)
  {
    const auto section = SpreadEvenly(bounds, sections[At(k)], sections[At(k + 1)], tolerance,
      (minPieces + numSections - 1) / numSections, maxPieces);
    if (!section)
    {
      return section.Status;
    }
    // Spans with unequal needs may share a piece: halve it.
    std::vector<double> ends(section.Value.rbegin(), section.Value.rend());
    double begin = ends.back();
    ends.pop_back();
    while (!ends.empty())
    {
      const double middle = 0.5 * (begin + ends.back());
      if (bounds.Deviation(begin, ends.back()) > (1.0 + 1e-9) * tolerance &&
        samples.size() < maxPieces && begin < middle && middle < ends.back())
      {
        ends.push_back(middle);
        continue;
      }
      samples.push_back(begin);
      begin = ends.back();
      ends.pop_back();
    }
  }
  samples.push_back(knots.End());
  return samples;
}
}
