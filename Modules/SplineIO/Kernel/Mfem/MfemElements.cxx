// SPDX-License-Identifier: BSD-3-Clause
#include "MfemElements.h"

#include "MfemLattice.h"
#include "TextWords.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
using Matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
using Nodes = std::vector<long double>;

/// Zeros of a function on [0, 1] that is -(value) / slope from a guess, by Newton's method.
template <typename Step>
long double Polished(long double x, const Step& step)
{
  for (int i = 0; i < 40; ++i)
  {
    x += step(x);
  }
  return x;
}

/// Legendre polynomials of degrees n and n - 1 on [-1, 1].
std::array<long double, 2> Legendre(int n, long double x)
{
  long double before = 1.0L;
  long double value = x;
  for (int k = 2; k <= n; ++k)
  {
    const long double next = ((2 * k - 1) * x * value - (k - 1) * before) / k;
    before = value;
    value = next;
  }
  return { value, before };
}

long double LegendreZero(int n, int i)
{
  const long double guess = -std::cos(3.14159265358979323846L * (i + 0.75L) / (n + 0.5L));
  return Polished(guess,
    [n](long double x)
    {
      const auto [value, before] = Legendre(n, x);
      return -value * (1.0L - x * x) / (n * (before - x * value));
    });
}

/// Interior node i in [1, p - 1] of Gauss-Lobatto: a zero of the derivative of degree p.
long double LobattoNode(int p, int i)
{
  const long double guess = -std::cos(3.14159265358979323846L * i / p);
  return Polished(guess,
    [p](long double x)
    {
      const auto [value, before] = Legendre(p, x);
      const long double slope = p * (before - x * value) / (1.0L - x * x);
      const long double bend = (2.0L * x * slope - p * (p + 1.0L) * value) / (1.0L - x * x);
      return -slope / bend;
    });
}

/// p + 1 nodes in [0, 1]. @pre basis is not Bernstein.
Nodes NodesOf(MfemBasis basis, int p)
{
  Nodes nodes;
  for (int i = 0; i <= p; ++i)
  {
    const long double uniform = static_cast<long double>(i) / p;
    const bool isEnd = i == 0 || i == p;
    switch (basis)
    {
      case MfemBasis::GaussLegendre:
        nodes.push_back((1.0L + LegendreZero(p + 1, i)) / 2.0L);
        break;
      case MfemBasis::GaussLobatto:
        nodes.push_back(isEnd ? uniform : (1.0L + LobattoNode(p, i)) / 2.0L);
        break;
      case MfemBasis::OpenUniform:
        nodes.push_back((i + 1.0L) / (p + 2.0L));
        break;
      case MfemBasis::OpenHalfUniform:
        nodes.push_back((i + 0.5L) / (p + 1.0L));
        break;
      default:
        nodes.push_back(uniform);
        break;
    }
  }
  return nodes;
}

/// Exponents of the Bernstein polynomials of a simplex; the last is that of 1 - sum.
std::vector<std::array<int, 4>> Exponents(int directions, int p)
{
  std::vector<std::array<int, 4>> all;
  for (int k = 0; k <= (directions > 2 ? p : 0); ++k)
  {
    for (int j = 0; j <= (directions > 1 ? p - k : 0); ++j)
    {
      for (int i = 0; i <= p - j - k; ++i)
      {
        all.push_back({ i, j, k, p - i - j - k });
      }
    }
  }
  return all;
}

/// From values at the nodes of a simplex to Bernstein coefficients. The nodes of triangles and
/// tetrahedra are those of the interval, made barycentric.
Eigen::MatrixXd ToBernstein(int directions, const MfemCollection& collection)
{
  const int p = collection.Degree;
  const auto exponents = Exponents(directions, p);
  const auto n = static_cast<Eigen::Index>(exponents.size());
  if (collection.Basis == MfemBasis::Bernstein)
  {
    return Eigen::MatrixXd::Identity(n, n);
  }
  const Nodes nodes = NodesOf(collection.Basis, p);
  Matrix values(n, n);
  for (Eigen::Index row = 0; row < n; ++row)
  {
    const std::array<int, 4>& place = exponents[static_cast<std::size_t>(row)];
    std::array<long double, 4> at{ 1.0L, 1.0L, 1.0L, 1.0L };
    long double sum = 0.0L;
    for (std::size_t d = 0; d < 4; ++d)
    {
      const bool isMeant = d == 3 || static_cast<int>(d) < directions;
      at[d] = isMeant ? nodes[static_cast<std::size_t>(place[d])] : 0.0L;
      sum += at[d];
    }
    for (Eigen::Index column = 0; column < n; ++column)
    {
      long double value = 1.0L;
      int factor = 0; // the multinomial coefficient, a binomial one at a time
      for (std::size_t d = 0; d < 4; ++d)
      {
        for (int e = 1; e <= exponents[static_cast<std::size_t>(column)][d]; ++e)
        {
          value *= at[d] / sum * ++factor / e;
        }
      }
      values(row, column) = value;
    }
  }
  return values.inverse().cast<double>();
}

/// Takes a beginning off a word.
bool Take(std::string_view& rest, std::string_view beginning)
{
  const bool begins = rest.substr(0, beginning.size()) == beginning;
  rest.remove_prefix(begins ? beginning.size() : 0);
  return begins;
}
}

Result<MfemCollection> ParseMfemCollection(std::string_view name, int dimension)
{
  const Status unknown{ ErrorCode::InvalidParameter,
    "the finite elements " + Shown(name) + " are not read; save the nodes as H1_" +
      std::to_string(dimension) + "D_P3 or L2_T1_" + std::to_string(dimension) +
      "D_P3 (Mesh::SetCurvature), or of another degree" };
  MfemCollection found;
  found.IsContinuous = true;
  const std::array<std::string_view, 3> fixed = { "Linear", "Quadratic", "Cubic" };
  for (std::size_t p = 0; p < fixed.size(); ++p)
  {
    if (name == fixed[p])
    {
      found.Degree = static_cast<int>(p) + 1;
      found.Basis = MfemBasis::ClosedUniform;
      return found;
    }
  }
  std::string_view rest = name;
  long long degree = 0;
  if (Take(rest, "NURBS"))
  {
    found.IsNurbs = true;
  }
  else
  {
    if (Take(rest, "H1Pos_") || Take(rest, "H1@P_") || Take(rest, "L2_T2_"))
    {
      found.Basis = MfemBasis::Bernstein;
    }
    else if (Take(rest, "H1@U_") || Take(rest, "L2_T4_"))
    {
      found.Basis = MfemBasis::ClosedUniform;
    }
    else if (Take(rest, "L2_T3_"))
    {
      found.Basis = MfemBasis::OpenUniform;
    }
    else if (Take(rest, "L2_T5_"))
    {
      found.Basis = MfemBasis::OpenHalfUniform;
    }
    else if (Take(rest, "L2_T0_"))
    {
      found.Basis = MfemBasis::GaussLegendre;
    }
    else if (!Take(rest, "H1_") && !Take(rest, "H1@G_") && !Take(rest, "L2_T1_"))
    {
      if (!Take(rest, "L2_"))
      {
        return unknown;
      }
      found.Basis = MfemBasis::GaussLegendre;
    }
    found.IsContinuous = name.front() == 'H';
    if (rest.size() < 5 || rest.substr(1, 3) != "D_P" || rest[0] < '1' || rest[0] > '3')
    {
      return unknown;
    }
    if (rest[0] - '0' != dimension)
    {
      return { ErrorCode::DimensionMismatch,
        "the finite elements " + Shown(name) + " are not of dimension " +
          std::to_string(dimension) + ", which the mesh has" };
    }
    rest.remove_prefix(4);
  }
  if (!ParseInteger(rest, -1000000, 1000000, degree))
  {
    return unknown;
  }
  if (degree < 1 || degree > MaxDegree)
  {
    return { ErrorCode::InvalidDegree,
      "the finite elements " + Shown(name) + " are not of a degree in [1, " +
        std::to_string(MaxDegree) + "]" };
  }
  found.Degree = static_cast<int>(degree);
  return found;
}

MfemConversion::MfemConversion(MfemShape shape, const MfemCollection& collection)
{
  const int dimension = ReferenceOf(shape).Dimension;
  if (ReferenceOf(shape).IsTensor)
  {
    this->Factors.assign(static_cast<std::size_t>(dimension), ToBernstein(1, collection));
  }
  else if (shape == MfemShape::Wedge)
  {
    this->Factors = { ToBernstein(2, collection), ToBernstein(1, collection) };
  }
  else
  {
    this->Factors = { ToBernstein(dimension, collection) };
  }
  for (const Eigen::MatrixXd& factor : this->Factors)
  {
    this->Size *= static_cast<int>(factor.rows());
  }
}

PointMatrix MfemConversion::Apply(PointMatrix values) const
{
  Eigen::Index inner = 1;
  for (const Eigen::MatrixXd& factor : this->Factors)
  {
    const Eigen::Index n = factor.rows();
    PointMatrix made = PointMatrix::Zero(values.rows(), values.cols());
    for (Eigen::Index row = 0; row < values.rows(); ++row)
    {
      const Eigen::Index i = row / inner % n;
      for (Eigen::Index j = 0; j < n; ++j)
      {
        made.row(row) += factor(i, j) * values.row(row + (j - i) * inner);
      }
    }
    values = std::move(made);
    inner *= n;
  }
  return values;
}
}
