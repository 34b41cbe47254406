// SPDX-License-Identifier: BSD-3-Clause
#include "CellNumerator.h"

#include <algorithm>
#include <cfloat>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr double SmallestMagnitude =
  0x1p-200; // of a plane's coefficients, for the floating-point stages
constexpr double LargestMagnitude = 0x1p200;

template <typename T>
const Form<T>& NumeratorOf(const ProofCell& cell, JacobianForms<T>& forms)
{
  if (!cell.Norm)
  {
    return forms.Determinant();
  }
  for (int c = 0; c < forms.NumNormals(); ++c)
  {
    forms.Normal(c);
  }
  return forms.SquaredNorm();
}

void SetRange(const ProofCell& cell, int scale, CellNumerator& numerator)
{
  if (cell.Rational)
  {
    std::vector<double> weights(
      cell.Plane(cell.Components), cell.Plane(cell.Components) + cell.Size());
    for (double& w : weights)
    {
      w = std::max(w, DBL_MIN);
    }
    numerator.Range = WeightRange(weights.data(), cell.Size(), numerator.Power);
    if (cell.Given > 0.0)
    {
      const auto ends = std::minmax_element(weights.begin(), weights.end());
      std::vector<double> wider{ *ends.first - cell.Given, *ends.second + cell.Given };
      numerator.Range = WeightRange(wider.data(), 2, numerator.Power);
    }
  }
  numerator.Range.Scale = scale;
  numerator.Range.Root = cell.Norm;
}

/// A set of slots that vanish on a face of the cell: not all of a group.
bool IsFace(const FormLayout& layout, int mask)
{
  for (int g = 0; g < layout.NumGroups; ++g)
  {
    const int group = layout.GroupMasks[static_cast<std::size_t>(g)];
    if ((mask & group) == group)
    {
      return false;
    }
  }
  return true;
}
bool IsOnFace(const SlotExponents& exponents, int mask)
{
  for (int s = 0; mask >> s; ++s)
  {
    if ((mask >> s & 1) && exponents[static_cast<std::size_t>(s)] != 0)
    {
      return false;
    }
  }
  return true;
}

void MarkDegenerate(int dimension, CellNumerator& numerator)
{
  const std::uint8_t places[] = { DegenerateVertex, DegenerateEdge, DegenerateFace };
  numerator.Degenerate = static_cast<std::uint8_t>(numerator.Degenerate | places[dimension]);
}

void SnapCorners(const ProofCell& cell, SnappedForm& snapped)
{
  if (!(cell.CollapseTolerance > 0.0))
  {
    return;
  }
  ExactForm& form = *snapped.Form;
  for (std::size_t c = 0; c < form.Layout->Corners.size(); ++c)
  {
    ExactInteger& value = form.C[static_cast<std::size_t>(form.Layout->Corners[c])];
    if (value.Sign() == 0)
    {
      continue;
    }
    const auto at = CornerParameters(cell.Shape, static_cast<int>(c));
    double v = std::fabs(form.ValueAt(at));
    if (cell.Rational)
    {
      v /= cell.CornerScale(static_cast<int>(c), snapped.Power);
    }
    if (cell.Norm)
    {
      v = std::sqrt(v);
    }
    if (v <= cell.ValueTolerance)
    {
      value = ExactInteger();
      snapped.Snapped = true;
    }
  }
}

/// Edges and vertices (faces of codimension two and more) where the quotient is zero.
void FindZeroFaces(const ProofCell& cell, CellNumerator& numerator)
{
  const FormLayout& layout = *numerator.Problem.Layout;
  const auto& exact = *numerator.Problem.Exact;
  for (int size = 2; size <= NumParameters(cell.Shape); ++size)
  {
    for (int mask = 0; mask < 1 << layout.NumSlots; ++mask)
    {
      bool proper = __builtin_popcount(static_cast<unsigned>(mask)) == size && IsFace(layout, mask);
      for (const std::uint8_t face : numerator.Problem.ZeroFaces)
      {
        proper = proper && (mask & face) != face; // part of one that is known
      }
      bool zero = proper;
      for (std::size_t k = 0; zero && k < exact.C.size(); ++k)
      {
        zero = !IsOnFace(layout.Exponents[k], mask) || exact.C[k].Sign() == 0;
      }
      if (zero)
      {
        numerator.Problem.ZeroFaces.push_back(static_cast<std::uint8_t>(mask));
        MarkDegenerate(NumParameters(cell.Shape) - size, numerator);
      }
    }
  }
}
}

bool MakeFloatingNumerator(const ProofCell& cell, LayoutCache& cache, CellNumerator& numerator)
{
  const int n = cell.Size();
  const int planes = cell.Components + (cell.Rational ? 1 : 0);
  std::vector<double> shifted(cell.Block);
  std::array<const double*, 4> pointers{};
  std::array<double, 4> absolute{};
  const double* w = cell.Plane(cell.Components);
  const double wLargest = cell.Rational ? *std::max_element(w, w + n) : 0.0;
  double largest = wLargest;
  for (int c = 0; c < planes; ++c)
  {
    double* p = shifted.data() + c * n;
    pointers[static_cast<std::size_t>(c)] = p;
    double error = cell.Given;
    if (c < cell.Components && (cell.Rational || !cell.Remainders.empty()))
    {
      // to the cell's middle, or to its first point: two roundings a coefficient, of what is left
      const double centre = cell.Rational ? 0.5 * (p[0] / w[0] + p[n - 1] / w[n - 1]) : p[0];
      double size = 0.0;
      for (int i = 0; i < n; ++i)
      {
        const double rest = std::fma(-centre, cell.Rational ? w[i] : 1.0, p[i]);
        p[i] = rest + cell.Remainder(c, i);
        size = std::max({ size, std::fabs(rest), std::fabs(p[i]) });
      }
      error += (cell.Rational ? std::fabs(centre) * cell.Given : 0.0) + 2.0 * UnitRoundoff * size;
    }
    absolute[static_cast<std::size_t>(c)] = error;
    for (int i = 0; i < n; ++i)
    {
      largest = std::max(largest, std::fabs(p[i]));
    }
  }
  if (!(largest >= SmallestMagnitude && largest <= LargestMagnitude))
  {
    return false;
  }
  JacobianForms<double> forms(cache);
  forms.Set(cell.Shape, cell.Degree, cell.Components, cell.Rational, pointers, absolute);
  const Form<double>& form = NumeratorOf(cell, forms);
  const int roundings = form.Roundings + form.Layout->MultinomialRoundings + 1;
  numerator.Values = form.C;
  for (std::size_t k = 0; k < numerator.Values.size(); ++k)
  {
    numerator.Values[k] /= form.Layout->Multinomials[k];
  }
  numerator.Problem.Layout = form.Layout;
  numerator.Problem.Numerator = numerator.Values;
  numerator.Problem.NumeratorError =
    RoundingFactor(roundings) * form.Magnitude + form.Absolute * (1.0 + 0x1p-30) + 0x1p-700;
  numerator.Layout = form.Layout;
  numerator.Error = numerator.Problem.NumeratorError;
  numerator.Power = forms.WeightPower() * (cell.Norm ? 2 : 1);
  SetRange(cell, 0, numerator);
  return true;
}

SnappedForm MakeSnappedForm(const ProofCell& cell, LayoutCache& cache)
{
  const ExactCell integers =
    MakeExactCell(*cell.Layout, cell.Components, cell.Rational, cell.Block.data(),
      cell.Remainders.empty() ? nullptr : cell.Remainders.data(), cell.PointTolerance);
  SnappedForm snapped;
  snapped.Snapped = integers.Snapped;
  std::array<const ExactInteger*, 4> planes{};
  for (std::size_t c = 0; c < 4; ++c)
  {
    planes[c] = integers.Planes[c].data();
  }
  JacobianForms<ExactInteger> forms(cache);
  forms.Set(cell.Shape, cell.Degree, cell.Components, cell.Rational, planes, {});
  snapped.Power = forms.WeightPower() * (cell.Norm ? 2 : 1);
  auto exact = std::make_shared<ExactForm>();
  snapped.Form = exact;
  {
    const Form<ExactInteger>& form = NumeratorOf(cell, forms);
    exact->Layout = form.Layout;
    exact->C = form.C;
  }
  const int factors = cell.Rational ? NumParameters(cell.Shape) + 1 : NumParameters(cell.Shape);
  exact->Exponent = integers.Exponent * factors * (cell.Norm ? 2 : 1);
  for (int s = 0; s < exact->Layout->NumSlots; ++s)
  {
    // a side that is a curve: rounding of its weights alone makes it more
    if ((integers.CollapsedSides >> s & 1) && SnapFaces(cell, snapped, 1 << s) > 0.0)
    {
      snapped.Snapped = true;
    }
  }
  SnapCorners(cell, snapped);
  return snapped;
}

double SnapFaces(const ProofCell& cell, const SnappedForm& snapped, int only)
{
  ExactForm& form = *snapped.Form;
  int scale = 0;
  const std::vector<double> values = form.Coefficients(scale);
  const FormLayout& layout = *form.Layout;
  double largest = 0.0;
  double weight = 1.0; // terms have products of weights for factors: none is smaller than that
  if (cell.Rational)
  {
    const double* w = cell.Plane(cell.Components);
    weight = std::pow(*std::min_element(w, w + cell.Size()), snapped.Power);
  }
  for (int mask = 1; mask < 1 << layout.NumSlots; ++mask)
  {
    if ((only != 0 && mask != only) || !IsFace(layout, mask) ||
      __builtin_popcount(static_cast<unsigned>(mask)) >= NumParameters(cell.Shape))
    {
      continue;
    }
    double most = 0.0;
    for (std::size_t k = 0; k < values.size(); ++k)
    {
      most = IsOnFace(layout.Exponents[k], mask) ? std::max(most, std::fabs(values[k])) : most;
    }
    most = std::ldexp(most, scale) / weight;
    most = cell.Norm ? std::sqrt(most) : most;
    if (most > 0.0 && most <= cell.ValueTolerance)
    {
      largest = std::max(largest, most);
      for (std::size_t k = 0; k < form.C.size(); ++k)
      {
        form.C[k] = IsOnFace(layout.Exponents[k], mask) ? ExactInteger() : form.C[k];
      }
    }
  }
  return largest;
}

CellNumerator MakeExactNumerator(
  const ProofCell& cell, const SnappedForm& snapped, LayoutCache& cache)
{
  const std::shared_ptr<ExactForm>& exact = snapped.Form;
  CellNumerator numerator;
  numerator.Power = snapped.Power;
  int scale = 0;
  numerator.Values = exact->Coefficients(scale);
  numerator.Layout = exact->Layout;
  double largest = 0.0;
  for (double v : numerator.Values)
  {
    largest = std::max(largest, std::fabs(v));
  }
  numerator.Error = 8.0 * UnitRoundoff * largest + DBL_MIN;
  numerator.Exact = exact;
  SetRange(cell, scale, numerator);

  auto quotient = exact;
  const bool isZero = largest == 0.0;
  for (int s = 0; !isZero && s < exact->Layout->NumSlots; ++s)
  {
    while (quotient->VanishesAt(s))
    {
      quotient = std::make_shared<ExactForm>(quotient->Quotient(s, cache));
      numerator.Factored = static_cast<std::uint8_t>(numerator.Factored | 1 << s);
      MarkDegenerate(NumParameters(cell.Shape) - 1, numerator);
    }
  }
  numerator.Problem.Layout = quotient->Layout;
  numerator.Problem.Numerator = quotient->Coefficients(numerator.Problem.Scale);
  double most = 0.0;
  for (double v : numerator.Problem.Numerator)
  {
    most = std::max(most, std::fabs(v));
  }
  numerator.Problem.NumeratorError = 8.0 * UnitRoundoff * most;
  numerator.Problem.Exact = quotient;
  if (!isZero)
  {
    FindZeroFaces(cell, numerator);
  }
  return numerator;
}
}
