// SPDX-License-Identifier: BSD-3-Clause
#include "ExactForm.h"

#include <cfloat>
#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
using Number = ExactInteger::Number;

/// Bits of |v|; 0 for 0.
int BitLength(const Number& v)
{
  return v.is_zero() ? 0 : static_cast<int>(msb(v.sign() < 0 ? Number(-v) : v)) + 1;
}

/// v as mantissa (rounded, relative error <= 2^-53) times 2^exponent.
double Mantissa(const Number& v, int& exponent)
{
  const int bits = BitLength(v);
  exponent = std::max(bits - 62, 0);
  Number top = v.sign() < 0 ? Number(-v) : v;
  top >>= exponent;
  // dropping bits below the 62nd: a relative error of 2^-61 before the rounding to 53 bits
  const double m = static_cast<double>(static_cast<std::uint64_t>(top));
  return v.sign() < 0 ? -m : m;
}

/// m 2^e, clamped to the normal numbers of its sign.
double Clamped(double m, int e)
{
  if (m == 0.0)
  {
    return 0.0;
  }
  const double value = std::ldexp(m, e);
  if (std::fabs(value) < DBL_MIN)
  {
    return std::copysign(DBL_MIN, m);
  }
  return std::isinf(value) ? std::copysign(DBL_MAX, m) : value;
}
}

ExactInteger ExactInteger::Multinomial(const FormLayout& layout, int i)
{
  if (layout.MultinomialRoundings == 0)
  {
    return Number(static_cast<std::int64_t>(layout.Multinomials[static_cast<std::size_t>(i)]));
  }
  Number result = 1;
  const auto& e = layout.Exponents[static_cast<std::size_t>(i)];
  for (int g = 0; g < layout.NumGroups; ++g)
  {
    int n = 0;
    for (int s = 0; s < layout.NumSlots; ++s)
    {
      if (layout.GroupMasks[static_cast<std::size_t>(g)] >> s & 1)
      {
        for (int k = 1; k <= e[static_cast<std::size_t>(s)]; ++k)
        {
          result = result * (++n) / k; // a product of binomials at every step
        }
      }
    }
  }
  return result;
}

DyadicNumber Dyadic(double x)
{
  DyadicNumber result;
  if (x == 0.0)
  {
    return result;
  }
  const double mantissa = std::frexp(x, &result.E);
  std::int64_t m = static_cast<std::int64_t>(std::ldexp(mantissa, 53));
  result.E -= 53;
  while ((m & 1) == 0)
  {
    m /= 2;
    ++result.E;
  }
  result.M = m;
  return result;
}

ExactForm ExactForm::Half(int edge, int side) const
{
  ExactForm half;
  half.Layout = this->Layout;
  half.C.resize(this->C.size());
  const FormLayout::Edge& e = this->Layout->Edges[static_cast<std::size_t>(edge)];
  int most = 0;
  for (const auto& line : e.Lines)
  {
    most = std::max(most, line.Size - 1);
  }
  std::vector<Number> q;
  for (const auto& line : e.Lines)
  {
    // With the new corner m at the middle, the kept slot becomes k + m / 2 and the other m / 2:
    // a shift of the univariate form in k, then powers of two.
    const int n = line.Size - 1;
    const int* indices = e.LineIndices.data() + line.First;
    const auto at = [&](int i) // i = exponent of m afterwards
    { return static_cast<std::size_t>(indices[side == 0 ? i : n - i]); };
    q.resize(static_cast<std::size_t>(n + 1));
    for (int i = 0; i <= n; ++i)
    {
      q[static_cast<std::size_t>(n - i)] = this->C[at(i)].V; // by power of the kept slot
    }
    for (int i = 0; i < n; ++i)
    {
      for (int k = n - 1; k >= i; --k)
      {
        q[static_cast<std::size_t>(k)] += q[static_cast<std::size_t>(k + 1)];
      }
    }
    for (int i = 0; i <= n; ++i)
    {
      half.C[at(i)].V = q[static_cast<std::size_t>(n - i)] << (most - i);
    }
  }
  half.Exponent = this->Exponent - most;
  // common powers of two go back into the exponent
  int common = std::numeric_limits<int>::max();
  for (const ExactInteger& c : half.C)
  {
    if (c.Sign() != 0)
    {
      common = std::min(common, static_cast<int>(lsb(c.V.sign() < 0 ? Number(-c.V) : c.V)));
    }
  }
  if (common > 0 && common < std::numeric_limits<int>::max())
  {
    for (ExactInteger& c : half.C)
    {
      const bool negative = c.V.sign() < 0;
      Number magnitude = negative ? Number(-c.V) : c.V;
      magnitude >>= common;
      c.V = negative ? Number(-magnitude) : magnitude;
    }
    half.Exponent += common;
  }
  return half;
}

bool ExactForm::VanishesAt(int slot) const
{
  for (std::size_t k = 0; k < this->C.size(); ++k)
  {
    if (this->Layout->Exponents[k][static_cast<std::size_t>(slot)] == 0 && this->C[k].Sign() != 0)
    {
      return false;
    }
  }
  return true;
}

ExactForm ExactForm::Quotient(int slot, LayoutCache& cache) const
{
  int direction = 0; // one of the slot's group
  const CellShape shape = this->Layout->Shape;
  for (int d = 0; d < NumParameters(shape); ++d)
  {
    if (this->Layout->GroupMasks[static_cast<std::size_t>(GroupOfDirection(shape, d))] >> slot & 1)
    {
      direction = d;
      break;
    }
  }
  ExactForm quotient;
  quotient.Layout = &cache.Get(shape, ChangedDegree(shape, this->Layout->Degree, direction, -1));
  quotient.Exponent = this->Exponent;
  std::map<SlotExponents, std::size_t> places;
  for (std::size_t k = 0; k < this->C.size(); ++k)
  {
    places[this->Layout->Exponents[k]] = k;
  }
  for (SlotExponents e : quotient.Layout->Exponents)
  {
    ++e[static_cast<std::size_t>(slot)];
    quotient.C.push_back(this->C[places.at(e)]);
  }
  return quotient;
}

DyadicNumber ExactForm::At(const std::array<double, 3>& parameters) const
{
  // all slots as integers over one power of two
  std::array<DyadicNumber, 3> u;
  int exponent = 0;
  for (std::size_t d = 0; d < 3; ++d)
  {
    u[d] = Dyadic(parameters[d]);
    exponent = std::min(exponent, u[d].M.is_zero() ? 0 : u[d].E);
  }
  const FormLayout& layout = *this->Layout;
  std::array<std::vector<Number>, MaxSlots> powers;
  std::array<Number, MaxSlots> slots;
  for (int g = 0, first = 0; g < layout.NumGroups; ++g)
  {
    Number rest = Number(1) << -exponent;
    int s = first;
    for (int d = 0; d < NumParameters(layout.Shape); ++d)
    {
      if (GroupOfDirection(layout.Shape, d) == g)
      {
        const DyadicNumber& x = u[static_cast<std::size_t>(d)];
        slots[static_cast<std::size_t>(++s)] =
          x.M.is_zero() ? Number(0) : Number(x.M << (x.E - exponent));
        rest -= slots[static_cast<std::size_t>(s)];
      }
    }
    slots[static_cast<std::size_t>(first)] = rest;
    first = s + 1;
  }
  int total = 0;
  const auto& first = layout.Exponents.front();
  for (int s = 0; s < layout.NumSlots; ++s)
  {
    total += first[static_cast<std::size_t>(s)];
    int most = 0;
    for (const auto& e : layout.Exponents)
    {
      most = std::max<int>(most, e[static_cast<std::size_t>(s)]);
    }
    auto& p = powers[static_cast<std::size_t>(s)];
    p.assign(1, Number(1));
    for (int k = 0; k < most; ++k)
    {
      p.push_back(p.back() * slots[static_cast<std::size_t>(s)]);
    }
  }
  DyadicNumber sum;
  for (std::size_t k = 0; k < this->C.size(); ++k)
  {
    Number term = this->C[k].V;
    for (int s = 0; s < layout.NumSlots; ++s)
    {
      term *= powers[static_cast<std::size_t>(s)][layout.Exponents[k][static_cast<std::size_t>(s)]];
    }
    sum.M += term;
  }
  sum.E = this->Exponent + total * exponent;
  return sum;
}

int ExactForm::SignAt(const std::array<double, 3>& parameters) const
{
  return this->At(parameters).M.sign();
}

double ExactForm::ValueAt(const std::array<double, 3>& parameters) const
{
  const DyadicNumber value = this->At(parameters);
  int exponent = 0;
  const double mantissa = Mantissa(value.M, exponent);
  return Clamped(mantissa, exponent + value.E);
}

std::vector<double> ExactForm::CoefficientsAt(int scale) const
{
  std::vector<double> result(this->C.size());
  for (std::size_t k = 0; k < result.size(); ++k)
  {
    int exponent = 0;
    const double mantissa = Mantissa(this->C[k].V, exponent);
    result[k] =
      Clamped(mantissa / this->Layout->Multinomials[k], exponent + this->Exponent - scale);
  }
  return result;
}

std::vector<double> ExactForm::Coefficients(int& scale) const
{
  int bits = 0;
  for (std::size_t k = 0; k < this->C.size(); ++k)
  {
    const int b = BitLength(this->C[k].V);
    bits = b > 0 ? std::max(bits, b - std::ilogb(this->Layout->Multinomials[k])) : bits;
  }
  scale = bits + this->Exponent;
  return this->CoefficientsAt(scale);
}

namespace
{
/// Component values of all planes as dyadic numbers.
using DyadicPlanes = std::array<std::vector<DyadicNumber>, 4>;

DyadicNumber Product(const DyadicNumber& a, const DyadicNumber& b)
{
  return { Number(a.M * b.M), a.E + b.E };
}

DyadicNumber Sum(const DyadicNumber& a, const DyadicNumber& b)
{
  const int e = a.M.is_zero() ? b.E : b.M.is_zero() ? a.E : std::min(a.E, b.E);
  const auto at = [e](const DyadicNumber& x)
  { return x.M.is_zero() ? Number(0) : Number(x.M << (x.E - e)); };
  return { Number(at(a) + at(b)), e };
}

bool Equal(const DyadicNumber& a, const DyadicNumber& b)
{
  if (a.M.sign() != b.M.sign())
  {
    return false;
  }
  if (a.M.is_zero())
  {
    return true;
  }
  const int e = std::min(a.E, b.E);
  return Number(a.M << (a.E - e)) == Number(b.M << (b.E - e));
}
}

bool Quotient(double hi, double lo, double w, double& x)
{
  x = hi / w;
  x += (std::fma(-x, w, hi) + lo) / w;
  const double product = x * w;
  // below that the product's own remainder may be rounded
  return product == hi && std::fma(x, w, -product) == lo &&
    (x == 0.0 || std::fabs(product) >= 0x1p-900);
}

ExactCell MakeExactCell(const FormLayout& layout, int numComponents, bool rational,
  const double* block, const double* remainders, double tolerance)
{
  const int n = layout.Size;
  const int planes = numComponents + (rational ? 1 : 0);
  DyadicPlanes values;
  for (int c = 0; c < planes; ++c)
  {
    for (int i = 0; i < n; ++i)
    {
      DyadicNumber x = Dyadic(block[c * n + i]);
      if (remainders && remainders[c * n + i] != 0.0)
      {
        x = Sum(x, Dyadic(remainders[c * n + i]));
      }
      values[static_cast<std::size_t>(c)].push_back(std::move(x));
    }
  }
  ExactCell cell;
  // Euclidean control points, rounded; neighbours that coincide within the tolerance become
  // one.
  std::vector<double> points(block, block + numComponents * n);
  const double* weights = rational ? block + numComponents * n : nullptr;
  for (int c = 0; weights && c < numComponents; ++c)
  {
    for (int i = 0; i < n; ++i)
    {
      Quotient(block[c * n + i], remainders ? remainders[c * n + i] : 0.0, weights[i],
        points[static_cast<std::size_t>(c * n + i)]);
    }
  }
  const auto point = [&](int c, int i) -> double&
  { return points[static_cast<std::size_t>(c * n + i)]; };
  const auto move = [&](int i, int to)
  {
    for (const int k : { to, i })
    {
      for (int c = 0; c < numComponents; ++c)
      {
        DyadicNumber exact = Dyadic(point(c, to));
        if (rational)
        {
          exact = Product(
            exact, values[static_cast<std::size_t>(numComponents)][static_cast<std::size_t>(k)]);
        }
        DyadicNumber& value = values[static_cast<std::size_t>(c)][static_cast<std::size_t>(k)];
        if (!Equal(value, exact))
        {
          value = exact;
          cell.Snapped = true;
        }
        point(c, k) = point(c, to);
      }
    }
  };
  for (int pass = 0; tolerance > 0.0 && pass < 3; ++pass)
  {
    for (const FormLayout::Edge& edge : layout.Edges)
    {
      for (const FormLayout::Line& line : edge.Lines)
      {
        const int* at = edge.LineIndices.data() + line.First;
        bool boundary = false;
        for (int s = 0; s < layout.NumSlots; ++s)
        {
          boundary = boundary ||
            (s != edge.From && s != edge.To &&
              layout.Exponents[static_cast<std::size_t>(at[0])][static_cast<std::size_t>(s)] == 0);
        }
        // from either end on, as long as the points agree with it: all of a collapsed line, or the
        // ends of one that stands still there
        for (const bool last : { false, true })
        {
          const int end = last ? at[line.Size - 1] : at[0];
          for (int i = 1; boundary && i < line.Size; ++i)
          {
            const int next = last ? at[line.Size - 1 - i] : at[i];
            bool close = true;
            for (int c = 0; c < numComponents; ++c)
            {
              close = close && std::fabs(point(c, next) - point(c, end)) <= tolerance;
            }
            if (!close)
            {
              break;
            }
            move(next, end);
          }
        }
      }
    }
  }

  for (int s = 0; tolerance > 0.0 && s < layout.NumSlots; ++s)
  {
    for (const FormLayout::Edge& edge : layout.Edges)
    {
      bool collapsed = s != edge.From && s != edge.To;
      for (std::size_t l = 0; collapsed && l < edge.Lines.size(); ++l)
      {
        const int* at = edge.LineIndices.data() + edge.Lines[l].First;
        const bool onSide =
          layout.Exponents[static_cast<std::size_t>(at[0])][static_cast<std::size_t>(s)] == 0;
        for (int i = 1; onSide && i < edge.Lines[l].Size; ++i)
        {
          for (int c = 0; c < numComponents; ++c)
          {
            collapsed = collapsed && point(c, at[i]) == point(c, at[0]);
          }
        }
      }
      cell.CollapsedSides =
        static_cast<std::uint8_t>(cell.CollapsedSides | (collapsed ? 1 << s : 0));
    }
  }

  int exponent = std::numeric_limits<int>::max();
  for (const auto& plane : values)
  {
    for (const DyadicNumber& x : plane)
    {
      exponent = x.M.is_zero() ? exponent : std::min(exponent, x.E);
    }
  }
  cell.Exponent = exponent == std::numeric_limits<int>::max() ? 0 : exponent;
  for (std::size_t c = 0; c < 4; ++c)
  {
    for (const DyadicNumber& x : values[c])
    {
      cell.Planes[c].push_back(
        ExactInteger(x.M.is_zero() ? Number(0) : Number(x.M << (x.E - cell.Exponent))));
    }
  }
  return cell;
}
}
