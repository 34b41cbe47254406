// SPDX-License-Identifier: BSD-3-Clause
#include "FoldRemoval.h"

#include "CellMeasures.h"
#include "DomainSolver.h"
#include "Regularity.h"

namespace knotwork
{
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
    DomainSolver<Dim> solver(SingleMap(map), mean, params);
    if (solver.RemoveFolds())
    {
      const Spline<Dim>& unfolded = solver.Map().Patches.front();
      const auto regularity =
        MeasureRegularity(MakeBezierForm(unfolded, threads), 1.0, 1000000, threads);
      if (!regularity || regularity->IsRegular())
      {
        return regularity ? Result<Spline<Dim>>(unfolded) : Result<Spline<Dim>>(regularity.Status);
      }
    }
  }
  return { ErrorCode::InvalidParameter,
    "the initial map has folds that moving its inner control points does not remove; begin with "
    "the identity, or switch the guard off" };
}

template Result<Spline<2>> RemoveFolds(const Spline<2>&, int);
template Result<Spline<3>> RemoveFolds(const Spline<3>&, int);
}
