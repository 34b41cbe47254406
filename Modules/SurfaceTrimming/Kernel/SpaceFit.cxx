// SPDX-License-Identifier: BSD-3-Clause
#include "SpaceFit.h"

#include <knotwork/SplineCore/TensorSpace.h>

#include <algorithm>
#include <cmath>

namespace knotwork::chains
{
namespace
{
constexpr int MaxCurveRounds = 30;
}

Result<Spline<1>> SpaceFit::Run(const Spline<1>& pcurves)
{
  Spline<1> uv = pcurves;
  for (int round = 0;; ++round)
  {
    auto curve = this->Fit(uv);
    if (!curve)
    {
      return curve;
    }
    std::vector<double> knots;
    if (Status status = this->FindFar(curve.Value, uv, knots); !status)
    {
      return status;
    }
    if (knots.empty() || round >= MaxCurveRounds)
    {
      PointMatrix all(uv.ControlPoints.rows(), 3 + uv.ControlPoints.cols());
      all << curve->ControlPoints, uv.ControlPoints;
      return Spline<1>{ uv.Space, std::move(all), {} };
    }
    auto refined = InsertKnots<1>(uv, 0, knots);
    if (!refined)
    {
      return refined;
    }
    // rounding of the insertion must not move the ends or leave the domain
    const Eigen::Index last = refined->ControlPoints.rows() - 1;
    refined->ControlPoints.row(0) = uv.ControlPoints.row(0);
    refined->ControlPoints.row(last) = uv.ControlPoints.row(uv.ControlPoints.rows() - 1);
    uv = std::move(refined.Value);
  }
}

Result<double> SpaceFit::BoundGap(const Spline<1>& curve) const
{
  double bound = 0.0;
  for (std::size_t k = 0; k < this->Surfaces.size(); ++k)
  {
    auto gap = this->BoundGap(curve, k);
    if (!gap)
    {
      return gap;
    }
    bound = std::max(bound, gap.Value);
  }
  return bound;
}

std::vector<SpaceFit::SpanPart> SpaceFit::CutSpans(const Spline<1>& pcurves) const
{
  std::vector<SpanPart> parts;
  for (const CurvePiece& span : CutAtCorners(pcurves, { 0.0, 1.0 }))
  {
    int count = 1;
    for (std::size_t k = 0; k < this->Surfaces.size(); ++k)
    {
      ParametricBox<2> box;
      for (std::size_t d = 0; d < 2; ++d)
      {
        const auto column = span.Curve.col(static_cast<Eigen::Index>(2 * k + d));
        box.Lower[d] = column.minCoeff();
        box.Upper[d] = column.maxCoeff();
      }
      count = std::max(count, this->Surfaces[k]->ElementsAcross(box));
    }
    for (int i = 0; i < count; ++i)
    {
      const auto at = [&](int n)
      { return span.Begin + (span.End - span.Begin) * static_cast<double>(n) / count; };
      parts.push_back({ span.Span, at(i), i + 1 == count ? span.End : at(i + 1) });
    }
  }
  return parts;
}

Status SpaceFit::Evaluate(const SurfaceBounds& surface, PointMatrix uv, PointMatrix& values)
{
  for (int d = 0; d < 2; ++d)
  {
    const std::size_t at = static_cast<std::size_t>(d);
    auto column = uv.col(d).array();
    column = column.max(surface.Domain().Lower[at]).min(surface.Domain().Upper[at]);
  }
  EvaluationParams params;
  params.Threads = 1;
  EvaluationBatch batch;
  Status status = EvaluateParameters<2>(surface.Form(), uv, params, batch);
  values = std::move(batch.Values);
  return status;
}

Status SpaceFit::Target(const Spline<1>& pcurves, const PointMatrix& t, PointMatrix& values) const
{
  const Eigen::Index n = t.rows();
  PointMatrix parameters(n + 2, 1);
  parameters << t, 0.0, 1.0;
  EvaluationParams params;
  params.Threads = 1;
  EvaluationBatch batch;
  Status status = EvaluateParameters<1>(MakeBezierForm(pcurves, 1), parameters, params, batch);
  PointMatrix sum = PointMatrix::Zero(n + 2, 3);
  for (std::size_t k = 0; status && k < this->Surfaces.size(); ++k)
  {
    PointMatrix points;
    status = Evaluate(
      *this->Surfaces[k], batch.Values.middleCols(2 * static_cast<Eigen::Index>(k), 2), points);
    sum += points;
  }
  sum /= static_cast<double>(this->Surfaces.size());
  const Eigen::RowVector3d first = this->Params.Ends[0] - sum.row(n);
  const Eigen::RowVector3d last = this->Params.Ends[1] - sum.row(n + 1);
  values = sum.topRows(n);
  values += (1.0 - t.col(0).array()).matrix() * first + t.col(0) * last;
  return status;
}

Result<Spline<1>> SpaceFit::Fit(const Spline<1>& pcurves) const
{
  std::vector<double> t;
  std::vector<double> weights;
  for (const SpanPart& part : this->CutSpans(pcurves))
  {
    AppendGauss(part.Begin, part.End, t, weights);
  }
  Samples samples;
  const Eigen::Index n = static_cast<Eigen::Index>(t.size());
  samples.Parameters = Eigen::Map<const Eigen::VectorXd>(t.data(), n);
  samples.Weights = Eigen::Map<const Eigen::VectorXd>(weights.data(), n);
  if (Status status = this->Target(pcurves, samples.Parameters, samples.Values); !status)
  {
    return status;
  }
  auto points = ProjectOnto(*pcurves.Space, samples, this->Params.Ends[0], this->Params.Ends[1]);
  if (!points)
  {
    return points.Status;
  }
  return Spline<1>{ pcurves.Space, std::move(points.Value), {} };
}

Status SpaceFit::FindFar(
  const Spline<1>& curve, const Spline<1>& pcurves, std::vector<double>& knots) const
{
  // ends too: errors of least squares are largest there
  constexpr int each = 9;
  const std::vector<SpanPart> parts = this->CutSpans(pcurves);
  PointMatrix t(static_cast<Eigen::Index>(each * parts.size()), 1);
  for (Eigen::Index i = 0; i < t.rows(); ++i)
  {
    const SpanPart& part = parts[static_cast<std::size_t>(i / each)];
    const double s = static_cast<double>(i % each) / (each - 1);
    t(i, 0) = (1.0 - s) * part.Begin + s * part.End;
  }
  PointMatrix target;
  EvaluationParams params;
  params.Threads = 1;
  EvaluationBatch batch;
  Status status = EvaluateParameters<1>(MakeBezierForm(curve, 1), t, params, batch);
  if (status)
  {
    status = this->Target(pcurves, t, target);
  }
  if (!status)
  {
    return status;
  }
  const Eigen::VectorXd far = (batch.Values - target).rowwise().norm();
  const std::vector<double>& breaks = curve.Space->Knots[0].Breaks();
  std::vector<double> most(breaks.size() - 1, 0.0);
  for (std::size_t p = 0; p < parts.size(); ++p)
  {
    double& here = most[static_cast<std::size_t>(parts[p].Span)];
    here = std::max(here, far.segment(static_cast<Eigen::Index>(p) * each, each).maxCoeff());
  }
  for (std::size_t e = 0; e < most.size(); ++e)
  {
    // samples miss a little of the largest distance
    if (most[e] > 0.8 * this->Params.CurveTolerance && breaks[e + 1] - breaks[e] > LeastSpan)
    {
      knots.push_back(0.5 * (breaks[e] + breaks[e + 1]));
    }
  }
  return {};
}

bool SpaceFit::BoundPiece(const SurfaceBounds& surface, const GapPiece& piece, double& bound)
{
  double first[3] = {};
  double second[3] = {};
  ParametricBox<2> box;
  const auto rows = [&](int i, int begin, int count)
  { return piece.Curve.row(i).segment(begin, count); };
  for (int d = 0; d < 3; ++d)
  {
    const int begin = d == 0 ? 0 : d + 2;
    const int count = d == 0 ? 3 : 1;
    for (int i = 0; i < Degree; ++i)
    {
      first[d] =
        std::max(first[d], Degree * (rows(i + 1, begin, count) - rows(i, begin, count)).norm());
    }
    for (int i = 0; i + 1 < Degree; ++i)
    {
      second[d] = std::max(second[d],
        Degree * (Degree - 1) *
          (rows(i + 2, begin, count) - 2.0 * rows(i + 1, begin, count) + rows(i, begin, count))
            .norm());
    }
    if (d > 0)
    {
      const std::size_t at = static_cast<std::size_t>(d - 1);
      box.Lower[at] = piece.Curve.col(begin).minCoeff();
      box.Upper[at] = piece.Curve.col(begin).maxCoeff();
    }
  }
  DerivativeBounds s;
  const bool isLocal = surface.Over(box, s);
  const double ends = std::max(piece.Ends[0], piece.Ends[1]);
  bound = s.IsSmooth ? ends +
      (second[0] + s.UU * first[1] * first[1] + 2.0 * s.UV * first[1] * first[2] +
        s.VV * first[2] * first[2] + s.U * second[1] + s.V * second[2]) /
        8.0
                     : ends + 0.5 * (first[0] + s.U * first[1] + s.V * first[2]);
  return isLocal;
}

Status SpaceFit::MeasureEnds(
  const SurfaceBounds& surface, const std::vector<GapPiece>& pieces, std::vector<double>& gaps)
{
  PointMatrix uv(static_cast<Eigen::Index>(pieces.size()), 2);
  for (std::size_t i = 0; i < pieces.size(); ++i)
  {
    uv.row(static_cast<Eigen::Index>(i)) = pieces[i].Curve.row(Degree).tail(2);
  }
  PointMatrix points;
  Status status = Evaluate(surface, uv, points);
  gaps.clear();
  for (std::size_t i = 0; status && i < pieces.size(); ++i)
  {
    gaps.push_back(
      (pieces[i].Curve.row(Degree).head(3) - points.row(static_cast<Eigen::Index>(i))).norm());
  }
  return status;
}

Result<double> SpaceFit::BoundGap(const Spline<1>& curve, std::size_t use) const
{
  const SurfaceBounds& surface = *this->Surfaces[use];
  std::vector<GapPiece> open;
  for (const CurvePiece& span : CutAtCorners(curve, { 0.0, 1.0 }))
  {
    GapPiece piece;
    piece.Curve.resize(Degree + 1, 5);
    piece.Curve << span.Curve.leftCols(3),
      span.Curve.middleCols(3 + 2 * static_cast<Eigen::Index>(use), 2);
    open.push_back(std::move(piece));
  }
  // halves of a point: its gap is that of the curve's begin
  GapPiece begin;
  begin.Curve = open.front().Curve.row(0).replicate(Degree + 1, 1);
  std::vector<double> gaps;
  if (Status status = MeasureEnds(surface, { begin }, gaps); !status)
  {
    return status;
  }
  double found = gaps[0];
  double last = gaps[0];
  if (Status status = MeasureEnds(surface, open, gaps); !status)
  {
    return status;
  }
  for (std::size_t i = 0; i < open.size(); ++i)
  {
    open[i].Ends = { last, gaps[i] };
    last = gaps[i];
    found = std::max(found, last);
  }
  double largest = found;
  while (!open.empty())
  {
    std::vector<GapPiece> halves;
    for (const GapPiece& piece : open)
    {
      double bound = 0.0;
      const bool isLocal = BoundPiece(surface, piece, bound);
      if (bound <= std::max(0.1 * this->Params.CurveTolerance, 1.05 * found) ||
        (isLocal && piece.Depth >= MaxDepth))
      {
        largest = std::max(largest, bound);
        continue;
      }
      auto curves = Halve(piece.Curve);
      halves.push_back({ std::move(curves[0]), { piece.Ends[0], 0.0 }, piece.Depth + 1 });
      halves.push_back({ std::move(curves[1]), { 0.0, piece.Ends[1] }, piece.Depth + 1 });
    }
    std::vector<GapPiece> firsts;
    for (std::size_t i = 0; i < halves.size(); i += 2)
    {
      firsts.push_back(halves[i]);
    }
    if (Status status = MeasureEnds(surface, firsts, gaps); !status)
    {
      return status;
    }
    for (std::size_t i = 0; i < gaps.size(); ++i)
    {
      halves[2 * i].Ends[1] = halves[2 * i + 1].Ends[0] = gaps[i];
      found = std::max(found, gaps[i]);
    }
    open = std::move(halves);
  }
  return largest;
}
}
