// SPDX-License-Identifier: BSD-3-Clause
#include "SignProof.h"

#include <algorithm>
#include <cfloat>
#include <cmath>

namespace knotwork
{
namespace
{
using BoxCornerParameters = std::array<std::array<double, 3>, 8>;

/// May the value be what rounding made of zero? Then exact arithmetic looks before the verdict.
bool IsSnapWorthy(const ProofCell& cell, const CellNumerator& numerator, double upper)
{
  return !numerator.Exact && cell.Given <= cell.GivenTolerance && cell.CollapseTolerance > 0.0 &&
    std::fabs(upper) <= 2.0 * cell.ValueTolerance;
}

/// On a face that was divided out the Jacobian itself is zero: a point nearby inside the sub-box
/// where it is negative.
void FindNegative(const ProofCell& cell, const CellNumerator& numerator, JacobianWitness& witness)
{
  witness.Upper = 0.0;
  std::array<double, 3> middle{};
  for (int c = 0; c < witness.NumCorners; ++c)
  {
    for (std::size_t d = 0; d < 3; ++d)
    {
      // only two corners a direction matter: opposite ones meet in the middle of tensor boxes,
      // and any dyadic interior point will do in simplices
      middle[d] += witness.Corners[static_cast<std::size_t>(c)][d];
    }
  }
  const double parts = witness.NumCorners == 6 ? 8.0
    : witness.NumCorners == 3                  ? 4.0
                                               : witness.NumCorners;
  for (std::size_t d = 0; d < 3; ++d)
  {
    // 8 and 4 parts of 6 and 3 corners: the witness takes the missing ones
    middle[d] = (middle[d] + (parts - witness.NumCorners) * witness.Parameters[d]) / parts;
  }
  std::array<double, 3> at = middle;
  for (int k = 0; k < 30; ++k)
  {
    if (numerator.Exact && numerator.Exact->SignAt(at) < 0)
    {
      witness.Parameters = at;
      const double value = numerator.Exact->ValueAt(at) * (1.0 - 0x1p-40);
      if (!cell.Rational)
      {
        witness.Upper = std::min(value, -DBL_MIN);
      }
      else
      {
        ValueRange unscaled = numerator.Range;
        unscaled.Scale = 0;
        witness.Upper = std::min(unscaled.Upper(value), 0.0);
      }
      return;
    }
    for (std::size_t d = 0; d < 3; ++d)
    {
      at[d] = 0.5 * (at[d] + witness.Parameters[d]);
    }
  }
}

/// A point where the problem is <= 0 as that of the Jacobian.
/// @param upper  of the problem's coefficients, <= 0.
JacobianWitness WitnessOf(const ProofCell& cell, const CellNumerator& numerator,
  const std::array<double, 3>& at, const BoxCornerParameters& corners, double upper)
{
  JacobianWitness witness;
  witness.Cell = cell.Number;
  witness.Parameters = at;
  witness.NumCorners = NumCorners(cell.Shape);
  witness.Corners = corners;
  if (numerator.Factored != 0)
  {
    FindNegative(cell, numerator, witness);
  }
  else
  {
    witness.Upper = std::min(cell.Norm ? 0.0 : numerator.Range.Upper(std::min(upper, 0.0)), 0.0);
  }
  return witness;
}

BoxProblem Negative(const BoxProblem& p)
{
  BoxProblem turned = p;
  for (double& v : turned.Numerator)
  {
    v = -v;
  }
  if (p.Exact)
  {
    auto form = std::make_shared<ExactForm>(*p.Exact);
    for (ExactInteger& c : form->C)
    {
      c = ExactInteger() - c;
    }
    turned.Exact = form;
  }
  return turned;
}
}

SignProof ProveSign(const ProofCell& cell, const CellNumerator& numerator,
  const JacobianParams& params, JacobianWitness& witness)
{
  SignProof sign;
  const BoxProblem& p = numerator.Problem;
  // signs at the corners that are not legally zero
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  int lowestAt = 0;
  for (std::size_t c = 0; c < p.Layout->Corners.size(); ++c)
  {
    const bool legal = std::any_of(p.ZeroFaces.begin(), p.ZeroFaces.end(),
      [&](std::uint8_t face) { return (p.Layout->CornerMasks[c] & face) == face; });
    const double v = p.Numerator[static_cast<std::size_t>(p.Layout->Corners[c])];
    if (!legal && v < lowest)
    {
      lowest = v;
      lowestAt = static_cast<int>(c);
    }
    highest = legal ? highest : std::max(highest, v);
  }
  const double error = numerator.Exact ? 0.0 : p.NumeratorError;
  const auto setInvalid =
    [&](const std::array<double, 3>& at, const BoxCornerParameters& corners, double upper)
  {
    sign.Verdict = Verdict::Invalid;
    witness = WitnessOf(cell, numerator, at, corners, upper);
  };
  bool negative = false;
  if (lowest < -error && highest > error)
  {
    if (IsSnapWorthy(cell, numerator, numerator.Range.Upper(lowest)))
    {
      sign.NeedsExact = true;
      return sign;
    }
    const auto corners = BoxCorners(*p.Layout, {});
    setInvalid(corners[static_cast<std::size_t>(lowestAt)], corners,
      lowest + (numerator.Exact ? 16.0 * UnitRoundoff * std::fabs(lowest) : error));
    return sign;
  }
  if (lowest < -error && highest <= error)
  {
    negative = !cell.Norm;
  }
  else if (!(highest > error))
  {
    if (!numerator.Exact && cell.Given == 0.0)
    {
      sign.NeedsExact = true;
      return sign;
    }
    // all corners are zero, legally or not: the sign of the integral
    double sum = 0.0;
    double size = 0.0;
    for (double v : p.Numerator)
    {
      sum += v;
      size = std::max(size, std::fabs(v));
    }
    negative = sum < 0.0 && !cell.Norm;
    if (size == 0.0)
    {
      const auto corners = BoxCorners(*p.Layout, {});
      setInvalid(corners[0], corners, 0.0);
      return sign;
    }
  }

  BoxSearchParams search;
  search.MaxBoxes = params.MaxBoxes;
  const bool fine = !cell.Rational && numerator.Factored == 0 && p.ZeroFaces.empty();
  search.RelativeGap = fine ? params.RelativeGap : 1.0;
  const BoxSearchResult found =
    negative ? SearchMinimum(Negative(p), search) : SearchMinimum(p, search);
  sign.Boxes += found.Boxes;
  if (found.NeedsExact)
  {
    sign.NeedsExact = true;
    return sign;
  }
  if (found.NonPositive)
  {
    if (IsSnapWorthy(cell, numerator, numerator.Range.Upper(found.Upper)))
    {
      sign.NeedsExact = true;
      return sign;
    }
    if (negative && lowest < -error)
    {
      // of both signs; the witness is the corner where it is negative
      const auto corners = BoxCorners(*p.Layout, {});
      setInvalid(corners[static_cast<std::size_t>(lowestAt)], corners,
        lowest + (numerator.Exact ? 16.0 * UnitRoundoff * std::fabs(lowest) : error));
    }
    else if (negative)
    {
      // of both signs, and no corner says where it is negative
      const BoxSearchResult other = SearchMinimum(p, search);
      sign.Boxes += other.Boxes;
      if (other.NonPositive)
      {
        setInvalid(other.Witness, other.WitnessCorners, other.Upper);
      }
      else
      {
        sign.Limit = other.Limit;
      }
    }
    else
    {
      setInvalid(found.Witness, found.WitnessCorners, found.Upper);
    }
    return sign;
  }
  if (found.Positive)
  {
    sign.Verdict = negative ? Verdict::Reversed : Verdict::Valid;
    sign.Lower = found.Lower;
    sign.Upper = found.Upper;
    return sign;
  }
  sign.Limit = found.Limit;
  sign.Lower = found.Lower;
  sign.Upper = found.Upper;
  sign.Turned = negative;
  return sign;
}
}
