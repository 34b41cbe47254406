// SPDX-License-Identifier: BSD-3-Clause
#include "CellProof.h"

#include "ValueBounds.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace knotwork
{
namespace
{
/// The numerator exactly; collapsed edges and zero corners are made so, zero faces are divided
/// out. Of a geometry that is known to within errors only this decides degenerate cells, when the
/// errors are below what CollapseTolerance forgives; all others stay with the floating form.
/// @return false when it was done before or decides nothing.
bool UseExact(
  const ProofCell& cell, LayoutCache& cache, CellNumerator& numerator, CellCertificate& result)
{
  if (numerator.Exact || cell.Given > cell.GivenTolerance)
  {
    return false;
  }
  const SnappedForm snapped = MakeSnappedForm(cell, cache);
  CellNumerator exact = MakeExactNumerator(cell, snapped, cache);
  if (cell.Given > 0.0 && exact.Degenerate == 0)
  {
    return false;
  }
  numerator = std::move(exact);
  result.Snapped = snapped.Snapped || cell.Given > 0.0;
  return true;
}

/// An invalid cell whose only fault is an edge or side where the Jacobian is zero within
/// CollapseTolerance, and that would be valid with zeros there, is neither: its coordinates do
/// not say.
void ForgiveRounding(const ProofCell& cell, bool isExact, const JacobianParams& params,
  LayoutCache& cache, CellCertificate& result)
{
  const bool open = result.Verdict == Verdict::Invalid
    ? isExact
    : result.Verdict == Verdict::Undecided && result.Limit == JacobianLimit::Precision;
  if (!open || !(cell.ValueTolerance > 0.0) || cell.Given > cell.GivenTolerance)
  {
    return;
  }
  const SnappedForm snapped = MakeSnappedForm(cell, cache);
  const double size = SnapFaces(cell, snapped);
  if (size == 0.0)
  {
    return;
  }
  JacobianWitness ignored;
  const SignProof sign = ProveSign(cell, MakeExactNumerator(cell, snapped, cache), params, ignored);
  result.Boxes += sign.Boxes;
  if (sign.Verdict == Verdict::Valid || sign.Verdict == Verdict::Reversed)
  {
    result.Verdict = Verdict::Undecided;
    result.Limit = JacobianLimit::Rounding;
    result.Rounding = cell.PointTolerance * (size / cell.ValueTolerance);
  }
}
}

CellCertificate ProveCell(const BernsteinCells& cells, int cell, const JacobianParams& params,
  std::int64_t maxBoxes, LayoutCache& cache, JacobianWitness& witness)
{
  const ProofCell proved(cells, cell, params, cache);
  JacobianParams own = params;
  own.MaxBoxes = maxBoxes;
  CellNumerator numerator;
  CellCertificate result;
  if (!proved.HasWeights() ||
    (!MakeFloatingNumerator(proved, cache, numerator) &&
      !UseExact(proved, cache, numerator, result)))
  {
    result.Limit = JacobianLimit::Precision;
    result.MinLower = result.MaxLower = -std::numeric_limits<double>::infinity();
    result.MinUpper = result.MaxUpper = std::numeric_limits<double>::infinity();
    return result;
  }
  SignProof sign;
  do
  {
    sign = ProveSign(proved, numerator, own, witness);
    result.Boxes += sign.Boxes;
  } while (sign.NeedsExact && UseExact(proved, cache, numerator, result));
  result.Verdict = sign.Verdict;
  result.Limit = sign.NeedsExact ? JacobianLimit::Precision : sign.Limit;
  result.Degenerate = sign.Verdict == Verdict::Invalid ? std::uint8_t(0) : numerator.Degenerate;
  BoundValues(proved, numerator, sign, own, cache, result);
  if (result.Verdict == Verdict::Invalid && !proved.Norm)
  {
    result.MinUpper = std::min(result.MinUpper, witness.Upper);
    result.MinLower = std::min(result.MinLower, result.MinUpper);
  }
  ForgiveRounding(proved, static_cast<bool>(numerator.Exact), own, cache, result);
  if (proved.Flat && result.Verdict == Verdict::Reversed)
  {
    // a surface in a coordinate plane has no side of its own
    result.Verdict = Verdict::Valid;
    std::swap(result.MinLower, result.MaxUpper);
    std::swap(result.MinUpper, result.MaxLower);
    for (double* x : { &result.MinLower, &result.MinUpper, &result.MaxLower, &result.MaxUpper })
    {
      *x = -*x;
    }
  }
  if (proved.Flat && result.Verdict == Verdict::Valid)
  {
    result.OneSided = true;
  }
  return result;
}
}
