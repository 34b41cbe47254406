// SPDX-License-Identifier: BSD-3-Clause
#include "PatchTraces.h"

#include "PointClusters.h"
#include "TensorSpace.h"

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
std::size_t At(std::int64_t i)
{
  return static_cast<std::size_t>(i);
}

bool IsClamped(const KnotVector& knots)
{
  return knots.Multiplicity(0) == knots.Degree() + 1 &&
    knots.Multiplicity(knots.NumElements()) == knots.Degree() + 1;
}

/// The same knots up to an affine change, optionally reversed.
bool SameKnots(const KnotVector& a, const KnotVector& b, bool reverse)
{
  if (a.Degree() != b.Degree() || a.Knots().size() != b.Knots().size())
  {
    return false;
  }
  const std::size_t n = a.Knots().size();
  for (std::size_t i = 0; i < n; ++i)
  {
    const double ta = (a.Knots()[i] - a.Begin()) / (a.End() - a.Begin());
    const double tb = reverse ? (b.End() - b.Knots()[n - 1 - i]) / (b.End() - b.Begin())
                              : (b.Knots()[i] - b.Begin()) / (b.End() - b.Begin());
    if (std::abs(ta - tb) > 1e-9)
    {
      return false;
    }
  }
  return true;
}

/// Numbers of the control points of all patches, equal where points and weights agree.
template <int Dim>
std::vector<std::vector<int>> NumberPoints(const std::vector<Spline<Dim>>& patches)
{
  int columns = 0;
  double largest = 1.0;
  for (const Spline<Dim>& spline : patches)
  {
    columns = std::max(columns, spline.NumComponents());
    largest = std::max(largest, spline.ControlPoints.cwiseAbs().maxCoeff());
    largest = std::max(largest, spline.IsRational() ? spline.Weights.maxCoeff() : 1.0);
  }
  PointClusters clusters(columns + 1, largest * PointClusters::RelativeTolerance);
  std::vector<std::vector<int>> all;
  for (const Spline<Dim>& spline : patches)
  {
    std::vector<int> numbers;
    std::vector<double> point(At(columns + 1), 0.0);
    for (Eigen::Index i = 0; i < spline.ControlPoints.rows(); ++i)
    {
      for (Eigen::Index c = 0; c < spline.ControlPoints.cols(); ++c)
      {
        point[At(c)] = spline.ControlPoints(i, c);
      }
      point.back() = spline.IsRational() ? spline.Weights[i] : 1.0;
      numbers.push_back(clusters.Number(point.data()));
    }
    all.push_back(std::move(numbers));
  }
  return all;
}

template <int Dim>
class TraceMatcher
{
public:
  explicit TraceMatcher(const std::vector<Spline<Dim>>& patches)
    : Patches(patches), Numbers(NumberPoints<Dim>(patches))
  {
  }

  std::vector<PatchTrace<Dim>> Find()
  {
    int numEntities = 1;
    for (int d = 0; d < Dim; ++d)
    {
      numEntities *= 3;
    }
    for (std::size_t p = 0; p < this->Patches.size(); ++p)
    {
      for (int code = 0; code < numEntities; ++code)
      {
        PatchTrace<Dim> trace;
        trace.Patch = static_cast<int>(p);
        int rest = code;
        for (std::size_t d = 0; d < Dim; ++d, rest /= 3)
        {
          trace.Entity[d] = rest % 3 - 1;
          trace.Free += trace.Entity[d] < 0 ? 1 : 0;
        }
        if (trace.Free < Dim && HasTrace<Dim>(*this->Patches[p].Space, trace.Entity))
        {
          this->Add(trace);
        }
      }
    }
    return std::move(this->Found);
  }

private:
  void Add(PatchTrace<Dim> trace)
  {
    const int index = static_cast<int>(this->Found.size());
    trace.Owner = index;
    // The points as an unordered set: entities that are one have equal buckets.
    std::vector<int> bucket;
    for (const auto& [key, function] :
      TraceFunctions<Dim>(*this->Patches[At(trace.Patch)].Space, trace.Entity))
    {
      bucket.push_back(this->Numbers[At(trace.Patch)][At(function)]);
    }
    std::sort(bucket.begin(), bucket.end());
    bucket.push_back(trace.Free);
    std::vector<int>& owners = this->Buckets[bucket];
    for (const int owner : owners)
    {
      if (this->Match(this->Found[At(owner)], trace))
      {
        trace.Owner = owner;
        break;
      }
    }
    if (trace.Owner == index)
    {
      owners.push_back(index);
    }
    this->Found.push_back(trace);
  }

  bool Match(const PatchTrace<Dim>& owner, PatchTrace<Dim>& trace) const
  {
    const SplineSpace<Dim>& spaceA = *this->Patches[At(owner.Patch)].Space;
    const SplineSpace<Dim>& spaceB = *this->Patches[At(trace.Patch)].Space;
    const auto functionsA = TraceFunctions<Dim>(spaceA, owner.Entity);
    const auto functionsB = TraceFunctions<Dim>(spaceB, trace.Entity);
    const auto knotsA = TraceKnots<Dim>(spaceA, owner.Entity);
    const auto knotsB = TraceKnots<Dim>(spaceB, trace.Entity);
    for (const SideOrientation& o : SideOrientations(trace.Free))
    {
      bool same = functionsA.size() == functionsB.size();
      for (std::size_t k = 0; same && k < knotsB.size(); ++k)
      {
        same = SameKnots(*knotsA[At(o.Axis[k])], *knotsB[k], o.Reversed[k]);
      }
      for (auto it = functionsA.begin(); same && it != functionsA.end(); ++it)
      {
        const auto found = functionsB.find(OrientedKey(it->first, o, knotsB));
        same = found != functionsB.end() &&
          this->Numbers[At(owner.Patch)][At(it->second)] ==
            this->Numbers[At(trace.Patch)][At(found->second)];
      }
      if (same)
      {
        trace.OnOwner = o;
        return true;
      }
    }
    return false;
  }

  const std::vector<Spline<Dim>>& Patches;
  std::vector<std::vector<int>> Numbers; ///< a patch and control point
  std::vector<PatchTrace<Dim>> Found;
  std::map<std::vector<int>, std::vector<int>> Buckets;
};
}

template <int Dim>
bool HasTrace(const SplineSpace<Dim>& space, const PatchEntity<Dim>& entity)
{
  bool has = space.HasDomain() && space.Kind != SpaceKind::LocallyRefined;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    has = has && (entity[d] < 0 || IsClamped(space.Knots[d]));
  }
  return has;
}

std::int64_t NumLevelFunctions(const KnotVector& knots, int level)
{
  return knots.NumFunctions() +
    std::int64_t{ knots.NumElements() } * ((std::int64_t{ 1 } << level) - 1);
}

template <int Dim>
std::map<FunctionKey, int> TraceFunctions(
  const SplineSpace<Dim>& space, const PatchEntity<Dim>& entity)
{
  std::map<FunctionKey, int> functions;
  const std::vector<FunctionInfo<Dim>> all = DescribeFunctions<Dim>(space);
  for (std::size_t f = 0; f < all.size(); ++f)
  {
    FunctionKey key{ all[f].Level, 0, 0 };
    std::size_t next = 1;
    bool onSide = true;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      if (entity[d] < 0)
      {
        key[next++] = all[f].Index[d];
      }
      else
      {
        const std::int64_t end =
          entity[d] == 0 ? 0 : NumLevelFunctions(space.Knots[d], all[f].Level) - 1;
        onSide = onSide && all[f].Index[d] == end;
      }
    }
    if (onSide)
    {
      functions.emplace(key, static_cast<int>(f));
    }
  }
  return functions;
}

template <int Dim, int Free>
std::vector<HierarchyBox<Free>> TraceBoxes(
  const SplineSpace<Dim>& space, const PatchEntity<Dim>& entity)
{
  std::vector<HierarchyBox<Free>> boxes;
  for (const HierarchyBox<Dim>& box : HierarchyBoxes<Dim>(space))
  {
    HierarchyBox<Free> trace;
    trace.Level = box.Level;
    std::size_t next = 0;
    bool touches = true;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      if (entity[d] < 0)
      {
        trace.Lower[next] = box.Lower[d];
        trace.Upper[next] = box.Upper[d];
        ++next;
      }
      else
      {
        touches = touches &&
          (entity[d] == 0
              ? box.Lower[d] == 0
              : box.Upper[d] == std::int64_t{ space.Knots[d].NumElements() } << box.Level);
      }
    }
    if (touches)
    {
      boxes.push_back(trace);
    }
  }
  return boxes;
}

template <int Dim, int Free>
Result<Trace<Free>> MakeTrace(const SplineSpace<Dim>& space, const PatchEntity<Dim>& entity)
{
  std::array<KnotVector, Free> knots;
  const std::vector<std::size_t> free = FreeDirections<Dim>(entity);
  for (std::size_t k = 0; k < Free; ++k)
  {
    knots[k] = space.Knots[free[k]];
  }
  auto made = space.Kind == SpaceKind::Hierarchical
    ? MakeHierarchicalSpace<Free>(knots, TraceBoxes<Dim, Free>(space, entity))
    : MakeTensorSpace<Free>(knots);
  if (!made)
  {
    return made.Status;
  }
  Trace<Free> trace;
  trace.Space = std::move(made.Value);
  if (space.Kind == SpaceKind::Tensor)
  {
    IntArray<Dim> count{};
    for (std::size_t d = 0; d < Dim; ++d)
    {
      count[d] = space.Knots[d].NumFunctions();
    }
    trace.Functions = EntityIndices<Dim>(count, entity);
    return trace;
  }
  const auto functions = TraceFunctions<Dim>(space, entity);
  for (const FunctionInfo<Free>& info : DescribeFunctions<Free>(*trace.Space))
  {
    FunctionKey key{ info.Level, 0, 0 };
    std::copy(info.Index.begin(), info.Index.end(), key.begin() + 1);
    const auto found = functions.find(key);
    if (found == functions.end())
    {
      return { ErrorCode::InvalidTopology, "a side has no space of its own" };
    }
    trace.Functions.push_back(found->second);
  }
  return trace;
}

template <int Dim, int Free>
Spline<Free> TraceOf(const Spline<Dim>& spline, const Trace<Free>& trace)
{
  Spline<Free> made;
  made.Space = trace.Space;
  made.ControlPoints.resize(trace.Space->NumFunctions, spline.ControlPoints.cols());
  made.Weights.resize(spline.IsRational() ? made.ControlPoints.rows() : 0);
  for (Eigen::Index f = 0; f < made.ControlPoints.rows(); ++f)
  {
    made.ControlPoints.row(f) = spline.ControlPoints.row(trace.Functions[At(f)]);
    if (spline.IsRational())
    {
      made.Weights[f] = spline.Weights[trace.Functions[At(f)]];
    }
  }
  return made;
}

template <int Dim>
std::vector<const KnotVector*> TraceKnots(
  const SplineSpace<Dim>& space, const PatchEntity<Dim>& entity)
{
  std::vector<const KnotVector*> knots;
  for (const std::size_t d : FreeDirections<Dim>(entity))
  {
    knots.push_back(&space.Knots[d]);
  }
  return knots;
}

FunctionKey OrientedKey(const FunctionKey& key, const SideOrientation& orientation,
  const std::vector<const KnotVector*>& knots)
{
  FunctionKey result{ key[0], 0, 0 };
  for (std::size_t k = 0; k < knots.size(); ++k)
  {
    const std::int64_t index = key[1 + At(orientation.Axis[k])];
    result[1 + k] = orientation.Reversed[k]
      ? NumLevelFunctions(*knots[k], static_cast<int>(key[0])) - 1 - index
      : index;
  }
  return result;
}

template <int Dim>
std::vector<PatchTrace<Dim>> FindSharedTraces(const std::vector<Spline<Dim>>& patches)
{
  return TraceMatcher<Dim>(patches).Find();
}

#define KNOTWORK_INSTANTIATE(Dim)                                                                  \
  template bool HasTrace<Dim>(const SplineSpace<Dim>&, const PatchEntity<Dim>&);                   \
  template std::map<FunctionKey, int> TraceFunctions<Dim>(                                         \
    const SplineSpace<Dim>&, const PatchEntity<Dim>&);                                             \
  template std::vector<const KnotVector*> TraceKnots<Dim>(                                         \
    const SplineSpace<Dim>&, const PatchEntity<Dim>&);                                             \
  template std::vector<PatchTrace<Dim>> FindSharedTraces<Dim>(const std::vector<Spline<Dim>>&);
KNOTWORK_INSTANTIATE(1)
KNOTWORK_INSTANTIATE(2)
KNOTWORK_INSTANTIATE(3)
#undef KNOTWORK_INSTANTIATE
#define KNOTWORK_INSTANTIATE(Dim, Free)                                                            \
  template std::vector<HierarchyBox<Free>> TraceBoxes<Dim, Free>(                                  \
    const SplineSpace<Dim>&, const PatchEntity<Dim>&);                                             \
  template Result<Trace<Free>> MakeTrace<Dim, Free>(                                               \
    const SplineSpace<Dim>&, const PatchEntity<Dim>&);                                             \
  template Spline<Free> TraceOf<Dim, Free>(const Spline<Dim>&, const Trace<Free>&);
KNOTWORK_INSTANTIATE(2, 1)
KNOTWORK_INSTANTIATE(2, 2)
KNOTWORK_INSTANTIATE(3, 1)
KNOTWORK_INSTANTIATE(3, 2)
KNOTWORK_INSTANTIATE(3, 3)
#undef KNOTWORK_INSTANTIATE
}
