// SPDX-License-Identifier: BSD-3-Clause
// The second opinion on a certificate. It shares nothing with the proof but the types: polynomials
// are maps from exponents of the barycentric coordinates to integers, Jacobians are determinants of
// derivatives as they are defined, and every comparison is exact.
#include "JacobianCertificate.h"

#include <boost/multiprecision/cpp_int.hpp>

#include <map>
#include <string>

namespace knotwork
{
namespace
{
using Integer = boost::multiprecision::cpp_int;
using Monomial = std::array<std::uint8_t, 6>;

/// Homogeneous in each group of barycentric coordinates; times 2^Exponent.
struct Polynomial
{
  std::map<Monomial, Integer> Terms;
  int Exponent = 0;
};

/// Barycentric coordinates of a shape: the first of each group, and per parameter its group and
/// place.
struct Coordinates
{
  std::vector<std::vector<int>> Groups;
  std::vector<int> First;  ///< per parameter: the coordinate that is 1 - sum of the others
  std::vector<int> Second; ///< per parameter: its own coordinate
};

Coordinates CoordinatesOf(CellShape shape)
{
  switch (shape)
  {
    case CellShape::Curve:
      return { { { 0, 1 } }, { 0 }, { 1 } };
    case CellShape::Quadrilateral:
      return { { { 0, 1 }, { 2, 3 } }, { 0, 2 }, { 1, 3 } };
    case CellShape::Hexahedron:
      return { { { 0, 1 }, { 2, 3 }, { 4, 5 } }, { 0, 2, 4 }, { 1, 3, 5 } };
    case CellShape::Triangle:
      return { { { 0, 1, 2 } }, { 0, 0 }, { 1, 2 } };
    case CellShape::Tetrahedron:
      return { { { 0, 1, 2, 3 } }, { 0, 0, 0 }, { 1, 2, 3 } };
    default:
      return { { { 0, 1, 2 }, { 3, 4 } }, { 0, 0, 3 }, { 1, 2, 4 } };
  }
}

Polynomial Sum(const Polynomial& a, const Polynomial& b, int sign)
{
  Polynomial result;
  if (a.Terms.empty() || b.Terms.empty())
  {
    result = a.Terms.empty() ? b : a;
    if (a.Terms.empty() && sign < 0)
    {
      for (auto& [m, c] : result.Terms)
      {
        c = -c;
      }
    }
    return result;
  }
  result.Exponent = std::min(a.Exponent, b.Exponent);
  for (const auto& [m, c] : a.Terms)
  {
    result.Terms[m] += c << (a.Exponent - result.Exponent);
  }
  for (const auto& [m, c] : b.Terms)
  {
    result.Terms[m] += sign * (c << (b.Exponent - result.Exponent));
  }
  for (auto it = result.Terms.begin(); it != result.Terms.end();)
  {
    it = it->second.is_zero() ? result.Terms.erase(it) : std::next(it);
  }
  return result;
}

Polynomial Product(const Polynomial& a, const Polynomial& b)
{
  Polynomial result;
  result.Exponent = a.Exponent + b.Exponent;
  for (const auto& [ma, ca] : a.Terms)
  {
    for (const auto& [mb, cb] : b.Terms)
    {
      Monomial m = ma;
      for (std::size_t s = 0; s < m.size(); ++s)
      {
        m[s] = static_cast<std::uint8_t>(m[s] + mb[s]);
      }
      result.Terms[m] += ca * cb;
    }
  }
  return result;
}

Polynomial PartialDerivative(const Polynomial& a, int coordinate)
{
  Polynomial result;
  result.Exponent = a.Exponent;
  const std::size_t s = static_cast<std::size_t>(coordinate);
  for (const auto& [ma, c] : a.Terms)
  {
    if (ma[s] > 0)
    {
      Monomial m = ma;
      --m[s];
      result.Terms[m] += c * static_cast<int>(ma[s]);
    }
  }
  return result;
}

/// By expansion along the first row.
Polynomial Determinant(const std::vector<std::vector<Polynomial>>& rows)
{
  if (rows.size() == 1)
  {
    return rows[0][0];
  }
  Polynomial result;
  for (std::size_t k = 0; k < rows.size(); ++k)
  {
    std::vector<std::vector<Polynomial>> minor;
    for (std::size_t r = 1; r < rows.size(); ++r)
    {
      minor.push_back(rows[r]);
      minor.back().erase(minor.back().begin() + static_cast<std::ptrdiff_t>(k));
    }
    result = Sum(result, Product(rows[0][k], Determinant(minor)), k % 2 == 0 ? 1 : -1);
  }
  return result;
}

/// A finite double, exactly.
void Decompose(double x, Integer& m, int& e)
{
  const double f = std::frexp(x, &e);
  m = static_cast<std::int64_t>(std::ldexp(f, 53));
  e -= 53;
}

Polynomial Constant(double x)
{
  Polynomial result;
  Decompose(x, result.Terms[Monomial{}], result.Exponent);
  if (x == 0.0)
  {
    result.Terms.clear();
  }
  return result;
}

/// One plane of a cell.
Polynomial PlaneOf(CellShape shape, const CellDegree& degree, const double* values)
{
  Polynomial result;
  const auto coordinates = CoordinatesOf(shape);
  for (int k = 0; k <= degree[2]; ++k)
  {
    for (int j = 0; j <= degree[1]; ++j)
    {
      for (int i = 0; i <= degree[0]; ++i)
      {
        const int index[3] = { i, j, k };
        // exponents, and the multinomial that Bernstein polynomials carry
        Monomial m{};
        Integer multinomial = 1;
        bool inside = true;
        for (const auto& group : coordinates.Groups)
        {
          int left = 0;
          for (std::size_t d = 0; d < coordinates.First.size(); ++d)
          {
            left = coordinates.First[d] == group[0] ? degree[d] : left;
          }
          for (std::size_t d = 0; d < coordinates.First.size(); ++d)
          {
            if (coordinates.First[d] == group[0])
            {
              for (int t = 0; t < index[d]; ++t)
              {
                multinomial *= left - t;
              }
              for (int t = 1; t <= index[d]; ++t)
              {
                multinomial /= t;
              }
              left -= index[d];
              inside = inside && left >= 0;
              m[static_cast<std::size_t>(coordinates.Second[d])] =
                static_cast<std::uint8_t>(index[d]);
            }
          }
          m[static_cast<std::size_t>(group[0])] = static_cast<std::uint8_t>(std::max(left, 0));
        }
        if (inside)
        {
          Polynomial term = Constant(values[CellCoefficient(shape, degree, i, j, k)]);
          if (!term.Terms.empty())
          {
            const Integer c = term.Terms.begin()->second * multinomial;
            term.Terms.clear();
            term.Terms[m] = c;
            result = Sum(result, term, 1);
          }
        }
      }
    }
  }
  return result;
}

int SignAt(const Polynomial& a, const Coordinates& coordinates, const std::array<double, 3>& at)
{
  // every coordinate as an integer over 2^shift
  int shift = 0;
  std::array<Integer, 3> m;
  std::array<int, 3> e{};
  for (std::size_t d = 0; d < 3; ++d)
  {
    Decompose(at[d], m[d], e[d]);
    shift = std::max(shift, m[d].is_zero() ? 0 : -e[d]);
  }
  std::array<Integer, 6> values;
  for (const auto& group : coordinates.Groups)
  {
    values[static_cast<std::size_t>(group[0])] = Integer(1) << shift;
  }
  for (std::size_t d = 0; d < coordinates.First.size(); ++d)
  {
    const Integer x = m[d].is_zero() ? Integer(0) : Integer(m[d] << (e[d] + shift));
    values[static_cast<std::size_t>(coordinates.Second[d])] = x;
    values[static_cast<std::size_t>(coordinates.First[d])] -= x;
  }
  Integer sum = 0;
  for (const auto& [monomial, c] : a.Terms)
  {
    Integer term = c;
    for (std::size_t s = 0; s < 6; ++s)
    {
      term *= pow(values[s], monomial[s]);
    }
    sum += term;
  }
  return sum.sign();
}

enum class Answer
{
  Yes,
  No,
  Unknown
};

struct Piece
{
  Polynomial P;
  int Depth = 0;
  int Inner = 0; ///< coordinates whose vanishing is not on the cell's boundary
};

Polynomial Half(const Polynomial& a, int from, int to)
{
  // the corner of `to` moves to the middle m: from -> from + m / 2, to -> m / 2
  Polynomial result;
  const std::size_t f = static_cast<std::size_t>(from);
  const std::size_t t = static_cast<std::size_t>(to);
  int most = 0;
  for (const auto& [m, c] : a.Terms)
  {
    most = std::max(most, m[f] + m[t]);
  }
  result.Exponent = a.Exponent - most;
  for (const auto& [m, c] : a.Terms)
  {
    Integer binomial = 1;
    for (int j = 0; j <= m[f]; ++j)
    {
      Monomial n = m;
      n[f] = static_cast<std::uint8_t>(m[f] - j);
      n[t] = static_cast<std::uint8_t>(m[t] + j);
      result.Terms[n] += (c * binomial) << (most - n[t]);
      binomial = binomial * (m[f] - j) / (j + 1);
    }
  }
  return result;
}

/// Is the polynomial positive on the cell? `touching`: zeros on the cell's boundary are allowed.
/// Every coefficient of a full form is in Terms or is zero.
Answer IsPositive(
  const Polynomial& polynomial, const Coordinates& coordinates, bool touching, int maxBoxes)
{
  std::vector<std::pair<int, int>> edges;
  std::size_t numCoefficients = 1;
  for (const auto& group : coordinates.Groups)
  {
    int degree = 0;
    if (!polynomial.Terms.empty())
    {
      for (int s : group)
      {
        degree += polynomial.Terms.begin()->first[static_cast<std::size_t>(s)];
      }
    }
    for (std::size_t s = 1; s < group.size(); ++s)
    {
      for (std::size_t r = 0; r < s; ++r)
      {
        edges.emplace_back(group[r], group[s]);
      }
    }
    std::size_t size = 1;
    for (std::size_t s = 1; s < group.size(); ++s)
    {
      size = size * (static_cast<std::size_t>(degree) + s) / s;
    }
    numCoefficients *= size;
  }
  std::vector<Piece> stack{ { polynomial, 0, 0 } };
  for (int boxes = 0; !stack.empty(); ++boxes)
  {
    if (boxes >= maxBoxes)
    {
      return Answer::Unknown;
    }
    const Piece piece = std::move(stack.back());
    stack.pop_back();
    bool negative = false;
    std::size_t positive = 0;
    for (const auto& [m, c] : piece.P.Terms)
    {
      negative = negative || c.sign() < 0;
      positive += c.sign() > 0;
    }
    // corners: one coordinate of each group carries its whole degree
    bool zeroCorner = false;
    std::vector<int> pick(coordinates.Groups.size(), 0);
    for (bool more = true; more;)
    {
      Monomial corner{};
      bool boundary = false;
      for (std::size_t g = 0; g < pick.size(); ++g)
      {
        int degree = 0;
        for (int s : coordinates.Groups[g])
        {
          degree +=
            piece.P.Terms.empty() ? 0 : piece.P.Terms.begin()->first[static_cast<std::size_t>(s)];
        }
        const int at = coordinates.Groups[g][static_cast<std::size_t>(pick[g])];
        corner[static_cast<std::size_t>(at)] = static_cast<std::uint8_t>(degree);
        for (int s : coordinates.Groups[g])
        {
          boundary = boundary || (s != at && !(piece.Inner >> s & 1));
        }
      }
      const auto found = piece.P.Terms.find(corner);
      const int sign = found == piece.P.Terms.end() ? 0 : found->second.sign();
      if (sign < 0 || (sign == 0 && !(touching && boundary)))
      {
        return Answer::No;
      }
      zeroCorner = zeroCorner || sign == 0;
      more = false;
      for (std::size_t g = 0; g < pick.size() && !more; ++g)
      {
        more = ++pick[g] < static_cast<int>(coordinates.Groups[g].size());
        pick[g] = more ? pick[g] : 0;
      }
    }
    if (!negative && positive > 0 && (positive == numCoefficients || zeroCorner))
    {
      continue;
    }
    const auto [from, to] = edges[static_cast<std::size_t>(piece.Depth) % edges.size()];
    stack.push_back({ Half(piece.P, from, to), piece.Depth + 1, piece.Inner | 1 << from });
    stack.push_back({ Half(piece.P, to, from), piece.Depth + 1, piece.Inner | 1 << to });
  }
  return Answer::Yes;
}

Polynomial Power(const Polynomial& a, int n)
{
  Polynomial result = Constant(1.0);
  for (int k = 0; k < n; ++k)
  {
    result = Product(result, a);
  }
  return result;
}

/// 1 as a form of the degree of another.
Polynomial One(const Polynomial& like, const Coordinates& coordinates)
{
  Polynomial result = Constant(1.0);
  for (const auto& group : coordinates.Groups)
  {
    Polynomial sum;
    int degree = 0;
    for (int s : group)
    {
      Monomial m{};
      m[static_cast<std::size_t>(s)] = 1;
      sum.Terms[m] = 1;
      degree += like.Terms.empty() ? 0 : like.Terms.begin()->first[static_cast<std::size_t>(s)];
    }
    result = Product(result, Power(sum, degree));
  }
  return result;
}

class CellCheck
{
public:
  CellCheck(
    const BernsteinCells& cells, int cell, const JacobianCertificate& certificate, int maxBoxes)
    : C(certificate.Cells[static_cast<std::size_t>(cell)]), Certificate(certificate),
      MaxBoxes(maxBoxes), Axes(CoordinatesOf(cells.Shapes[static_cast<std::size_t>(cell)]))
  {
    const std::size_t at = static_cast<std::size_t>(cell);
    const CellShape shape = cells.Shapes[at];
    const int parameters = NumParameters(shape);
    const int n = NumCellCoefficients(shape, cells.Degrees[at]);
    std::vector<Polynomial> planes;
    for (int c = 0; c < cells.NumPlanes(); ++c)
    {
      planes.push_back(PlaneOf(shape, cells.Degrees[at], cells.Block(cell) + c * n));
    }
    const auto jacobian = [&](std::vector<int> components)
    {
      std::vector<std::vector<Polynomial>> rows;
      if (cells.Rational)
      {
        components.push_back(cells.NumComponents);
        rows.emplace_back();
        for (int c : components)
        {
          rows.back().push_back(planes[static_cast<std::size_t>(c)]);
        }
      }
      for (int d = 0; d < parameters; ++d)
      {
        rows.emplace_back();
        for (int c : components)
        {
          const Polynomial& plane = planes[static_cast<std::size_t>(c)];
          rows.back().push_back(
            Sum(PartialDerivative(plane, this->Axes.Second[static_cast<std::size_t>(d)]),
              PartialDerivative(plane, this->Axes.First[static_cast<std::size_t>(d)]), -1));
        }
      }
      Polynomial result = Determinant(rows);
      // det J W^(d+1) = (-1)^d [X, X_u, ...]
      return cells.Rational && parameters % 2 == 1 ? Sum(Polynomial{}, result, -1) : result;
    };
    int power = cells.Rational ? parameters + 1 : 0;
    if (parameters == cells.NumComponents)
    {
      std::vector<int> all;
      for (int c = 0; c < parameters; ++c)
      {
        all.push_back(c);
      }
      this->D = jacobian(all);
    }
    else
    {
      std::vector<Polynomial> normals;
      if (parameters == 1)
      {
        for (int c = 0; c < cells.NumComponents; ++c)
        {
          normals.push_back(jacobian({ c }));
        }
      }
      else
      {
        normals = { jacobian({ 1, 2 }), jacobian({ 2, 0 }), jacobian({ 0, 1 }) };
      }
      int alive = 0;
      for (const Polynomial& p : normals)
      {
        alive += !p.Terms.empty();
        this->D = p.Terms.empty() ? this->D : p;
      }
      this->Flat = parameters == 2 && alive == 1;
      if (!this->Flat)
      {
        this->D = Polynomial{};
        for (const Polynomial& p : normals)
        {
          this->D = Sum(this->D, Product(p, p), 1);
        }
        this->Square = true;
        power *= 2;
      }
    }
    this->W = cells.Rational ? Power(planes.back(), power) : One(this->D, this->Axes);
    if (cells.Rational)
    {
      // one degree for both: multiply by the sums of the coordinates
      this->Raise(this->D, this->W);
    }
  }

  Answer Run(std::string& reason)
  {
    if (this->D.Terms.empty())
    {
      reason = "the Jacobian is zero throughout";
      return this->C.Verdict == Verdict::Invalid ? Answer::Yes : Answer::No;
    }
    switch (this->C.Verdict)
    {
      case Verdict::Invalid:
        return this->Invalid(reason);
      case Verdict::Undecided:
        return Answer::Unknown;
      default:
        return this->Signed(reason);
    }
  }

private:
  void Raise(Polynomial& a, Polynomial& b) const
  {
    for (const auto& group : this->Axes.Groups)
    {
      const auto degree = [&](const Polynomial& p)
      {
        int sum = 0;
        for (int s : group)
        {
          sum += p.Terms.empty() ? 0 : p.Terms.begin()->first[static_cast<std::size_t>(s)];
        }
        return sum;
      };
      Polynomial ones;
      for (int s : group)
      {
        Monomial m{};
        m[static_cast<std::size_t>(s)] = 1;
        ones.Terms[m] = 1;
      }
      while (!a.Terms.empty() && degree(a) < degree(b))
      {
        a = Product(a, ones);
      }
      while (!a.Terms.empty() && degree(b) < degree(a))
      {
        b = Product(b, ones);
      }
    }
  }

  /// D - bound W (of squares: the bound's square).
  Polynomial Minus(double bound) const
  {
    Polynomial c = Constant(bound);
    if (this->Square)
    {
      c = Product(c, c);
    }
    return Sum(this->D, Product(c, this->W), -1);
  }

  Answer Positive(const Polynomial& p, bool touching) const
  {
    return IsPositive(p, this->Axes, touching, this->MaxBoxes);
  }

  Answer Invalid(std::string& reason) const
  {
    if (this->C.Witness < 0 ||
      this->C.Witness >= static_cast<std::int32_t>(this->Certificate.Witnesses.size()))
    {
      reason = "no witness";
      return Answer::No;
    }
    const JacobianWitness& w =
      this->Certificate.Witnesses[static_cast<std::size_t>(this->C.Witness)];
    const int sign = SignAt(this->D, this->Axes, w.Parameters);
    if (!this->Flat && (this->Square ? sign != 0 : sign > 0))
    {
      reason = "the Jacobian is positive at the witness";
      return Answer::No;
    }
    if (!this->Square && !this->Flat && SignAt(this->Minus(w.Upper), this->Axes, w.Parameters) > 0)
    {
      reason = "the Jacobian at the witness is above its upper bound";
      return Answer::No;
    }
    const bool reversed =
      !this->Square && this->Positive(Sum(Polynomial{}, this->D, -1), false) == Answer::Yes;
    if (reversed || (this->Flat && this->Positive(this->D, false) == Answer::Yes))
    {
      reason = "the Jacobian has one sign";
      return Answer::No;
    }
    return this->Bounds(reason, false);
  }

  Answer Signed(std::string& reason) const
  {
    const bool degenerate = this->C.Degenerate != 0;
    if (this->C.Snapped)
    {
      return Answer::Unknown; // the claim is about a geometry within the tolerance
    }
    bool reversed = this->C.Verdict == Verdict::Reversed;
    if (this->Flat)
    {
      reversed = this->Positive(this->D, degenerate) == Answer::No;
    }
    const Polynomial p = reversed ? Sum(Polynomial{}, this->D, -1) : this->D;
    const Answer answer = this->Positive(p, degenerate);
    if (answer != Answer::Yes)
    {
      reason = "the Jacobian is not of one sign";
      return answer;
    }
    return this->Bounds(reason, this->Flat && reversed);
  }

  Answer Bounds(std::string& reason, bool turned) const
  {
    if (!(this->C.MinLower <= this->C.MinUpper && this->C.MinUpper <= this->C.MaxUpper &&
          this->C.MaxLower <= this->C.MaxUpper && this->C.MinLower <= this->C.MaxLower))
    {
      reason = "the bounds are out of order";
      return Answer::No;
    }
    if (turned)
    {
      return Answer::Yes;
    }
    bool unknown = false;
    const auto holds = [&](const Polynomial& p, bool touching, Answer wrong, const char* text)
    {
      const Answer answer = this->Positive(p, touching);
      unknown = unknown || answer == Answer::Unknown;
      if (answer == wrong)
      {
        reason = text;
        return false;
      }
      return true;
    };
    const auto finite = [](double x) { return std::isfinite(x); };
    const auto minus = [&](double x) { return this->Minus(x); };
    const auto below = [&](double x) { return Sum(Polynomial{}, this->Minus(x), -1); };
    // a bound that is attained makes a zero of the difference: allow a hair
    const double hair = 1e-9 * std::max(std::fabs(this->C.MaxUpper), std::fabs(this->C.MinLower));
    const bool skipLower = this->Square && this->C.MinLower <= 0.0;
    if (finite(this->C.MinLower) && !skipLower &&
      !holds(minus(this->Square ? this->C.MinLower * (1.0 - 1e-9) : this->C.MinLower - hair), true,
        Answer::No, "the Jacobian is below its lower bound"))
    {
      return Answer::No;
    }
    if (finite(this->C.MaxUpper) &&
      !holds(
        below(this->C.MaxUpper + hair), true, Answer::No, "the Jacobian is above its upper bound"))
    {
      return Answer::No;
    }
    if (finite(this->C.MinUpper) && this->C.MinUpper + hair > 0.0 &&
      !holds(
        minus(this->C.MinUpper + hair), false, Answer::Yes, "the minimum is above its upper bound"))
    {
      return Answer::No;
    }
    if (finite(this->C.MaxLower) && this->C.MaxLower - hair > 0.0 &&
      !holds(
        below(this->C.MaxLower - hair), false, Answer::Yes, "the maximum is below its lower bound"))
    {
      return Answer::No;
    }
    return unknown ? Answer::Unknown : Answer::Yes;
  }

  const CellCertificate& C;
  const JacobianCertificate& Certificate;
  int MaxBoxes;
  Coordinates Axes;
  Polynomial D; ///< Jacobian (or its square) times a power of the weight function
  Polynomial W; ///< that power, of the same degree
  bool Square = false;
  bool Flat = false;
};
}

CertificateCheck VerifyCertificate(
  const BernsteinCells& cells, const JacobianCertificate& certificate, int maxBoxes)
{
  CertificateCheck check;
  if (!cells.Check() || static_cast<int>(certificate.Cells.size()) != cells.NumCells() ||
    !cells.Errors.empty())
  {
    check.Refuted = 1;
    check.FirstRefuted = "the certificate is not of these cells, or they are not exact";
    return check;
  }
  for (int c = 0; c < cells.NumCells(); ++c)
  {
    std::string reason;
    switch (CellCheck(cells, c, certificate, maxBoxes).Run(reason))
    {
      case Answer::Yes:
        ++check.Confirmed;
        break;
      case Answer::Unknown:
        ++check.Unchecked;
        break;
      case Answer::No:
        if (check.Refuted++ == 0)
        {
          check.FirstRefuted = "cell " + std::to_string(c) + ": " + reason;
        }
    }
  }
  return check;
}
}
