// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryFaults.h"
#include "DomainMeasure.h"
#include "DomainRun.h"
#include "HarmonicMaps.h"
#include "InitialMaps.h"
#include <knotwork/SplineCore/Refinement.h>

#include <algorithm>
#include <chrono>

namespace knotwork
{
namespace
{
/// One patch between its sides.
template <int Dim>
class PatchSource final : public DomainSource<Dim>
{
public:
  PatchSource(const CompatibleBoundary<Dim>& boundary, InitialWeights weights)
    : Boundary(boundary), Weights(weights)
  {
  }

  Result<GluedMap<Dim>> FirstMap(InitialMapMethod method, int variant) override
  {
    Spline<Dim> map = MapOfBoundary<Dim>(this->Boundary);
    FillWeights<Dim>(map, this->Weights);
    Status status;
    switch (method)
    {
      case InitialMapMethod::Harmonic:
        status = FillHarmonic<Dim>(map);
        break;
      case InitialMapMethod::Spring:
        status = FillSpring<Dim>(map);
        break;
      case InitialMapMethod::VariationalHarmonic:
        status = FillVariationalHarmonic<Dim>(map);
        break;
      case InitialMapMethod::Automatic:
      case InitialMapMethod::Coons:
        FillCoons<Dim>(map, Steepness(variant));
    }
    if (!status)
    {
      return status;
    }
    return SingleMap<Dim>(map);
  }

  /// Coons: every choice of directions that are steep, but for all and none of them.
  int NumVariants(InitialMapMethod method) const override
  {
    return method == InitialMapMethod::Coons ? (1 << Dim) - 1 : 1;
  }

  /// Elements without a certificate are split.
  Result<GluedMap<Dim>> Refine(
    const GluedMap<Dim>& map, const JacobianCertificate& certificate) override
  {
    const Spline<Dim>& patch = map.Patches.front();
    RefinementParams refinement;
    refinement.Extension = 0;
    for (const KnotVector& knots : patch.Space->Knots)
    {
      refinement.Extension = std::max(refinement.Extension, (knots.Degree() + 1) / 2);
    }
    std::vector<int> marked;
    for (std::size_t e = 0; e < certificate.Cells.size(); ++e)
    {
      const CellCertificate& cell = certificate.Cells[e];
      // those only just regular too, unless the boundary alone decides
      if (cell.Verdict != Verdict::Valid ||
        (cell.Degenerate != 0 && !AtCorner(patch.Space->Elements[e].Box)))
      {
        marked.push_back(static_cast<int>(e));
      }
    }
    auto refined = RefineMarkedElements<Dim>(patch, marked, refinement);
    if (!refined)
    {
      return refined.Status;
    }
    return SingleMap<Dim>(refined->Value);
  }

private:
  /// Bit d of the variant: direction d is steep.
  static std::array<int, Dim> Steepness(int variant)
  {
    constexpr int steep = 6;
    std::array<int, Dim> steepness{};
    for (std::size_t d = 0; d < Dim; ++d)
    {
      steepness[d] = variant >> d & 1 ? steep : 1;
    }
    return steepness;
  }

  static bool AtCorner(const ParametricBox<Dim>& box)
  {
    for (std::size_t d = 0; d < Dim; ++d)
    {
      if (box.Lower[d] != 0.0 && box.Upper[d] != 1.0)
      {
        return false;
      }
    }
    return true;
  }

  const CompatibleBoundary<Dim>& Boundary;
  InitialWeights Weights;
};
}

template <int Dim>
Result<DomainParameterization<Dim>> ParameterizeDomain(
  const DomainBoundary<Dim>& boundary, const DomainParams& params, const ProgressCallback& progress)
{
  const auto start = std::chrono::steady_clock::now();
  if (Status status = CheckParams(params, Dim); !status)
  {
    return status;
  }
  WorkBudget budget(params.Effort, params.TimeLimit, progress);
  BoundaryParams boundaryParams;
  boundaryParams.GapTolerance = params.GapTolerance;
  boundaryParams.MaxFunctions = params.MaxFunctions;
  auto compatible = MakeCompatible<Dim>(boundary, boundaryParams);
  if (!compatible)
  {
    return compatible.Status;
  }
  DomainParameterization<Dim> out;
  out.Boundary = std::move(compatible.Value);
  std::array<bool, 2 * Dim> all;
  all.fill(true);
  out.Folds = FindBoundaryFolds<Dim>(out.Boundary, all);
  for (const BoundaryFold& fold : out.Folds)
  {
    out.Messages.push_back(fold.Message);
  }
  auto crossings = FindBoundaryCrossings<Dim>(out.Boundary, params.Threads);
  if (!crossings)
  {
    return crossings.Status;
  }
  out.Crossings = std::move(crossings.Value);
  for (const BoundaryCrossing& crossing : out.Crossings)
  {
    out.Messages.push_back(crossing.Message);
  }
  const double area = SignedMeasure<Dim>(out.Boundary.Sides);
  const std::chrono::duration<double> before = std::chrono::steady_clock::now() - start;
  out.SecondsOptimization = before.count();
  PatchSource<Dim> source(out.Boundary, params.FirstWeights);
  DomainRun<Dim> run;
  if (Status status = RunDomain<Dim>(source, area, params, budget, run, out); !status)
  {
    return status;
  }
  out.Map = std::move(run.Map.Patches.front());
  out.InitialMap = std::move(run.InitialMap.Patches.front());
  return out;
}

template Result<DomainParameterization<2>> ParameterizeDomain<2>(
  const DomainBoundary<2>&, const DomainParams&, const ProgressCallback&);
template Result<DomainParameterization<3>> ParameterizeDomain<3>(
  const DomainBoundary<3>&, const DomainParams&, const ProgressCallback&);
}
