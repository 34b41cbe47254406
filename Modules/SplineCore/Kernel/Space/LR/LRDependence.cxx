// SPDX-License-Identifier: BSD-3-Clause
#include "LRDependence.h"

#include "LRModular.h"
#include "LRVolume.h"

#include <Eigen/SVD>
#include <cmath>
#include <map>
#include <numeric>

namespace knotwork
{
namespace
{
using Number = PrimeField::Number;

constexpr std::size_t MaxEliminated = 3000; // functions of one elimination

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

template <typename Data>
std::vector<std::vector<int>> ElementsOfFunctions(const Data& data)
{
  std::vector<std::vector<int>> elements(At(data.Basis.NumFunctions()));
  for (std::size_t e = 0; e < data.ElementKnots.size(); ++e)
  {
    for (std::size_t k = data.AliveStart[e]; k < data.AliveStart[e + 1]; ++k)
    {
      elements[At(data.AliveFunctions[k])].push_back(static_cast<int>(e));
    }
  }
  return elements;
}

/// Functions that no element proves to be in no relation.
template <typename Data>
std::vector<int> Peel(
  const Data& data, const std::vector<std::vector<int>>& elements, LRModularRows<Data>& rows)
{
  const auto perElement = At(NumTensorFunctions<LRModularRows<Data>::Dim>(data.Basis.Degree));
  std::vector<bool> on(At(data.Basis.NumFunctions()), true);
  std::vector<int> queue;
  std::vector<bool> queued(data.ElementKnots.size(), true);
  for (std::size_t e = data.ElementKnots.size(); e-- > 0;)
  {
    queue.push_back(static_cast<int>(e));
  }
  std::vector<int> left;
  ModularRow row;
  while (!queue.empty())
  {
    const int e = queue.back();
    queue.pop_back();
    queued[At(e)] = false;
    left.clear();
    for (std::size_t k = data.AliveStart[At(e)]; k < data.AliveStart[At(e) + 1]; ++k)
    {
      if (on[At(data.AliveFunctions[k])])
      {
        left.push_back(data.AliveFunctions[k]);
      }
    }
    if (left.empty() || left.size() > perElement)
    {
      continue;
    }
    ModularEchelon echelon(rows.GetField());
    bool independent = true;
    for (std::size_t i = 0; i < left.size() && independent; ++i)
    {
      rows.Get(left[i], e, row);
      independent = echelon.Add(row);
    }
    if (!independent)
    {
      continue;
    }
    for (const int f : left)
    {
      on[At(f)] = false;
      for (const int other : elements[At(f)])
      {
        if (!queued[At(other)])
        {
          queued[At(other)] = true;
          queue.push_back(other);
        }
      }
    }
  }
  std::vector<int> unpeeled;
  for (int f = 0; f < data.Basis.NumFunctions(); ++f)
  {
    if (on[At(f)])
    {
      unpeeled.push_back(f);
    }
  }
  return unpeeled;
}

/// Parts of the unpeeled functions that share no element.
template <typename Data>
std::vector<std::vector<int>> Parts(
  const Data& data, const std::vector<int>& unpeeled, const std::vector<std::vector<int>>& elements)
{
  std::vector<int> part(At(data.Basis.NumFunctions()), -2);
  for (const int f : unpeeled)
  {
    part[At(f)] = -1;
  }
  std::vector<std::vector<int>> parts;
  for (const int first : unpeeled)
  {
    if (part[At(first)] >= 0)
    {
      continue;
    }
    const auto id = static_cast<int>(parts.size());
    part[At(first)] = id;
    std::vector<int> members{ first };
    for (std::size_t i = 0; i < members.size(); ++i)
    {
      for (const int e : elements[At(members[i])])
      {
        for (std::size_t k = data.AliveStart[At(e)]; k < data.AliveStart[At(e) + 1]; ++k)
        {
          const int f = data.AliveFunctions[k];
          if (part[At(f)] == -1)
          {
            part[At(f)] = id;
            members.push_back(f);
          }
        }
      }
    }
    std::sort(members.begin(), members.end());
    parts.push_back(std::move(members));
  }
  return parts;
}

/// The Bernstein coefficients of some functions on all elements that they meet: one row an element
/// and polynomial, one column a function.
template <typename Data>
class PartMatrix
{
public:
  PartMatrix(const Data& data, const std::vector<int>& functions,
    const std::vector<std::vector<int>>& elements)
    : Space(data), Functions(functions)
  {
    for (std::size_t c = 0; c < functions.size(); ++c)
    {
      for (const int e : elements[At(functions[c])])
      {
        this->Columns[e].push_back(c);
      }
    }
  }

  /// Calls use(row) until it says false.
  template <typename Use>
  void ForEachRow(LRModularRows<Data>& rows, Use&& use) const
  {
    const auto perElement =
      At(NumTensorFunctions<LRModularRows<Data>::Dim>(this->Space.Basis.Degree));
    std::vector<ModularRow> columns;
    for (const auto& [e, ids] : this->Columns)
    {
      columns.resize(ids.size());
      for (std::size_t k = 0; k < ids.size(); ++k)
      {
        rows.Get(this->Functions[ids[k]], e, columns[k]);
      }
      for (std::size_t b = 0; b < perElement; ++b)
      {
        ModularRow row(this->Functions.size(), 0);
        for (std::size_t k = 0; k < ids.size(); ++k)
        {
          row[ids[k]] = columns[k][b];
        }
        if (!use(std::move(row)))
        {
          return;
        }
      }
    }
  }

  ModularEchelon Reduce(LRModularRows<Data>& rows) const
  {
    ModularEchelon echelon(rows.GetField());
    this->ForEachRow(rows,
      [&](ModularRow row)
      {
        echelon.Add(std::move(row));
        return echelon.Rank() < this->Functions.size();
      });
    return echelon;
  }

  /// log2 of a number that makes a function's coefficients whole when it multiplies them: all the
  /// knot differences of de Boor's steps, in units of the smallest bit of any knot. The
  /// coefficients themselves are in [0, 1].
  double DenominatorBits(int function) const
  {
    double bits = 0.0;
    for (std::size_t d = 0; d < LRModularRows<Data>::Dim; ++d)
    {
      const std::vector<double>& values = this->Space.Basis.Knots[d];
      const int* knots = this->Space.Basis.Local(function, static_cast<int>(d));
      const int p = this->Space.Basis.Degree[d];
      const double length = values[At(knots[p + 1])] - values[At(knots[0])];
      double unit = length; // a power of two that divides all knots
      for (const double value : values)
      {
        unit = value == 0.0 ? unit : std::min(unit, LastBit(value));
      }
      // on each span p (p + 1) / 2 differences, none longer than the support; p + 1 spans
      bits += 0.5 * p * (p + 1) * (p + 1) * std::ceil(std::log2(length / unit) + 1.0);
    }
    return bits;
  }

  /// log2 of a bound on every minor of the matrix made whole.
  double MinorBits() const
  {
    const auto n = static_cast<double>(this->Functions.size());
    double bits = 0.5 * n * std::log2(n) + 1.0;
    for (const int f : this->Functions)
    {
      bits += this->DenominatorBits(f);
    }
    return bits;
  }

private:
  static double LastBit(double value)
  {
    int exponent = 0;
    auto mantissa =
      static_cast<std::int64_t>(std::ldexp(std::frexp(std::fabs(value), &exponent), 53));
    exponent -= 53;
    for (; mantissa % 2 == 0; mantissa /= 2)
    {
      ++exponent;
    }
    return std::ldexp(1.0, exponent);
  }

  const Data& Space;
  const std::vector<int>& Functions;
  std::map<int, std::vector<std::size_t>> Columns; // of an element
};

/// The fraction n / d with |n|, d < 2^15 that a residue stands for; d = 0 when there is none.
std::array<std::int64_t, 2> Fraction(Number residue, const PrimeField& field)
{
  constexpr std::int64_t limit = 32768;
  std::array<std::int64_t, 2> r{ field.Prime(), residue };
  std::array<std::int64_t, 2> t{ 0, 1 };
  while (r[1] >= limit)
  {
    const std::int64_t q = r[0] / r[1];
    r = { r[1], r[0] - q * r[1] };
    t = { t[1], t[0] - q * t[1] };
  }
  if (t[1] == 0 || std::abs(t[1]) >= limit)
  {
    return { 0, 0 };
  }
  return t[1] < 0 ? std::array<std::int64_t, 2>{ -r[1], -t[1] }
                  : std::array<std::int64_t, 2>{ r[1], t[1] };
}

/// Whole numbers proportional to residues; empty when they would be large.
std::vector<std::int64_t> WholeNumbers(const ModularRow& residues, const PrimeField& field)
{
  constexpr std::int64_t limit = std::int64_t{ 1 } << 40;
  std::vector<std::array<std::int64_t, 2>> fractions;
  std::int64_t common = 1;
  for (const Number residue : residues)
  {
    fractions.push_back(Fraction(residue, field));
    if (fractions.back()[1] == 0)
    {
      return {};
    }
    common = common / std::gcd(common, fractions.back()[1]) * fractions.back()[1];
    if (common > limit)
    {
      return {};
    }
  }
  std::vector<std::int64_t> numbers;
  for (const auto& [n, d] : fractions)
  {
    numbers.push_back(common / d * n); // below 2^55
  }
  return numbers;
}

/// The relation holds modulo primes whose product exceeds what its sum, made whole, can be.
template <typename Data>
bool IsExact(LRPrimes<Data>& primes, const PartMatrix<Data>& matrix,
  const std::vector<int>& functions, const std::vector<std::int64_t>& numbers)
{
  double bits = 2.0;
  double size = 0.0;
  for (std::size_t k = 0; k < functions.size(); ++k)
  {
    bits += numbers[k] == 0 ? 0.0 : matrix.DenominatorBits(functions[k]);
    size += std::fabs(static_cast<double>(numbers[k]));
  }
  return primes.Exceed(bits + std::log2(size + 1.0),
    [&](LRModularRows<Data>& rows)
    {
      const PrimeField& field = rows.GetField();
      ModularRow residues;
      for (const std::int64_t n : numbers)
      {
        const auto magnitude =
          static_cast<Number>(static_cast<std::uint64_t>(std::abs(n)) % field.Prime());
        residues.push_back(n < 0 ? field.Subtract(0, magnitude) : magnitude);
      }
      bool zero = true;
      matrix.ForEachRow(rows,
        [&](const ModularRow& row)
        {
          Number sum = 0;
          for (std::size_t c = 0; c < row.size(); ++c)
          {
            sum = field.Add(sum, field.Multiply(row[c], residues[c]));
          }
          zero = sum == 0;
          return zero;
        });
      return zero;
    });
}

/// Coefficients of the relation of the columns before the free one and it, in double precision.
template <int Dim>
std::vector<double> RoundedRelation(
  const SplineSpace<Dim>& space, const std::vector<int>& functions, const ModularRow& kernel)
{
  std::vector<int> column(At(space.NumFunctions), -1);
  int numColumns = 0;
  for (std::size_t k = 0; k < functions.size(); ++k)
  {
    column[At(functions[k])] = kernel[k] != 0 ? numColumns++ : -1;
  }
  std::vector<Eigen::VectorXd> rows;
  for (int row = 0; row < space.NumLocalFunctions; ++row)
  {
    Eigen::VectorXd values = Eigen::VectorXd::Zero(numColumns);
    for (std::size_t k = space.RowStart[At(row)]; k < space.RowStart[At(row) + 1]; ++k)
    {
      if (column[At(space.RowFunction[k])] >= 0)
      {
        values[column[At(space.RowFunction[k])]] = space.RowCoefficient[k];
      }
    }
    if (values.squaredNorm() > 0.0)
    {
      rows.push_back(std::move(values));
    }
  }
  Eigen::MatrixXd matrix(static_cast<Eigen::Index>(rows.size()), numColumns);
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    matrix.row(static_cast<Eigen::Index>(i)) = rows[i];
  }
  // the relation is the eigenvector of the smallest eigenvalue of the Gram matrix
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(matrix, Eigen::ComputeThinV);
  const Eigen::VectorXd x = svd.matrixV().col(numColumns - 1);
  std::vector<double> coefficients(functions.size(), 0.0);
  for (std::size_t k = 0; k < functions.size(); ++k)
  {
    if (column[At(functions[k])] >= 0)
    {
      coefficients[k] = x[column[At(functions[k])]];
    }
  }
  return coefficients;
}

/// Fills the relation from a vector of the kernel modulo the first prime.
template <int Dim, typename Data>
void Exhibit(const SplineSpace<Dim>& space, const Data& data, LRPrimes<Data>& primes,
  const PartMatrix<Data>& matrix, const std::vector<int>& functions, const ModularRow& kernel,
  const PrimeField& field, LRDependenceResult& result)
{
  std::vector<std::int64_t> numbers = WholeNumbers(kernel, field);
  if (!numbers.empty() && !IsExact(primes, matrix, functions, numbers))
  {
    numbers.clear();
  }
  std::vector<double> coefficients;
  if (numbers.empty())
  {
    coefficients = RoundedRelation(space, functions, kernel);
  }
  else
  {
    for (std::size_t k = 0; k < functions.size(); ++k)
    {
      coefficients.push_back(
        static_cast<double>(numbers[k]) / data.Basis.Scaling[At(functions[k])]);
    }
  }
  double largest = 0.0;
  for (const double c : coefficients)
  {
    largest = std::max(largest, std::fabs(c));
  }
  for (std::size_t k = 0; k < functions.size(); ++k)
  {
    if (kernel[k] != 0)
    {
      result.Functions.push_back(functions[k]);
      result.Coefficients.push_back(coefficients[k] / largest);
      if (!numbers.empty())
      {
        result.Integers.push_back(numbers[k]);
      }
    }
  }
}
template <int Dim, typename Data>
LRDependenceResult Decide(const SplineSpace<Dim>& space, const Data& data)
{
  LRDependenceResult result;
  const auto elements = ElementsOfFunctions(data);
  // one prime that tells all knots apart does
  LRPrimes<Data> primes(data);
  primes.Exceed(0.0,
    [&](LRModularRows<Data>& rows)
    {
      result.Unpeeled = Peel(data, elements, rows);
      return true;
    });
  result.Verdict = LRVerdict::Independent;
  for (const std::vector<int>& part : Parts(data, result.Unpeeled, elements))
  {
    if (part.size() > MaxEliminated)
    {
      result.Verdict = LRVerdict::Undecided;
      continue;
    }
    const PartMatrix<Data> matrix(data, part, elements);
    int defect = 0;
    ModularRow kernel;
    PrimeField field;
    const bool isShort = primes.Exceed(matrix.MinorBits(),
      [&](LRModularRows<Data>& rows)
      {
        const ModularEchelon echelon = matrix.Reduce(rows);
        if (echelon.Rank() == part.size())
        {
          return false;
        }
        const auto missing = static_cast<int>(part.size() - echelon.Rank());
        if (kernel.empty() || missing < defect)
        {
          defect = missing;
          kernel = echelon.Kernel(part.size());
          field = rows.GetField();
        }
        return true;
      });
    if (isShort)
    {
      result.Verdict = LRVerdict::Dependent;
      result.Defect += defect;
      if (result.Functions.empty())
      {
        Exhibit(space, data, primes, matrix, part, kernel, field, result);
      }
    }
  }
  return result;
}

constexpr const char* NotLocallyRefined = "the space is not locally refined";
}

Result<LRDependenceResult> DecideDependence(const SplineSpace<2>& space)
{
  return space.Kind == SpaceKind::LocallyRefined
    ? Result<LRDependenceResult>(Decide(space, *space.LocallyRefined))
    : Status(ErrorCode::DimensionMismatch, NotLocallyRefined);
}

Result<LRDependenceResult> DecideDependence(const SplineSpace<3>& space)
{
  return space.Kind == SpaceKind::LocallyRefined
    ? Result<LRDependenceResult>(Decide(space, LRVolumeOf(space)))
    : Status(ErrorCode::DimensionMismatch, NotLocallyRefined);
}
}
