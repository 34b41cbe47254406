// SPDX-License-Identifier: BSD-3-Clause
#include "TemplateMap.h"

#include "ClosestPoints.h"
#include "FitSystem.h"
#include "NegativeJacobian.h"
#include "TensorSpace.h"

#include <chrono>
#include <cmath>
#include <string>

namespace knotwork
{
namespace
{
constexpr int JacobianGrid = 1000; // points a direction of the negative share: what papers report

/// A target patch and the template patch that is carried onto it.
template <int Dim>
struct Constraint
{
  std::size_t Template = 0; // index of the template patch
  PointMatrix Points;       // p_i
  PointMatrix Normals;      // N_i; empty unless the method reads them
  TargetIndex<Dim> Target;
  PatchFeet Closest; // present parameters, feet and distances
};

Status OutOfRange(const char* option, const std::string& range, const std::string& value)
{
  return { ErrorCode::InvalidParameter,
    std::string(option) + " must be in " + range + ", not " + value };
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
  if (!(params.TikhonovWeight >= 0.0) || !std::isfinite(params.TikhonovWeight))
  {
    return OutOfRange("Tikhonov weight", "[0, infinity)", std::to_string(params.TikhonovWeight));
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

/// The map of the first iteration: the given one, or the identity in Greville abscissae.
template <int Dim>
Result<Spline<Dim>> StartMap(const Skeleton<Dim>& skeleton, const TemplateMapParams<Dim>& params)
{
  const ParametricBox<Dim> box = BoundingBox(skeleton);
  if (params.InitialMap)
  {
    const Spline<Dim>& map = *params.InitialMap;
    if (!map.Space || !map.Space->HasDomain || map.NumComponents() != Dim || map.IsRational())
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

/// What iterations share: the patches and what is searched on them.
template <int Dim>
struct Problem
{
  const TemplateMapParams<Dim>& Params;
  std::vector<int> Ids;                     // of the template
  std::vector<MappedPatch<Dim>> Patches;    // of the template
  std::vector<Constraint<Dim>> Constraints; // of the target

  Problem(const Skeleton<Dim>& skeleton, const Skeleton<Dim>& target, const SplineSpace<Dim>& space,
    const TemplateMapParams<Dim>& params)
    : Params(params)
  {
    for (const SkeletonPatch<Dim>& patch : skeleton)
    {
      this->Ids.push_back(patch.Id);
      this->Patches.emplace_back(patch, params.TemplateSamples, space);
    }
    for (const SkeletonPatch<Dim>& patch : target)
    {
      Constraint<Dim> constraint;
      while (skeleton[constraint.Template].Id != patch.Id)
      {
        ++constraint.Template;
      }
      constraint.Closest.Places = this->Patches[constraint.Template].FirstPlaces(patch);
      constraint.Points = patch.Points;
      if (params.Method == TemplateMapMethod::Tdm)
      {
        constraint.Normals = UnitNormals(patch);
      }
      constraint.Target = TargetIndex<Dim>(patch);
      this->Constraints.push_back(std::move(constraint));
    }
  }

  /// Dense samples and distances under a map; parameters stay.
  void Update(const BezierForm<Dim>& form)
  {
    for (MappedPatch<Dim>& patch : this->Patches)
    {
      patch.Update(form, this->Params.Threads);
    }
    for (Constraint<Dim>& c : this->Constraints)
    {
      c.Closest =
        this->Patches[c.Template].At(form, c.Points, c.Closest.Places, this->Params.Threads);
    }
  }

  /// All target samples at their present parameters.
  FitSamples<Dim> Samples() const
  {
    Eigen::Index total = 0;
    for (const Constraint<Dim>& c : this->Constraints)
    {
      total += c.Points.rows();
    }
    FitSamples<Dim> samples;
    samples.Parameters.resize(total, Dim);
    samples.Residuals.resize(total, Dim);
    samples.Normals.resize(this->Params.Method == TemplateMapMethod::Tdm ? total : 0, Dim);
    Eigen::Index row = 0;
    for (const Constraint<Dim>& c : this->Constraints)
    {
      const Eigen::Index n = c.Points.rows();
      samples.Parameters.middleRows(row, n) =
        this->Patches[c.Template].DomainPoints(c.Closest.Places);
      samples.Residuals.middleRows(row, n) = c.Points - c.Closest.Feet;
      if (c.Normals.rows() > 0)
      {
        samples.Normals.middleRows(row, n) = c.Normals;
      }
      row += n;
    }
    return samples;
  }

  /// The closest-point update, and the errors after it.
  void Project(const BezierForm<Dim>& form, TemplateMapIteration& record)
  {
    double largest = 0.0;
    for (Constraint<Dim>& c : this->Constraints)
    {
      const MappedPatch<Dim>& patch = this->Patches[c.Template];
      PatchFeet closest = patch.Project(
        form, c.Points, c.Closest.Places, this->Params.NewtonSteps, this->Params.Threads);
      largest = std::max({ largest, closest.SquaredDistances.maxCoeff(),
        c.Target.LargestSquaredDistance(patch.MappedSamples(), this->Params.Threads) });
      if (this->Params.Method != TemplateMapMethod::Fixed)
      {
        c.Closest = std::move(closest);
      }
      record.SquaredError += c.Closest.SquaredDistances.sum();
    }
    record.MaxError = std::sqrt(largest);
  }

  void Finish(TemplateMapResult<Dim>& result) const;
};

/// Skeleton, parameters and errors of the finished map.
template <int Dim>
void Problem<Dim>::Finish(TemplateMapResult<Dim>& result) const
{
  const SplineSpace<Dim>& space = *result.Map.Space;
  result.ElementErrors.assign(static_cast<std::size_t>(space.NumElements()), 0.0);
  const auto raise = [&](int element, double error)
  {
    double& largest = result.ElementErrors[static_cast<std::size_t>(element)];
    largest = std::max(largest, error);
  };
  for (std::size_t k = 0; k < this->Patches.size(); ++k)
  {
    const MappedPatch<Dim>& patch = this->Patches[k];
    MappedSkeletonPatch mapped;
    mapped.Id = this->Ids[k];
    mapped.Free = true;
    mapped.Places = patch.SamplePlaces();
    mapped.Points = patch.MappedSamples();
    mapped.Distances = Eigen::VectorXd::Constant(mapped.Points.rows(), -1.0);
    result.Skeleton.push_back(std::move(mapped));
  }
  for (const Constraint<Dim>& c : this->Constraints)
  {
    const MappedPatch<Dim>& patch = this->Patches[c.Template];
    MappedSkeletonPatch& mapped = result.Skeleton[c.Template];
    mapped.Free = false;
    mapped.Distances = c.Target.SquaredDistances(mapped.Points, this->Params.Threads).cwiseSqrt();
    for (Eigen::Index i = 0; i < mapped.Distances.size(); ++i)
    {
      raise(patch.SampleElements()[static_cast<std::size_t>(i)], mapped.Distances(i));
    }
    result.Parameters.push_back(c.Closest.Places.col(0));
    result.SampleErrors.push_back(c.Closest.SquaredDistances.cwiseSqrt());
    const PointMatrix places = patch.DomainPoints(c.Closest.Places);
    for (Eigen::Index i = 0; i < places.rows(); ++i)
    {
      double local[Dim];
      raise(space.Locate(places.row(i).data(), local), result.SampleErrors.back()(i));
    }
  }
}
}

template <int Dim>
Result<TemplateMapResult<Dim>> MapTemplate(const Skeleton<Dim>& templateSkeleton,
  const Skeleton<Dim>& target, const TemplateMapParams<Dim>& params)
{
  const auto start = std::chrono::steady_clock::now();
  if (Status status = CheckOptions(params); !status)
  {
    return status;
  }
  if (Status status = CheckSkeletons(templateSkeleton, target); !status)
  {
    return status;
  }
  Result<Spline<Dim>> startMap = StartMap(templateSkeleton, params);
  if (!startMap)
  {
    return startMap.Status;
  }
  TemplateMapResult<Dim> result;
  result.Map = std::move(startMap.Value);
  const SplineSpace<Dim>& space = *result.Map.Space;

  const bool tangent = params.Method == TemplateMapMethod::Tdm;
  FitWeights weights;
  (tangent ? weights.Normal : weights.Point) = 1.0;
  weights.Proximal = params.TikhonovWeight;
  Problem<Dim> problem(templateSkeleton, target, space, params);
  FitSystem<Dim> system(result.Map.Space, tangent);
  problem.Update(MakeBezierForm(result.Map, params.Threads));
  for (int iteration = 1; iteration <= params.Iterations; ++iteration)
  {
    if (params.Progress && !params.Progress(double(iteration - 1) / params.Iterations))
    {
      return { ErrorCode::Aborted, "before iteration " + std::to_string(iteration) };
    }
    Result<PointMatrix> step = system.Step(problem.Samples(), weights, result.Map.ControlPoints);
    if (!step)
    {
      return { step.Status.Code,
        "iteration " + std::to_string(iteration) + ": " + step.Status.Detail };
    }
    result.Map.ControlPoints += step.Value;
    const BezierForm<Dim> form = MakeBezierForm(result.Map, params.Threads);
    TemplateMapIteration record;
    record.Iteration = iteration;
    problem.Update(form);
    problem.Project(form, record);
    Result<double> share = NegativeJacobianShare(form, JacobianGrid, params.Threads);
    if (!share)
    {
      return share.Status;
    }
    record.NegativeShare = share.Value;
    record.Functions = space.NumFunctions;
    record.Seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    result.History.push_back(record);
  }
  problem.Finish(result);
  if (params.Progress && !params.Progress(1.0))
  {
    return { ErrorCode::Aborted, "after the last iteration" };
  }
  return result;
}

template Result<TemplateMapResult<2>> MapTemplate(
  const Skeleton<2>&, const Skeleton<2>&, const TemplateMapParams<2>&);
}
