// SPDX-License-Identifier: BSD-3-Clause
#include "PenalizedFit.h"
#include "PenalizedSystem.h"
#include <knotwork/DomainParameterization/WorkBudget.h>
#include <knotwork/SplineCore/Numbers.h>
#include <knotwork/SplineCore/SizeLimit.h>
#include <knotwork/SplineCore/TensorSpace.h>

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
/// Nor for points that are nearer than this part of the farthest one: finer nets elsewhere bring
/// them nearer, too, and each span crosses the whole net.
constexpr double FarthestShare = 0.25;
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
/// Of the unit of work, measured: rows that are made and looked at, rows that are summed up by
/// pairs of functions, and the factorization.
constexpr double RowNanoseconds = 130.0;
constexpr double PairNanoseconds = 300.0 / 256.0;
constexpr double FactorNanoseconds = 60.0 / 64.0;
/// Rows of a net of as many functions as spans, a function.
constexpr double RowsOfAFunction = 54.0;
constexpr Eigen::Index RefinementBlock = 65536;
/// Barycentric coordinates from which on a point counts as inside a triangle, not on its edge.
constexpr double Inside = 1e-6;

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

/// The net with spans halved that hold the farthest points beyond the goal; the same net when there
/// are none, or none may be halved.
NetKnots RefinedNet(const NetKnots& knots, const BezierForm<2>& surface,
  const ChartSamples& samples, const BackMapResiduals& residuals, const BackMapParams& params)
{
  const bool reweighted = residuals.Max <= ReweightReach * params.Tolerance;
  const double goal = std::max(
    (reweighted ? ReweightedGoal : Goal) * params.Tolerance, FarthestShare * residuals.Max);
  std::vector<Eigen::Index> far;
  for (Eigen::Index i = 0; i < residuals.Distances.size(); ++i)
  {
    if (residuals.Distances[i] > goal)
    {
      far.push_back(i);
    }
  }
  EvaluationParams evaluation;
  evaluation.Derivatives = 2;
  evaluation.Threads = params.Threads;
  EvaluationBatch batch;
  std::array<std::vector<double>, 2> need;
  for (std::size_t d = 0; d < 2; ++d)
  {
    need[d].assign(static_cast<std::size_t>(knots[d].NumElements()), 0.0);
  }
  PointMatrix parameters;
  for (std::size_t k = 0; k < far.size(); ++k)
  {
    const auto row = static_cast<Eigen::Index>(k) % RefinementBlock;
    if (row == 0) // blocks: derivatives of all would take more memory than the net
    {
      const auto left = static_cast<Eigen::Index>(far.size() - k);
      parameters.resize(std::min(left, RefinementBlock), 2);
      for (Eigen::Index i = 0; i < parameters.rows(); ++i)
      {
        parameters.row(i) = samples.Parameters.row(far[k + static_cast<std::size_t>(i)]);
      }
      EvaluateParameters<2>(surface, parameters, evaluation, batch);
    }
    std::array<std::size_t, 2> element{};
    std::array<double, 2> span{};
    for (std::size_t d = 0; d < 2; ++d)
    {
      element[d] = static_cast<std::size_t>(
        knots[d].FindElement(parameters(row, static_cast<Eigen::Index>(d))));
      span[d] = knots[d].Breaks()[element[d] + 1] - knots[d].Breaks()[element[d]];
    }
    const auto second = batch.Second.row(row);
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

double NumFunctions(const NetKnots& knots)
{
  return static_cast<double>(knots[0].NumFunctions()) * knots[1].NumFunctions();
}

/// Nanoseconds of a solution on a net.
double SolutionWork(const NetKnots& knots, double weightedRows)
{
  const double order = knots[0].Degree() + 1.0;
  return PairNanoseconds * std::pow(order, 4.0) * weightedRows +
    FactorNanoseconds * std::pow(order, 3.0) * std::pow(NumFunctions(knots), 1.5);
}

/// Of all that is done on a net once, as is known before.
double ExpectedWork(const NetKnots& knots, std::size_t triangles)
{
  double rows = RowsOfAFunction;
  for (const KnotVector& k : knots)
  {
    rows *= k.NumFunctions();
  }
  rows += 4.0 * static_cast<double>(triangles);
  return RowNanoseconds * rows + SolutionWork(knots, 0.5 * rows);
}

/// Two triangles that hold the sample that is farthest off, with places of it that no surface can
/// meet both within the tolerance: a sentence, or nothing.
std::string FindContradiction(const ChartMesh& chart, const ChartSamples& samples,
  const BackMapResiduals& residuals, double tolerance)
{
  Eigen::Index worst = 0;
  residuals.Distances.maxCoeff(&worst);
  const Eigen::RowVector2d at = samples.Parameters.row(worst);
  std::vector<std::size_t> found;
  PointMatrix places(0, 3);
  for (std::size_t t = 0; t < chart.Triangles.size(); ++t)
  {
    const auto& corners = chart.Triangles[t];
    const Eigen::RowVector2d a = chart.UV.row(corners[1]) - chart.UV.row(corners[0]);
    const Eigen::RowVector2d b = chart.UV.row(corners[2]) - chart.UV.row(corners[0]);
    const Eigen::RowVector2d p = at - chart.UV.row(corners[0]);
    const double area = a[0] * b[1] - a[1] * b[0];
    const double s = (p[0] * b[1] - p[1] * b[0]) / area;
    const double r = (a[0] * p[1] - a[1] * p[0]) / area;
    if (!(s >= Inside && r >= Inside && s + r <= 1.0 - Inside))
    {
      continue;
    }
    const Eigen::RowVector3d place = (1.0 - s - r) * chart.Points.row(corners[0]) +
      s * chart.Points.row(corners[1]) + r * chart.Points.row(corners[2]);
    for (std::size_t k = 0; k < found.size(); ++k)
    {
      const double apart = (place - places.row(static_cast<Eigen::Index>(k))).norm();
      if (apart > 2.0 * tolerance)
      {
        return "triangles " + std::to_string(found[k]) + " and " + std::to_string(t) +
          " lie on each other in the plane, at " + PointText(at.data(), 2) + ", and " +
          Digits(apart) + " apart in space";
      }
    }
    found.push_back(t);
    places.conservativeResize(places.rows() + 1, 3);
    places.bottomRows(1) = place;
  }
  return {};
}

/// What a fit may still do, and why it stopped.
class Limits
{
public:
  explicit Limits(const BackMapParams& params)
    : Budget(params.Effort, params.TimeLimit, {}), Later(1e9 * params.LaterWork),
      MaxFunctions(params.MaxFunctions)
  {
  }
  void Spend(double nanoseconds) { this->Budget.Spend(nanoseconds); }
  /// Whether so much more may be done for a surface on a net, and if not, why.
  bool Allows(const NetKnots& knots, double nanoseconds)
  {
    nanoseconds += this->Later * NumFunctions(knots);
    this->Budget.Continue();
    if (this->Stop == BackMapStop::Finished)
    {
      this->Stop = this->Budget.Stop() == DomainStop::Time ? BackMapStop::Time
        : nanoseconds > this->Budget.Left()                ? BackMapStop::Effort
                                                           : BackMapStop::Finished;
    }
    return this->Stop == BackMapStop::Finished;
  }
  bool AllowsNet(const NetKnots& knots, std::size_t triangles)
  {
    if (NumFunctions(knots) > this->MaxFunctions)
    {
      this->Stop = BackMapStop::Functions;
      return false;
    }
    return this->Allows(knots, ExpectedWork(knots, triangles));
  }
  /// What a net is expected to cost in all, in the unit of Effort.
  double Price(const NetKnots& knots, std::size_t triangles) const
  {
    return 1e-9 * (ExpectedWork(knots, triangles) + this->Later * NumFunctions(knots));
  }
  double Used() const { return this->Budget.Used(); }

  BackMapStop Stop = BackMapStop::Finished;

private:
  WorkBudget Budget;
  double Later; ///< nanoseconds of a control point
  double MaxFunctions;
};

/// Least squares on a net.
Status FitNet(const ChartMesh& chart, const std::vector<std::array<int, 2>>& boundary,
  const NetKnots& knots, const BackMapParams& params, Limits& limits, NetFit& net, BackMap& map,
  BackMapResiduals& residuals)
{
  if (Status status = CheckNet(knots, params); !status)
  {
    return status;
  }
  const auto space = MakeTensorSpace<2>(knots);
  if (!space)
  {
    return space.Status;
  }
  net.Space = space.Value;
  net.Samples = SampleChart(chart, boundary, knots, params.Threads);
  limits.Spend(RowNanoseconds * static_cast<double>(net.Samples.Weights.size()) +
    SolutionWork(knots, static_cast<double>(net.Samples.NumWeighted)));
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
void Reweight(NetFit& net, const BackMapParams& params, Limits& limits, BackMap& map,
  BackMapResiduals& residuals)
{
  const double work = 0.5 * RowNanoseconds * static_cast<double>(net.Samples.Weights.size()) +
    SolutionWork(net.Space->Knots, static_cast<double>(net.Samples.NumWeighted));
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
    if (!limits.Allows(net.Space->Knots, work))
    {
      return;
    }
    limits.Spend(work);
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

Status CheckNet(const NetKnots& knots, const BackMapParams& params)
{
  return CheckSize(NumFunctions(knots), params.MaxFunctions, "control points of a net");
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
  if (byNeed && params.FirstNet.size() == knots.size())
  {
    std::copy(params.FirstNet.begin(), params.FirstNet.end(), knots.begin());
  }
  Limits limits(params);
  BackMap map; // of the net that is worked on
  BackMap best;
  NetKnots next;
  for (;;)
  {
    NetFit net;
    BackMapResiduals residuals;
    Status status = FitNet(chart, boundary, knots, aim, limits, net, map, residuals);
    if (!status)
    {
      return status;
    }
    if (byNeed && residuals.Max > aim.Tolerance)
    {
      map.StopReason = FindContradiction(chart, net.Samples, residuals, params.Tolerance);
    }
    NetKnots finer = knots;
    if (!map.StopReason.empty())
    {
      limits.Stop = BackMapStop::Contradiction;
    }
    else if (byNeed && map.Passes < MaxPasses)
    {
      if (residuals.Max > aim.Tolerance && residuals.Max <= ReweightReach * aim.Tolerance)
      {
        Reweight(net, aim, limits, map, residuals);
      }
      if (residuals.Max > aim.Tolerance)
      {
        finer = RefinedNet(
          knots, MakeBezierForm(map.Surface, params.Threads), net.Samples, residuals, aim);
        if (finer == knots && limits.Stop == BackMapStop::Finished)
        {
          if (residuals.Max > ReweightReach * aim.Tolerance)
          {
            Reweight(net, aim, limits, map, residuals); // as near as this net comes
          }
          limits.Stop = BackMapStop::Elements;
        }
      }
    }
    if (best.Passes == 0 || map.MaxResidual <= best.MaxResidual)
    {
      best = map;
    }
    if (params.Progress && !params.Progress(std::min(1.0, aim.Tolerance / residuals.Max)))
    {
      return { ErrorCode::Aborted, "the back-map was stopped" };
    }
    next = finer;
    if (finer == knots || limits.Stop != BackMapStop::Finished ||
      !limits.AllowsNet(finer, chart.Triangles.size()))
    {
      break;
    }
    knots = std::move(finer);
  }
  best.WithinTolerance = best.MaxResidual <= params.Tolerance;
  best.Passes = map.Passes;
  best.Stop = best.MaxResidual <= aim.Tolerance ? BackMapStop::Finished : limits.Stop;
  best.StopReason = map.StopReason;
  best.Work = limits.Used();
  if (best.Stop == BackMapStop::Effort)
  {
    best.NextNet.assign(next.begin(), next.end());
    best.NextWork = limits.Price(next, chart.Triangles.size());
  }
  return best;
}
}
