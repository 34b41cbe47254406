// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceFit.h"

#include "ClosestParameters.h"
#include "FitChecks.h"
#include "FitFeatures.h"
#include "FitMarks.h"
#include "FitRun.h"
#include "FitSides.h"
#include "FitSummary.h"
#include "FitUpdate.h"
#include "LeastSquares.h"
#include "Multilevel.h"
#include "OutlierSearch.h"
#include <knotwork/SplineCore/Parallel.h>
#include <knotwork/SplineCore/Refinement.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>

namespace knotwork
{
namespace
{
constexpr std::size_t PointChunk = 16384;
constexpr int MultilevelSteps = 2;             // an iteration
constexpr int ReweightSteps = 3;               // an iteration
constexpr int OutlierSteps = 3;                // an iteration
constexpr int CorrectionSteps = 8;             // an iteration
constexpr double CorrectionProgress = 0.8;     // of the squared distances, that another one leaves
constexpr double SolverAccuracy = 0.03;        // of the smallest tolerance
constexpr double FirstSmoothing = 1e-3;        // of the surface that the first one starts from
constexpr int FirstSteps = 3;                  // damped, to the first one
constexpr double LeastProgress = 0.9;          // of the points outside may be left by an iteration
constexpr std::size_t FunctionsPerPoint = 10;  // unless a limit is given
constexpr std::size_t MostFunctions = 1000000; // of clouds with fewer points

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// One fit while it runs.
class Fitting
{
public:
  Fitting(const PointCloud& cloud, const FitParams& params, FitDivision& division)
    : Division(division), Given(cloud), Moved(params.CorrectParameters ? cloud : PointCloud()),
      Cloud(params.CorrectParameters || division.IsDivided() ? this->Moved : cloud),
      Params(WithStart(params)), Begin(std::chrono::steady_clock::now()),
      Tolerances(FitTolerances(cloud, params, division)),
      Components(static_cast<int>(cloud.Values.cols())),
      Moments(Params.Degree, this->Components, division)
  {
  }

  Result<SurfaceFit> Run()
  {
    if (Status status = this->Start(); !status)
    {
      return status;
    }
    for (int iteration = 0;; ++iteration)
    {
      if (iteration > 0 || !this->IsMetByStart())
      {
        if (Status status = this->ApproximateCorrected(iteration); !status)
        {
          return status;
        }
      }
      this->AddRow(iteration);
      const FitIteration& row = this->Fit.Iterations.back();
      this->IsBestEarlier = row.NumOutside > 0 && this->CriterionReached();
      if (row.NumOutside == 0 || this->IsBestEarlier || this->LimitReached())
      {
        break;
      }
      if (!this->Division.All(!this->Params.Progress || this->Params.Progress(this->Share())))
      {
        return { ErrorCode::Aborted, "stopped in iteration " + std::to_string(iteration) };
      }
      if (this->IsSplit)
      {
        const std::vector<SplitMark> marks = MarkElements(this->State, this->Functions,
          this->Points, this->Errors, this->Params, this->Division, iteration);
        auto refined = this->RefineWithinLimit(marks);
        if (!refined)
        {
          return refined.Status;
        }
        this->IsSplit = refined.Value.Space != nullptr;
        this->Stuck = this->Fit.End;
        if (this->IsSplit)
        {
          this->Adopt(std::move(refined.Value));
        }
      }
      else if (!this->IsNearer())
      {
        this->Fit.End = this->Stuck;
        break;
      }
    }
    if (Status status = this->Deliver(); !status)
    {
      return status;
    }
    return std::move(this->Fit);
  }

private:
  Status Start()
  {
    this->NumPoints = this->Division.Sum(this->Tolerances.size());
    const ParametricBox<2> domain = FitDomain(this->Given, this->Params, this->Division);
    auto first = this->Params.Start
      ? MakeStartState(this->Params, this->Components)
      : MakeFirstState(this->Params, domain, this->Components, this->NumPoints);
    if (!first)
    {
      return first.Status;
    }
    this->State = std::move(first.Value);
    if (Status status = this->Divide(); !status)
    {
      return status;
    }
    if (this->Params.Side != FitSide::Both)
    {
      this->Bands = EvenBands(this->Cloud.Parameters, domain, this->Tolerances);
    }
    this->Group();
    this->Accuracy = SolverAccuracy *
      std::min(this->Params.ToleranceFactorAbove, this->Params.ToleranceFactorBelow) *
      this->LeastTolerance();
    this->Moments.Update(*this->State.Space, {}, {}, this->Points, this->Params.Threads);
    if (this->Params.Smoothing > 0.0 && !this->Params.Start)
    {
      this->BeginWithMeans();
    }
    if (this->Params.FindOutliers)
    {
      this->Outliers.assign(this->Tolerances.size(), 0);
      this->Weights.resize(this->Tolerances.size());
      for (std::size_t i = 0; i < this->Points.Size(); ++i)
      {
        this->Weights[At(this->Points.Order[i])] = this->Points.Base[i];
      }
      this->SearchOutliers();
    }
    return {};
  }

  /// Of several processes this one gets the points of its elements.
  Status Divide()
  {
    if (!this->Division.IsDivided())
    {
      return {};
    }
    const std::vector<int> elements =
      LocatePoints(*this->State.Space, this->Given.Parameters, this->Params.Threads);
    this->Division.Assign(elements, this->State.Space->NumElements());
    this->Moved = this->Division.Deal(this->Tolerances, elements);
    this->Tolerances.assign(this->Moved.Tolerances.begin(), this->Moved.Tolerances.end());
    this->Moved.Tolerances.resize(0);
    return this->Division.Check(this->Moved, this->Params.NumMeasured);
  }

  double LeastTolerance() const
  {
    double least = std::numeric_limits<double>::infinity();
    for (const double tolerance : this->Points.Tolerance)
    {
      least = std::min(least, tolerance);
    }
    return -this->Division.Largest(-least);
  }

  /// Where there are no points an average of all is better than 0.
  void BeginWithMeans()
  {
    for (int c = 0; c < this->Components; ++c)
    {
      double sum = 0.0;
      double weight = 0.0;
      for (int e = 0; e < this->State.Space->NumElements(); ++e)
      {
        const double* right = this->Moments.Right(e, c);
        sum += std::accumulate(right, right + this->Moments.PerElement(), 0.0);
        weight += this->Moments.Weight(e);
      }
      this->State.Coefficients.col(c).setConstant(sum / weight);
    }
  }

  /// The points by the elements of the state's space.
  void Group()
  {
    this->Points = GroupPoints(*this->State.Space, this->Cloud, this->Tolerances,
      this->Params.SignificantWeight, this->Params.Threads);
    this->Points.FactorAbove = this->Params.ToleranceFactorAbove;
    this->Points.FactorBelow = this->Params.ToleranceFactorBelow;
    for (std::size_t i = 0; !this->Outliers.empty() && i < this->Points.Size(); ++i)
    {
      if (this->Outliers[At(this->Points.Order[i])] != 0)
      {
        this->Points.Base[i] = 0.0;
      }
    }
    if (this->Params.Side != FitSide::Both)
    {
      MoveToBands(this->Params.Side, this->Bands, this->Points);
    }
    this->Functions = FindElementFunctions(*this->State.Space, this->Params.Threads);
  }

  /// Approximates and corrects parameters by turns while that makes the distances much smaller:
  /// else elements would be split for the parameters' errors.
  Status ApproximateCorrected(int iteration)
  {
    this->Approximate(iteration);
    double before = std::numeric_limits<double>::infinity();
    for (int k = 0; this->Params.CorrectParameters; ++k)
    {
      if (Status status = this->CorrectParameters(); !status)
      {
        return status;
      }
      double squares = 0.0;
      std::size_t outside = 0;
      for (const ElementErrors& own : this->Errors)
      {
        squares += own.Squares;
        outside += own.NumOutside;
      }
      if (outside == 0 || squares > CorrectionProgress * before || k == CorrectionSteps)
      {
        break;
      }
      before = squares;
      this->Approximate(iteration);
    }
    return {};
  }

  /// The points move along the surface to where it is closest to them.
  Status CorrectParameters()
  {
    auto closest = ClosestParameters(
      { this->State.Space, this->State.Coefficients.leftCols(this->Params.NumMeasured), {} },
      this->Moved.Values.leftCols(this->Params.NumMeasured).eval(), this->Params.Threads, {});
    if (!closest)
    {
      return closest.Status;
    }
    this->Moved.Parameters = std::move(closest.Value);
    this->Group();
    this->Moments.Update(*this->State.Space, {}, {}, this->Points, this->Params.Threads);
    this->Measure();
    if (this->Search)
    {
      this->SearchOutliers();
      const std::vector<int> changed = this->Search->Update(this->Points, this->Weights,
        this->Params.OutlierScale, this->Outliers, this->Params.Threads);
      this->Moments.Recompute(*this->State.Space, changed, this->Points, this->Params.Threads);
      this->Measure();
    }
    return {};
  }

  void SearchOutliers()
  {
    this->Search = std::make_unique<OutlierSearch>(this->Cloud, this->State.Space->Domain(),
      this->Params.NumMeasured, this->Params.OutlierDeviation);
  }

  /// Whether all points are within their tolerances of the start as it is.
  bool IsMetByStart()
  {
    if (!this->Params.Start)
    {
      return false;
    }
    this->Measure();
    return std::all_of(this->Errors.begin(), this->Errors.end(),
      [](const ElementErrors& own) { return own.NumOutside == 0; });
  }

  void Approximate(int iteration)
  {
    this->IsLeastSquares = this->Params.Method == FitMethod::LeastSquares ||
      (this->Params.Method == FitMethod::Combined && iteration < this->Params.SwitchIteration);
    std::unique_ptr<LeastSquaresSystem> system;
    if (this->IsLeastSquares)
    {
      LeastSquaresParams params;
      params.Smoothing = this->Params.Smoothing;
      params.IsDamped = params.Smoothing > 0.0;
      params.Accuracy = this->Accuracy;
      params.Threads = this->Params.Threads;
      system = std::make_unique<LeastSquaresSystem>(this->Functions, this->Moments,
        this->Params.Degree, this->Components, this->Division, params);
      if (iteration == 0 && params.IsDamped && !this->Params.Start)
      {
        this->SolveStiffly(params);
        for (int k = 1; k < FirstSteps; ++k)
        {
          system->Solve(this->State.Coefficients);
        }
      }
    }
    this->Solve(system.get());
    for (int k = 0; this->Search && k < OutlierSteps; ++k)
    {
      const std::vector<int> changed = this->Search->Update(this->Points, this->Weights,
        this->Params.OutlierScale, this->Outliers, this->Params.Threads);
      if (changed.empty())
      {
        break;
      }
      this->SolveAgain(changed, system.get());
    }
    for (int k = 0; system && k < ReweightSteps; ++k)
    {
      const std::vector<int> changed =
        ReweightPoints(this->Errors, this->Functions.PerElement, this->Points);
      if (changed.empty())
      {
        break;
      }
      this->SolveAgain(changed, system.get());
    }
  }

  /// A surface that is sensible where there are no points, for the first one to start from.
  void SolveStiffly(LeastSquaresParams params)
  {
    params.Smoothing = std::max(params.Smoothing, FirstSmoothing);
    params.IsDamped = false;
    LeastSquaresSystem(
      this->Functions, this->Moments, this->Params.Degree, this->Components, this->Division, params)
      .Solve(this->State.Coefficients);
  }

  /// @param changed  elements with points whose weights have changed.
  void SolveAgain(const std::vector<int>& changed, LeastSquaresSystem* system)
  {
    this->Moments.Recompute(*this->State.Space, changed, this->Points, this->Params.Threads);
    if (system)
    {
      system->Update(changed);
    }
    this->Solve(system);
  }

  void Solve(const LeastSquaresSystem* system)
  {
    const std::vector<std::uint8_t> fixed = this->TakeFromStart();
    if (system)
    {
      system->Solve(this->State.Coefficients, fixed);
    }
    for (int k = 0; !system && k < MultilevelSteps; ++k)
    {
      MultilevelStep(*this->State.Space, this->Functions, this->Points, fixed, this->Division,
        this->Params.Threads, this->State.Coefficients);
    }
    this->Measure();
  }

  /// What refinement has left of the changes beyond the supports of the functions with points goes
  /// back to the start. At the points this changes nothing, but on edges that are held.
  /// @return the functions that stay; empty without a start.
  std::vector<std::uint8_t> TakeFromStart()
  {
    if (!this->Params.Start)
    {
      return {};
    }
    std::vector<std::uint8_t> fixed = FindFixedFunctions(
      *this->State.Space, this->Functions, this->Points, this->Params.Start->Edges, this->Division);
    for (std::size_t f = 0; f < fixed.size(); ++f)
    {
      if (fixed[f] != 0)
      {
        const auto row = static_cast<Eigen::Index>(f);
        this->State.Coefficients.row(row) = this->State.Start.row(row).head(this->Components);
      }
    }
    return fixed;
  }

  void Measure()
  {
    this->Errors = MeasureDistances(*this->State.Space, this->Functions, this->State.Coefficients,
      this->Params.NumMeasured, this->Division, this->Points, this->Params.Threads);
  }

  void AddRow(int iteration)
  {
    FitIteration row = SummarizeFit(*this->State.Space, this->Cloud, this->Points, this->Errors,
      this->Division, this->Params.Threads);
    row.Iteration = iteration;
    row.LeastSquares = this->IsLeastSquares;
    row.Seconds = this->Division.OfFirst(
      std::chrono::duration<double>(std::chrono::steady_clock::now() - this->Begin).count());
    this->Fit.Iterations.push_back(row);
    if (this->Params.FeatureIterations)
    {
      this->AddFeatures();
    }
  }

  void AddFeatures()
  {
    const Eigen::Index height = this->Params.NumMeasured - 1;
    if (this->Params.FeatureGridSize > 0)
    {
      this->Fit.GridFeatures.push_back(GridFeatures(
        this->State, this->Points, height, this->Params.FeatureGridSize, this->Params.Threads));
    }
    if (this->Params.ElementFeatures)
    {
      this->Fit.ElementFeatures.push_back(
        ElementFeatures(this->State, this->Points, height, this->Division, this->Params.Threads));
    }
  }

  /// Part of the work done, by the logarithm of the number of points outside.
  double Share()
  {
    const FitIteration& row = this->Fit.Iterations.back();
    const double left = std::log1p(static_cast<double>(row.NumOutside)) /
      std::log1p(static_cast<double>(this->NumPoints));
    const double limit = (row.Iteration + 1.0) / (this->Params.MaxIterations + 1.0);
    this->Done = std::clamp(std::max(1.0 - left, limit), this->Done, 0.99);
    return this->Done;
  }

  /// Keeps the state of the least value of the information criterion; true when it has risen twice.
  bool CriterionReached()
  {
    if (this->Params.Criterion == FitCriterion::Tolerance)
    {
      return false;
    }
    const FitIteration& row = this->Fit.Iterations.back();
    const double value = this->Params.Criterion == FitCriterion::AIC ? row.AIC : row.BIC;
    this->Fit.End = FitEnd::Criterion;
    if (row.Iteration == 0 || value < this->BestCriterion)
    {
      this->BestCriterion = value;
      this->Best = this->State;
      this->BestDivision = this->Division;
      this->BestOutliers = this->Outliers;
      this->NumRises = 0;
      return false;
    }
    return ++this->NumRises == 2;
  }

  /// Whether the last iteration, in the space of the one before, has brought points inside.
  bool IsNearer() const
  {
    const std::size_t before = this->Fit.Iterations[this->Fit.Iterations.size() - 2].NumOutside;
    return static_cast<double>(this->Fit.Iterations.back().NumOutside) <=
      LeastProgress * static_cast<double>(before);
  }

  /// Time is up, too, when another iteration like the last one would take longer.
  bool LimitReached()
  {
    const std::vector<FitIteration>& rows = this->Fit.Iterations;
    const double now = rows.back().Seconds;
    const double last = rows.size() > 1 ? now - rows[rows.size() - 2].Seconds : 0.0;
    if (this->Params.MaxSeconds > 0.0 && now + last >= this->Params.MaxSeconds)
    {
      this->Fit.End = FitEnd::Seconds;
      return true;
    }
    this->Fit.End = FitEnd::Iterations;
    return rows.back().Iteration >= this->Params.MaxIterations;
  }

  int FunctionLimit() const
  {
    const std::size_t n = this->NumPoints;
    const std::size_t given =
      this->Params.Start ? At(this->Params.Start->Surface.Space->NumFunctions) : 0;
    return this->Params.MaxFunctions > 0
      ? this->Params.MaxFunctions
      : static_cast<int>(
          std::min(given + std::max(n, std::min(FunctionsPerPoint * n, MostFunctions)),
            static_cast<std::size_t>(std::numeric_limits<int>::max())));
  }

  /// The next state; without a space when nothing can be split. When all marks make more functions
  /// than are allowed, the worst elements are split, as many as fit.
  Result<FitState> RefineWithinLimit(const std::vector<SplitMark>& marks)
  {
    this->Fit.End = FitEnd::Functions;
    if (marks.empty())
    {
      const bool contradict =
        this->Division.All(PointsContradict(this->State, this->Points, this->Errors, this->Params));
      this->Fit.End = contradict ? FitEnd::Contradiction : FitEnd::Resolution;
      if (!contradict &&
        this->Division.All(PointsAreHeld(this->State, this->Points, this->Errors, this->Params)))
      {
        this->Fit.End = FitEnd::HeldEdges;
      }
      return FitState{};
    }
    const int iteration = this->Fit.Iterations.back().Iteration + 1;
    auto refined = RefineState(this->State, marks, iteration, this->Params);
    const int limit = this->FunctionLimit();
    if (!refined || refined.Value.Space->NumFunctions <= limit)
    {
      return refined;
    }
    std::vector<SplitMark> ranked = marks;
    std::stable_sort(ranked.begin(), ranked.end(),
      [&](const SplitMark& a, const SplitMark& b)
      { return this->Errors[At(a.Element)].Ratio > this->Errors[At(b.Element)].Ratio; });
    FitState best;
    std::size_t low = 0; // marks that fit
    std::size_t high = ranked.size();
    while (high - low > std::max<std::size_t>(1, ranked.size() / 16))
    {
      const std::size_t middle = (low + high) / 2;
      std::vector<SplitMark> some(
        ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(middle));
      std::sort(some.begin(), some.end(),
        [](const SplitMark& a, const SplitMark& b) { return a.Element < b.Element; });
      refined = RefineState(this->State, some, iteration, this->Params);
      if (!refined)
      {
        return refined;
      }
      const bool fits = refined.Value.Space->NumFunctions <= limit;
      (fits ? low : high) = middle;
      if (fits)
      {
        best = std::move(refined.Value);
      }
    }
    return best;
  }

  void Adopt(FitState refined)
  {
    const SplineSpace<2>& coarse = *this->State.Space;
    const SplineSpace<2>& fine = *refined.Space;
    const std::vector<int> parents = ParentElements(coarse, fine, this->Params.Threads);
    std::vector<int> parts(At(coarse.NumElements()), 0);
    for (const int parent : parents)
    {
      ++parts[At(parent)];
    }
    std::vector<bool> isSplit(parts.size());
    std::transform(parts.begin(), parts.end(), isSplit.begin(), [](int n) { return n > 1; });
    this->Division.Refine(parents);
    RegroupPoints(coarse, fine, parents, this->Points, this->Params.Threads);
    this->Moments.Update(fine, parents, isSplit, this->Points, this->Params.Threads);
    this->State = std::move(refined);
    this->Functions = FindElementFunctions(*this->State.Space, this->Params.Threads);
  }

  Status Deliver()
  {
    if (this->IsBestEarlier)
    {
      this->State = this->Best;
      this->Division = this->BestDivision;
      this->Outliers = this->BestOutliers;
      this->Group();
      if (Status status = this->Params.CorrectParameters ? this->CorrectParameters() : Status();
          !status)
      {
        return status;
      }
    }
    if (this->Params.Side != FitSide::Both)
    {
      MoveFromBands(this->Cloud, this->Tolerances, this->Points);
      this->Measure();
      ShiftToSide(this->Params.Side, this->Functions, this->Points, this->State.Coefficients);
    }
    this->Fit.Final = this->Fit.Iterations.back();
    if (this->IsBestEarlier || this->Params.Side != FitSide::Both)
    {
      this->Measure();
      this->AddRow(this->Fit.Iterations.back().Iteration);
      this->Fit.Final = this->Fit.Iterations.back();
    }
    if (!this->Params.FeatureIterations)
    {
      this->AddFeatures();
    }
    this->Fit.NumPoints = this->NumPoints;
    this->Fit.WithinTolerance = this->Fit.Final.NumOutside == 0;
    this->Fit.End = this->Fit.WithinTolerance ? FitEnd::Tolerance : this->Fit.End;
    this->Fit.Surface.Space = this->State.Space;
    const Eigen::Index carried =
      std::max<Eigen::Index>(0, this->State.Start.cols() - this->Components);
    this->Fit.Surface.ControlPoints.resize(
      this->State.Coefficients.rows(), this->Components + carried);
    this->Fit.Surface.ControlPoints.leftCols(this->Components) = this->State.Coefficients;
    if (carried > 0)
    {
      this->Fit.Surface.ControlPoints.rightCols(carried) = this->State.Start.rightCols(carried);
    }
    this->Fit.DomainPoints = std::move(this->State.DomainPoints);
    if (this->Division.IsDivided()) // distances take its place
    {
      this->Moved = PointCloud();
    }
    this->Fit.Distances.resize(this->Points.Size());
    ParallelFor(this->Points.Size(), PointChunk, this->Params.Threads,
      [this](std::size_t begin, std::size_t end)
      {
        for (std::size_t i = begin; i < end; ++i)
        {
          const std::size_t row = At(this->Points.Order[i]);
          this->Fit.Distances[row] = this->Points.Distance[i];
          this->Tolerances[row] = this->Points.Limit(i);
        }
      });
    this->Points = FitPoints(); // what comes home takes its place
    this->Fit.Distances = this->Division.BringHome(std::move(this->Fit.Distances));
    this->Fit.Tolerances = this->Division.BringHome(std::move(this->Tolerances));
    this->Fit.Outliers = std::move(this->Outliers);
    if (this->Params.CorrectParameters)
    {
      this->Fit.Parameters = std::move(this->Moved.Parameters);
    }
    return {};
  }

  FitDivision& Division;
  const PointCloud& Given; ///< not where it was given up (FitDivision::Deal)
  PointCloud Moved;        ///< a copy, when parameters are corrected; the points of own elements
  const PointCloud& Cloud;
  const FitParams Params;
  std::chrono::steady_clock::time_point Begin;
  std::vector<double> Tolerances;
  std::vector<double> Bands; ///< one-sided fits: their widths
  std::size_t NumPoints = 0; ///< of all processes
  int Components;
  double Accuracy = 0.0;
  bool IsLeastSquares = true;
  bool IsSplit = true;              ///< there has been something to split
  FitEnd Stuck = FitEnd::Tolerance; ///< why not
  FitState State;
  FitPoints Points;
  ElementFunctions Functions;
  ElementMoments Moments;
  std::vector<ElementErrors> Errors;
  std::unique_ptr<OutlierSearch> Search;
  std::vector<std::uint8_t> Outliers;
  std::vector<double> Weights; // asked for, in the cloud's order
  FitState Best;
  FitDivision BestDivision;
  std::vector<std::uint8_t> BestOutliers;
  double BestCriterion = 0.0;
  int NumRises = 0;
  bool IsBestEarlier = false; ///< the criterion has ended the fit
  double Done = 0.0;          // share that was reported
  SurfaceFit Fit;
};
}

Result<SurfaceFit> RunFit(const PointCloud& cloud, const FitParams& params, FitDivision& division)
{
  return Fitting(cloud, params, division).Run();
}

Result<SurfaceFit> FitSurface(const PointCloud& cloud, const FitParams& params)
{
  if (Status status = CheckFit(cloud, params); !status)
  {
    return status;
  }
  FitDivision alone;
  return RunFit(cloud, params, alone);
}
}
