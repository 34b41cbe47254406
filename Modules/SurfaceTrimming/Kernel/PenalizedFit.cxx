// SPDX-License-Identifier: BSD-3-Clause
#include "PenalizedFit.h"
#include "PenalizedSystem.h"
#include "TensorSpace.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace knotwork
{
namespace
{
/// Spans of the longer side that a net by need begins with; BackMapParams::Smoothing is that of
/// such a net.
constexpr int FirstElements = 8;
constexpr int MaxPasses = 24;
/// Spans are halved for points beyond this part of the tolerance.
constexpr double Goal = 0.7;
/// The same once far points weigh more: then most are near the tolerance.
constexpr double ReweightedGoal = 0.95;
/// What is within this part of the tolerance can be proved to be within it cheaply.
constexpr double ProofShare = 0.95;
/// A direction is refined where the surface bends in it at least so much of the most.
constexpr double BendingShare = 0.25;
/// Least weight of the thin-plate energy, by the fourth power of the longest side: Cholesky's
/// rounding grows with its inverse.
constexpr double LeastSmoothing = 1e-17;
/// Weight of the length of bilinear splines, by the square of the longest side: their folds along
/// knots are not seen by the thin-plate energy.
constexpr double BilinearStretching = 1e-13;
constexpr int MaxAttempts = 5;
/// Far points get more weight when none is farther than so many tolerances, so many times.
constexpr double ReweightReach = 5.0;
constexpr int MaxReweightings = 4;
/// Less progress than this ends it.
constexpr double LeastProgress = 0.9;
constexpr double SampleShare = 0.05;
constexpr double MostGain = 30.0;
constexpr int MaxFunctions = 1500000;

double LongestSide(const NetKnots& knots)
{
  return std::max(knots[0].End() - knots[0].Begin(), knots[1].End() - knots[1].Begin());
}

/// Clamped knots on given breaks.
KnotVector KnotsOfBreaks(int degree, const std::vector<double>& breaks)
{
  std::vector<double> knots(static_cast<std::size_t>(degree), breaks.front());
  knots.insert(knots.end(), breaks.begin(), breaks.end());
  knots.insert(knots.end(), static_cast<std::size_t>(degree), breaks.back());
  return KnotVector::Create(degree, std::move(knots)).Value;
}

/// Spans of a direction that are to be halved, the worst ones first when not all may.
KnotVector Halved(
  const KnotVector& knots, const std::vector<double>& need, int maxElements, double shortest)
{
  const std::vector<double>& breaks = knots.Breaks();
  std::vector<int> chosen;
  for (int e = 0; e < knots.NumElements(); ++e)
  {
    const auto i = static_cast<std::size_t>(e);
    if (need[i] > 0.0 && breaks[i + 1] - breaks[i] > shortest)
    {
      chosen.push_back(e);
    }
  }
  std::stable_sort(chosen.begin(), chosen.end(),
    [&](int a, int b)
    { return need[static_cast<std::size_t>(a)] > need[static_cast<std::size_t>(b)]; });
  const int room = std::max(0, maxElements - knots.NumElements());
  chosen.resize(std::min(chosen.size(), static_cast<std::size_t>(room)));
  std::vector<double> finer = breaks;
  for (int e : chosen)
  {
    const auto i = static_cast<std::size_t>(e);
    finer.push_back(0.5 * (breaks[i] + breaks[i + 1]));
  }
  std::sort(finer.begin(), finer.end());
  return KnotsOfBreaks(knots.Degree(), finer);
}

/// The net with spans halved that hold points beyond the goal; the same net when there are none, or
/// none may be halved.
NetKnots RefinedNet(const NetKnots& knots, const BezierForm<2>& surface,
  const ChartSamples& samples, const BackMapResiduals& residuals, const BackMapParams& params)
{
  const bool reweighted = residuals.Max <= ReweightReach * params.Tolerance;
  const double goal = (reweighted ? ReweightedGoal : Goal) * params.Tolerance;
  std::vector<Eigen::Index> far;
  for (Eigen::Index i = 0; i < residuals.Distances.size(); ++i)
  {
    if (residuals.Distances[i] > goal)
    {
      far.push_back(i);
    }
  }
  PointMatrix parameters(static_cast<Eigen::Index>(far.size()), 2);
  for (std::size_t k = 0; k < far.size(); ++k)
  {
    parameters.row(static_cast<Eigen::Index>(k)) = samples.Parameters.row(far[k]);
  }
  EvaluationParams evaluation;
  evaluation.Derivatives = 2;
  evaluation.Threads = params.Threads;
  EvaluationBatch batch;
  EvaluateParameters<2>(surface, parameters, evaluation, batch);

  std::array<std::vector<double>, 2> need;
  for (std::size_t d = 0; d < 2; ++d)
  {
    need[d].assign(static_cast<std::size_t>(knots[d].NumElements()), 0.0);
  }
  for (std::size_t k = 0; k < far.size(); ++k)
  {
    std::array<std::size_t, 2> element{};
    std::array<double, 2> span{};
    for (std::size_t d = 0; d < 2; ++d)
    {
      const auto row = static_cast<Eigen::Index>(k);
      element[d] = static_cast<std::size_t>(
        knots[d].FindElement(parameters(row, static_cast<Eigen::Index>(d))));
      span[d] = knots[d].Breaks()[element[d] + 1] - knots[d].Breaks()[element[d]];
    }
    const auto second = batch.Second.row(static_cast<Eigen::Index>(k));
    const std::array<double, 2> bending{ span[0] * span[0] * second.segment<3>(0).norm(),
      span[1] * span[1] * second.segment<3>(6).norm() };
    const double twist = span[0] * span[1] * second.segment<3>(3).norm();
    const double least = BendingShare * std::max(bending[0], bending[1]);
    for (std::size_t d = 0; d < 2; ++d)
    {
      if (bending[d] >= least || twist >= bending[1 - d])
      {
        need[d][element[d]] = std::max(need[d][element[d]], residuals.Distances[far[k]]);
      }
    }
  }
  const double shortest = LongestSide(knots) / (8.0 * params.MaxElements);
  return { Halved(knots[0], need[0], params.MaxElements, shortest),
    Halved(knots[1], need[1], params.MaxElements, shortest) };
}

double SmoothingOf(const NetKnots& knots, const BackMapParams& params)
{
  const double longest = LongestSide(knots);
  return std::max(params.Smoothing * std::pow(FirstElements * SmallestSpan(knots), 4.0),
    LeastSmoothing * std::pow(longest, 4.0));
}

/// A net with its samples and equations.
struct NetFit
{
  SplineSpacePtr<2> Space;
  ChartSamples Samples;
  std::unique_ptr<PenalizedSystem> System;
};

/// Control points of a net; where rounding makes the system singular, with more smoothing.
Result<PointMatrix> FirstSolution(NetFit& net, const BackMapParams& params)
{
  const double longest = LongestSide(net.Space->Knots);
  const double stretching = params.Degree == 1 ? BilinearStretching * longest * longest : 0.0;
  double smoothing = SmoothingOf(net.Space->Knots, params);
  Result<PointMatrix> solution;
  for (int attempt = 0; attempt < MaxAttempts; ++attempt, smoothing *= 100.0)
  {
    net.System =
      std::make_unique<PenalizedSystem>(net.Space, smoothing, stretching, params.Threads);
    solution = net.System->Solve(net.Samples, net.Samples.Weights);
    if (solution || solution.Status.Code != ErrorCode::SingularSystem)
    {
      break;
    }
  }
  return solution;
}

/// What a sample weighs at least once it counts: a part of the spans around it.
double LeastWeight(const NetKnots& knots, const Eigen::RowVector2d& parameter)
{
  double weight = SampleShare;
  for (std::size_t d = 0; d < 2; ++d)
  {
    const auto e =
      static_cast<std::size_t>(knots[d].FindElement(parameter[static_cast<Eigen::Index>(d)]));
    weight *= knots[d].Breaks()[e + 1] - knots[d].Breaks()[e];
  }
  return weight;
}

void SetSurface(BackMap& map, const SplineSpacePtr<2>& space, PointMatrix control,
  const BackMapResiduals& residuals)
{
  map.Surface.Space = space;
  map.Surface.ControlPoints = std::move(control);
  map.MaxResidual = residuals.Max;
  map.RmsResidual = residuals.Rms;
}

/// Least squares on a net.
Status FitNet(const ChartMesh& chart, const std::vector<std::array<int, 2>>& boundary,
  const NetKnots& knots, const BackMapParams& params, NetFit& net, BackMap& map,
  BackMapResiduals& residuals)
{
  if (static_cast<double>(knots[0].NumFunctions()) * knots[1].NumFunctions() > MaxFunctions)
  {
    return { ErrorCode::TooLarge,
      "a net of " + std::to_string(knots[0].NumFunctions()) + " x " +
        std::to_string(knots[1].NumFunctions()) + " control points; ask for fewer spans" };
  }
  const auto space = MakeTensorSpace<2>(knots);
  if (!space)
  {
    return space.Status;
  }
  net.Space = space.Value;
  net.Samples = SampleChart(chart, boundary, knots, params.Threads);
  Result<PointMatrix> control = FirstSolution(net, params);
  if (!control)
  {
    return control.Status;
  }
  Spline<2> surface;
  surface.Space = net.Space;
  surface.ControlPoints = control.Value;
  residuals = MeasureBackMap(MakeBezierForm(surface, params.Threads), net.Samples, params.Threads);
  SetSurface(map, net.Space, std::move(control.Value), residuals);
  ++map.Passes;
  return {};
}

/// Makes points that are far weigh more, until all are within the tolerance or it no longer helps:
/// at sharp edges and tips least squares leave more than the space can do.
void Reweight(NetFit& net, const BackMapParams& params, BackMap& map, BackMapResiduals& residuals)
{
  Eigen::VectorXd weights = net.Samples.Weights;
  BackMapResiduals last = residuals;
  for (int k = 0; k < MaxReweightings && residuals.Max > params.Tolerance; ++k)
  {
    for (Eigen::Index i = 0; i < weights.size(); ++i)
    {
      const double ratio = last.Distances[i] / (Goal * params.Tolerance);
      if (ratio > 1.0)
      {
        weights[i] =
          std::max(weights[i], LeastWeight(net.Space->Knots, net.Samples.Parameters.row(i))) *
          std::min(ratio * ratio, MostGain);
      }
    }
    Result<PointMatrix> control = net.System->Solve(net.Samples, weights);
    if (!control)
    {
      return;
    }
    Spline<2> surface;
    surface.Space = net.Space;
    surface.ControlPoints = control.Value;
    last = MeasureBackMap(MakeBezierForm(surface, params.Threads), net.Samples, params.Threads);
    const double before = residuals.Max;
    if (last.Max < before)
    {
      residuals = last;
      SetSurface(map, net.Space, std::move(control.Value), residuals);
    }
    if (last.Max > LeastProgress * before)
    {
      return;
    }
  }
}
}

ParametricBox<2> BackMapRectangle(const ChartMesh& chart, double margin)
{
  const Eigen::RowVector2d lower = chart.UV.colwise().minCoeff();
  const Eigen::RowVector2d upper = chart.UV.colwise().maxCoeff();
  const double wider = margin * (upper - lower).maxCoeff();
  ParametricBox<2> box;
  for (int d = 0; d < 2; ++d)
  {
    box.Lower[static_cast<std::size_t>(d)] = lower[d] - wider;
    box.Upper[static_cast<std::size_t>(d)] = upper[d] + wider;
  }
  return box;
}

NetKnots UniformNet(const ParametricBox<2>& rectangle, int degree, int elements)
{
  const double width = rectangle.Upper[0] - rectangle.Lower[0];
  const double height = rectangle.Upper[1] - rectangle.Lower[1];
  const double span = std::max(width, height) / elements;
  NetKnots knots;
  for (std::size_t d = 0; d < 2; ++d)
  {
    const double side = d == 0 ? width : height;
    knots[d] = KnotVector::Uniform(degree, std::max(1, static_cast<int>(std::lround(side / span))),
      rectangle.Lower[d], rectangle.Upper[d]);
  }
  return knots;
}

BackMapResiduals MeasureBackMap(
  const BezierForm<2>& surface, const ChartSamples& samples, int threads)
{
  EvaluationParams evaluation;
  evaluation.Threads = threads;
  EvaluationBatch batch;
  EvaluateParameters<2>(surface, samples.Parameters, evaluation, batch);
  BackMapResiduals residuals;
  residuals.Distances = (batch.Values - samples.Points).rowwise().norm();
  residuals.Max = residuals.Distances.maxCoeff();
  const auto weights = samples.Weights.head(samples.NumInside);
  residuals.Rms =
    std::sqrt(weights.dot(residuals.Distances.head(samples.NumInside).cwiseAbs2()) / weights.sum());
  return residuals;
}

Result<BackMap> FitPenalized(const ChartMesh& chart, const BackMapParams& params)
{
  const std::vector<std::array<int, 2>> boundary = BoundaryEdges(chart.Triangles);
  const bool byNeed = params.Elements == 0;
  BackMapParams aim = params;
  aim.Tolerance *= ProofShare;
  NetKnots knots = UniformNet(BackMapRectangle(chart, params.Margin), params.Degree,
    byNeed ? std::min(FirstElements, params.MaxElements) : params.Elements);
  BackMap map;
  for (bool last = false; !last;)
  {
    NetFit net;
    BackMapResiduals residuals;
    Status status = FitNet(chart, boundary, knots, aim, net, map, residuals);
    if (!status)
    {
      return status;
    }
    last = !byNeed || residuals.Max <= aim.Tolerance || map.Passes == MaxPasses;
    if (!last && residuals.Max <= ReweightReach * aim.Tolerance)
    {
      Reweight(net, aim, map, residuals);
    }
    if (params.Progress && !params.Progress(std::min(1.0, aim.Tolerance / residuals.Max)))
    {
      return { ErrorCode::Aborted, "the back-map was stopped" };
    }
    if (last || residuals.Max <= aim.Tolerance)
    {
      break;
    }
    NetKnots finer =
      RefinedNet(knots, MakeBezierForm(map.Surface, params.Threads), net.Samples, residuals, aim);
    last = finer == knots;
    if (last && residuals.Max > ReweightReach * aim.Tolerance)
    {
      Reweight(net, aim, map, residuals); // as near as this net comes
    }
    knots = std::move(finer);
  }
  map.WithinTolerance = map.MaxResidual <= params.Tolerance;
  return map;
}
}
