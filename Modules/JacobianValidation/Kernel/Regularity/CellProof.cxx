// SPDX-License-Identifier: BSD-3-Clause
#include "CellProof.h"

#include <cfloat>
#include <limits>

namespace knotwork
{
namespace
{
double Below(double x)
{
  return std::nextafter(x, -std::numeric_limits<double>::infinity());
}
double Above(double x)
{
  return std::nextafter(x, std::numeric_limits<double>::infinity());
}

/// x 2^scale, towards minus infinity where it is not exact.
double ScaledDown(double x, int scale)
{
  const double y = std::ldexp(x, scale);
  return std::fabs(y) < 2.0 * DBL_MIN || std::isinf(y) ? Below(y) : y;
}
}

double ValueRange::Lower(double coefficient) const
{
  double x = ScaledDown(coefficient, this->Scale);
  if (this->WeightLower != 1.0 || this->WeightUpper != 1.0)
  {
    x = Below(x / (x >= 0.0 ? this->WeightUpper : this->WeightLower));
  }
  if (this->Root)
  {
    x = x <= 0.0 ? 0.0 : std::max(Below(std::sqrt(x)), 0.0);
  }
  return x;
}

double ValueRange::Upper(double coefficient) const
{
  double x = -ScaledDown(-coefficient, this->Scale);
  if (this->WeightLower != 1.0 || this->WeightUpper != 1.0)
  {
    x = Above(x / (x >= 0.0 ? this->WeightLower : this->WeightUpper));
  }
  if (this->Root)
  {
    x = x <= 0.0 ? 0.0 : Above(std::sqrt(x));
  }
  return x;
}

ValueRange WeightRange(const double* weights, int count, int power)
{
  ValueRange range;
  const auto ends = std::minmax_element(weights, weights + count);
  for (int k = 0; k < power; ++k)
  {
    range.WeightLower = Below(range.WeightLower * *ends.first);
    range.WeightUpper = Above(range.WeightUpper * *ends.second);
  }
  return range;
}

namespace
{
constexpr double SmallestMagnitude =
  0x1p-200; // of a plane's coefficients, for the floating-point stages
constexpr double LargestMagnitude = 0x1p200;

class CellProof
{
public:
  CellProof(const BernsteinCells& cells, int cell, const JacobianParams& params,
    std::int64_t maxBoxes, LayoutCache& cache)
    : Params(params), MaxBoxes(maxBoxes), Cache(cache), Cell(cell)
  {
    const std::size_t c = static_cast<std::size_t>(cell);
    this->Shape = cells.Shapes[c];
    this->Degree = cells.Degrees[c];
    this->Layout = &cache.Get(this->Shape, this->Degree);
    this->Components = cells.NumComponents;
    this->Rational = cells.Rational;
    const double* block = cells.Block(cell);
    this->Block.assign(block, block + cells.NumPlanes() * this->Layout->Size);
    this->Given = cells.Uncertainty(cell);
    if (!cells.Remainders.empty())
    {
      const double* rest = cells.Remainders.data() + cells.Offsets[c];
      const double* end = rest + this->Block.size();
      if (std::any_of(rest, end, [](double x) { return x != 0.0; }))
      {
        this->Remainders.assign(rest, end);
      }
    }
    this->DropConstantComponent();
    this->Norm = this->Components > NumParameters(this->Shape);
    this->MeasureNet();
  }

  CellCertificate Run(JacobianWitness& witness)
  {
    if (!this->HasWeights() || (!this->UseFloating() && !this->UseExact()))
    {
      this->Result.Limit = JacobianLimit::Precision;
      this->Result.MinLower = this->Result.MaxLower = -std::numeric_limits<double>::infinity();
      this->Result.MinUpper = this->Result.MaxUpper = std::numeric_limits<double>::infinity();
      return this->Result;
    }
    while (!this->Decide(witness))
    {
      if (!this->UseExact())
      {
        this->Result.Limit = JacobianLimit::Precision;
        break;
      }
    }
    this->Bounds();
    if (this->Result.Verdict == Verdict::Invalid && !this->Norm)
    {
      this->Result.MinUpper = std::min(this->Result.MinUpper, witness.Upper);
      this->Result.MinLower = std::min(this->Result.MinLower, this->Result.MinUpper);
    }
    this->ForgiveRounding();
    if (this->Flat && this->Result.Verdict == Verdict::Reversed)
    {
      // a surface in a coordinate plane has no side of its own
      this->Result.Verdict = Verdict::Valid;
      std::swap(this->Result.MinLower, this->Result.MaxUpper);
      std::swap(this->Result.MinUpper, this->Result.MaxLower);
      for (double* x : { &this->Result.MinLower, &this->Result.MinUpper, &this->Result.MaxLower,
             &this->Result.MaxUpper })
      {
        *x = -*x;
      }
    }
    if (this->Flat && this->Result.Verdict == Verdict::Valid)
    {
      this->Result.OneSided = true;
    }
    return this->Result;
  }

private:
  int Size() const { return this->Layout->Size; }
  const double* Plane(int c) const { return this->Block.data() + c * this->Size(); }

  /// A surface in a plane x, y or z = const is a planar map.
  void DropConstantComponent()
  {
    if (NumParameters(this->Shape) != 2 || this->Components != 3 || this->Given > 0.0)
    {
      return;
    }
    const int n = this->Size();
    for (int c = 0; c < 3; ++c)
    {
      if (this->IsConstant(c))
      {
        for (std::vector<double>* values : { &this->Block, &this->Remainders })
        {
          if (values->empty())
          {
            continue;
          }
          values->erase(values->begin() + c * n, values->begin() + (c + 1) * n);
          if (c == 1)
          {
            // (z, x), as in the normal's component y
            std::swap_ranges(values->begin(), values->begin() + n, values->begin() + n);
          }
        }
        this->Components = 2;
        this->Flat = true;
        return;
      }
    }
  }

  /// The weights are positive whatever the errors are.
  bool HasWeights() const
  {
    const double* w = this->Plane(this->Components);
    return !this->Rational || *std::min_element(w, w + this->Size()) > this->Given;
  }

  double Remainder(int c, int i) const
  {
    return this->Remainders.empty()
      ? 0.0
      : this->Remainders[static_cast<std::size_t>(c * this->Size() + i)];
  }

  /// All control points have the same coordinate, exactly.
  bool IsConstant(int c) const
  {
    const double* p = this->Plane(c);
    const double* w = this->Plane(this->Components);
    double first = 0.0;
    for (int i = 0; i < this->Size(); ++i)
    {
      double x = p[i];
      if (this->Rational && x != 0.0 && !Quotient(p[i], this->Remainder(c, i), w[i], x))
      {
        return false;
      }
      first = i == 0 ? x : first;
      if (x != first)
      {
        return false;
      }
    }
    return true;
  }

  /// Size of the control net, for what CollapseTolerance means here: moving control points by the
  /// tolerance changes the Jacobian at a corner by at most this, up to a small factor.
  void MeasureNet()
  {
    const int n = this->Size();
    double coordinate = 0.0;
    double step = 0.0;
    const auto point = [&](int c, int i)
    {
      const double x = this->Plane(c)[i];
      return this->Rational ? x / this->Plane(this->Components)[i] : x;
    };
    for (int c = 0; c < this->Components; ++c)
    {
      for (int i = 0; i < n; ++i)
      {
        coordinate = std::max(coordinate, std::fabs(point(c, i)));
      }
      for (const FormLayout::Edge& edge : this->Layout->Edges)
      {
        for (const FormLayout::Line& line : edge.Lines)
        {
          const int* at = edge.LineIndices.data() + line.First;
          for (int i = 0; i + 1 < line.Size; ++i)
          {
            step = std::max(step, std::fabs(point(c, at[i + 1]) - point(c, at[i])));
          }
        }
      }
    }
    this->PointTolerance = this->Params.CollapseTolerance * coordinate;
    const double* w = this->Plane(this->Components);
    this->GivenTolerance =
      this->PointTolerance * (this->Rational ? *std::min_element(w, w + n) : 1.0);
    double change = 4.0 * this->PointTolerance;
    for (int d = 0; d < NumParameters(this->Shape); ++d)
    {
      change *= this->Degree[static_cast<std::size_t>(d)] * (d > 0 ? step : 1.0);
    }
    this->ValueTolerance = change;
  }

  template <typename T>
  const Form<T>& Numerator(JacobianForms<T>& forms)
  {
    if (!this->Norm)
    {
      return forms.Determinant();
    }
    for (int c = 0; c < forms.NumNormals(); ++c)
    {
      forms.Normal(c);
    }
    return forms.SquaredNorm();
  }

  /// The numerator in doubles with its error bound. @return false when magnitudes are extreme.
  bool UseFloating()
  {
    const int n = this->Size();
    const int planes = this->Components + (this->Rational ? 1 : 0);
    std::vector<double> shifted(this->Block);
    std::array<const double*, 4> pointers{};
    std::array<double, 4> absolute{};
    const double* w = this->Plane(this->Components);
    const double wLargest = this->Rational ? *std::max_element(w, w + n) : 0.0;
    double largest = wLargest;
    for (int c = 0; c < planes; ++c)
    {
      double* p = shifted.data() + c * n;
      pointers[static_cast<std::size_t>(c)] = p;
      double error = this->Given;
      if (c < this->Components && (this->Rational || !this->Remainders.empty()))
      {
        // to the cell's middle, or to its first point: two roundings a coefficient, of what is left
        const double centre = this->Rational ? 0.5 * (p[0] / w[0] + p[n - 1] / w[n - 1]) : p[0];
        double size = 0.0;
        for (int i = 0; i < n; ++i)
        {
          const double rest = std::fma(-centre, this->Rational ? w[i] : 1.0, p[i]);
          p[i] = rest + this->Remainder(c, i);
          size = std::max({ size, std::fabs(rest), std::fabs(p[i]) });
        }
        error +=
          (this->Rational ? std::fabs(centre) * this->Given : 0.0) + 2.0 * UnitRoundoff * size;
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
    JacobianForms<double> forms(this->Cache);
    forms.Set(this->Shape, this->Degree, this->Components, this->Rational, pointers, absolute);
    const Form<double>& form = this->Numerator(forms);
    const int roundings = form.Roundings + form.Layout->MultinomialRoundings + 1;
    this->Values = form.C;
    for (std::size_t k = 0; k < this->Values.size(); ++k)
    {
      this->Values[k] /= form.Layout->Multinomials[k];
    }
    this->Problem = BoxProblem{};
    this->Problem.Layout = form.Layout;
    this->Problem.Numerator = this->Values;
    this->Problem.NumeratorError =
      RoundingFactor(roundings) * form.Magnitude + form.Absolute * (1.0 + 0x1p-30) + 0x1p-700;
    this->ValuesLayout = form.Layout;
    this->ValuesError = this->Problem.NumeratorError;
    this->Power = forms.WeightPower() * (this->Norm ? 2 : 1);
    this->SetRange(0);
    return true;
  }

  void SetRange(int scale)
  {
    this->Range = ValueRange{};
    if (this->Rational)
    {
      std::vector<double> weights(
        this->Plane(this->Components), this->Plane(this->Components) + this->Size());
      for (double& w : weights)
      {
        w = std::max(w, DBL_MIN);
      }
      this->Range = WeightRange(weights.data(), this->Size(), this->Power);
      if (this->Given > 0.0)
      {
        const auto ends = std::minmax_element(weights.begin(), weights.end());
        std::vector<double> wider{ *ends.first - this->Given, *ends.second + this->Given };
        this->Range = WeightRange(wider.data(), 2, this->Power);
      }
    }
    this->Range.Scale = scale;
    this->Range.Root = this->Norm;
  }

  /// The numerator exactly; collapsed edges and zero corners are made so, zero faces are divided
  /// out. Of a geometry that is known to within errors only this decides degenerate cells, when the
  /// errors are below what CollapseTolerance forgives; all others stay with the floating form.
  /// @return false when it was done before or decides nothing.
  bool UseExact()
  {
    if (this->ExactWasTried || this->Given > this->GivenTolerance)
    {
      return false;
    }
    this->ExactWasTried = true;
    this->TakeExact(this->MakeExactNumerator());
    if (this->Given > 0.0)
    {
      if (this->Result.Degenerate == 0)
      {
        this->Exact = nullptr;
        this->Result.Snapped = false;
        this->UseFloating();
        return false;
      }
      this->Result.Snapped = true;
    }
    return true;
  }

  /// The numerator with collapsed edges and zero corners made so.
  std::shared_ptr<ExactForm> MakeExactNumerator()
  {
    const ExactCell cell =
      MakeExactCell(*this->Layout, this->Components, this->Rational, this->Block.data(),
        this->Remainders.empty() ? nullptr : this->Remainders.data(), this->PointTolerance);
    this->Result.Snapped = cell.Snapped;
    std::array<const ExactInteger*, 4> planes{};
    for (std::size_t c = 0; c < 4; ++c)
    {
      planes[c] = cell.Planes[c].data();
    }
    JacobianForms<ExactInteger> forms(this->Cache);
    forms.Set(this->Shape, this->Degree, this->Components, this->Rational, planes, {});
    this->Power = forms.WeightPower() * (this->Norm ? 2 : 1);
    auto exact = std::make_shared<ExactForm>();
    {
      const Form<ExactInteger>& form = this->Numerator(forms);
      exact->Layout = form.Layout;
      exact->C = form.C;
    }
    const int factors =
      this->Rational ? NumParameters(this->Shape) + 1 : NumParameters(this->Shape);
    exact->Exponent = cell.Exponent * factors * (this->Norm ? 2 : 1);
    for (int s = 0; s < exact->Layout->NumSlots; ++s)
    {
      // a side that is a curve: rounding of its weights alone makes it more
      if ((cell.CollapsedSides >> s & 1) && this->SnapFaces(*exact, 1 << s) > 0.0)
      {
        this->Result.Snapped = true;
      }
    }
    this->SnapCorners(*exact);
    return exact;
  }

  /// The problem of the sign of a numerator, divided by the faces where it vanishes.
  void TakeExact(const std::shared_ptr<ExactForm>& exact)
  {
    int scale = 0;
    this->Values = exact->Coefficients(scale);
    this->ValuesLayout = exact->Layout;
    double largest = 0.0;
    for (double v : this->Values)
    {
      largest = std::max(largest, std::fabs(v));
    }
    this->ValuesError = 8.0 * UnitRoundoff * largest + DBL_MIN;
    this->Exact = exact;
    this->SetRange(scale);

    auto quotient = exact;
    this->Factored = 0;
    this->Result.Degenerate = 0;
    const bool isZero = largest == 0.0;
    for (int s = 0; !isZero && s < exact->Layout->NumSlots; ++s)
    {
      while (quotient->VanishesAt(s))
      {
        quotient = std::make_shared<ExactForm>(quotient->Quotient(s, this->Cache));
        this->Factored = static_cast<std::uint8_t>(this->Factored | 1 << s);
        this->MarkDegenerate(NumParameters(this->Shape) - 1);
      }
    }
    this->Problem = BoxProblem{};
    this->Problem.Layout = quotient->Layout;
    this->Problem.Numerator = quotient->Coefficients(this->Problem.Scale);
    double most = 0.0;
    for (double v : this->Problem.Numerator)
    {
      most = std::max(most, std::fabs(v));
    }
    this->Problem.NumeratorError = 8.0 * UnitRoundoff * most;
    this->Problem.Exact = quotient;
    if (!isZero)
    {
      this->FindZeroFaces();
    }
  }

  void MarkDegenerate(int dimension)
  {
    const std::uint8_t places[] = { DegenerateVertex, DegenerateEdge, DegenerateFace };
    this->Result.Degenerate =
      static_cast<std::uint8_t>(this->Result.Degenerate | places[dimension]);
  }

  void SnapCorners(ExactForm& form)
  {
    if (!(this->Params.CollapseTolerance > 0.0))
    {
      return;
    }
    for (std::size_t c = 0; c < form.Layout->Corners.size(); ++c)
    {
      ExactInteger& value = form.C[static_cast<std::size_t>(form.Layout->Corners[c])];
      if (value.Sign() == 0)
      {
        continue;
      }
      const auto at = CornerParameters(this->Shape, static_cast<int>(c));
      double v = std::fabs(form.ValueAt(at));
      if (this->Rational)
      {
        v /= this->CornerScale(static_cast<int>(c));
      }
      if (this->Norm)
      {
        v = std::sqrt(v);
      }
      if (v <= this->ValueTolerance)
      {
        value = ExactInteger();
        this->Result.Snapped = true;
      }
    }
  }

  /// Of a rational cell: the numerator at a corner over the Jacobian of the map that has the same
  /// control points and no weights (its square when the numerator is squared). det J is that times
  /// the product of w_d / w, the weights of the corner's neighbours over its own.
  double CornerScale(int corner) const
  {
    const double* w = this->Plane(this->Components);
    const int at = this->Layout->Corners[static_cast<std::size_t>(corner)];
    double ratio = 1.0;
    int left = NumParameters(this->Shape);
    for (const FormLayout::Edge& edge : this->Layout->Edges)
    {
      for (const FormLayout::Line& line : edge.Lines)
      {
        const int* indices = edge.LineIndices.data() + line.First;
        for (const bool end : { false, true })
        {
          if (line.Size > 1 && left > 0 && indices[end ? line.Size - 1 : 0] == at)
          {
            ratio *= w[indices[end ? line.Size - 2 : 1]] / w[at];
            --left;
          }
        }
      }
    }
    return std::pow(w[at], this->Power) * (this->Norm ? ratio * ratio : ratio);
  }

  /// Sides and edges on which all coefficients are within what CollapseTolerance makes of zero
  /// become zero. @param only  the side (set of slots) that may; 0: all.
  /// @return the largest of what they were, 0 when there is none.
  double SnapFaces(ExactForm& form, int only = 0)
  {
    int scale = 0;
    const std::vector<double> values = form.Coefficients(scale);
    const FormLayout& layout = *form.Layout;
    double largest = 0.0;
    double weight = 1.0; // terms have products of weights for factors: none is smaller than that
    if (this->Rational)
    {
      const double* w = this->Plane(this->Components);
      weight = std::pow(*std::min_element(w, w + this->Size()), this->Power);
    }
    for (int mask = 1; mask < 1 << layout.NumSlots; ++mask)
    {
      if ((only != 0 && mask != only) || !this->IsFace(layout, mask) ||
        __builtin_popcount(static_cast<unsigned>(mask)) >= NumParameters(this->Shape))
      {
        continue;
      }
      double most = 0.0;
      for (std::size_t k = 0; k < values.size(); ++k)
      {
        most = IsOnFace(layout.Exponents[k], mask) ? std::max(most, std::fabs(values[k])) : most;
      }
      most = std::ldexp(most, scale) / weight;
      most = this->Norm ? std::sqrt(most) : most;
      if (most > 0.0 && most <= this->ValueTolerance)
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

  /// A set of slots that vanish on a face of the cell: not all of a group.
  static bool IsFace(const FormLayout& layout, int mask)
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
  static bool IsOnFace(const SlotExponents& exponents, int mask)
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

  /// An invalid cell whose only fault is an edge or side where the Jacobian is zero within
  /// CollapseTolerance, and that would be valid with zeros there, is neither: its coordinates do
  /// not say.
  void ForgiveRounding()
  {
    const bool open = this->Result.Verdict == Verdict::Invalid
      ? static_cast<bool>(this->Exact)
      : this->Result.Verdict == Verdict::Undecided &&
        this->Result.Limit == JacobianLimit::Precision;
    if (!open || !(this->ValueTolerance > 0.0) || this->Given > this->GivenTolerance)
    {
      return;
    }
    CellProof snapped(*this);
    snapped.Result = CellCertificate();
    snapped.ExactWasTried = true;
    const auto form = snapped.MakeExactNumerator();
    const double size = snapped.SnapFaces(*form);
    if (size == 0.0)
    {
      return;
    }
    snapped.TakeExact(form);
    JacobianWitness ignored;
    const bool decided = snapped.Decide(ignored);
    this->Result.Boxes += snapped.Result.Boxes;
    if (decided &&
      (snapped.Result.Verdict == Verdict::Valid || snapped.Result.Verdict == Verdict::Reversed))
    {
      this->Result.Verdict = Verdict::Undecided;
      this->Result.Limit = JacobianLimit::Rounding;
      this->Result.Rounding = this->PointTolerance * (size / this->ValueTolerance);
    }
  }

  /// Edges and vertices (faces of codimension two and more) where the quotient is zero.
  void FindZeroFaces()
  {
    const FormLayout& layout = *this->Problem.Layout;
    const auto& exact = *this->Problem.Exact;
    for (int size = 2; size <= NumParameters(this->Shape); ++size)
    {
      for (int mask = 0; mask < 1 << layout.NumSlots; ++mask)
      {
        bool proper =
          __builtin_popcount(static_cast<unsigned>(mask)) == size && IsFace(layout, mask);
        for (const std::uint8_t face : this->Problem.ZeroFaces)
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
          this->Problem.ZeroFaces.push_back(static_cast<std::uint8_t>(mask));
          this->MarkDegenerate(NumParameters(this->Shape) - size);
        }
      }
    }
  }

  /// May the value be what rounding made of zero? Then exact arithmetic looks before the verdict.
  bool IsSnapWorthy(double upper) const
  {
    return !this->ExactWasTried && this->Given <= this->GivenTolerance &&
      this->Params.CollapseTolerance > 0.0 && std::fabs(upper) <= 2.0 * this->ValueTolerance;
  }

  /// @return false when exact arithmetic is wanted.
  bool Decide(JacobianWitness& witness)
  {
    const BoxProblem& p = this->Problem;
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
    const double error = this->Exact ? 0.0 : p.NumeratorError;
    bool negative = false;
    if (lowest < -error && highest > error)
    {
      if (this->IsSnapWorthy(this->Range.Upper(lowest)))
      {
        return false;
      }
      const auto corners = BoxCorners(*p.Layout, {});
      this->SetInvalid(witness, corners[static_cast<std::size_t>(lowestAt)], corners,
        lowest + (this->Exact ? 16.0 * UnitRoundoff * std::fabs(lowest) : error));
      return true;
    }
    if (lowest < -error && highest <= error)
    {
      negative = !this->Norm;
    }
    else if (!(highest > error))
    {
      if (!this->Exact && this->Given == 0.0)
      {
        return false;
      }
      // all corners are zero, legally or not: the sign of the integral
      double sum = 0.0;
      double size = 0.0;
      for (double v : p.Numerator)
      {
        sum += v;
        size = std::max(size, std::fabs(v));
      }
      negative = sum < 0.0 && !this->Norm;
      if (size == 0.0)
      {
        const auto corners = BoxCorners(*p.Layout, {});
        this->SetInvalid(witness, corners[0], corners, 0.0);
        return true;
      }
    }

    BoxProblem turned;
    if (negative)
    {
      turned = p;
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
    }
    BoxSearchParams search;
    search.MaxBoxes = this->MaxBoxes;
    const bool fine = !this->Rational && this->Factored == 0 && p.ZeroFaces.empty();
    search.RelativeGap = fine ? this->Params.RelativeGap : 1.0;
    const BoxSearchResult found = SearchMinimum(negative ? turned : p, search);
    this->Result.Boxes += found.Boxes;
    if (found.NeedsExact)
    {
      return false;
    }
    if (found.NonPositive)
    {
      if (this->IsSnapWorthy(this->Range.Upper(found.Upper)))
      {
        return false;
      }
      if (negative && lowest < -error)
      {
        // of both signs; the witness is the corner where it is negative
        const auto corners = BoxCorners(*p.Layout, {});
        this->SetInvalid(witness, corners[static_cast<std::size_t>(lowestAt)], corners,
          lowest + (this->Exact ? 16.0 * UnitRoundoff * std::fabs(lowest) : error));
      }
      else if (negative)
      {
        // of both signs, and no corner says where it is negative
        const BoxSearchResult other = SearchMinimum(p, search);
        this->Result.Boxes += other.Boxes;
        if (other.NonPositive)
        {
          this->SetInvalid(witness, other.Witness, other.WitnessCorners, other.Upper);
        }
        else
        {
          this->Result.Limit = other.Limit;
        }
      }
      else
      {
        this->SetInvalid(witness, found.Witness, found.WitnessCorners, found.Upper);
      }
      return true;
    }
    if (found.Positive)
    {
      this->Result.Verdict = negative ? Verdict::Reversed : Verdict::Valid;
      this->SignLower = found.Lower;
      this->SignUpper = found.Upper;
      return true;
    }
    this->Result.Limit = found.Limit;
    this->SignLower = found.Lower;
    this->SignUpper = found.Upper;
    this->Turned = negative;
    return true;
  }

  /// @param upper  of the problem's coefficients, <= 0.
  void SetInvalid(JacobianWitness& witness, const std::array<double, 3>& at,
    const std::array<std::array<double, 3>, 8>& corners, double upper)
  {
    this->Result.Verdict = Verdict::Invalid;
    this->Result.Degenerate = 0;
    this->Result.Limit = JacobianLimit::None;
    witness.Cell = this->Cell;
    witness.Parameters = at;
    witness.NumCorners = NumCorners(this->Shape);
    witness.Corners = corners;
    if (this->Factored != 0)
    {
      this->FindNegative(witness);
    }
    else
    {
      witness.Upper = std::min(this->Norm ? 0.0 : this->Range.Upper(std::min(upper, 0.0)), 0.0);
    }
  }

  /// On a face that was divided out the Jacobian itself is zero: a point nearby inside the sub-box
  /// where it is negative.
  void FindNegative(JacobianWitness& witness)
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
      if (this->Exact && this->Exact->SignAt(at) < 0)
      {
        witness.Parameters = at;
        const double value = this->Exact->ValueAt(at) * (1.0 - 0x1p-40);
        if (!this->Rational)
        {
          witness.Upper = std::min(value, -DBL_MIN);
        }
        else
        {
          ValueRange unscaled = this->Range;
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

  /// Fills the four bounds.
  void Bounds()
  {
    CellCertificate& r = this->Result;
    double smallest = std::numeric_limits<double>::infinity();
    double largest = -smallest;
    for (double v : this->Values)
    {
      smallest = std::min(smallest, v);
      largest = std::max(largest, v);
    }
    double cornerMin = std::numeric_limits<double>::infinity();
    double cornerMax = -cornerMin;
    for (std::size_t c = 0; c < this->ValuesLayout->Corners.size(); ++c)
    {
      const double v = this->Values[static_cast<std::size_t>(this->ValuesLayout->Corners[c])];
      ValueRange here = this->Range;
      if (this->Rational)
      {
        const double weight = this->Plane(this->Components)[this->Layout->Corners[c]];
        const double ends[2] = { weight - this->Given, weight + this->Given };
        here = WeightRange(ends, 2, this->Power);
        here.Scale = this->Range.Scale;
        here.Root = this->Range.Root;
      }
      cornerMin = std::min(cornerMin, here.Upper(v + this->ValuesError));
      cornerMax = std::max(cornerMax, here.Lower(v - this->ValuesError));
    }
    r.MinLower = this->Range.Lower(smallest - this->ValuesError);
    r.MinUpper = cornerMin;
    r.MaxLower = cornerMax;
    r.MaxUpper = this->Range.Upper(largest + this->ValuesError);
    const bool degenerate = this->Factored != 0 || !this->Problem.ZeroFaces.empty();
    // what the proof of the sign knows beyond that
    ValueRange sign = this->Range;
    sign.Scale = this->Exact ? this->Problem.Scale : 0;
    if (r.Verdict == Verdict::Valid && !degenerate)
    {
      r.MinLower = std::max(r.MinLower, sign.Lower(this->SignLower));
      r.MinUpper = std::min(r.MinUpper, sign.Upper(this->SignUpper));
    }
    else if (r.Verdict == Verdict::Reversed && !degenerate)
    {
      r.MaxUpper = std::min(r.MaxUpper, -sign.Lower(this->SignLower));
      r.MaxLower = std::max(r.MaxLower, -sign.Upper(this->SignUpper));
    }
    else if (r.Verdict == Verdict::Undecided && !degenerate && !this->Turned &&
      this->SignLower > -std::numeric_limits<double>::infinity())
    {
      r.MinLower = std::max(r.MinLower, sign.Lower(this->SignLower));
      r.MinUpper = std::min(r.MinUpper, sign.Upper(this->SignUpper));
    }
    else if (r.Verdict == Verdict::Undecided && !degenerate && this->Turned)
    {
      r.MaxUpper = std::min(r.MaxUpper, -sign.Lower(this->SignLower));
      r.MaxLower = std::max(r.MaxLower, -sign.Upper(this->SignUpper));
    }
    if (degenerate && r.Verdict == Verdict::Valid)
    {
      r.MinLower = r.MinUpper = 0.0;
    }
    if (degenerate && r.Verdict == Verdict::Reversed)
    {
      r.MaxLower = r.MaxUpper = 0.0;
    }
    const bool wantMin = this->Params.RelativeGap < 1.0 && r.MinLower < r.MinUpper;
    if (wantMin)
    {
      this->Refine(false, r.MinLower, r.MinUpper);
    }
    if (this->Params.ComputeMax && r.MaxLower < r.MaxUpper)
    {
      this->Refine(true, r.MaxLower, r.MaxUpper);
    }
    if (r.Verdict == Verdict::Invalid && !this->Norm)
    {
      r.MinUpper = std::min(r.MinUpper, 0.0);
    }
    if (r.Verdict == Verdict::Invalid && this->Norm)
    {
      r.MinLower = r.MinUpper = 0.0;
    }
    // the minimum is at most the maximum, and the bounds say so too
    r.MinUpper = std::min(r.MinUpper, r.MaxUpper);
    r.MaxLower = std::max(r.MaxLower, r.MinLower);
    r.MinLower = std::min(r.MinLower, r.MinUpper);
    r.MaxUpper = std::max(r.MaxUpper, r.MaxLower);
  }

  /// Brings a pair of bounds to the gap; rational cells as the quotient of numerator and weights'
  /// power in one degree, whose bounds converge as fast as those of polynomials.
  void Refine(bool maximum, double& lower, double& upper)
  {
    if (upper - lower <= this->Params.RelativeGap * std::max(std::fabs(lower), std::fabs(upper)))
    {
      return;
    }
    BoxProblem p;
    p.Layout = this->ValuesLayout;
    p.Numerator = this->Values;
    p.NumeratorError = this->ValuesError;
    ValueRange range;
    range.Scale = this->Range.Scale;
    range.Root = this->Norm;
    if (this->Rational && !this->SetQuotient(p))
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
    search.MaxBoxes = this->MaxBoxes;
    search.NeedSign = false;
    search.RelativeGap = this->Params.RelativeGap;
    const BoxSearchResult found = SearchMinimum(p, search);
    this->Result.Boxes += found.Boxes;
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

  bool SetQuotient(BoxProblem& p)
  {
    JacobianForms<double> forms(this->Cache);
    std::array<const double*, 4> planes{};
    std::array<double, 4> absolute{};
    planes[static_cast<std::size_t>(this->Components)] = this->Plane(this->Components);
    absolute[static_cast<std::size_t>(this->Components)] = this->Given;
    forms.Set(this->Shape, this->Degree, this->Components, true, planes, absolute);
    Form<double> numerator;
    numerator.Layout = this->ValuesLayout;
    numerator.C = this->Values;
    for (std::size_t k = 0; k < numerator.C.size(); ++k)
    {
      numerator.C[k] *= this->ValuesLayout->Multinomials[k];
      numerator.Magnitude = std::max(numerator.Magnitude, std::fabs(this->Values[k]));
    }
    numerator.Roundings = 1 + this->ValuesLayout->MultinomialRoundings;
    numerator.Absolute = this->ValuesError;
    const Form<double> weights = forms.WeightToPower(this->Power);
    Form<double> elevated;
    forms.Elevate(numerator, weights.Layout->Degree, elevated);
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

  const JacobianParams& Params;
  std::int64_t MaxBoxes;
  LayoutCache& Cache;
  int Cell;
  CellShape Shape = CellShape::Curve;
  CellDegree Degree{};
  const FormLayout* Layout = nullptr;
  int Components = 0;
  bool Rational = false;
  double Given = 0.0; ///< what Block + Remainders may be off by
  std::vector<double> Block;
  std::vector<double> Remainders; ///< empty: none
  bool Norm = false;
  bool Flat = false;
  double PointTolerance = 0.0;
  double GivenTolerance = 0.0; ///< PointTolerance for homogeneous coefficients
  bool ExactWasTried = false;
  double ValueTolerance = 0.0;

  BoxProblem Problem; ///< of the sign
  ValueRange Range;   ///< of Values
  int Power = 0;
  std::vector<double> Values; ///< unscaled coefficients of the numerator itself
  const FormLayout* ValuesLayout = nullptr;
  double ValuesError = 0.0;
  std::shared_ptr<const ExactForm> Exact;
  std::uint8_t Factored = 0;
  bool Turned = false;
  double SignLower = -std::numeric_limits<double>::infinity();
  double SignUpper = std::numeric_limits<double>::infinity();
  CellCertificate Result;
};
}

CellCertificate ProveCell(const BernsteinCells& cells, int cell, const JacobianParams& params,
  std::int64_t maxBoxes, LayoutCache& cache, JacobianWitness& witness)
{
  return CellProof(cells, cell, params, maxBoxes, cache).Run(witness);
}
}
