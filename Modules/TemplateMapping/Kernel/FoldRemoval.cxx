// SPDX-License-Identifier: BSD-3-Clause
#include "FoldRemoval.h"

#include "Regularity.h"
#include <knotwork/DomainParameterization/DomainSolver.h>
#include <knotwork/JacobianValidation/CellMeasures.h>

namespace knotwork
{
namespace
{
constexpr int Rounds = 5;
constexpr std::int64_t Boxes = 1000000;
}

template <int Dim>
Result<Spline<Dim>> RemoveFolds(const Spline<Dim>& map, int threads)
{
  const auto measures = MeasureCells(MakeBernsteinCells<Dim>(MakeBezierForm(map, threads)));
  if (!measures)
  {
    return measures.Status;
  }
  const ParametricBox<Dim> domain = map.Space->Domain();
  double volume = 1.0;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    volume *= domain.Upper[d] - domain.Lower[d];
  }
  // The functionals scale det J by its mean.
  const double mean = measures->Total.Measure / volume;
  if (mean > 0.0)
  {
    DomainParams params;
    params.Threads = threads;
    WorkBudget budget(params.Effort, params.TimeLimit, {});
    DomainSolver<Dim> solver(SingleMap(map), mean, params, budget);
    std::vector<int> extra(map.Space->Elements.size(), 0);
    for (int round = 0; round < Rounds && solver.RemoveFolds(); ++round)
    {
      const Spline<Dim>& unfolded = solver.Map().Patches.front();
      const auto regularity =
        MeasureRegularity(MakeBezierForm(unfolded, threads), 1.0, Boxes, threads);
      if (!regularity || regularity->IsRegular())
      {
        return regularity ? Result<Spline<Dim>>(unfolded) : Result<Spline<Dim>>(regularity.Status);
      }
      // The solver looks at points only: more of them where it missed a fold, and away from them.
      for (std::size_t e = 0; e < extra.size(); ++e)
      {
        extra[e] += regularity->MinLower[e] > 0.0 ? 0 : 2;
      }
      solver.ImprovePoints();
      solver.SetQuadrature(extra);
    }
  }
  return { ErrorCode::InvalidParameter,
    "the initial map has folds that moving its inner control points does not remove; begin with "
    "the identity, or switch the guard off" };
}

template Result<Spline<2>> RemoveFolds(const Spline<2>&, int);
template Result<Spline<3>> RemoveFolds(const Spline<3>&, int);
}
