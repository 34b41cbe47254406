// SPDX-License-Identifier: BSD-3-Clause
#include "BernsteinCells.h"
#include "Bernstein.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

namespace knotwork
{
namespace
{
constexpr int TriangleSize(int p)
{
  return (p + 1) * (p + 2) / 2;
}
constexpr int TetrahedronSize(int p)
{
  return (p + 1) * (p + 2) * (p + 3) / 6;
}
/// Entries (i, j) of a triangle of degree p in the rows before j.
constexpr int RowsBefore(int p, int j)
{
  return j * (p + 1) - j * (j - 1) / 2;
}

bool IsDegree(CellShape shape, const CellDegree& degree)
{
  const int n = NumParameters(shape);
  for (int d = 0; d < 3; ++d)
  {
    const int p = degree[static_cast<std::size_t>(d)];
    if (d < n ? p < 1 || p > MaxDegree : p != 0)
    {
      return false;
    }
  }
  switch (shape)
  {
    case CellShape::Triangle:
    case CellShape::Wedge:
      return degree[0] == degree[1];
    case CellShape::Tetrahedron:
      return degree[0] == degree[1] && degree[0] == degree[2];
    default:
      return true;
  }
}
}

int NumParameters(CellShape shape)
{
  constexpr int numbers[NumCellShapes] = { 1, 2, 3, 2, 3, 3 };
  return numbers[static_cast<int>(shape)];
}

int NumCorners(CellShape shape)
{
  constexpr int numbers[NumCellShapes] = { 2, 4, 8, 3, 4, 6 };
  return numbers[static_cast<int>(shape)];
}

std::array<double, 3> CornerParameters(CellShape shape, int corner)
{
  std::array<double, 3> u{};
  switch (shape)
  {
    case CellShape::Triangle:
    case CellShape::Tetrahedron:
      if (corner > 0)
      {
        u[static_cast<std::size_t>(corner - 1)] = 1.0;
      }
      break;
    case CellShape::Wedge:
      if (corner % 3 > 0)
      {
        u[static_cast<std::size_t>(corner % 3 - 1)] = 1.0;
      }
      u[2] = corner / 3;
      break;
    default:
      for (int d = 0; d < NumParameters(shape); ++d)
      {
        u[static_cast<std::size_t>(d)] = (corner >> d) & 1;
      }
  }
  return u;
}

int NumCellCoefficients(CellShape shape, const CellDegree& degree)
{
  switch (shape)
  {
    case CellShape::Triangle:
      return TriangleSize(degree[0]);
    case CellShape::Tetrahedron:
      return TetrahedronSize(degree[0]);
    case CellShape::Wedge:
      return TriangleSize(degree[0]) * (degree[2] + 1);
    default:
      return NumTensorFunctions<3>(degree);
  }
}

int CellCoefficient(CellShape shape, const CellDegree& degree, int i, int j, int k)
{
  const int p = degree[0];
  switch (shape)
  {
    case CellShape::Triangle:
      return RowsBefore(p, j) + i;
    case CellShape::Tetrahedron:
      // the layers below k, then rows of a triangle of degree p - k
      return TetrahedronSize(p) - TetrahedronSize(p - k) + RowsBefore(p - k, j) + i;
    case CellShape::Wedge:
      return TriangleSize(p) * k + RowsBefore(p, j) + i;
    default:
      return i + (p + 1) * (j + (degree[1] + 1) * k);
  }
}

int BernsteinCells::Add(CellShape shape, const CellDegree& degree)
{
  this->Shapes.push_back(shape);
  this->Degrees.push_back(degree);
  this->Data.resize(this->Data.size() +
    static_cast<std::size_t>(NumCellCoefficients(shape, degree) * this->NumPlanes()));
  this->Offsets.push_back(this->Data.size());
  return this->NumCells() - 1;
}

double BernsteinCells::Uncertainty(int cell) const
{
  const std::size_t c = static_cast<std::size_t>(cell);
  double rest = this->Errors.empty() ? 0.0 : this->Errors[c];
  if (rest > 0.0 && !this->Remainders.empty())
  {
    double largest = 0.0;
    for (std::size_t i = this->Offsets[c]; i < this->Offsets[c + 1]; ++i)
    {
      largest = std::max(largest, std::abs(this->Remainders[i]));
    }
    rest = std::max(0.0, rest - largest);
  }
  return rest;
}

Status BernsteinCells::CheckStructure() const
{
  const std::size_t n = this->Shapes.size();
  if (this->Degrees.size() != n || this->Offsets.size() != n + 1 || this->Offsets.front() != 0 ||
    this->Offsets.back() != this->Data.size() ||
    (!this->Errors.empty() && this->Errors.size() != n) ||
    (!this->Remainders.empty() && this->Remainders.size() != this->Data.size()))
  {
    return { ErrorCode::SizeMismatch,
      "shapes, degrees, offsets, data, errors and remainders do not fit" };
  }
  std::size_t size = 0;
  for (std::size_t c = 0; c < n; ++c)
  {
    if (c == 0 || !this->AreAlike(c, c - 1))
    {
      if (static_cast<int>(this->Shapes[c]) >= NumCellShapes ||
        !IsDegree(this->Shapes[c], this->Degrees[c]))
      {
        return { ErrorCode::InvalidDegree,
          "cell " + std::to_string(c) + ": degrees must fit the shape and lie in [1, 9]" };
      }
      size = static_cast<std::size_t>(
        NumCellCoefficients(this->Shapes[c], this->Degrees[c]) * this->NumPlanes());
    }
    if (this->Offsets[c] + size != this->Offsets[c + 1])
    {
      return { ErrorCode::SizeMismatch, "cell " + std::to_string(c) + ": block of a wrong size" };
    }
  }
  return {};
}

Status BernsteinCells::Check() const
{
  if (const Status status = this->CheckStructure(); !status)
  {
    return status;
  }
  for (int c = 0; c < this->NumCells(); ++c)
  {
    const std::size_t at = static_cast<std::size_t>(c);
    const std::string name = "cell " + std::to_string(c);
    const int size = NumCellCoefficients(this->Shapes[at], this->Degrees[at]);
    const double* block = this->Block(c);
    for (int i = 0; i < size * this->NumPlanes(); ++i)
    {
      if (!std::isfinite(block[i]))
      {
        return { ErrorCode::NonFiniteInput, name + ": a coefficient is not finite" };
      }
      if (this->Rational && i >= size * this->NumComponents && !(block[i] > 0.0))
      {
        return { ErrorCode::InvalidWeight, name + ": a Bernstein weight is not positive" };
      }
    }
    if (!this->Errors.empty() && !(this->Errors[at] >= 0.0 && std::isfinite(this->Errors[at])))
    {
      return { ErrorCode::NonFiniteInput, name + ": its error is negative or not finite" };
    }
  }
  return {};
}

namespace
{
/// Bernstein polynomials of a simplex of 1 to 3 parameters, in the order of BernsteinCells.
std::vector<double> SimplexValues(int parameters, int p, const double* t)
{
  double rest = 1.0;
  for (int d = 0; d < parameters; ++d)
  {
    rest -= t[d];
  }
  std::vector<double> values;
  for (int k = 0; k <= (parameters > 2 ? p : 0); ++k)
  {
    for (int j = 0; j <= (parameters > 1 ? p - k : 0); ++j)
    {
      for (int i = 0; i <= p - j - k; ++i)
      {
        double value = Binomial(p, k) * Binomial(p - k, j) * Binomial(p - k - j, i) *
          std::pow(t[0], i) * std::pow(rest, p - i - j - k);
        value *= parameters > 1 ? std::pow(t[1], j) : 1.0;
        value *= parameters > 2 ? std::pow(t[2], k) : 1.0;
        values.push_back(value);
      }
    }
  }
  return values;
}

/// Products of the values of the factors, the first fastest.
std::vector<double> Products(const std::vector<std::vector<double>>& factors)
{
  std::vector<double> all{ 1.0 };
  for (const std::vector<double>& factor : factors)
  {
    std::vector<double> next;
    for (const double b : factor)
    {
      for (const double a : all)
      {
        next.push_back(a * b);
      }
    }
    all = std::move(next);
  }
  return all;
}
}

void EvaluateCell(
  const BernsteinCells& cells, int cell, const std::array<double, 3>& parameters, double* point)
{
  const CellShape shape = cells.Shapes[static_cast<std::size_t>(cell)];
  const CellDegree& degree = cells.Degrees[static_cast<std::size_t>(cell)];
  const double* t = parameters.data();
  std::vector<std::vector<double>> factors;
  switch (shape)
  {
    case CellShape::Triangle:
      factors.push_back(SimplexValues(2, degree[0], t));
      break;
    case CellShape::Tetrahedron:
      factors.push_back(SimplexValues(3, degree[0], t));
      break;
    case CellShape::Wedge:
      factors.push_back(SimplexValues(2, degree[0], t));
      factors.push_back(SimplexValues(1, degree[2], t + 2));
      break;
    default:
      for (int d = 0; d < NumParameters(shape); ++d)
      {
        factors.push_back(SimplexValues(1, degree[static_cast<std::size_t>(d)], t + d));
      }
  }
  const std::vector<double> values = Products(factors);
  const double* block = cells.Block(cell);
  double weight = 1.0;
  for (int c = cells.NumPlanes() - 1; c >= 0; --c)
  {
    const double sum = std::inner_product(
      values.begin(), values.end(), block + static_cast<std::size_t>(c) * values.size(), 0.0);
    if (c == cells.NumComponents)
    {
      weight = sum;
    }
    else
    {
      point[c] = sum / weight;
    }
  }
}

template <int Dim>
BernsteinCells MakeBernsteinCells(const BezierForm<Dim>& form)
{
  constexpr CellShape shape = Dim == 1 ? CellShape::Curve
    : Dim == 2                         ? CellShape::Quadrilateral
                                       : CellShape::Hexahedron;
  const std::size_t n = form.Space->Elements.size();
  BernsteinCells cells;
  cells.NumComponents = form.NumComponents;
  cells.Rational = form.Rational;
  cells.Shapes.assign(n, shape);
  cells.Degrees.assign(n, CellDegree{});
  for (std::size_t e = 0; e < n; ++e)
  {
    const auto& degree = form.Space->Elements[e].Degree;
    std::copy(degree.begin(), degree.end(), cells.Degrees[e].begin());
  }
  cells.Offsets = form.Offsets;
  cells.Data = form.Data;
  return cells;
}

template BernsteinCells MakeBernsteinCells<1>(const BezierForm<1>&);
template BernsteinCells MakeBernsteinCells<2>(const BezierForm<2>&);
template BernsteinCells MakeBernsteinCells<3>(const BezierForm<3>&);
}
