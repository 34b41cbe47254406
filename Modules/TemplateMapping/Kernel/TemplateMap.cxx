// SPDX-License-Identifier: BSD-3-Clause
#include "TemplateMap.h"

#include "FinerSpace.h"
#include "FoldRemoval.h"
#include "NegativeJacobian.h"
#include "RegularityGuard.h"
#include "TemplateProblem.h"
#include <knotwork/SplineCore/BasisEvaluation.h>
#include <knotwork/SplineCore/HierarchicalSpace.h>
#include <knotwork/SplineCore/SizeLimit.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <string>

namespace knotwork
{
namespace
{
/// Of the negative share a direction: a million in all is what papers report.
template <int Dim>
constexpr int GridPoints = Dim == 2 ? 1000 : 100;
constexpr double ResultGap = 0.1; // of the bounds that are reported
constexpr std::int64_t ResultBoxes = 1000000;
constexpr int Halvings = 10; // of a step that does not lower what is minimized
/// Factor of the proximal weight after a step that was not in danger, once the map was begun anew,
/// and the least part of the given weight.
constexpr double Relaxation = 0.5;
constexpr double LeastProximal = 1e-3;
constexpr double LeastInitialUniformity = 1e-12;
/// Of the initial map, against its uniformity: decides where samples in one plane (on one line)
/// leave affine parts open, and changes no map visibly.
constexpr double InitialProximal = 1e-9;

Status OutOfRange(const char* option, const std::string& range, const std::string& value)
{
  return { ErrorCode::InvalidParameter,
    std::string(option) + " must be in " + range + ", not " + value };
}

template <int Dim>
Status CheckRefinement(const TemplateMapParams<Dim>& params)
{
  if (params.RefineEvery < 0 || params.RefineEvery > 100000)
  {
    return OutOfRange(
      "iterations between refinements", "[0, 100000]", std::to_string(params.RefineEvery));
  }
  if (!(params.StagnationRatio > 0.0 && params.StagnationRatio < 1.0))
  {
    return OutOfRange("stagnation ratio", "(0, 1)", std::to_string(params.StagnationRatio));
  }
  if (!(params.RefineThreshold >= 0.0) || !std::isfinite(params.RefineThreshold))
  {
    return OutOfRange(
      "refinement threshold", "[0, infinity)", std::to_string(params.RefineThreshold));
  }
  if (!(params.RefineShare >= 0.0 && params.RefineShare <= 1.0))
  {
    return OutOfRange("refined share", "[0, 1]", std::to_string(params.RefineShare));
  }
  if (params.Extension < 0 || params.Extension > 100)
  {
    return OutOfRange("extension", "[0, 100]", std::to_string(params.Extension));
  }
  if (params.MaxLevel < 0 || params.MaxLevel > 24)
  {
    return OutOfRange("largest level", "[0, 24]", std::to_string(params.MaxLevel));
  }
  if (params.MaxFunctions < 1)
  {
    return OutOfRange(
      "number of functions", "[1, 2147483647]", std::to_string(params.MaxFunctions));
  }
  return {};
}

template <int Dim>
Status CheckOptions(const TemplateMapParams<Dim>& params)
{
  if (params.Iterations < 1 || params.Iterations > 100000)
  {
    return OutOfRange("iterations", "[1, 100000]", std::to_string(params.Iterations));
  }
  if (params.TemplateSamples != 0 &&
    (params.TemplateSamples < 2 || params.TemplateSamples > 10000000))
  {
    return OutOfRange(
      "template samples", "[2, 10000000] or 0", std::to_string(params.TemplateSamples));
  }
  if (params.NewtonSteps < 0 || params.NewtonSteps > 100)
  {
    return OutOfRange("Newton steps", "[0, 100]", std::to_string(params.NewtonSteps));
  }
  const std::pair<const char*, double> weights[] = { { "PDM weight", params.PdmWeight },
    { "TDM weight", params.TdmWeight }, { "Tikhonov weight", params.TikhonovWeight },
    { "uniformity weight", params.UniformityWeight }, { "length weight", params.LengthWeight },
    { "orthogonality weight", params.OrthogonalityWeight },
    { "skewness weight", params.SkewnessWeight },
    { "eccentricity weight", params.EccentricityWeight }, { "area weight", params.AreaWeight },
    { "self-intersection weight", params.SelfIntersectionWeight } };
  for (const auto& [name, weight] : weights)
  {
    if (!(weight >= 0.0 && weight <= 1e30))
    {
      return OutOfRange(name, "[0, 1e30]", std::to_string(weight));
    }
  }
  if (!(params.InitialUniformityWeight >= LeastInitialUniformity &&
        params.InitialUniformityWeight <= 1e30))
  {
    return OutOfRange("uniformity weight of the initial map", "[1e-12, 1e30]",
      std::to_string(params.InitialUniformityWeight));
  }
  if (params.Method == TemplateMapMethod::Weighted && params.PdmWeight + params.TdmWeight == 0.0)
  {
    return { ErrorCode::InvalidParameter,
      "the weights of point and tangent distances are both 0; give one of them a weight" };
  }
  if (!(params.Accuracy >= 0.0) || !std::isfinite(params.Accuracy))
  {
    return OutOfRange("accuracy", "[0, infinity)", std::to_string(params.Accuracy));
  }
  if (!(params.MaxIrregularShare >= 0.0 && params.MaxIrregularShare <= 1.0))
  {
    return OutOfRange(
      "share of irregular points", "[0, 1]", std::to_string(params.MaxIrregularShare));
  }
  if (Status status = CheckRefinement(params); !status)
  {
    return status;
  }
  if (params.InitialMap)
  {
    return {};
  }
  if (params.Degree < 1 || params.Degree > MaxDegree)
  {
    return { ErrorCode::InvalidDegree,
      "degree " + std::to_string(params.Degree) + " is outside [1, 9]" };
  }
  for (int knots : params.InnerKnots)
  {
    if (knots < 0 || knots > 4096)
    {
      return OutOfRange("inner knots", "[0, 4096]", std::to_string(knots));
    }
  }
  return {};
}

template <int Dim>
Status CheckInside(const ParametricBox<Dim>& inner, const ParametricBox<Dim>& outer)
{
  for (std::size_t d = 0; d < Dim; ++d)
  {
    const double slack = 1e-12 * (outer.Upper[d] - outer.Lower[d]); // as SplineSpace::Locate
    if (!(outer.Upper[d] > outer.Lower[d]) || !std::isfinite(outer.Upper[d] - outer.Lower[d]))
    {
      return { ErrorCode::InvalidParameter,
        "the domain is empty in direction " + std::to_string(d) +
          "; a template on an axis-parallel line needs a domain of its own" };
    }
    if (inner.Lower[d] < outer.Lower[d] - slack || inner.Upper[d] > outer.Upper[d] + slack)
    {
      return { ErrorCode::InvalidParameter,
        "the template reaches outside the domain in direction " + std::to_string(d) };
    }
  }
  return {};
}

/// The given map, or the identity in Greville abscissae.
template <int Dim>
Result<Spline<Dim>> StartMap(const Skeleton<Dim>& skeleton, const TemplateMapParams<Dim>& params)
{
  const ParametricBox<Dim> box = BoundingBox(skeleton);
  if (params.InitialMap)
  {
    const Spline<Dim>& map = *params.InitialMap;
    if (!map.Space || !map.Space->HasDomain() || map.NumComponents() != Dim || map.IsRational())
    {
      return { ErrorCode::DimensionMismatch,
        "the initial map must be polynomial, of as many components as parameters, with a domain" };
    }
    if (Status status = map.Check(); !status)
    {
      return { status.Code, "initial map: " + status.Detail };
    }
    if (Status status = CheckInside(box, map.Space->Domain()); !status)
    {
      return status;
    }
    return map;
  }
  const ParametricBox<Dim> domain = params.Domain.value_or(box);
  if (Status status = CheckInside(box, domain); !status)
  {
    return status;
  }
  double functions = 1.0;
  for (const int inner : params.InnerKnots)
  {
    functions *= 1.0 * inner + params.Degree + 1;
  }
  if (Status status = CheckSize(functions, params.MaxFunctions, "functions", "MaxFunctions");
      !status)
  {
    return status;
  }
  std::array<KnotVector, Dim> knots;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    knots[d] = KnotVector::Uniform(
      params.Degree, params.InnerKnots[d] + 1, domain.Lower[d], domain.Upper[d]);
  }
  Result<SplineSpacePtr<Dim>> space = MakeTensorSpace<Dim>(knots);
  if (!space)
  {
    return space.Status;
  }
  Spline<Dim> map;
  map.ControlPoints = GrevillePoints(*space.Value);
  map.Space = std::move(space.Value);
  return map;
}

/// The iterations of MapTemplate: a step for the control points, an update of the closest points, a
/// refinement of the space, in turn.
template <int Dim>
class MapLoop
{
public:
  MapLoop(TemplateProblem<Dim>& problem, const TemplateMapParams<Dim>& params, Spline<Dim> start)
    : Problem(problem), Params(params), First(std::move(start)), Guard(params.Threads)
  {
    const bool tangent = params.Method == TemplateMapMethod::Tdm;
    const bool both = params.Method == TemplateMapMethod::Weighted;
    this->Weights.Point = both ? params.PdmWeight : tangent ? 0.0 : 1.0;
    this->Weights.Normal = both ? params.TdmWeight : tangent ? 1.0 : 0.0;
    this->Weights.Uniformity = params.UniformityWeight;
    this->Weights.Length = params.LengthWeight;
    this->Weights.Orthogonality = params.OrthogonalityWeight;
    this->Weights.Skewness = params.SkewnessWeight;
    this->Weights.Eccentricity = params.EccentricityWeight;
    this->Weights.Area = params.AreaWeight;
    this->Weights.SelfIntersection = params.SelfIntersectionWeight;
  }

  Result<TemplateMapResult<Dim>> Run()
  {
    Status status = this->Begin(false);
    int iteration = 1;
    while (status && iteration <= this->Params.Iterations && !this->IsDone)
    {
      if (this->Params.Progress &&
        !this->Params.Progress(double(iteration - 1) / this->Params.Iterations))
      {
        return { ErrorCode::Aborted, "before iteration " + std::to_string(iteration) };
      }
      status = this->Iterate(iteration);
      if (!status)
      {
        status.Detail = "iteration " + std::to_string(iteration) + ": " + status.Detail;
      }
      iteration = static_cast<int>(this->Out.History.size()) + 1;
    }
    return status ? this->Finish() : Result<TemplateMapResult<Dim>>(status);
  }

private:
  using Clock = std::chrono::steady_clock;

  /// The first map, and the samples where they were given or where they are closest to it.
  Status Begin(bool closest)
  {
    this->Map = this->First;
    this->Out.History.clear();
    this->IsSearched = closest;
    this->Weights.Proximal = this->Params.TikhonovWeight;
    this->Problem.ForgetPlaces();
    if (Status status = this->EnterSpace(); !status)
    {
      return status;
    }
    if (this->Params.Guard && !this->Guard.IsRegular())
    {
      Result<Spline<Dim>> unfolded = RemoveFolds(this->Map, this->Params.Threads);
      if (!unfolded)
      {
        return unfolded.Status;
      }
      this->First = this->Map = std::move(unfolded.Value);
      if (Status status = this->EnterSpace(); !status)
      {
        return status;
      }
    }
    const bool moves =
      this->Params.Start != TemplateInitialMap::Identity && !this->Params.InitialMap;
    for (int pass = moves ? 0 : 1; pass < 2; ++pass)
    {
      if (closest)
      {
        TemplateMapIteration ignored;
        this->Problem.Project(this->Form, false, ignored);
      }
      if (pass == 0)
      {
        if (Status status = this->MoveFirst(); !status)
        {
          return status;
        }
      }
    }
    return {};
  }

  /// All that depends on the space, for the present map.
  Status EnterSpace()
  {
    const bool coupled = this->Weights.Normal > 0.0 || HasMeasures(this->Weights);
    this->System = std::make_unique<FitSystem<Dim>>(
      this->Map.Space, coupled, FitSolver::Automatic, this->Params.Threads);
    this->Problem.SetSpace(*this->Map.Space);
    this->Form = MakeBezierForm(this->Map, this->Params.Threads);
    this->Problem.Update(this->Form);
    return this->Params.Guard ? this->Guard.Begin(this->Form) : Status{};
  }

  /// The step of Moved, and that of Quadratic.
  Result<PointMatrix> StepOfRowSums() const;
  Result<PointMatrix> StepOfLeastBending();
  /// From the identity to the initial map, as far as the guard lets it go.
  Status MoveFirst();
  Status Iterate(int iteration);
  /// @param restart  set when the map has to begin anew.
  Status TakeStep(TemplateMapIteration& record, bool& restart);
  /// Share of a step at which the sum of all terms falls: 1 when all of them are quadratic.
  double FallingShare(const FitSamples<Dim>& samples, const PointMatrix& step) const;
  bool IsRefinementDue() const;
  /// What a refinement that is due makes of the space: the same space when there is nothing to do.
  Result<SplineSpacePtr<Dim>> FinerSpace() const;
  Status Refine();
  Result<TemplateMapResult<Dim>> Finish();

  TemplateProblem<Dim>& Problem;
  const TemplateMapParams<Dim>& Params;
  Clock::time_point Start = Clock::now();
  Spline<Dim> First;
  Spline<Dim> Map;
  BezierForm<Dim> Form; // of Map
  RegularityGuard<Dim> Guard;
  FitWeights Weights;
  std::unique_ptr<FitSystem<Dim>> System;
  TemplateMapResult<Dim> Out;
  bool IsSearched = false; // the first step was made at closest points
  bool IsDone = false;
};

template <int Dim>
Result<PointMatrix> MapLoop<Dim>::StepOfRowSums() const
{
  const FitSamples<Dim> samples = this->Problem.Samples();
  auto values = CollocationMatrix(*this->Map.Space, samples.Parameters, this->Params.Threads);
  if (!values)
  {
    return values.Status;
  }
  const Eigen::VectorXd sums =
    values->transpose() * Eigen::VectorXd::Ones(samples.Parameters.rows());
  PointMatrix step = values->transpose() * Eigen::MatrixXd(samples.Residuals);
  const Eigen::RowVectorXd mean = samples.Residuals.colwise().mean();
  for (Eigen::Index f = 0; f < step.rows(); ++f)
  {
    step.row(f) = sums(f) > 0.0 ? Eigen::RowVectorXd(step.row(f) / sums(f)) : mean;
  }
  return step;
}

template <int Dim>
Result<PointMatrix> MapLoop<Dim>::StepOfLeastBending()
{
  FitWeights weights;
  weights.Point = 1.0;
  weights.Uniformity = this->Params.InitialUniformityWeight;
  weights.Proximal = InitialProximal * weights.Uniformity;
  FitSystem<Dim> system(this->Map.Space, false, FitSolver::Automatic, this->Params.Threads);
  return system.Step(this->Problem.Samples(), weights, this->Map.ControlPoints);
}

template <int Dim>
Status MapLoop<Dim>::MoveFirst()
{
  const Result<PointMatrix> step = this->Params.Start == TemplateInitialMap::Moved
    ? this->StepOfRowSums()
    : this->StepOfLeastBending();
  if (!step)
  {
    return { step.Status.Code, "initial map: " + step.Status.Detail };
  }
  const PointMatrix before = this->Map.ControlPoints;
  for (double length = 1.0; length > 1e-3; length *= 0.5)
  {
    this->Map.ControlPoints = before + length * step.Value;
    if (Status status = this->EnterSpace(); !status)
    {
      return status;
    }
    if (!this->Params.Guard || this->Guard.IsRegular())
    {
      return {};
    }
  }
  this->Map.ControlPoints = before;
  return this->EnterSpace();
}

template <int Dim>
Status MapLoop<Dim>::Iterate(int iteration)
{
  TemplateMapIteration record;
  record.Iteration = iteration;
  const Spline<Dim> before = this->Map;
  bool restart = false;
  if (Status status = this->TakeStep(record, restart); !status)
  {
    return status;
  }
  if (restart)
  {
    return this->Begin(true);
  }
  Result<double> share = NegativeJacobianShare(this->Form, GridPoints<Dim>, this->Params.Threads);
  if (!share)
  {
    return share.Status;
  }
  record.NegativeShare = share.Value;
  const bool isTooIrregular = record.NegativeShare > this->Params.MaxIrregularShare;
  if (isTooIrregular && !this->Out.History.empty())
  {
    this->Map = before;
    this->Form = MakeBezierForm(this->Map, this->Params.Threads);
    this->Problem.Update(this->Form);
    this->IsDone = true;
    return {};
  }
  this->Problem.Update(this->Form);
  this->Problem.Project(this->Form, this->Params.Method == TemplateMapMethod::Fixed, record);
  record.Functions = this->Map.Space->NumFunctions;
  record.Seconds = std::chrono::duration<double>(Clock::now() - this->Start).count();
  this->Out.History.push_back(record);
  this->IsDone = isTooIrregular || record.MaxError <= this->Params.Accuracy;
  const bool isLast = this->IsDone || iteration == this->Params.Iterations;
  return !isLast && this->IsRefinementDue() ? this->Refine() : Status{};
}

template <int Dim>
Status MapLoop<Dim>::TakeStep(TemplateMapIteration& record, bool& restart)
{
  const FitSamples<Dim> samples = this->Problem.Samples();
  const auto shorten = [&](const PointMatrix& step) { return this->FallingShare(samples, step); };
  if (!this->Params.Guard)
  {
    Result<PointMatrix> step = this->System->Step(samples, this->Weights, this->Map.ControlPoints);
    if (step)
    {
      record.StepLength = shorten(step.Value);
      this->Map.ControlPoints += record.StepLength * step.Value;
      this->Form = MakeBezierForm(this->Map, this->Params.Threads);
    }
    return step.Status;
  }
  // Places that were given can ask for a turn or a fold which closest points do not: begin there.
  const bool giveUp = !this->IsSearched && this->Params.Method != TemplateMapMethod::Fixed &&
    this->Problem.HasGivenPlaces();
  const auto outcome =
    this->Guard.Step(*this->System, samples, this->Weights, this->Map, this->Form, shorten, giveUp);
  if (!outcome)
  {
    return outcome.Status;
  }
  restart = giveUp && outcome->IsEndangered;
  record.StepLength = outcome->Length;
  record.HeldElements = outcome->Held;
  if (this->IsSearched && !outcome->IsEndangered)
  {
    this->Weights.Proximal =
      std::max(Relaxation * this->Weights.Proximal, LeastProximal * this->Params.TikhonovWeight);
  }
  return {};
}

template <int Dim>
double MapLoop<Dim>::FallingShare(const FitSamples<Dim>& samples, const PointMatrix& step) const
{
  if (!HasMeasures(this->Weights))
  {
    return 1.0;
  }
  EvaluationBatch moved; // by the whole step
  Spline<Dim> change = this->Map;
  change.ControlPoints = step;
  EvaluateParameters(MakeBezierForm(change, this->Params.Threads), samples.Parameters,
    { 0, this->Params.Threads }, moved);
  const auto total = [&](double length)
  {
    const PointMatrix left = samples.Residuals - length * moved.Values;
    double sum = this->Weights.Point * left.squaredNorm() +
      this->Weights.Proximal * length * length * step.squaredNorm();
    if (this->Weights.Normal > 0.0)
    {
      sum +=
        this->Weights.Normal * left.cwiseProduct(samples.Normals).rowwise().sum().squaredNorm();
    }
    const PointMatrix points = this->Map.ControlPoints + length * step;
    for (int k = 0; k < NumQualityKinds; ++k)
    {
      const QualityKind kind = static_cast<QualityKind>(k);
      const double weight = QualityWeight(this->Weights, kind);
      if (weight > 0.0)
      {
        sum += weight * QualityValue<Dim>(this->Map.Space, points, kind, this->Params.Threads);
      }
    }
    return sum;
  };
  const double present = total(0.0);
  double length = 1.0;
  for (int k = 0; k < Halvings && !(total(length) < present); ++k)
  {
    length *= 0.5;
  }
  return length;
}

template <int Dim>
bool MapLoop<Dim>::IsRefinementDue() const
{
  if (this->Params.Refinement == TemplateRefinement::None)
  {
    return false;
  }
  const auto& history = this->Out.History;
  if (this->Params.RefineEvery > 0)
  {
    return history.size() % static_cast<std::size_t>(this->Params.RefineEvery) == 0;
  }
  const std::size_t last = history.size() - 1;
  return last > 0 && history[last].Functions == history[last - 1].Functions &&
    history[last].SquaredError >
    (1.0 - this->Params.StagnationRatio) * history[last - 1].SquaredError;
}

template <int Dim>
Result<SplineSpacePtr<Dim>> MapLoop<Dim>::FinerSpace() const
{
  const SplineSpacePtr<Dim>& space = this->Map.Space;
  switch (this->Params.Refinement)
  {
    case TemplateRefinement::None:
      break;
    case TemplateRefinement::Local:
      return RefineAround(space,
        this->Problem.FarSamples(this->Params.RefineThreshold, this->Params.RefineShare),
        this->Params.Extension, this->Params.MaxLevel);
    case TemplateRefinement::Global:
      return RefineEverywhere(space, this->Params.MaxLevel);
    case TemplateRefinement::Held:
      return RefineHeld(
        space, this->Guard.HeldElements(), this->Params.Extension, this->Params.MaxLevel);
  }
  return space;
}

template <int Dim>
Status MapLoop<Dim>::Refine()
{
  const Result<SplineSpacePtr<Dim>> finer = this->FinerSpace();
  if (!finer)
  {
    return finer.Status;
  }
  if (finer.Value == this->Map.Space || finer.Value->NumFunctions > this->Params.MaxFunctions)
  {
    return {};
  }
  Result<Spline<Dim>> map = TransferToRefined(this->Map, finer.Value);
  if (!map)
  {
    return map.Status;
  }
  this->Map = std::move(map.Value);
  return this->EnterSpace();
}

template <int Dim>
Result<TemplateMapResult<Dim>> MapLoop<Dim>::Finish()
{
  Result<Regularity> regularity =
    MeasureRegularity(this->Form, ResultGap, ResultBoxes, this->Params.Threads);
  if (!regularity)
  {
    return regularity.Status;
  }
  if (this->Params.Injectivity)
  {
    auto injectivity =
      ProveMapInjectivity(this->Form, regularity->Certificate, ResultBoxes, this->Params.Threads);
    if (!injectivity)
    {
      return injectivity.Status;
    }
    this->Out.Injectivity = std::move(injectivity.Value);
  }
  this->Out.MinJacobianBound = regularity->Bound();
  this->Out.ElementMinJacobian = std::move(regularity->MinLower);
  this->Out.ElementMaxJacobian = std::move(regularity->MaxUpper);
  this->Out.Certificate = std::move(regularity->Certificate);
  this->Out.Map = std::move(this->Map);
  this->Problem.Report(this->Out);
  if (this->Params.Progress && !this->Params.Progress(1.0))
  {
    return { ErrorCode::Aborted, "after the last iteration" };
  }
  return std::move(this->Out);
}
}

template <int Dim>
Result<TemplateMapResult<Dim>> MapTemplate(const Skeleton<Dim>& templateSkeleton,
  const Skeleton<Dim>& target, const TemplateMapParams<Dim>& params)
{
  if (Status status = CheckOptions(params); !status)
  {
    return status;
  }
  if (Status status = CheckSkeletons(templateSkeleton, target); !status)
  {
    return status;
  }
  Result<Spline<Dim>> start = StartMap(templateSkeleton, params);
  if (!start)
  {
    return start.Status;
  }
  TemplateProblem<Dim> problem(templateSkeleton, target, *start->Space, params);
  return MapLoop<Dim>(problem, params, std::move(start.Value)).Run();
}

template Result<TemplateMapResult<2>> MapTemplate(
  const Skeleton<2>&, const Skeleton<2>&, const TemplateMapParams<2>&);
template Result<TemplateMapResult<3>> MapTemplate(
  const Skeleton<3>&, const Skeleton<3>&, const TemplateMapParams<3>&);
}
