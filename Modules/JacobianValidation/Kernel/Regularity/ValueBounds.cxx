// SPDX-License-Identifier: BSD-3-Clause
#include "ValueBounds.h"

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
/// The quotient of numerator and weights' power in one degree. @return false when it overflows.
bool SetQuotient(
  const ProofCell& cell, const CellNumerator& numerator, LayoutCache& cache, BoxProblem& p)
{
  JacobianForms<double> forms(cache);
  std::array<const double*, 4> planes{};
  std::array<double, 4> absolute{};
  planes[static_cast<std::size_t>(cell.Components)] = cell.Plane(cell.Components);
  absolute[static_cast<std::size_t>(cell.Components)] = cell.Given;
  forms.Set(cell.Shape, cell.Degree, cell.Components, true, planes, absolute);
  Form<double> values;
  values.Layout = numerator.Layout;
  values.C = numerator.Values;
  for (std::size_t k = 0; k < values.C.size(); ++k)
  {
    values.C[k] *= numerator.Layout->Multinomials[k];
    values.Magnitude = std::max(values.Magnitude, std::fabs(numerator.Values[k]));
  }
  values.Roundings = 1 + numerator.Layout->MultinomialRoundings;
  values.Absolute = numerator.Error;
  const Form<double> weights = forms.WeightToPower(numerator.Power);
  Form<double> elevated;
  forms.Elevate(values, weights.Layout->Degree, elevated);
  const auto unscale = [](const Form<double>& form, std::vector<double>& out, double& error)
  {
    out = form.C;
    for (std::size_t k = 0; k < out.size(); ++k)
    {
      out[k] /= form.Layout->Multinomials[k];
    }
    error =
      RoundingFactor(form.Roundings + form.Layout->MultinomialRoundings + 1) * form.Magnitude +
      form.Absolute * (1.0 + 0x1p-30) + 0x1p-900;
  };
  unscale(elevated, p.Numerator, p.NumeratorError);
  unscale(weights, p.Denominator, p.DenominatorError);
  p.Layout = weights.Layout;
  return std::isfinite(p.NumeratorError) && std::isfinite(p.DenominatorError);
}

/// Brings a pair of bounds to the gap; rational cells as the quotient of numerator and weights'
/// power in one degree, whose bounds converge as fast as those of polynomials.
void Refine(const ProofCell& cell, const CellNumerator& numerator, bool maximum,
  const JacobianParams& params, LayoutCache& cache, CellCertificate& r)
{
  double& lower = maximum ? r.MaxLower : r.MinLower;
  double& upper = maximum ? r.MaxUpper : r.MinUpper;
  if (upper - lower <= params.RelativeGap * std::max(std::fabs(lower), std::fabs(upper)))
  {
    return;
  }
  BoxProblem p;
  p.Layout = numerator.Layout;
  p.Numerator = numerator.Values;
  p.NumeratorError = numerator.Error;
  ValueRange range;
  range.Scale = numerator.Range.Scale;
  range.Root = cell.Norm;
  if (cell.Rational && !SetQuotient(cell, numerator, cache, p))
  {
    return;
  }
  if (maximum)
  {
    for (double& v : p.Numerator)
    {
      v = -v;
    }
  }
  BoxSearchParams search;
  search.MaxBoxes = params.MaxBoxes;
  search.NeedSign = false;
  search.RelativeGap = params.RelativeGap;
  const BoxSearchResult found = SearchMinimum(p, search);
  r.Boxes += found.Boxes;
  if (maximum)
  {
    lower = std::max(lower, range.Lower(-found.Upper));
    upper = std::min(upper, range.Upper(-found.Lower));
  }
  else
  {
    lower = std::max(lower, range.Lower(found.Lower));
    upper = std::min(upper, range.Upper(found.Upper));
  }
}
}

void BoundValues(const ProofCell& cell, const CellNumerator& numerator, const SignProof& sign,
  const JacobianParams& params, LayoutCache& cache, CellCertificate& r)
{
  double smallest = std::numeric_limits<double>::infinity();
  double largest = -smallest;
  for (double v : numerator.Values)
  {
    smallest = std::min(smallest, v);
    largest = std::max(largest, v);
  }
  double cornerMin = std::numeric_limits<double>::infinity();
  double cornerMax = -cornerMin;
  for (std::size_t c = 0; c < numerator.Layout->Corners.size(); ++c)
  {
    const double v = numerator.Values[static_cast<std::size_t>(numerator.Layout->Corners[c])];
    ValueRange here = numerator.Range;
    if (cell.Rational)
    {
      const double weight = cell.Plane(cell.Components)[cell.Layout->Corners[c]];
      const double ends[2] = { weight - cell.Given, weight + cell.Given };
      here = WeightRange(ends, 2, numerator.Power);
      here.Scale = numerator.Range.Scale;
      here.Root = numerator.Range.Root;
    }
    cornerMin = std::min(cornerMin, here.Upper(v + numerator.Error));
    cornerMax = std::max(cornerMax, here.Lower(v - numerator.Error));
  }
  r.MinLower = numerator.Range.Lower(smallest - numerator.Error);
  r.MinUpper = cornerMin;
  r.MaxLower = cornerMax;
  r.MaxUpper = numerator.Range.Upper(largest + numerator.Error);
  const bool degenerate = numerator.Factored != 0 || !numerator.Problem.ZeroFaces.empty();
  // what the proof of the sign knows beyond that
  ValueRange range = numerator.Range;
  range.Scale = numerator.Exact ? numerator.Problem.Scale : 0;
  const bool isOpen = r.Verdict == Verdict::Undecided;
  if (!degenerate &&
    (r.Verdict == Verdict::Valid ||
      (isOpen && !sign.Turned && sign.Lower > -std::numeric_limits<double>::infinity())))
  {
    r.MinLower = std::max(r.MinLower, range.Lower(sign.Lower));
    r.MinUpper = std::min(r.MinUpper, range.Upper(sign.Upper));
  }
  else if (!degenerate && (r.Verdict == Verdict::Reversed || (isOpen && sign.Turned)))
  {
    r.MaxUpper = std::min(r.MaxUpper, -range.Lower(sign.Lower));
    r.MaxLower = std::max(r.MaxLower, -range.Upper(sign.Upper));
  }
  if (degenerate && r.Verdict == Verdict::Valid)
  {
    r.MinLower = r.MinUpper = 0.0;
  }
  if (degenerate && r.Verdict == Verdict::Reversed)
  {
    r.MaxLower = r.MaxUpper = 0.0;
  }
  const bool wantMin = params.RelativeGap < 1.0 && r.MinLower < r.MinUpper;
  if (wantMin)
  {
    Refine(cell, numerator, false, params, cache, r);
  }
  if (params.ComputeMax && r.MaxLower < r.MaxUpper)
  {
    Refine(cell, numerator, true, params, cache, r);
  }
  if (r.Verdict == Verdict::Invalid && !cell.Norm)
  {
    r.MinUpper = std::min(r.MinUpper, 0.0);
  }
  if (r.Verdict == Verdict::Invalid && cell.Norm)
  {
    r.MinLower = r.MinUpper = 0.0;
  }
  // the minimum is at most the maximum, and the bounds say so too
  r.MinUpper = std::min(r.MinUpper, r.MaxUpper);
  r.MaxLower = std::max(r.MaxLower, r.MinLower);
  r.MinLower = std::min(r.MinLower, r.MinUpper);
  r.MaxUpper = std::max(r.MaxUpper, r.MaxLower);
}
}
