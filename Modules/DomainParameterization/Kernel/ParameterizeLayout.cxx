// SPDX-License-Identifier: BSD-3-Clause
#include "ParameterizeLayout.h"

#include "BoundaryFaults.h"
#include "DomainRun.h"
#include "GluedSystem.h"
#include "InitialMaps.h"
#include <knotwork/SplineCore/PatchTraces.h>
#include <knotwork/SplineCore/Refinement.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <chrono>
#include <cmath>

namespace knotwork
{
namespace
{
/// Of refined spaces: hopeless boundaries end in a time that can be waited for.
constexpr std::int64_t MostFunctions = 4000;

template <int Dim>
std::vector<PatchEntity<Dim>> EntitiesOf(std::size_t numFree)
{
  std::vector<PatchEntity<Dim>> entities;
  for (int code = 0; code < (Dim == 2 ? 9 : 27); ++code)
  {
    PatchEntity<Dim> entity{};
    int rest = code;
    for (int& end : entity)
    {
      end = rest % 3 == 2 ? -1 : rest % 3;
      rest /= 3;
    }
    if (FreeDirections<Dim>(entity).size() == numFree)
    {
      entities.push_back(entity);
    }
  }
  return entities;
}

/// Control points and weights by their numbers, taken out of the patches and put back.
template <int Dim>
class Numbered
{
public:
  explicit Numbered(const GluedMap<Dim>& map) : Points(GluedPoints<Dim>(map))
  {
    this->Weights.setOnes(map.IsRational() ? map.NumFunctions() : 0);
    for (std::size_t p = 0; p < map.Patches.size() && map.IsRational(); ++p)
    {
      for (std::size_t i = 0; i < map.Functions[p].size(); ++i)
      {
        this->Weights[map.Functions[p][i]] = map.Patches[p].Weights[static_cast<Eigen::Index>(i)];
      }
    }
  }
  void Into(GluedMap<Dim>& map, std::size_t p) const
  {
    for (std::size_t i = 0; i < map.Functions[p].size(); ++i)
    {
      const Eigen::Index row = static_cast<Eigen::Index>(i);
      map.Patches[p].ControlPoints.row(row) = this->Points.row(map.Functions[p][i]);
      if (map.IsRational())
      {
        map.Patches[p].Weights[row] = this->Weights[map.Functions[p][i]];
      }
    }
  }
  PointMatrix Points;
  Eigen::VectorXd Weights;
};

/// Edges, faces or patches whose boundary is known are filled.
template <int Dim, int K>
void FillParts(GluedMap<Dim>& map, Numbered<Dim>& all, std::vector<bool>& known)
{
  for (std::size_t p = 0; p < map.Patches.size(); ++p)
  {
    all.Into(map, p);
    for (const PatchEntity<Dim>& entity : EntitiesOf<Dim>(K))
    {
      const Trace<K> trace = MakeTrace<Dim, K>(*map.Patches[p].Space, entity).Value;
      const std::vector<int>& functions = trace.Functions;
      Spline<K> own = TraceOf<Dim, K>(map.Patches[p], trace);
      const std::vector<bool> ends = BoundaryFunctions<K>(*own.Space);
      FillWeights<K>(own);
      FillCoons<K>(own);
      for (std::size_t i = 0; i < functions.size(); ++i)
      {
        const int number = map.Functions[p][static_cast<std::size_t>(functions[i])];
        if (ends[i] || known[static_cast<std::size_t>(number)])
        {
          continue;
        }
        known[static_cast<std::size_t>(number)] = true;
        const Eigen::Index row = static_cast<Eigen::Index>(i);
        all.Points.row(number) = own.ControlPoints.row(row);
        if (own.IsRational())
        {
          all.Weights[number] = own.Weights[row];
        }
      }
    }
  }
}

/// Inner vertices from the layout, sides without a given one straight, patches by Boolean sums.
template <int Dim>
GluedMap<Dim> CoonsMap(const CompatibleLayout<Dim>& layout, InitialWeights weights)
{
  GluedMap<Dim> map = layout.Map;
  Numbered<Dim> all(map);
  std::vector<bool> known = layout.Given;
  double sum = 0.0;
  int count = 0;
  std::vector<int> inner;
  for (std::size_t p = 0; p < map.Patches.size(); ++p)
  {
    for (std::size_t c = 0; c < layout.Corners[p].size(); ++c)
    {
      const int function = CornerFunction<Dim>(*map.Patches[p].Space, static_cast<int>(c));
      const int number = map.Functions[p][static_cast<std::size_t>(function)];
      if (layout.Given[static_cast<std::size_t>(number)])
      {
        sum += map.IsRational() ? std::log(all.Weights[number]) : 0.0;
        ++count;
      }
      else
      {
        known[static_cast<std::size_t>(number)] = true;
        all.Points.row(number) = layout.Vertices.row(layout.Corners[p][c]);
        inner.push_back(number);
      }
    }
  }
  for (int number : inner)
  {
    if (map.IsRational())
    {
      all.Weights[number] = std::exp(sum / count);
    }
  }
  FillParts<Dim, 1>(map, all, known);
  FillParts<Dim, 2>(map, all, known);
  if constexpr (Dim == 3)
  {
    FillParts<Dim, 3>(map, all, known);
  }
  for (std::size_t i = 0; map.IsRational() && i < layout.Given.size(); ++i)
  {
    if (weights == InitialWeights::Ones && !layout.Given[i])
    {
      all.Weights[static_cast<Eigen::Index>(i)] = 1.0;
    }
  }
  for (std::size_t p = 0; p < map.Patches.size(); ++p)
  {
    all.Into(map, p);
  }
  return map;
}

template <int Dim>
class LayoutSource final : public DomainSource<Dim>
{
public:
  LayoutSource(const CompatibleLayout<Dim>& layout, InitialWeights weights)
    : Layout(layout), Weights(weights)
  {
  }

  Result<GluedMap<Dim>> FirstMap(InitialMapMethod method, int) override
  {
    if (method == InitialMapMethod::VariationalHarmonic)
    {
      return { ErrorCode::InvalidParameter,
        "the variational harmonic map is one of a single patch; with a layout begin with the "
        "harmonic map" };
    }
    GluedMap<Dim> map = CoonsMap<Dim>(this->Layout, this->Weights);
    if (method != InitialMapMethod::Coons)
    {
      const GluedSystem<Dim> system(
        map, method == InitialMapMethod::Spring ? GluedOperator::Spring : GluedOperator::Rational);
      if (Status status = system.Fill(map); !status)
      {
        return status;
      }
    }
    return map;
  }

  bool MayRefine(const GluedMap<Dim>& map) const override
  {
    return (std::int64_t(map.NumFunctions()) << Dim) <= MostFunctions;
  }

  Result<GluedMap<Dim>> Refine(const GluedMap<Dim>& map, const JacobianCertificate&) override
  {
    MultiPatch<Dim> patches;
    patches.Topology.Interfaces = this->Layout.Shared;
    for (const Spline<Dim>& patch : map.Patches)
    {
      auto refined = RefineAllElements<Dim>(patch);
      if (!refined)
      {
        return refined.Status;
      }
      patches.Patches.push_back(std::move(refined->Value));
    }
    auto glued = Glue<Dim>(patches, this->Layout.Corners);
    for (std::size_t p = 0; p < patches.Patches.size() && glued; ++p)
    {
      for (int s = 0; s < 2 * Dim; ++s)
      {
        if (this->Layout.Fixed[p][static_cast<std::size_t>(s)])
        {
          for (int f : SideFunctions<Dim>(*patches.Patches[p].Space, s))
          {
            glued
              ->Fixed[static_cast<std::size_t>(glued->Functions[p][static_cast<std::size_t>(f)])] =
              true;
          }
        }
      }
    }
    return glued;
  }

private:
  const CompatibleLayout<Dim>& Layout;
  InitialWeights Weights;
};

/// Places where the fixed sides of one patch alone make det J <= 0.
template <int Dim>
void FindFolds(const CompatibleLayout<Dim>& layout, const GluedMap<Dim>& map, DomainReport& report)
{
  for (std::size_t p = 0; p < map.Patches.size(); ++p)
  {
    CompatibleBoundary<Dim> boundary;
    boundary.Knots = map.Patches[p].Space->Knots;
    for (int s = 0; s < 2 * Dim; ++s)
    {
      auto side = SideSpline<Dim>(map.Patches[p], s);
      if (!side)
      {
        return; // not finite: no place can be named
      }
      const std::size_t at = static_cast<std::size_t>(s);
      boundary.Sides[at] = std::move(side.Value);
      boundary.Origins[at].Input = layout.Inputs[p][at];
    }
    for (BoundaryFold& fold : FindBoundaryFolds<Dim>(boundary, layout.Fixed[p]))
    {
      fold.Message = "patch " + std::to_string(p) + ": " + fold.Message;
      report.Messages.push_back(fold.Message);
      report.Folds.push_back(std::move(fold));
    }
  }
}
}

template <int Dim>
Result<LayoutParameterization<Dim>> ParameterizeLayout(const PatchLayout<Dim>& layout,
  const LayoutParams& layoutParams, const DomainParams& params, const ProgressCallback& progress)
{
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  if (Status status = CheckParams(params, Dim); !status)
  {
    return status;
  }
  WorkBudget budget(params.Effort, params.TimeLimit, progress);
  auto compatible = MakeCompatible<Dim>(layout, layoutParams);
  if (!compatible)
  {
    return compatible.Status;
  }
  LayoutParameterization<Dim> out;
  out.Layout = std::move(compatible.Value);
  FindFolds<Dim>(out.Layout, CoonsMap<Dim>(out.Layout, params.FirstWeights), out);
  const double numPatches = static_cast<double>(out.Layout.Corners.size());
  const std::chrono::duration<double> before = Clock::now() - start;
  out.SecondsOptimization = before.count();
  LayoutSource<Dim> source(out.Layout, params.FirstWeights);
  DomainRun<Dim> run;
  if (Status status =
        RunDomain<Dim>(source, out.Layout.Area / numPatches, params, budget, run, out);
      !status)
  {
    return status;
  }
  out.Map = std::move(run.Map);
  out.InitialMap = std::move(run.InitialMap);
  out.Metrics.Area *= numPatches;
  out.InitialMetrics.Area *= numPatches;
  return out;
}

template Result<LayoutParameterization<2>> ParameterizeLayout<2>(
  const PatchLayout<2>&, const LayoutParams&, const DomainParams&, const ProgressCallback&);
template Result<LayoutParameterization<3>> ParameterizeLayout<3>(
  const PatchLayout<3>&, const LayoutParams&, const DomainParams&, const ProgressCallback&);
}
