// SPDX-License-Identifier: BSD-3-Clause
#include "ChainFit.h"

#include <knotwork/SplineCore/BasisEvaluation.h>
#include <knotwork/SplineCore/Bernstein.h>
#include <knotwork/SplineCore/Quadrature.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <set>

namespace knotwork
{
namespace
{
constexpr int Degree = 3;
constexpr int MaxRounds = 60;
/// From then on, and when there are many, knots become multiple where the tolerance does not hold.
constexpr int Patience = 40;
constexpr int MaxCurveRounds = 30;
constexpr int MaxDepth = 40;
/// Spans of a length that rounding does not spoil.
constexpr double LeastSpan = 1e-9;
/// Corners that would have to be rounded within less stay corners.
constexpr double LeastRounding = 1e-7;

/// A cubic in Bernstein form, a coefficient a row.
using Cubic = Eigen::Matrix<double, Degree + 1, Eigen::Dynamic, Eigen::RowMajor>;
using PlaneCubic = Eigen::Matrix<double, Degree + 1, 2, Eigen::RowMajor>;

template <typename Matrix>
std::array<Matrix, 2> Halve(const Matrix& whole)
{
  std::array<Matrix, 2> halves{ whole, whole };
  const int columns = static_cast<int>(whole.cols());
  for (int c = 0; c < columns; ++c)
  {
    HalveBernstein(Degree, halves[1].data() + c, halves[0].data() + c, columns);
  }
  return halves;
}

/// A part of a knot span without a corner of the boundary inside.
struct CurvePiece
{
  int Segment = 0;
  int Span = 0;
  double Begin = 0.0;
  double End = 0.0;
  Cubic Curve;
};

std::vector<CurvePiece> CutAtCorners(const Spline<1>& curve, const std::vector<double>& corners)
{
  const BezierForm<1> form = MakeBezierForm(curve, 1);
  std::vector<CurvePiece> pieces;
  int segment = 0;
  const int columns = curve.NumComponents();
  for (int e = 0; e < form.Space->NumElements(); ++e)
  {
    const auto& box = form.Space->Elements[static_cast<std::size_t>(e)].Box;
    const double begin = box.Lower[0];
    const double end = box.Upper[0];
    double at = begin;
    while (at < end)
    {
      while (corners[static_cast<std::size_t>(segment) + 1] <= at)
      {
        ++segment;
      }
      CurvePiece piece;
      piece.Segment = segment;
      piece.Span = e;
      piece.Begin = at;
      piece.End = std::min(end, corners[static_cast<std::size_t>(segment) + 1]);
      piece.Curve.resize(Degree + 1, columns);
      for (int c = 0; c < columns; ++c)
      {
        const double* block = form.Block(e) + c * (Degree + 1);
        const auto part =
          BernsteinRestrict<1>({ Degree }, std::vector<double>(block, block + Degree + 1), 0,
            (piece.Begin - begin) / (end - begin), (piece.End - begin) / (end - begin));
        for (int i = 0; i <= Degree; ++i)
        {
          piece.Curve(i, c) = part[static_cast<std::size_t>(i)];
        }
      }
      at = piece.End;
      pieces.push_back(std::move(piece));
    }
  }
  return pieces;
}

Eigen::RowVectorXd PointAt(
  const std::vector<double>& parameters, const PointMatrix& points, int segment, double t)
{
  const double a = parameters[static_cast<std::size_t>(segment)];
  const double b = parameters[static_cast<std::size_t>(segment) + 1];
  const double s = (t - a) / (b - a);
  return (1.0 - s) * points.row(segment) + s * points.row(segment + 1);
}

/// Curve minus polyline on a piece.
Cubic Difference(
  const CurvePiece& piece, const std::vector<double>& parameters, const PointMatrix& points)
{
  Cubic difference = piece.Curve;
  const Eigen::RowVectorXd begin = PointAt(parameters, points, piece.Segment, piece.Begin);
  const Eigen::RowVectorXd end = PointAt(parameters, points, piece.Segment, piece.End);
  for (int i = 0; i <= Degree; ++i)
  {
    const double s = static_cast<double>(i) / Degree;
    difference.row(i) -= (1.0 - s) * begin + s * end;
  }
  return difference;
}

/// @param knots  inner ones, ascending.
Result<SplineSpacePtr<1>> MakeSpace(const std::vector<double>& knots)
{
  std::vector<double> all(Degree + 1, 0.0);
  all.insert(all.end(), knots.begin(), knots.end());
  all.insert(all.end(), Degree + 1, 1.0);
  auto vector = KnotVector::Create(Degree, std::move(all));
  if (!vector)
  {
    return vector.Status;
  }
  return MakeTensorSpace<1>({ std::move(vector.Value) });
}

/// Values at Gauss points of parts of the spans, and their weights.
struct Samples
{
  PointMatrix Parameters; ///< n x 1
  Eigen::VectorXd Weights;
  PointMatrix Values;
};

/// Least squares control points, the first and last one given.
Result<PointMatrix> ProjectOnto(const SplineSpace<1>& space, const Samples& samples,
  const Eigen::RowVectorXd& first, const Eigen::RowVectorXd& last)
{
  auto basis = CollocationMatrix<1>(space, samples.Parameters, 1);
  if (!basis)
  {
    return basis.Status;
  }
  const Eigen::Index n = space.NumFunctions;
  PointMatrix points(n, samples.Values.cols());
  points.row(0) = first;
  points.row(n - 1) = last;
  const Eigen::SparseMatrix<double> columns = basis.Value;
  const Eigen::SparseMatrix<double> inner = columns.middleCols(1, n - 2);
  const PointMatrix rest = samples.Values - columns.col(0) * first - columns.col(n - 1) * last;
  const Eigen::SparseMatrix<double> weighted = inner.transpose() * samples.Weights.asDiagonal();
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower,
    Eigen::NaturalOrdering<int>>
    solver(weighted * inner);
  if (solver.info() != Eigen::Success)
  {
    return { ErrorCode::SingularSystem, "least squares of a boundary curve" };
  }
  const Eigen::MatrixXd right = weighted * rest;
  points.middleRows(1, n - 2) = solver.solve(right);
  return points;
}

void AppendGauss(double begin, double end, std::vector<double>& t, std::vector<double>& weights)
{
  static const QuadratureRule rule = GaussLegendre(Degree + 1);
  for (std::size_t q = 0; q < rule.Nodes.size(); ++q)
  {
    t.push_back(begin + (end - begin) * rule.Nodes[q]);
    weights.push_back((end - begin) * rule.Weights[q]);
  }
}

// ---- pcurves ---------------------------------------------------------------------------------

class ParameterFit
{
public:
  ParameterFit(
    const ChainPolyline& chain, const std::vector<const SurfaceBounds*>& surfaces, double tolerance)
    : Chain(chain), Surfaces(surfaces), Tolerance(tolerance)
  {
  }

  Result<Spline<1>> Run()
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

  double Distance = 0.0;

private:
  int NumUses() const { return static_cast<int>(this->Surfaces.size()); }

  Result<Spline<1>> Fit() const
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
    auto points =
      ProjectOnto(*space.Value, samples, this->Chain.UV.row(0), this->Chain.UV.row(last));
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

  /// Of |S(lambda) - S(pi)|: the surface's derivatives on the way times the way.
  double Bound(const CurvePiece& piece) const
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
  double Bound(const SurfaceBounds& surface, const PlaneCubic& curve, const PlaneCubic& difference,
    int depth) const
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

  /// Change of a polyline's velocity at a vertex, in space.
  double Jump(std::size_t vertex) const
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

  std::size_t MaxKnots() const { return 24 * this->Chain.Parameters.size() + 200; }

  /// A corner of the curve at every corner of the boundary, and nothing else. @return false when
  /// that has been tried.
  bool FollowExactly()
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

  /// Inner corners of the boundary from a to b become corners of the curve.
  void Multiply(std::vector<double>::const_iterator a, std::vector<double>::const_iterator b)
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

  void Refine(double begin, double end, bool multiply)
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

  /// A knot at the corner that is next to the middle of the span, if any is near.
  void InsertBetween(double begin, double end, std::vector<double>::const_iterator first,
    std::vector<double>::const_iterator last)
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

  /// Knots around a corner, once. A cubic spline over knots with distance h rounds a corner off by
  /// h / 6 of the jump of the velocity there, within 2 h.
  bool Surround(std::size_t vertex)
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

  const ChainPolyline& Chain;
  const std::vector<const SurfaceBounds*>& Surfaces;
  double Tolerance;
  std::vector<double> Knots;
  std::set<std::size_t> Surrounded;
  bool IsExact = false;
};

// ---- curve in space --------------------------------------------------------------------------

class SpaceFit
{
public:
  SpaceFit(const std::vector<const SurfaceBounds*>& surfaces, const ChainFitParams& params)
    : Surfaces(surfaces), Params(params)
  {
  }

  /// Both curves side by side: x, y, z, then UV.
  Result<Spline<1>> Run(const Spline<1>& pcurves)
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

  /// Bound of |C - S(lambda)| over all uses.
  Result<double> BoundGap(const Spline<1>& curve) const
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

private:
  struct SpanPart
  {
    int Span = 0;
    double Begin = 0.0;
    double End = 0.0;
  };
  /// Spans in equal parts, about one an element of a surface on the way.
  std::vector<SpanPart> CutSpans(const Spline<1>& pcurves) const
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

  /// Points of a surface at parameters that rounding may have moved out of the domain.
  static Status Evaluate(const SurfaceBounds& surface, PointMatrix uv, PointMatrix& values)
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

  /// What the curve in space follows: the mean of the surfaces, led to the vertices.
  Status Target(const Spline<1>& pcurves, const PointMatrix& t, PointMatrix& values) const
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

  Result<Spline<1>> Fit(const Spline<1>& pcurves) const
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

  /// Middles of spans in which the curve is too far from its target.
  Status FindFar(const Spline<1>& curve, const Spline<1>& pcurves, std::vector<double>& knots) const
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

  /// A part of the curve: x, y, z, u, v, with the gap at its ends.
  struct GapPiece
  {
    Cubic Curve;
    std::array<double, 2> Ends{};
    int Depth = 0;
  };

  /// Linear interpolation of E = C - S(lambda) is off by at most |E''| / 8 on a piece, and where
  /// derivatives of S jump by |E'| / 2.
  static bool BoundPiece(const SurfaceBounds& surface, const GapPiece& piece, double& bound)
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

  /// Gaps at the end of each piece.
  static Status MeasureEnds(
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

  Result<double> BoundGap(const Spline<1>& curve, std::size_t use) const
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

  const std::vector<const SurfaceBounds*>& Surfaces;
  const ChainFitParams& Params;
};
}

ChainPolyline MakeChainPolyline(const PointMatrix& points, const std::vector<PointMatrix>& uv)
{
  ChainPolyline chain;
  chain.Points = points;
  const Eigen::Index n = points.rows();
  chain.UV.resize(n, 2 * static_cast<Eigen::Index>(uv.size()));
  for (std::size_t k = 0; k < uv.size(); ++k)
  {
    chain.UV.middleCols(2 * static_cast<Eigen::Index>(k), 2) = uv[k];
  }
  chain.Parameters.assign(1, 0.0);
  for (Eigen::Index i = 1; i < n; ++i)
  {
    double length = 0.0;
    for (const PointMatrix& plane : uv)
    {
      length += (plane.row(i) - plane.row(i - 1)).norm();
    }
    chain.Parameters.push_back(chain.Parameters.back() + length);
  }
  const double total = chain.Parameters.back();
  for (double& t : chain.Parameters)
  {
    t /= total;
  }
  return chain;
}

Result<FittedChain> FitChain(const ChainPolyline& chain,
  const std::vector<const SurfaceBounds*>& surfaces, const ChainFitParams& params)
{
  ParameterFit parameterFit(chain, surfaces, params.Tolerance);
  auto pcurves = parameterFit.Run();
  if (!pcurves)
  {
    return pcurves.Status;
  }
  SpaceFit spaceFit(surfaces, params);
  auto both = spaceFit.Run(pcurves.Value);
  if (!both)
  {
    return both.Status;
  }
  auto gap = spaceFit.BoundGap(both.Value);
  if (!gap)
  {
    return gap.Status;
  }
  FittedChain fitted;
  fitted.TrimDistance = parameterFit.Distance;
  fitted.EdgeGap = gap.Value;
  fitted.Curve = { both->Space, both->ControlPoints.leftCols(3), {} };
  fitted.UV = both->ControlPoints.rightCols(both->ControlPoints.cols() - 3);
  for (const CurvePiece& piece : CutAtCorners(fitted.Curve, chain.Parameters))
  {
    const Cubic difference = Difference(piece, chain.Parameters, chain.Points);
    fitted.BoundaryDistance =
      std::max(fitted.BoundaryDistance, difference.rowwise().norm().maxCoeff());
  }
  return fitted;
}
}
