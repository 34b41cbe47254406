// SPDX-License-Identifier: BSD-3-Clause
#include "LRDependence.h"

#include "LRLineRows.h"
#include "PrimeField.h"

#include <Eigen/SVD>
#include <cmath>
#include <map>
#include <unordered_map>

namespace knotwork
{
namespace
{
using Number = PrimeField::Number;
using Row = std::vector<Number>;

constexpr std::size_t MaxEliminated = 3000; // functions of one elimination

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Bernstein coefficients of the unscaled functions modulo a prime.
class ModularRows
{
public:
  explicit ModularRows(const LRData& data)
    : Data(data), Lines{ LRLineRows<Number>(data.Basis, 0), LRLineRows<Number>(data.Basis, 1) }
  {
  }

  void SetPrime(Number prime)
  {
    this->Field = PrimeField(prime);
    this->Unlucky = false;
    for (std::size_t d = 0; d < 2; ++d)
    {
      this->Knots[d].clear();
      for (const double knot : this->Data.Basis.Knots[d])
      {
        this->Knots[d].push_back(this->Field.OfDouble(knot));
      }
      this->Lines[d].Clear();
      this->Inverses[d].clear();
    }
  }

  const PrimeField& GetField() const { return this->Field; }
  /// Two knots are the same modulo the prime: its rows mean nothing.
  bool IsUnlucky() const { return this->Unlucky; }

  /// (p + 1)(q + 1) coefficients of a function on an element.
  void Get(int function, int element, Row& result)
  {
    const std::array<int, 4>& box = this->Data.ElementKnots[At(element)];
    const int u = this->Find(0, function, box[0], box[2]);
    const int v = this->Find(1, function, box[1], box[3]);
    const IntArray<2>& degree = this->Data.Basis.Degree;
    result.clear();
    for (int j = 0; j <= degree[1]; ++j)
    {
      for (int i = 0; i <= degree[0]; ++i)
      {
        result.push_back(this->Field.Multiply(this->Lines[0].Row(u)[i], this->Lines[1].Row(v)[j]));
      }
    }
  }

private:
  int Find(std::size_t d, int function, int low, int high)
  {
    return this->Lines[d].Find(function, low, high,
      [this, d](const int* knots, int a, int b, Number* row) { this->Make(d, knots, a, b, row); });
  }

  void Make(std::size_t d, const int* knots, int low, int high, Number* row)
  {
    const std::vector<Number>& t = this->Knots[d];
    LRBlossomRow(
      this->Data.Basis.Degree[d], knots, low, high,
      [&](int u, int lower, int upper, Number a, Number b)
      {
        const Number left = this->Field.Multiply(this->Field.Subtract(t[At(upper)], t[At(u)]), a);
        const Number right = this->Field.Multiply(this->Field.Subtract(t[At(u)], t[At(lower)]), b);
        return this->Field.Multiply(
          this->Field.Add(left, right), this->InverseLength(d, lower, upper));
      },
      row);
  }

  Number InverseLength(std::size_t d, int lower, int upper)
  {
    const std::uint64_t key =
      (static_cast<std::uint64_t>(lower) << 32) | static_cast<std::uint64_t>(upper);
    const auto [place, isNew] = this->Inverses[d].try_emplace(key, 0);
    if (isNew)
    {
      const Number length =
        this->Field.Subtract(this->Knots[d][At(upper)], this->Knots[d][At(lower)]);
      this->Unlucky = this->Unlucky || length == 0;
      place->second = this->Field.Inverse(length);
    }
    return place->second;
  }

  const LRData& Data;
  PrimeField Field;
  std::array<std::vector<Number>, 2> Knots;
  std::array<LRLineRows<Number>, 2> Lines;
  std::array<std::unordered_map<std::uint64_t, Number>, 2> Inverses;
  bool Unlucky = false;
};

/// Row echelon form that grows row by row: reduced rows with leading ones.
class Echelon
{
public:
  explicit Echelon(const PrimeField& field) : Field(field) {}

  /// @return whether the row was independent of the rows before.
  bool Add(Row row)
  {
    for (const auto& [pivot, other] : this->Rows)
    {
      this->Eliminate(row, other, pivot);
    }
    std::size_t pivot = 0;
    while (pivot < row.size() && row[pivot] == 0)
    {
      ++pivot;
    }
    if (pivot == row.size())
    {
      return false;
    }
    const Number scale = this->Field.Inverse(row[pivot]);
    for (Number& x : row)
    {
      x = this->Field.Multiply(x, scale);
    }
    this->Rows.emplace(pivot, std::move(row));
    return true;
  }

  std::size_t Rank() const { return this->Rows.size(); }

  /// A vector that all rows annihilate, 1 in the first column without pivot. @pre there is one.
  Row Kernel(std::size_t columns) const
  {
    std::size_t free = 0;
    while (this->Rows.count(free) > 0)
    {
      ++free;
    }
    Row x(columns, 0);
    x[free] = 1;
    for (auto row = this->Rows.rbegin(); row != this->Rows.rend(); ++row)
    {
      Number sum = 0;
      for (std::size_t c = row->first + 1; c < columns; ++c)
      {
        sum = this->Field.Add(sum, this->Field.Multiply(row->second[c], x[c]));
      }
      x[row->first] = this->Field.Subtract(0, sum);
    }
    return x;
  }

private:
  void Eliminate(Row& row, const Row& other, std::size_t pivot) const
  {
    const Number factor = row[pivot];
    if (factor == 0)
    {
      return;
    }
    for (std::size_t c = pivot; c < row.size(); ++c)
    {
      row[c] = this->Field.Subtract(row[c], this->Field.Multiply(factor, other[c]));
    }
  }

  const PrimeField& Field;
  std::map<std::size_t, Row> Rows; // by pivot
};

std::vector<std::vector<int>> ElementsOfFunctions(const LRData& data)
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
std::vector<int> Peel(
  const LRData& data, const std::vector<std::vector<int>>& elements, ModularRows& rows)
{
  const auto perElement = At(NumTensorFunctions<2>(data.Basis.Degree));
  std::vector<bool> on(At(data.Basis.NumFunctions()), true);
  std::vector<int> queue;
  std::vector<bool> queued(data.ElementKnots.size(), true);
  for (std::size_t e = data.ElementKnots.size(); e-- > 0;)
  {
    queue.push_back(static_cast<int>(e));
  }
  std::vector<int> left;
  Row row;
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
    Echelon echelon(rows.GetField());
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
std::vector<std::vector<int>> Parts(const LRData& data, const std::vector<int>& unpeeled,
  const std::vector<std::vector<int>>& elements)
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
class PartMatrix
{
public:
  PartMatrix(const LRData& data, const std::vector<int>& functions,
    const std::vector<std::vector<int>>& elements)
    : Data(data), Functions(functions)
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
  void ForEachRow(ModularRows& rows, Use&& use) const
  {
    const auto perElement = At(NumTensorFunctions<2>(this->Data.Basis.Degree));
    std::vector<Row> columns;
    for (const auto& [e, ids] : this->Columns)
    {
      columns.resize(ids.size());
      for (std::size_t k = 0; k < ids.size(); ++k)
      {
        rows.Get(this->Functions[ids[k]], e, columns[k]);
      }
      for (std::size_t b = 0; b < perElement; ++b)
      {
        Row row(this->Functions.size(), 0);
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

  Echelon Reduce(ModularRows& rows) const
  {
    Echelon echelon(rows.GetField());
    this->ForEachRow(rows,
      [&](Row row)
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
    for (std::size_t d = 0; d < 2; ++d)
    {
      const std::vector<double>& values = this->Data.Basis.Knots[d];
      const int* knots = this->Data.Basis.Local(function, static_cast<int>(d));
      const int p = this->Data.Basis.Degree[d];
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

  const LRData& Data;
  const std::vector<int>& Functions;
  std::map<int, std::vector<std::size_t>> Columns; // of an element
};

/// Primes one after the other, those left out modulo which two knots are the same.
class Primes
{
public:
  explicit Primes(const LRData& data) : Rows(data) {}

  /// Calls use(rows) with a new prime until their product exceeds 2^bits or use says false.
  /// @return whether all calls said true.
  template <typename Use>
  bool Exceed(double bits, Use&& use)
  {
    Number prime = PrimeField::LargestPrime;
    for (double product = 0.0; product <= bits;)
    {
      this->Rows.SetPrime(prime);
      const bool good = use(this->Rows);
      if (!this->Rows.IsUnlucky())
      {
        if (!good)
        {
          return false;
        }
        product += std::log2(static_cast<double>(prime)) - 1e-6;
      }
      prime = PrimeField::PrimeBelow(prime);
    }
    return true;
  }

private:
  ModularRows Rows;
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
std::vector<std::int64_t> WholeNumbers(const Row& residues, const PrimeField& field)
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
bool IsExact(Primes& primes, const PartMatrix& matrix, const std::vector<int>& functions,
  const std::vector<std::int64_t>& numbers)
{
  double bits = 2.0;
  double size = 0.0;
  for (std::size_t k = 0; k < functions.size(); ++k)
  {
    bits += numbers[k] == 0 ? 0.0 : matrix.DenominatorBits(functions[k]);
    size += std::fabs(static_cast<double>(numbers[k]));
  }
  return primes.Exceed(bits + std::log2(size + 1.0),
    [&](ModularRows& rows)
    {
      const PrimeField& field = rows.GetField();
      Row residues;
      for (const std::int64_t n : numbers)
      {
        const auto magnitude =
          static_cast<Number>(static_cast<std::uint64_t>(std::abs(n)) % field.Prime());
        residues.push_back(n < 0 ? field.Subtract(0, magnitude) : magnitude);
      }
      bool zero = true;
      matrix.ForEachRow(rows,
        [&](const Row& row)
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
std::vector<double> RoundedRelation(
  const SplineSpace<2>& space, const std::vector<int>& functions, const Row& kernel)
{
  const LRData& data = *space.LocallyRefined;
  std::vector<int> column(At(space.NumFunctions), -1);
  int numColumns = 0;
  for (std::size_t k = 0; k < functions.size(); ++k)
  {
    column[At(functions[k])] = kernel[k] != 0 ? numColumns++ : -1;
  }
  std::vector<Eigen::VectorXd> rows;
  const auto perElement = NumTensorFunctions<2>(data.Basis.Degree);
  for (int row = 0; row < perElement * space.NumElements(); ++row)
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
void Exhibit(const SplineSpace<2>& space, Primes& primes, const PartMatrix& matrix,
  const std::vector<int>& functions, const Row& kernel, const PrimeField& field,
  LRDependenceResult& result)
{
  const LRData& data = *space.LocallyRefined;
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
}

Result<LRDependenceResult> DecideDependence(const SplineSpace<2>& space)
{
  if (space.Kind != SpaceKind::LocallyRefined)
  {
    return { ErrorCode::DimensionMismatch, "the space is not locally refined" };
  }
  const LRData& data = *space.LocallyRefined;
  LRDependenceResult result;
  const auto elements = ElementsOfFunctions(data);
  // one prime that tells all knots apart does
  Primes primes(data);
  primes.Exceed(0.0,
    [&](ModularRows& rows)
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
    const PartMatrix matrix(data, part, elements);
    int defect = 0;
    Row kernel;
    PrimeField field;
    const bool isShort = primes.Exceed(matrix.MinorBits(),
      [&](ModularRows& rows)
      {
        const Echelon echelon = matrix.Reduce(rows);
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
        Exhibit(space, primes, matrix, part, kernel, field, result);
      }
    }
  }
  return result;
}

namespace
{
/// Segments across the support of a function that split it: first along lines that are there in
/// part, then through the middle of its longest spans.
std::vector<LRSegment> SplittingSegments(const LRBasis& basis, int f)
{
  std::vector<LRSegment> going, fresh;
  for (int d = 0; d < 2; ++d)
  {
    const std::vector<double>& values = basis.Knots[At(d)];
    const int* knots = basis.Local(f, d);
    const int* across = basis.Local(f, 1 - d);
    const int last = basis.Degree[At(d)] + 1;
    const int low = across[0];
    const int high = across[basis.Degree[At(1 - d)] + 1];
    LRSegment segment;
    segment.Direction = d;
    segment.Start = basis.Knots[At(1 - d)][At(low)];
    segment.End = basis.Knots[At(1 - d)][At(high)];
    for (int k = knots[0] + 1; k < knots[last]; ++k)
    {
      int most = 0;
      for (int i = low; i < high; ++i)
      {
        most = std::max(most, LRMultiplicity(basis.Lines[At(d)][At(k)], i, i + 1));
      }
      if (most > 0 && std::find(knots, knots + last + 1, k) == knots + last + 1)
      {
        segment.Value = values[At(k)];
        going.push_back(segment);
      }
    }
    for (int i = 0; i < last; ++i)
    {
      if (knots[i] < knots[i + 1])
      {
        segment.Value = 0.5 * (values[At(knots[i])] + values[At(knots[i + 1])]);
        fresh.push_back(segment);
      }
    }
  }
  going.insert(going.end(), fresh.begin(), fresh.end());
  return going;
}

/// The first of the segments that leaves fewer relations.
Result<SplineSpacePtr<2>> Improve(const SplineSpacePtr<2>& space,
  const LRDependenceResult& relation, LRSegment& chosen, LRDependenceResult& better)
{
  for (const int f : relation.Functions)
  {
    for (const LRSegment& segment : SplittingSegments(space->LocallyRefined->Basis, f))
    {
      Result<SplineSpacePtr<2>> refined = InsertSegments(space, { segment });
      if (!refined)
      {
        continue;
      }
      Result<LRDependenceResult> decided = DecideDependence(*refined.Value);
      if (decided->Verdict != LRVerdict::Undecided && decided->Defect < relation.Defect)
      {
        chosen = segment;
        better = std::move(decided.Value);
        return refined;
      }
    }
  }
  return { ErrorCode::NotConverged, "no segment across a function of the relation resolves it" };
}
}

Result<LRResolution> ResolveDependence(const Spline<2>& spline, int maxSegments)
{
  if (Status status = spline.Check(); !status)
  {
    return status;
  }
  Result<LRDependenceResult> decided = DecideDependence(*spline.Space);
  if (!decided)
  {
    return decided.Status;
  }
  LRResolution resolution;
  SplineSpacePtr<2> space = spline.Space;
  while (decided->Verdict == LRVerdict::Dependent)
  {
    if (static_cast<int>(resolution.Segments.size()) >= maxSegments)
    {
      return { ErrorCode::NotConverged,
        std::to_string(decided->Defect) + " relations are left after " +
          std::to_string(maxSegments) + " segments" };
    }
    LRSegment segment;
    LRDependenceResult better;
    Result<SplineSpacePtr<2>> refined = Improve(space, decided.Value, segment, better);
    if (!refined)
    {
      return refined.Status;
    }
    space = refined.Value;
    decided.Value = std::move(better);
    resolution.Segments.push_back(segment);
  }
  if (decided->Verdict == LRVerdict::Undecided)
  {
    return { ErrorCode::NotConverged,
      std::to_string(decided->Unpeeled.size()) + " functions are too many for an elimination" };
  }
  Result<Spline<2>> value = InsertSegments(spline, resolution.Segments);
  if (!value)
  {
    return value.Status;
  }
  resolution.Value = std::move(value.Value);
  return resolution;
}
}
