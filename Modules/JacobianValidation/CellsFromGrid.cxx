// SPDX-License-Identifier: BSD-3-Clause
#include "CellsFromGrid.h"

#include "CellConversion.h"
#include <knotwork/SplineGrid/BezierCells.h>

#include "vtkCellType.h"
#include "vtkCellTypes.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <tuple>

namespace knotwork
{
namespace
{
/// What rounding left out of sums a + b, exactly.
PointMatrix RestsOfSums(const PointMatrix& a, const PointMatrix& b, const PointMatrix& sums)
{
  const PointMatrix parts = sums - a; // of b
  return (a - (sums - parts)) + (b - parts);
}

class Reader
{
public:
  Reader(vtkUnstructuredGrid* grid, GridCells& result) : Result(result), Grid(grid), Bezier(grid) {}

  Status Read()
  {
    for (vtkIdType cell = 0; cell < this->Grid->GetNumberOfCells(); ++cell)
    {
      if (Status status = this->ReadCell(cell); !status)
      {
        return status;
      }
    }
    return {};
  }

private:
  Status ReadCell(vtkIdType cell)
  {
    const int type = this->Grid->GetCellType(cell);
    switch (BezierCellDimension(type))
    {
      case 1:
        return this->ReadBezier<1>(cell, CellShape::Curve);
      case 2:
        return this->ReadBezier<2>(cell, CellShape::Quadrilateral);
      case 3:
        return this->ReadBezier<3>(cell, CellShape::Hexahedron);
      default:
        return this->Convert(cell, type);
    }
  }

  template <int Dim>
  Status ReadBezier(vtkIdType cell, CellShape shape)
  {
    IntArray<Dim> degree{};
    if (Status status = this->Bezier.Read<Dim>("", cell, nullptr, degree, this->Ids); !status)
    {
      return status;
    }
    CellDegree all{};
    std::copy(degree.begin(), degree.end(), all.begin());
    return this->Add(cell, shape, all, this->Ids);
  }

  /// Adds a cell whose coefficients are points of the grid.
  Status Add(
    vtkIdType cell, CellShape shape, const CellDegree& degree, const std::vector<vtkIdType>& points)
  {
    const auto n = points.size();
    double* block = this->NewBlock(shape, degree, 0.0);
    for (std::size_t k = 0; k < n; ++k)
    {
      double x[4];
      if (Status status = this->Bezier.ReadPoint("", cell, points[k], x); !status)
      {
        return status;
      }
      this->Set(block, n, k, x);
    }
    this->Result.Points.insert(this->Result.Points.end(), points.begin(), points.end());
    this->Result.Cells.Errors.back() = this->Rounding;
    return {};
  }

  double* NewBlock(CellShape shape, const CellDegree& degree, double error)
  {
    BernsteinCells& cells = this->Result.Cells;
    this->Result.FirstPoint.push_back(this->Result.Points.size());
    cells.Errors.push_back(error);
    this->Rounding = 0.0;
    return cells.Block(cells.Add(shape, degree));
  }

  void SetRemainder(const double* value, double rest)
  {
    BernsteinCells& cells = this->Result.Cells;
    if (rest != 0.0)
    {
      cells.Remainders.resize(cells.Data.size());
      cells.Remainders[static_cast<std::size_t>(value - cells.Data.data())] = rest;
    }
  }

  /// Homogeneous coefficients are products that need not be doubles: what each is off by is its
  /// remainder, and Rounding grows to the largest.
  void Set(double* block, std::size_t n, std::size_t k, const double* x)
  {
    const bool rational = this->Result.Cells.Rational;
    for (std::size_t c = 0; c < 3; ++c)
    {
      double& value = block[c * n + k];
      value = rational ? x[3] * x[c] : x[c];
      if (rational)
      {
        const double rest = std::fma(x[3], x[c], -value);
        this->SetRemainder(&value, rest);
        this->Rounding = std::max(this->Rounding, std::abs(rest));
        // near the smallest doubles the remainder is rounded too, so it is not all
        const bool exact = x[c] == 0.0 || std::abs(value) >= 0x1p-900;
        this->Rounding = exact ? this->Rounding : 2.0 * this->Rounding + 0x1p-1000;
      }
    }
    if (rational)
    {
      block[3 * n + k] = x[3];
    }
  }

  Status Convert(vtkIdType cell, int type)
  {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    this->Grid->GetCellPoints(cell, count, ids);
    CellShape shape{};
    CellDegree degree{};
    if (Status status = this->ShapeOf(cell, type, count, shape, degree); !status)
    {
      return status;
    }
    auto [entry, isNew] =
      this->Conversions.try_emplace(std::make_tuple(type, count, degree), CellConversion());
    CellConversion& conversion = entry->second;
    if (isNew)
    {
      auto made = MakeCellConversion(type, shape, degree, count);
      if (!made)
      {
        return { made.Status.Code, CellName(cell) + ": " + made.Status.Detail };
      }
      conversion = std::move(made.Value);
    }
    if (!conversion.Points.empty())
    {
      this->Ids.resize(conversion.Points.size());
      for (std::size_t k = 0; k < this->Ids.size(); ++k)
      {
        this->Ids[k] = ids[conversion.Points[k]];
      }
      return this->Add(cell, shape, degree, this->Ids);
    }
    PointMatrix points(count, 3);
    for (vtkIdType i = 0; i < count; ++i)
    {
      double x[4];
      if (Status status = this->Bezier.ReadPoint("", cell, ids[i], x); !status)
      {
        return status;
      }
      points.row(i) << x[0], x[1], x[2];
    }
    // Shape functions sum to one: what is converted is the offsets from the first point, so that
    // rounding is of the cell's size and not of its distance from the origin.
    const PointMatrix origin = points.row(0).replicate(count, 1);
    const PointMatrix offsets = points - origin;
    const PointMatrix rests = RestsOfSums(points, -origin, offsets);
    const LongMatrix converted =
      conversion.Matrix * (offsets.cast<long double>() + rests.cast<long double>());
    const PointMatrix most = converted.cast<double>();
    const PointMatrix least = (converted - most.cast<long double>()).cast<double>();
    const auto n = static_cast<std::size_t>(converted.rows());
    const PointMatrix start = origin.row(0).replicate(converted.rows(), 1);
    const PointMatrix sums = start + most;
    const PointMatrix rest = RestsOfSums(start, most, sums);
    const PointMatrix remainders = rest + least;
    // of remainders one rounding; one of offsets is what the bound has for products and sums
    const double bound = (conversion.Bound * offsets.cwiseAbs()).maxCoeff() +
      0x1p-53 * (rest.cwiseAbs() + least.cwiseAbs()).maxCoeff();
    const double largest = remainders.cwiseAbs().maxCoeff();
    double error = largest + bound;
    while (error - largest < bound)
    {
      error = std::nextafter(error, std::numeric_limits<double>::infinity());
    }
    double* block = this->NewBlock(shape, degree, error);
    for (std::size_t k = 0; k < n; ++k)
    {
      const auto row = static_cast<Eigen::Index>(k);
      const double x[4] = { sums(row, 0), sums(row, 1), sums(row, 2), 1.0 };
      this->Set(block, n, k, x); // weight 1: the products are exact
      for (Eigen::Index c = 0; c < 3; ++c)
      {
        this->SetRemainder(block + static_cast<std::size_t>(c) * n + k, remainders(row, c));
      }
    }
    this->Result.Points.insert(this->Result.Points.end(), n, -1);
    return {};
  }

  /// @return InvalidTopology, InvalidDegree.
  Status ShapeOf(
    vtkIdType cell, int type, vtkIdType count, CellShape& shape, CellDegree& degree) const
  {
    const CellConversion fixed = FixedCellShape(type);
    shape = fixed.Shape;
    degree = fixed.Degree;
    if (degree[0] > 0)
    {
      return {};
    }
    const auto simplex = [&](CellShape kind, int parameters)
    {
      shape = kind;
      for (int p = 1; p <= MaxDegree; ++p)
      {
        CellDegree candidate{};
        std::fill_n(candidate.begin(), parameters, p);
        if (NumCellCoefficients(kind, candidate) == count)
        {
          degree = candidate;
        }
      }
    };
    std::vector<vtkIdType> order;
    switch (type)
    {
      case VTK_LAGRANGE_CURVE:
      {
        IntArray<1> p{};
        const Status status = this->Bezier.Read<1>("", cell, nullptr, p, order);
        shape = CellShape::Curve;
        degree = { p[0], 0, 0 };
        return status;
      }
      case VTK_LAGRANGE_QUADRILATERAL:
      {
        IntArray<2> p{};
        const Status status = this->Bezier.Read<2>("", cell, nullptr, p, order);
        shape = CellShape::Quadrilateral;
        degree = { p[0], p[1], 0 };
        return status;
      }
      case VTK_LAGRANGE_HEXAHEDRON:
      {
        const Status status = this->Bezier.Read<3>("", cell, nullptr, degree, order);
        shape = CellShape::Hexahedron;
        return status;
      }
      case VTK_LAGRANGE_TRIANGLE:
      case VTK_BEZIER_TRIANGLE:
        simplex(CellShape::Triangle, 2);
        break;
      case VTK_LAGRANGE_TETRAHEDRON:
      case VTK_BEZIER_TETRAHEDRON:
        simplex(CellShape::Tetrahedron, 3);
        break;
      case VTK_LAGRANGE_WEDGE:
      case VTK_BEZIER_WEDGE:
        shape = CellShape::Wedge;
        for (const CellDegree& candidate : this->Bezier.DegreesOf(cell))
        {
          if (candidate[0] == candidate[1] && NumCellCoefficients(shape, candidate) == count)
          {
            degree = candidate;
            break;
          }
        }
        if (degree[0] == 0)
        {
          simplex(CellShape::Wedge, 3);
        }
        break;
      default:
      {
        const char* name = vtkCellTypes::GetClassNameFromTypeId(type);
        return { ErrorCode::InvalidTopology,
          CellName(cell) + " is a " + (name ? name : "cell") + " (type " + std::to_string(type) +
            "), which has no Bernstein form: split such cells into triangles or tetrahedra" };
      }
    }
    if (degree[0] == 0)
    {
      return { ErrorCode::InvalidDegree,
        CellName(cell) + ": no degree in [1, " + std::to_string(MaxDegree) + "] has " +
          std::to_string(count) + " points" };
    }
    return {};
  }

  GridCells& Result;
  vtkUnstructuredGrid* Grid;
  BezierCells Bezier;
  std::map<std::tuple<int, vtkIdType, CellDegree>, CellConversion> Conversions;
  std::vector<vtkIdType> Ids;
  double Rounding = 0.0; ///< of the homogeneous coefficients of the cell being read
};
}

Result<GridCells> ReadGridCells(const std::vector<vtkUnstructuredGrid*>& grids)
{
  GridCells result;
  result.Cells.NumComponents = 3;
  result.Cells.Rational = std::any_of(grids.begin(), grids.end(),
    [](vtkUnstructuredGrid* grid) { return BezierCells(grid).IsRational(); });
  for (std::size_t g = 0; g < grids.size(); ++g)
  {
    if (Status status = Reader(grids[g], result).Read(); !status)
    {
      const std::string where = grids.size() > 1 ? "grid " + std::to_string(g) + ", " : "";
      return { status.Code, where + status.Detail };
    }
  }
  if (!result.Cells.Remainders.empty())
  {
    result.Cells.Remainders.resize(result.Cells.Data.size());
  }
  std::vector<double>& errors = result.Cells.Errors;
  if (std::all_of(errors.begin(), errors.end(), [](double e) { return e == 0.0; }))
  {
    errors.clear();
  }
  return result;
}
}
