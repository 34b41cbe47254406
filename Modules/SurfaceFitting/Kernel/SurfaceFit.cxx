// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceFit.h"

#include "FitChecks.h"
#include "FitLikelihood.h"
#include "FitSpaces.h"
#include "LeastSquares.h"
#include "Multilevel.h"
#include "PointDistances.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr int MultilevelSteps = 2;      // an iteration
constexpr double SolverAccuracy = 0.03; // of the smallest tolerance
constexpr double SplitBoth =
  0.5; // a direction's gain, of the other one's, from which both are split
// Points outside gain weight when they are few and not far: ratio to the tolerance, share of all.
constexpr int ReweightSteps = 3;
constexpr double ReweightRatio = 1.3;
constexpr double ReweightShare = 1e-3;
constexpr double ReweightFloor = 0.9; // of the tolerance: from here on
constexpr double ReweightGain = 4.0;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// One fit while it runs.
class Fitting
{
public:
  Fitting(const PointCloud& cloud, const FitParams& params)
    : Cloud(cloud), Params(params), Begin(std::chrono::steady_clock::now())
  {
  }

  Result<SurfaceFit> Run()
  {
    const std::vector<double> tolerances = FitTolerances(this->Cloud, this->Params);
    this->Accuracy = SolverAccuracy * *std::min_element(tolerances.begin(), tolerances.end());
    auto first = MakeFirstState(this->Params, FitDomain(this->Cloud, this->Params),
      static_cast<int>(this->Cloud.Values.cols()),
      static_cast<std::size_t>(this->Cloud.Parameters.rows()));
    if (!first)
    {
      return first.Status;
    }
    this->State = std::move(first.Value);
    this->Points = GroupPoints(*this->State.Space, this->Cloud, tolerances,
      this->Params.SignificantWeight, this->Params.Threads);
    this->Functions = FindElementFunctions(*this->State.Space, this->Params.Threads);
    ElementMoments moments(this->Params.Degree, static_cast<int>(this->Cloud.Values.cols()));
    this->Moments = &moments;
    moments.Update(*this->State.Space, {}, {}, this->Points, this->Params.Threads);
    for (int iteration = 0;; ++iteration)
    {
      this->Approximate(iteration);
      this->Errors = MeasureDistances(*this->State.Space, this->Functions, this->State.Coefficients,
        this->Params.NumMeasured, this->Points, this->Params.Threads);
      this->Fit.Iterations.push_back(this->Summarize(iteration));
      if (this->Fit.Iterations.back().NumOutside == 0 || this->LimitReached(iteration))
      {
        break;
      }
      if (this->Params.Progress &&
        !this->Params.Progress(std::min(0.99, static_cast<double>(iteration + 1) / 16.0)))
      {
        return { ErrorCode::Aborted, "stopped at iteration " + std::to_string(iteration) };
      }
      const std::vector<SplitMark> marks = this->MarkElements(iteration);
      if (marks.empty())
      {
        break;
      }
      if (Status status = this->Refine(marks); !status)
      {
        return status;
      }
    }
    this->Deliver(tolerances);
    return std::move(this->Fit);
  }

private:
  void Approximate(int iteration)
  {
    this->LeastSquares = this->Params.Method == FitMethod::LeastSquares ||
      (this->Params.Method == FitMethod::Combined && iteration < this->Params.SwitchIteration);
    if (!this->LeastSquares)
    {
      for (int k = 0; k < MultilevelSteps; ++k)
      {
        MultilevelStep(*this->State.Space, this->Functions, this->Points, this->Params.Threads,
          this->State.Coefficients);
      }
      this->Measure();
      return;
    }
    LeastSquaresParams params;
    params.Smoothing = this->Params.Smoothing;
    params.Accuracy = this->Accuracy;
    params.Threads = this->Params.Threads;
    LeastSquaresSystem system(this->Functions, *this->Moments, this->Params.Degree,
      static_cast<int>(this->State.Coefficients.cols()), params);
    system.Solve(this->State.Coefficients);
    this->Measure();
    for (int k = 0; k < ReweightSteps; ++k)
    {
      const std::vector<int> changed = this->Reweight();
      if (changed.empty())
      {
        break;
      }
      this->Moments->Recompute(*this->State.Space, changed, this->Points, this->Params.Threads);
      system.Update(changed);
      system.Solve(this->State.Coefficients);
      this->Measure();
    }
  }

  void Measure()
  {
    this->Errors = MeasureDistances(*this->State.Space, this->Functions, this->State.Coefficients,
      this->Params.NumMeasured, this->Points, this->Params.Threads);
  }

  /// Gives points outside more weight where this can bring them inside. @return the elements of
  /// these points; empty when it is not worthwhile.
  std::vector<int> Reweight()
  {
    std::vector<int> changed;
    double worst = 0.0;
    std::size_t outside = 0;
    std::size_t total = 0;
    for (const ElementErrors& errors : this->Errors)
    {
      worst = std::max(worst, errors.Ratio);
      outside += errors.NumOutside;
      total += errors.Count;
    }
    if (outside == 0 || worst > ReweightRatio ||
      static_cast<double>(outside) > ReweightShare * static_cast<double>(total))
    {
      return changed;
    }
    for (int e = 0; e < this->State.Space->NumElements(); ++e)
    {
      const ElementErrors& errors = this->Errors[At(e)];
      if (errors.Ratio <= 1.0)
      {
        continue;
      }
      changed.push_back(e);
      const FitPoints::Range& range = this->Points.Ranges[At(e)];
      const double unit =
        std::max(1.0, static_cast<double>(range.Count()) / this->Functions.PerElement);
      for (std::size_t i = range.Begin; i < range.End; ++i)
      {
        const double ratio = std::fabs(this->Points.Distance[i]) / this->Points.Tolerance[i];
        if (ratio > ReweightFloor)
        {
          this->Points.Boost[i] += ReweightGain * unit * (ratio - ReweightFloor) / ReweightFloor;
        }
      }
    }
    return changed;
  }

  FitIteration Summarize(int iteration) const
  {
    FitIteration row;
    row.Iteration = iteration;
    row.LeastSquares = this->LeastSquares;
    row.NumFunctions = this->State.Space->NumFunctions;
    row.NumElements = this->State.Space->NumElements();
    std::size_t count = 0;
    double squares = 0.0;
    for (const ElementErrors& errors : this->Errors)
    {
      row.MaxError = std::max(row.MaxError, errors.Max);
      row.MeanError += errors.Sum;
      squares += errors.Squares;
      row.NumOutside += errors.NumOutside;
      count += errors.Count;
    }
    if (count > 0)
    {
      row.MeanError /= static_cast<double>(count);
      row.RmsError = std::sqrt(squares / static_cast<double>(count));
    }
    row.NumOutliers = this->Points.Size() - count;
    const TDistribution t = FitTDistribution(this->Points, this->Params.Threads);
    row.LogLikelihood = t.LogLikelihood;
    row.DegreesOfFreedom = t.DegreesOfFreedom;
    row.AIC = 2.0 * row.NumFunctions - 2.0 * t.LogLikelihood;
    row.BIC = std::log(static_cast<double>(std::max<std::size_t>(count, 1))) * row.NumFunctions -
      2.0 * t.LogLikelihood;
    row.Seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - this->Begin).count();
    return row;
  }

  bool LimitReached(int iteration) const
  {
    const FitIteration& row = this->Fit.Iterations.back();
    return iteration >= this->Params.MaxIterations ||
      (this->Params.MaxFunctions > 0 && row.NumFunctions >= this->Params.MaxFunctions) ||
      (this->Params.MaxSeconds > 0.0 && row.Seconds >= this->Params.MaxSeconds);
  }

  std::vector<SplitMark> MarkElements(int iteration) const
  {
    double worst = 0.0;
    std::size_t most = 0;
    for (const ElementErrors& errors : this->Errors)
    {
      worst = std::max(worst, errors.Ratio);
      most = std::max(most, errors.NumOutside);
    }
    const ParametricBox<2> domain = this->State.Space->Domain();
    std::vector<SplitMark> marks;
    for (int e = 0; e < this->State.Space->NumElements(); ++e)
    {
      const ElementErrors& errors = this->Errors[At(e)];
      if (errors.NumOutside == 0)
      {
        continue;
      }
      const double share = this->Params.ThresholdShare;
      if ((this->Params.Threshold == FitThreshold::LargestErrors &&
            errors.Ratio - 1.0 < share * (worst - 1.0)) ||
        (this->Params.Threshold == FitThreshold::MostPoints &&
          static_cast<double>(errors.NumOutside) < share * static_cast<double>(most)))
      {
        continue;
      }
      const ParametricBox<2>& box = this->State.Space->Elements[At(e)].Box;
      SplitMark mark;
      mark.Element = e;
      if (this->Params.Directions == FitDirections::Alternating)
      {
        mark.Directions = { iteration % 2 == 0, iteration % 2 == 1 };
      }
      else if (this->Params.Directions == FitDirections::ByError)
      {
        const RealArray<2> gains = SplitGains(box, this->Points, this->Points.Ranges[At(e)]);
        mark.Directions = { gains[0] >= SplitBoth * gains[1], gains[1] >= SplitBoth * gains[0] };
      }
      for (std::size_t d = 0; d < 2; ++d)
      {
        const double length = box.Upper[d] - box.Lower[d];
        mark.Directions[d] = mark.Directions[d] &&
          0.5 * length >= this->Params.MinElementSize * (domain.Upper[d] - domain.Lower[d]);
      }
      if (mark.Directions[0] || mark.Directions[1])
      {
        marks.push_back(mark);
      }
    }
    return marks;
  }

  Status Refine(const std::vector<SplitMark>& marks)
  {
    auto refined = RefineState(this->State, marks, this->Params);
    if (!refined)
    {
      return refined.Status;
    }
    const SplineSpace<2>& coarse = *this->State.Space;
    const SplineSpace<2>& fine = *refined.Value.Space;
    const std::vector<int> parents = FindParents(coarse, fine);
    std::vector<int> parts(At(coarse.NumElements()), 0);
    for (const int parent : parents)
    {
      ++parts[At(parent)];
    }
    std::vector<bool> isSplit(parts.size());
    std::transform(parts.begin(), parts.end(), isSplit.begin(), [](int n) { return n > 1; });
    RegroupPoints(coarse, fine, parents, this->Points, this->Params.Threads);
    this->Moments->Update(fine, parents, isSplit, this->Points, this->Params.Threads);
    this->State = std::move(refined.Value);
    this->Functions = FindElementFunctions(*this->State.Space, this->Params.Threads);
    return {};
  }

  void Deliver(const std::vector<double>& tolerances)
  {
    this->Fit.Surface.Space = this->State.Space;
    this->Fit.Surface.ControlPoints = std::move(this->State.Coefficients);
    this->Fit.DomainPoints = std::move(this->State.DomainPoints);
    this->Fit.Tolerances = tolerances;
    this->Fit.Distances.resize(this->Points.Size());
    for (std::size_t i = 0; i < this->Points.Size(); ++i)
    {
      this->Fit.Distances[At(this->Points.Order[i])] = this->Points.Distance[i];
    }
    if (this->Params.FindOutliers)
    {
      this->Fit.Outliers.resize(this->Points.Size());
      for (std::size_t i = 0; i < this->Points.Size(); ++i)
      {
        this->Fit.Outliers[At(this->Points.Order[i])] = this->Points.Base[i] == 0.0 ? 1 : 0;
      }
    }
    this->Fit.Final = this->Fit.Iterations.back();
    this->Fit.WithinTolerance = this->Fit.Final.NumOutside == 0;
  }

  const PointCloud& Cloud;
  const FitParams& Params;
  std::chrono::steady_clock::time_point Begin;
  double Accuracy = 0.0;
  bool LeastSquares = true;
  FitState State;
  FitPoints Points;
  ElementFunctions Functions;
  ElementMoments* Moments = nullptr;
  std::vector<ElementErrors> Errors;
  SurfaceFit Fit;
};
}

Result<SurfaceFit> FitSurface(const PointCloud& cloud, const FitParams& params)
{
  if (Status status = CheckFit(cloud, params); !status)
  {
    return status;
  }
  return Fitting(cloud, params).Run();
}
}
