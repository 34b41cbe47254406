// SPDX-License-Identifier: BSD-3-Clause
#include "Composition.h"

#include "BezierProjection.h"
#include "HierarchicalSpace.h"
#include "Numbers.h"
#include "Parallel.h"
#include "PatchTraces.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <string>

namespace knotwork
{
namespace
{
std::size_t At(std::int64_t i)
{
  return static_cast<std::size_t>(i);
}

/// outer o inner at parameters (or element + local parameters without a domain), first failure
/// kept.
template <int Dim>
class Composed
{
public:
  Composed(const BezierForm<Dim>& inner, const PointMap& outer) : Inner(inner), Outer(outer) {}

  bool Evaluate(
    int element, const PointMatrix& local, const PointMatrix& parameters, PointMatrix& values) const
  {
    EvaluationBatch batch;
    EvaluationParams params;
    params.Threads = 1;
    Status status;
    if (this->Inner.Space->HasDomain())
    {
      status = EvaluateParameters<Dim>(this->Inner, parameters, params, batch);
    }
    else
    {
      const std::vector<int> elements(At(local.rows()), element);
      status = EvaluateElements<Dim>(this->Inner, elements, local, params, batch);
    }
    if (status)
    {
      PointMatrix result;
      status = this->Outer(batch.Values, result);
      if (status)
      {
        values = result;
        return true;
      }
    }
    const std::lock_guard<std::mutex> lock(this->Mutex);
    if (this->First)
    {
      this->First = status;
    }
    return false;
  }

  /// The first failure of the outer map if there was one, else the projection's own status.
  Status Explain(const Status& status) const { return this->First ? status : this->First; }

private:
  const BezierForm<Dim>& Inner;
  const PointMap& Outer;
  mutable std::mutex Mutex;
  mutable Status First;
};

template <int Dim>
Result<PointMatrix> Project(const Spline<Dim>& inner, const SplineSpacePtr<Dim>& space,
  int numComponents, const PointMap& outer, int threads)
{
  const BezierForm<Dim> form = MakeBezierForm<Dim>(inner, threads);
  const Composed<Dim> composed(form, outer);
  ProjectionParams params;
  params.Threads = threads;
  const Result<Spline<Dim>> projected = ProjectOntoSpace<Dim>(
    space, numComponents,
    [&](int element, const PointMatrix& local, const PointMatrix& parameters, PointMatrix& values)
    { return composed.Evaluate(element, local, parameters, values); },
    params);
  if (!projected)
  {
    return composed.Explain(projected.Status);
  }
  return projected.Value.ControlPoints;
}

template <int Dim>
class Composer
{
public:
  Composer(const std::vector<Spline<Dim>>& inner, int numComponents, const PointMap& outer,
    const CompositionParams& params)
    : Inner(inner), NumComponents(numComponents), Outer(outer), Params(params)
  {
  }

  Result<CompositionResult<Dim>> Run()
  {
    CompositionResult<Dim> result;
    for (const Spline<Dim>& spline : this->Inner)
    {
      this->Spaces.push_back(spline.Space);
    }
    this->Entities = FindSharedTraces<Dim>(this->Inner);
    for (std::size_t i = 0; i < this->Entities.size(); ++i)
    {
      const bool shared = this->Entities[i].Owner != static_cast<int>(i);
      result.NumInterfaces += shared && this->Entities[i].Free == Dim - 1 ? 1 : 0;
    }
    for (int round = 0;; ++round)
    {
      Status status = this->ProjectAll(result);
      if (!status)
      {
        return status;
      }
      std::vector<std::vector<int>> marked(this->Spaces.size());
      result.Distances.assign(this->Spaces.size(), 0.0);
      for (std::size_t p = 0; p < this->Spaces.size(); ++p)
      {
        status = this->Measure(p, result, marked[p]);
        if (!status)
        {
          return WithPatch(status, p);
        }
      }
      if (this->Params.Progress &&
        !this->Params.Progress(
          static_cast<double>(round + 1) / static_cast<double>(this->Params.MaxLevel + 2)))
      {
        return { ErrorCode::Aborted, "" };
      }
      bool refined = false;
      status = this->Refine(marked, refined);
      if (!status)
      {
        return status;
      }
      if (!refined)
      {
        return result;
      }
    }
  }

private:
  static Status WithPatch(const Status& status, std::size_t patch)
  {
    return { status.Code, "patch " + std::to_string(patch) + ": " + status.Detail };
  }

  /// Interiors first, then sides, edges, corners: each overwrites what came before.
  Status ProjectAll(CompositionResult<Dim>& result)
  {
    result.Patches.assign(this->Inner.size(), {});
    for (std::size_t p = 0; p < this->Inner.size(); ++p)
    {
      const Result<PointMatrix> projected = Project<Dim>(
        this->Inner[p], this->Spaces[p], this->NumComponents, this->Outer, this->Params.Threads);
      if (!projected)
      {
        return WithPatch(projected.Status, p);
      }
      result.Patches[p].Space = this->Spaces[p];
      result.Patches[p].ControlPoints = projected.Value;
    }
    Status status;
    if constexpr (Dim == 3)
    {
      status = this->ProjectEntities<2>(result);
    }
    if constexpr (Dim >= 2)
    {
      status = status ? this->ProjectEntities<1>(result) : status;
    }
    return status ? this->ProjectCorners(result) : status;
  }

  template <int Free>
  Status ProjectEntities(CompositionResult<Dim>& result)
  {
    for (std::size_t i = 0; i < this->Entities.size(); ++i)
    {
      const PatchTrace<Dim>& entity = this->Entities[i];
      if (entity.Free != Free)
      {
        continue;
      }
      const std::size_t p = At(entity.Patch);
      if (entity.Owner != static_cast<int>(i))
      {
        this->CopyOnOwner(entity, result);
        continue;
      }
      const auto from = MakeTrace<Dim, Free>(*this->Inner[p].Space, entity.Entity);
      const auto to = MakeTrace<Dim, Free>(*this->Spaces[p], entity.Entity);
      if (!from || !to)
      {
        return WithPatch(from ? to.Status : from.Status, p);
      }
      const Result<PointMatrix> projected =
        Project<Free>(TraceOf<Dim, Free>(this->Inner[p], from.Value), to->Space,
          this->NumComponents, this->Outer, this->Params.Threads);
      if (!projected)
      {
        return WithPatch(projected.Status, p);
      }
      for (std::size_t f = 0; f < to->Functions.size(); ++f)
      {
        result.Patches[p].ControlPoints.row(to->Functions[f]) =
          projected.Value.row(static_cast<Eigen::Index>(f));
      }
    }
    return {};
  }

  Status ProjectCorners(CompositionResult<Dim>& result)
  {
    for (std::size_t i = 0; i < this->Entities.size(); ++i)
    {
      const PatchTrace<Dim>& entity = this->Entities[i];
      if (entity.Free != 0)
      {
        continue;
      }
      const std::size_t p = At(entity.Patch);
      const auto from = TraceFunctions<Dim>(*this->Inner[p].Space, entity.Entity);
      const auto to = TraceFunctions<Dim>(*this->Spaces[p], entity.Entity);
      const PointMatrix corner = this->Inner[p].ControlPoints.row(from.begin()->second);
      PointMatrix value;
      const Status status = this->Outer(corner, value);
      if (!status)
      {
        return WithPatch(status, p);
      }
      result.Patches[p].ControlPoints.row(to.begin()->second) = value.row(0);
    }
    return {};
  }

  void CopyOnOwner(const PatchTrace<Dim>& entity, CompositionResult<Dim>& result) const
  {
    const PatchTrace<Dim>& owner = this->Entities[At(entity.Owner)];
    const auto from = TraceFunctions<Dim>(*this->Spaces[At(owner.Patch)], owner.Entity);
    const auto to = TraceFunctions<Dim>(*this->Spaces[At(entity.Patch)], entity.Entity);
    const auto knots = TraceKnots<Dim>(*this->Spaces[At(entity.Patch)], entity.Entity);
    for (const auto& [key, function] : from)
    {
      const auto found = to.find(OrientedKey(key, entity.OnOwner, knots));
      if (found != to.end()) // always: MirrorRefinement made the trace spaces equal
      {
        result.Patches[At(entity.Patch)].ControlPoints.row(found->second) =
          result.Patches[At(owner.Patch)].ControlPoints.row(function);
      }
    }
  }

  /// Distance on a regular grid of every element; elements above the tolerance are marked.
  Status Measure(std::size_t p, CompositionResult<Dim>& result, std::vector<int>& marked) const
  {
    const SplineSpace<Dim>& space = *this->Spaces[p];
    const BezierForm<Dim> inner = MakeBezierForm<Dim>(this->Inner[p], this->Params.Threads);
    const BezierForm<Dim> approximation =
      MakeBezierForm<Dim>(result.Patches[p], this->Params.Threads);
    const Composed<Dim> composed(inner, this->Outer);
    std::vector<double> distance(space.Elements.size(), 0.0);
    std::vector<char> failed(space.Elements.size(), 0);
    ParallelFor(space.Elements.size(), 8, this->Params.Threads,
      [&](std::size_t begin, std::size_t end)
      {
        EvaluationBatch batch;
        EvaluationParams evaluation;
        evaluation.Threads = 1;
        for (std::size_t e = begin; e < end; ++e)
        {
          const auto& element = space.Elements[e];
          IntArray<Dim> counts;
          Eigen::Index n = 1;
          for (std::size_t d = 0; d < Dim; ++d)
          {
            counts[d] = this->Params.Samples != 0 ? this->Params.Samples : element.Degree[d] + 3;
            n *= counts[d];
          }
          PointMatrix local(n, Dim);
          PointMatrix parameters(n, Dim);
          for (Eigen::Index i = 0; i < n; ++i)
          {
            Eigen::Index rest = i;
            for (std::size_t d = 0; d < Dim; ++d)
            {
              const double t = static_cast<double>(rest % counts[d]) / (counts[d] - 1);
              rest /= counts[d];
              local(i, static_cast<Eigen::Index>(d)) = t;
              parameters(i, static_cast<Eigen::Index>(d)) =
                (1.0 - t) * element.Box.Lower[d] + t * element.Box.Upper[d];
            }
          }
          PointMatrix exact;
          const std::vector<int> elements(At(n), static_cast<int>(e));
          if (!composed.Evaluate(static_cast<int>(e), local, parameters, exact) ||
            !EvaluateElements<Dim>(approximation, elements, local, evaluation, batch))
          {
            failed[e] = 1;
            continue;
          }
          distance[e] = (exact - batch.Values).rowwise().norm().maxCoeff();
        }
      });
    for (std::size_t e = 0; e < distance.size(); ++e)
    {
      if (failed[e])
      {
        return composed.Explain({ ErrorCode::OutsideDomain, "element " + std::to_string(e) });
      }
      result.Distances[p] = std::max(result.Distances[p], distance[e]);
      if (this->Params.Tolerance > 0.0 && distance[e] > this->Params.Tolerance &&
        space.HasDomain() && space.Elements[e].Level < this->Params.MaxLevel)
      {
        marked.push_back(static_cast<int>(e));
      }
    }
    return {};
  }

  Status Refine(const std::vector<std::vector<int>>& marked, bool& refined)
  {
    refined = false;
    for (std::size_t p = 0; p < marked.size(); ++p)
    {
      if (marked[p].empty())
      {
        continue;
      }
      RefinementParams params;
      params.MaxLevel = this->Params.MaxLevel;
      params.Extension = this->Params.Extension;
      if (params.Extension < 0)
      {
        params.Extension = 0;
        for (const KnotVector& knots : this->Spaces[p]->Knots)
        {
          params.Extension = std::max(params.Extension, knots.Degree() / 2);
        }
      }
      const double functions =
        this->Spaces[p]->NumFunctions + static_cast<double>(marked[p].size()) * ((1 << Dim) - 1);
      if (Status status = CheckSize(functions, this->Params.MaxFunctions); !status)
      {
        return WithPatch(status, p);
      }
      const Result<SplineSpacePtr<Dim>> finer =
        RefineElements<Dim>(this->Spaces[p], marked[p], params);
      if (!finer)
      {
        return WithPatch(finer.Status, p);
      }
      refined = refined || finer.Value->NumElements() > this->Spaces[p]->NumElements();
      this->Spaces[p] = finer.Value;
    }
    if (!refined)
    {
      return {};
    }
    // Until the traces of all sides that are one are refined alike.
    for (bool changed = true; changed;)
    {
      changed = false;
      for (const PatchTrace<Dim>& entity : this->Entities)
      {
        const PatchTrace<Dim>& owner = this->Entities[At(entity.Owner)];
        if (&owner == &entity)
        {
          continue;
        }
        Status status;
        if constexpr (Dim == 3)
        {
          if (entity.Free == 2)
          {
            status = this->Mirror<2>(owner, entity, changed);
          }
        }
        if constexpr (Dim >= 2)
        {
          if (status && entity.Free == 1)
          {
            status = this->Mirror<1>(owner, entity, changed);
          }
        }
        if (!status)
        {
          return status;
        }
      }
    }
    return {};
  }

  /// Refines both patches along a common side to the union of their traces' hierarchies.
  template <int Free>
  Status Mirror(const PatchTrace<Dim>& owner, const PatchTrace<Dim>& entity, bool& changed)
  {
    const auto knots = TraceKnots<Dim>(*this->Spaces[At(entity.Patch)], entity.Entity);
    std::vector<HierarchyBox<Free>> toEntity =
      TraceBoxes<Dim, Free>(*this->Spaces[At(owner.Patch)], owner.Entity);
    std::vector<HierarchyBox<Free>> toOwner =
      TraceBoxes<Dim, Free>(*this->Spaces[At(entity.Patch)], entity.Entity);
    // the axes of what the boxes are turned to and those they come from, in the entity's order
    const auto turn = [&](std::vector<HierarchyBox<Free>>& boxes, const auto& to, const auto& from)
    {
      for (HierarchyBox<Free>& box : boxes)
      {
        const HierarchyBox<Free> old = box;
        for (std::size_t k = 0; k < Free; ++k)
        {
          const std::int64_t n = std::int64_t{ knots[k]->NumElements() } << box.Level;
          const bool reverse = entity.OnOwner.Reversed[k];
          box.Lower[to(k)] = reverse ? n - old.Upper[from(k)] : old.Lower[from(k)];
          box.Upper[to(k)] = reverse ? n - old.Lower[from(k)] : old.Upper[from(k)];
        }
      }
    };
    const auto own = [](std::size_t k) { return k; };
    const auto owners = [&](std::size_t k) { return At(entity.OnOwner.Axis[k]); };
    turn(toEntity, own, owners);
    turn(toOwner, owners, own);
    const Status status = this->RefineAlong<Free>(owner, toOwner, changed);
    return status ? this->RefineAlong<Free>(entity, toEntity, changed) : status;
  }

  template <int Free>
  Status RefineAlong(
    const PatchTrace<Dim>& entity, const std::vector<HierarchyBox<Free>>& traces, bool& changed)
  {
    SplineSpacePtr<Dim>& space = this->Spaces[At(entity.Patch)];
    std::vector<HierarchyBox<Dim>> boxes;
    for (const HierarchyBox<Free>& trace : traces)
    {
      HierarchyBox<Dim> box;
      box.Level = trace.Level;
      std::size_t next = 0;
      for (std::size_t d = 0; d < Dim; ++d)
      {
        const std::int64_t n = std::int64_t{ space->Knots[d].NumElements() } << box.Level;
        const bool free = entity.Entity[d] < 0;
        box.Lower[d] = free ? trace.Lower[next] : entity.Entity[d] == 0 ? 0 : n - 2;
        box.Upper[d] = free ? trace.Upper[next] : entity.Entity[d] == 0 ? 2 : n;
        next += free ? 1 : 0;
      }
      boxes.push_back(box);
    }
    if (boxes.empty())
    {
      return {};
    }
    const Result<SplineSpacePtr<Dim>> finer = RefineBoxes<Dim>(space, boxes);
    if (!finer)
    {
      return WithPatch(finer.Status, At(entity.Patch));
    }
    if (finer.Value->NumElements() > space->NumElements())
    {
      changed = true;
      space = finer.Value;
    }
    return {};
  }

  const std::vector<Spline<Dim>>& Inner;
  int NumComponents;
  const PointMap& Outer;
  const CompositionParams& Params;
  std::vector<SplineSpacePtr<Dim>> Spaces;
  std::vector<PatchTrace<Dim>> Entities;
};
}

template <int Dim>
Status MapPoints(const BezierForm<Dim>& map, const PointMatrixView& points, bool clamp, int threads,
  PointMatrix& values)
{
  if (!map.Space->HasDomain())
  {
    return { ErrorCode::DimensionMismatch,
      "the map has no parameter domain (Bezier elements of foreign origin)" };
  }
  if (points.cols() < Dim)
  {
    return { ErrorCode::DimensionMismatch,
      "points with " + std::to_string(points.cols()) + " coordinates for a map with " +
        std::to_string(Dim) + " parameters" };
  }
  const ParametricBox<Dim> domain = map.Space->Domain();
  PointMatrix parameters = points.leftCols(Dim);
  for (Eigen::Index i = 0; i < parameters.rows(); ++i)
  {
    for (int d = 0; d < Dim; ++d)
    {
      double& u = parameters(i, d);
      const double lower = domain.Lower[At(d)];
      const double upper = domain.Upper[At(d)];
      if (!std::isfinite(u))
      {
        return { ErrorCode::NonFiniteInput, "point " + std::to_string(i) };
      }
      if (!clamp && (u < lower - 1e-12 * (upper - lower) || u > upper + 1e-12 * (upper - lower)))
      {
        return { ErrorCode::OutsideDomain,
          "point " + std::to_string(i) + " has coordinate " + Digits(u) + " in direction " +
            std::to_string(d) + ", the domain is [" + Digits(lower) + ", " + Digits(upper) + "]" };
      }
      u = std::clamp(u, lower, upper);
    }
  }
  EvaluationParams params;
  params.Threads = threads;
  EvaluationBatch batch;
  const Status status = EvaluateParameters<Dim>(map, parameters, params, batch);
  values = std::move(batch.Values);
  return status;
}

template <int Dim>
Result<CompositionResult<Dim>> ComposeSplines(const std::vector<Spline<Dim>>& inner,
  int numComponents, const PointMap& outer, const CompositionParams& params)
{
  if (inner.empty())
  {
    return { ErrorCode::EmptyInput, "no spline to compose" };
  }
  if (!(params.Tolerance >= 0.0) || !std::isfinite(params.Tolerance) || params.MaxLevel < 0 ||
    params.MaxLevel > 20 || params.Extension < -1 || params.Extension > 10 ||
    (params.Samples != 0 && (params.Samples < 2 || params.Samples > 64)))
  {
    return { ErrorCode::InvalidParameter,
      "the tolerance must be >= 0, the maximum level in [0, 20], the extension in [-1, 10], the "
      "samples 0 or in [2, 64]" };
  }
  for (std::size_t p = 0; p < inner.size(); ++p)
  {
    const Status status = inner[p].Check();
    if (!status)
    {
      return { status.Code, "patch " + std::to_string(p) + ": " + status.Detail };
    }
    if (inner[p].NumComponents() > 4)
    {
      return { ErrorCode::DimensionMismatch, "splines with more than 4 components" };
    }
  }
  return Composer<Dim>(inner, numComponents, outer, params).Run();
}

template Status MapPoints<1>(const BezierForm<1>&, const PointMatrixView&, bool, int, PointMatrix&);
template Status MapPoints<2>(const BezierForm<2>&, const PointMatrixView&, bool, int, PointMatrix&);
template Status MapPoints<3>(const BezierForm<3>&, const PointMatrixView&, bool, int, PointMatrix&);
template Result<CompositionResult<1>> ComposeSplines<1>(
  const std::vector<Spline<1>>&, int, const PointMap&, const CompositionParams&);
template Result<CompositionResult<2>> ComposeSplines<2>(
  const std::vector<Spline<2>>&, int, const PointMap&, const CompositionParams&);
template Result<CompositionResult<3>> ComposeSplines<3>(
  const std::vector<Spline<3>>&, int, const PointMap&, const CompositionParams&);
}
