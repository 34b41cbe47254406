// SPDX-License-Identifier: BSD-3-Clause
#include "BezierCells.h"

#include "SplineSchema.h"
#include <knotwork/SplineCore/Numbers.h>

#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDataArray.h"
#include "vtkPointData.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace knotwork
{
std::string CellName(vtkIdType cell)
{
  return "cell " + std::to_string(cell);
}

int BezierCellDimension(int cellType)
{
  switch (cellType)
  {
    case VTK_BEZIER_CURVE:
      return 1;
    case VTK_BEZIER_QUADRILATERAL:
      return 2;
    case VTK_BEZIER_HEXAHEDRON:
      return 3;
    default:
      return 0;
  }
}

BezierCells::BezierCells(vtkUnstructuredGrid* grid) : Grid(grid)
{
  vtkCellData* cellData = grid->GetCellData();
  for (vtkDataArray* array : { cellData->GetHigherOrderDegrees(), cellData->GetArray(name::Degrees),
         cellData->GetArray(name::DegreesCopy) })
  {
    if (array && array->GetNumberOfTuples() == grid->GetNumberOfCells() &&
      std::find(this->Degrees.begin(), this->Degrees.end(), array) == this->Degrees.end())
    {
      this->Degrees.push_back(array);
    }
  }
  vtkPointData* pointData = grid->GetPointData();
  for (vtkDataArray* array : { pointData->GetRationalWeights(), pointData->GetArray(name::Weights),
         pointData->GetArray(name::WeightsCopy) })
  {
    if (array && array->GetNumberOfComponents() == 1 &&
      array->GetNumberOfTuples() == grid->GetNumberOfPoints())
    {
      this->Weights = array;
      break;
    }
  }
}

template <int Dim>
Status BezierCells::Read(const std::string& where, vtkIdType cell, const IntArray<Dim>* expected,
  IntArray<Dim>& degree, std::vector<vtkIdType>& points) const
{
  vtkIdType count = 0;
  const vtkIdType* ids = nullptr;
  this->Grid->GetCellPoints(cell, count, ids);
  if (Status status = this->ReadDegree<Dim>(where, cell, count, expected, degree); !status)
  {
    return status;
  }
  std::array<int, 3> key{};
  std::copy(degree.begin(), degree.end(), key.begin());
  std::vector<int>& order = this->Orders[key];
  if (order.empty())
  {
    order = VtkPointOrder<Dim>(degree);
  }
  points.resize(order.size());
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    points[static_cast<std::size_t>(order[i])] = ids[i];
  }
  return {};
}

Status BezierCells::ReadPoint(
  const std::string& where, vtkIdType cell, vtkIdType point, double* coordinates) const
{
  this->Grid->GetPoint(point, coordinates);
  coordinates[3] = this->Weights ? this->Weights->GetComponent(point, 0) : 1.0;
  const auto place = [&] { return where + CellName(cell) + ", point " + std::to_string(point); };
  if (!std::isfinite(coordinates[0]) || !std::isfinite(coordinates[1]) ||
    !std::isfinite(coordinates[2]))
  {
    return { ErrorCode::NonFiniteInput, place() + ": a coordinate is not a finite number" };
  }
  if (!(std::max({ std::abs(coordinates[0]), std::abs(coordinates[1]),
          std::abs(coordinates[2]) }) <= LargestNumber))
  {
    return { ErrorCode::TooLarge, place() + ": " + BeyondLimit() };
  }
  if (!(coordinates[3] >= 1.0 / LargestWeight && coordinates[3] <= LargestWeight))
  {
    return { ErrorCode::InvalidWeight,
      place() + ": the weight is " + Digits(coordinates[3]) + ", not in [" +
        Digits(1.0 / LargestWeight) + ", " + Digits(LargestWeight) + "]" };
  }
  return {};
}

bool BezierCells::IsRational() const
{
  for (vtkIdType i = 0; this->Weights && i < this->Weights->GetNumberOfTuples(); ++i)
  {
    if (this->Weights->GetComponent(i, 0) != 1.0)
    {
      return true;
    }
  }
  return false;
}

std::vector<std::array<int, 3>> BezierCells::DegreesOf(vtkIdType cell) const
{
  std::vector<std::array<int, 3>> all;
  for (vtkDataArray* array : this->Degrees)
  {
    std::array<int, 3> degree{};
    bool whole = true;
    for (int d = 0; d < std::min(3, array->GetNumberOfComponents()) && whole; ++d)
    {
      const double p = array->GetComponent(cell, d);
      whole = p >= 0 && p <= MaxDegree && p == std::floor(p);
      degree[static_cast<std::size_t>(d)] = whole ? static_cast<int>(p) : 0;
    }
    if (whole)
    {
      all.push_back(degree);
    }
  }
  return all;
}

template <int Dim>
Status BezierCells::ReadDegree(const std::string& where, vtkIdType cell, vtkIdType numPoints,
  const IntArray<Dim>* expected, IntArray<Dim>& degree) const
{
  for (vtkDataArray* array : this->Degrees)
  {
    if (array->GetNumberOfComponents() < Dim)
    {
      continue;
    }
    vtkIdType product = 1;
    bool whole = true;
    for (int d = 0; d < Dim && whole; ++d)
    {
      const double p = array->GetComponent(cell, d);
      whole = p >= 1 && p <= MaxDegree && p == std::floor(p);
      degree[static_cast<std::size_t>(d)] = whole ? static_cast<int>(p) : 0;
      product *= whole ? static_cast<vtkIdType>(p) + 1 : 0;
    }
    if (whole && product == numPoints && (!expected || degree == *expected))
    {
      return {};
    }
  }
  if (this->Degrees.empty()) // then VTK takes the same degree in all directions
  {
    const double root = std::round(std::pow(static_cast<double>(numPoints), 1.0 / Dim));
    degree.fill(static_cast<int>(root) - 1);
    if (degree[0] >= 1 && degree[0] <= MaxDegree && NumTensorFunctions<Dim>(degree) == numPoints &&
      (!expected || degree == *expected))
    {
      return {};
    }
  }
  std::ostringstream text;
  text << where << CellName(cell) << ": ";
  if (this->Degrees.empty())
  {
    text << "there is no array " << name::Degrees;
  }
  else
  {
    text << this->Degrees.front()->GetName() << " is (";
    for (int d = 0; d < std::min(Dim, this->Degrees.front()->GetNumberOfComponents()); ++d)
    {
      text << (d > 0 ? ", " : "") << this->Degrees.front()->GetComponent(cell, d);
    }
    text << ")";
  }
  text << "; needed are whole numbers in [1, " << MaxDegree << "] for a cell of " << numPoints
       << " points";
  if (expected)
  {
    text << " of a patch of degree (";
    for (int d = 0; d < Dim; ++d)
    {
      text << (d > 0 ? ", " : "") << (*expected)[static_cast<std::size_t>(d)];
    }
    text << ")";
  }
  return { ErrorCode::InvalidDegree, text.str() };
}

#define KNOTWORK_INSTANTIATE(Dim)                                                                  \
  template VTKKNOTWORKSPLINEGRID_EXPORT Status BezierCells::Read<Dim>(const std::string&,          \
    vtkIdType, const IntArray<Dim>*, IntArray<Dim>&, std::vector<vtkIdType>&) const
KNOTWORK_INSTANTIATE(1);
KNOTWORK_INSTANTIATE(2);
KNOTWORK_INSTANTIATE(3);
#undef KNOTWORK_INSTANTIATE
}
