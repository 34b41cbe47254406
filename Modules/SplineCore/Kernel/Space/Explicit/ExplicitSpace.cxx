// SPDX-License-Identifier: BSD-3-Clause
#include "ExplicitSpace.h"

#include "Numbers.h"
#include "SharedRows.h"

#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <unordered_map>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Gives equal vectors of coefficients one number, in the order in which they come.
class VectorPool
{
public:
  /// Numbers of vectors are appended to the table.
  VectorPool(std::vector<std::size_t>& first, std::vector<double>& coefficients)
    : First(first), Coefficients(coefficients)
  {
  }

  int Number(const double* vector, std::size_t size)
  {
    std::uint64_t hash = size;
    for (std::size_t i = 0; i < size; ++i)
    {
      std::uint64_t word = 0;
      const double value = vector[i] + 0.0; // -0 and 0 are one
      std::memcpy(&word, &value, sizeof word);
      hash = (hash ^ word) * 0x9e3779b97f4a7c15ULL;
      hash ^= hash >> 29;
    }
    const auto [begin, end] = this->Known.equal_range(hash);
    for (auto known = begin; known != end; ++known)
    {
      const std::size_t at = this->First[At(known->second)];
      if (this->First[At(known->second) + 1] - at == size &&
        std::equal(
          vector, vector + size, this->Coefficients.begin() + static_cast<std::ptrdiff_t>(at)))
      {
        return known->second;
      }
    }
    const auto number = static_cast<int>(this->First.size()) - 1;
    for (std::size_t i = 0; i < size; ++i)
    {
      this->Coefficients.push_back(vector[i] + 0.0);
    }
    this->First.push_back(this->Coefficients.size());
    this->Known.emplace(hash, number);
    return number;
  }

private:
  std::vector<std::size_t>& First;
  std::vector<double>& Coefficients;
  std::unordered_multimap<std::uint64_t, int> Known;
};

/// Where the pivots of a decomposition fall to rounding at once. On a very short element they fall
/// to it by and by: its functions may be independent, whatever doubles can tell.
Eigen::Index RankOf(const Eigen::MatrixXd& matrix)
{
  constexpr double drop = 1e-10;
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> decomposition(matrix);
  const Eigen::VectorXd pivots = decomposition.matrixQR().diagonal().cwiseAbs();
  const double rounding =
    std::numeric_limits<double>::epsilon() * static_cast<double>(pivots.size());
  for (Eigen::Index k = 1; k < pivots.size(); ++k)
  {
    if (!(pivots[k] > rounding * pivots[0]) && !(pivots[k] > drop * pivots[k - 1]))
    {
      return k;
    }
  }
  return pivots.size();
}

/// What is wrong with the functions on one element; each different operator is looked at once.
template <int Dim>
class ElementCheck
{
public:
  ElementCheck(const ExtractionTable<Dim>& table, int numFunctions, int first)
    : Table(table), First(first), LastElement(At(numFunctions), -1)
  {
  }

  Status Check(int e)
  {
    const IntArray<Dim>& degree = this->Table.Degrees[At(e)];
    for (const int p : degree)
    {
      if (p < 1 || p > MaxDegree)
      {
        return { ErrorCode::InvalidDegree, this->Name(e) + " has degree " + std::to_string(p) };
      }
    }
    if (Status status = this->CheckNumbers(e); !status)
    {
      return status;
    }
    const auto begin = this->Table.Vectors.begin();
    const std::vector<int> vectors(
      begin + static_cast<std::ptrdiff_t>(this->Table.FirstFunction[At(e)]),
      begin + static_cast<std::ptrdiff_t>(this->Table.FirstFunction[At(e) + 1]));
    // vectors of one length belong to several degrees, which no check looks at
    return this->Passed.insert(vectors).second ? this->CheckOperator(e) : Status();
  }

private:
  std::string Name(int e) const { return "element " + std::to_string(e + this->First); }

  Status CheckNumbers(int e)
  {
    const int points = NumTensorFunctions<Dim>(this->Table.Degrees[At(e)]);
    for (std::size_t k = this->Table.FirstFunction[At(e)]; k < this->Table.FirstFunction[At(e) + 1];
         ++k)
    {
      const int function = this->Table.Functions[k];
      const int vector = this->Table.Vectors[k];
      if (function < 0 || At(function) >= this->LastElement.size())
      {
        return { ErrorCode::InvalidTopology,
          this->Name(e) + " has control point " + std::to_string(function + this->First) +
            ", there are " + std::to_string(this->LastElement.size()) };
      }
      if (this->LastElement[At(function)] == e)
      {
        return { ErrorCode::InvalidTopology,
          this->Name(e) + " has control point " + std::to_string(function + this->First) +
            " twice" };
      }
      this->LastElement[At(function)] = e;
      if (vector < 0 || At(vector) >= this->Table.NumVectors())
      {
        return { ErrorCode::InvalidTopology,
          this->Name(e) + " has coefficient vector " + std::to_string(vector + this->First) +
            ", there are " + std::to_string(this->Table.NumVectors()) };
      }
      const std::size_t size =
        this->Table.FirstCoefficient[At(vector) + 1] - this->Table.FirstCoefficient[At(vector)];
      if (size != At(points))
      {
        return { ErrorCode::SizeMismatch,
          this->Name(e) + " has " + std::to_string(points) +
            " Bernstein polynomials, its coefficient vector " +
            std::to_string(vector + this->First) + " has " + std::to_string(size) +
            " coefficients" };
      }
    }
    return {};
  }

  Status CheckOperator(int e) const
  {
    const int points = NumTensorFunctions<Dim>(this->Table.Degrees[At(e)]);
    const std::size_t begin = this->Table.FirstFunction[At(e)];
    const std::size_t count = this->Table.FirstFunction[At(e) + 1] - begin;
    Eigen::MatrixXd operation(static_cast<Eigen::Index>(count), points);
    for (std::size_t k = 0; k < count; ++k)
    {
      const int vector = this->Table.Vectors[begin + k];
      const double* coefficients =
        this->Table.Coefficients.data() + this->Table.FirstCoefficient[At(vector)];
      for (int i = 0; i < points; ++i)
      {
        const std::string where = "coefficient " + std::to_string(i + 1) + " of vector " +
          std::to_string(vector + this->First);
        if (!std::isfinite(coefficients[i]))
        {
          return { ErrorCode::NonFiniteInput, this->Name(e) + ": " + where + " is not finite" };
        }
        if (coefficients[i] < -ExtractionTolerance)
        {
          return { ErrorCode::NotInSpace,
            this->Name(e) + ": its functions are not positive: " + where + " is " +
              Digits(coefficients[i]) };
        }
        operation(static_cast<Eigen::Index>(k), i) = coefficients[i];
      }
    }
    for (int i = 0; i < points; ++i)
    {
      const double sum = operation.col(i).sum();
      if (!(std::abs(sum - 1.0) <= ExtractionTolerance))
      {
        return { ErrorCode::NotInSpace,
          this->Name(e) + ": its functions do not sum to one: their coefficients " +
            std::to_string(i + 1) + " have the sum " + Digits(sum, 16) };
      }
    }
    return this->CheckSpan(e, operation);
  }

  /// By functions that have the largest coefficient 1: beside a very short element others are
  /// nearly 0 without being dependent.
  Status CheckSpan(int e, Eigen::MatrixXd& operation) const
  {
    for (Eigen::Index k = 0; k < operation.rows(); ++k)
    {
      const double largest = operation.row(k).maxCoeff();
      operation.row(k) *= largest > 0.0 ? 1.0 / largest : 1.0;
    }
    const Eigen::Index rank = RankOf(operation);
    if (rank < operation.cols())
    {
      return { ErrorCode::NotInSpace,
        this->Name(e) + ": its " + std::to_string(operation.rows()) +
          " functions do not span the polynomials of its degrees, but " + std::to_string(rank) +
          " of " + std::to_string(operation.cols()) + " dimensions" };
    }
    return {};
  }

  const ExtractionTable<Dim>& Table;
  int First;
  std::vector<int> LastElement; ///< that had a function
  std::set<std::vector<int>> Passed;
};

template <int Dim>
Status CheckSizes(const ExtractionTable<Dim>& table, int numFunctions)
{
  if (table.Degrees.empty())
  {
    return { ErrorCode::EmptyInput, "there is no element" };
  }
  const auto ascends = [](const std::vector<std::size_t>& offsets, std::size_t end)
  {
    return !offsets.empty() && offsets.front() == 0 && offsets.back() == end &&
      std::is_sorted(offsets.begin(), offsets.end());
  };
  if (numFunctions < 0 || table.FirstFunction.size() != table.Degrees.size() + 1 ||
    !ascends(table.FirstFunction, table.Functions.size()) ||
    table.Vectors.size() != table.Functions.size() ||
    !ascends(table.FirstCoefficient, table.Coefficients.size()))
  {
    return { ErrorCode::SizeMismatch, "the tables of the operators do not fit each other" };
  }
  if (At(numFunctions) / 2 > table.Functions.size())
  {
    return { ErrorCode::InvalidTopology,
      "of " + std::to_string(numFunctions) + " control points the elements have at most " +
        std::to_string(table.Functions.size()) + "; remove the others" };
  }
  constexpr auto most = static_cast<std::size_t>(std::numeric_limits<int>::max());
  std::size_t points = 0;
  for (const IntArray<Dim>& degree : table.Degrees)
  {
    std::size_t size = 1;
    for (const int p : degree)
    {
      size *= At(std::clamp(p, 0, MaxDegree) + 1);
    }
    points += size;
  }
  if (points > most || table.NumVectors() > most || table.Functions.size() > most)
  {
    return { ErrorCode::TooLarge,
      std::to_string(points) + " Bernstein polynomials on all elements; there may be " +
        std::to_string(most) };
  }
  return {};
}

}

template <int Dim>
ExtractionTable<Dim> WithVectorsOnce(const ExtractionTable<Dim>& given)
{
  ExtractionTable<Dim> table;
  table.Degrees = given.Degrees;
  table.FirstFunction = given.FirstFunction;
  table.Functions = given.Functions;
  table.Vectors.reserve(given.Vectors.size());
  VectorPool pool(table.FirstCoefficient, table.Coefficients);
  std::vector<int> known(given.NumVectors(), -1);
  for (const int vector : given.Vectors)
  {
    if (known[At(vector)] < 0)
    {
      const std::size_t begin = given.FirstCoefficient[At(vector)];
      known[At(vector)] = pool.Number(
        given.Coefficients.data() + begin, given.FirstCoefficient[At(vector) + 1] - begin);
    }
    table.Vectors.push_back(known[At(vector)]);
  }
  return table;
}

template <int Dim>
Result<SplineSpacePtr<Dim>> MakeExplicitSpace(
  const ExtractionTable<Dim>& table, int numFunctions, int first)
{
  if (Status status = CheckSizes<Dim>(table, numFunctions); !status)
  {
    return status;
  }
  ElementCheck<Dim> check(table, numFunctions, first);
  for (int e = 0; e < static_cast<int>(table.NumElements()); ++e)
  {
    if (Status status = check.Check(e); !status)
    {
      return status;
    }
  }
  auto space = std::make_shared<SplineSpace<Dim>>();
  auto extraction = std::make_shared<const ExtractionTable<Dim>>(WithVectorsOnce<Dim>(table));
  const BernsteinRows rows = RowsOf<Dim>(*extraction);
  const std::vector<int> equal = FindEqualRows<Dim>(*extraction, rows);
  space->Kind = SpaceKind::Explicit;
  space->NumFunctions = numFunctions;
  space->Elements.resize(extraction->NumElements());
  std::size_t firstLocal = 0;
  for (std::size_t e = 0; e < space->Elements.size(); ++e)
  {
    auto& element = space->Elements[e];
    element.Degree = extraction->Degrees[e];
    element.Factor.fill(-1);
    element.Box.Upper.fill(1.0);
    element.FirstLocal = firstLocal;
    firstLocal += At(NumTensorFunctions<Dim>(element.Degree));
  }
  // local functions are the rows that differ, as they come
  std::vector<int> number(equal.size(), -1);
  space->RowStart.push_back(0);
  space->LocalFunctionIds.reserve(equal.size());
  for (const int row : equal)
  {
    if (number[At(row)] < 0)
    {
      number[At(row)] = space->NumLocalFunctions++;
      for (std::size_t k = rows.Start[At(row)]; k < rows.Start[At(row) + 1]; ++k)
      {
        space->RowFunction.push_back(rows.Functions[k]);
        space->RowCoefficient.push_back(rows.Coefficients[k]);
      }
      space->RowStart.push_back(space->RowFunction.size());
    }
    space->LocalFunctionIds.push_back(number[At(row)]);
  }
  space->Extraction = std::move(extraction);
  return SplineSpacePtr<Dim>(std::move(space));
}

template <int Dim>
ExtractionTable<Dim> ExtractionOf(const SplineSpace<Dim>& space)
{
  if (space.Extraction)
  {
    return *space.Extraction;
  }
  ExtractionTable<Dim> table;
  VectorPool pool(table.FirstCoefficient, table.Coefficients);
  for (int e = 0; e < space.NumElements(); ++e)
  {
    const PointMatrix rows = space.ExtractionOperator(e);
    const std::vector<int> alive = space.AliveFunctions(e);
    table.Functions.insert(table.Functions.end(), alive.begin(), alive.end());
    for (Eigen::Index k = 0; k < rows.rows(); ++k)
    {
      table.Vectors.push_back(
        pool.Number(rows.row(k).data(), static_cast<std::size_t>(rows.cols())));
    }
    table.EndElement(space.Elements[At(e)].Degree);
  }
  return table;
}

template <int Dim>
bool AreLocallyIndependent(const ExtractionTable<Dim>& table, int numFunctions)
{
  std::vector<char> shown(At(numFunctions), 0);
  for (std::size_t e = 0; e < table.NumElements(); ++e)
  {
    const std::size_t begin = table.FirstFunction[e];
    const std::size_t end = table.FirstFunction[e + 1];
    for (std::size_t k = begin;
         k < end && end - begin == At(NumTensorFunctions<Dim>(table.Degrees[e])); ++k)
    {
      shown[At(table.Functions[k])] = 1;
    }
  }
  return std::find(shown.begin(), shown.end(), char{ 0 }) == shown.end();
}

template Result<SplineSpacePtr<1>> MakeExplicitSpace<1>(const ExtractionTable<1>&, int, int);
template Result<SplineSpacePtr<2>> MakeExplicitSpace<2>(const ExtractionTable<2>&, int, int);
template Result<SplineSpacePtr<3>> MakeExplicitSpace<3>(const ExtractionTable<3>&, int, int);
#define KNOTWORK_INSTANTIATE(Dim)                                                                  \
  template ExtractionTable<Dim> WithVectorsOnce<Dim>(const ExtractionTable<Dim>&);                 \
  template ExtractionTable<Dim> ExtractionOf<Dim>(const SplineSpace<Dim>&);                        \
  template bool AreLocallyIndependent<Dim>(const ExtractionTable<Dim>&, int);
KNOTWORK_INSTANTIATE(1)
KNOTWORK_INSTANTIATE(2)
KNOTWORK_INSTANTIATE(3)
#undef KNOTWORK_INSTANTIATE
}
