// SPDX-License-Identifier: BSD-3-Clause
#include "ElementData.h"

#include <knotwork/SplineGrid/HigherOrderCells.h>
#include <knotwork/SplineGrid/InputChecks.h>
#include <knotwork/SplineGrid/NamedArray.h>
#include <knotwork/SplineGrid/SplineModel.h>

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkCellTypes.h"
#include "vtkDoubleArray.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <limits>
#include <map>

namespace knotwork
{
namespace
{
enum class CellKind
{
  Element, ///< of a surface or volume
  Lower,   ///< a point or line
  Other    ///< none that is curved
};

struct CellClass
{
  CellKind Kind;
  CellShape Shape;
};

/// Corners come first in all of VTK's cells.
CellClass ClassOf(int type, vtkIdType numPoints)
{
  switch (type)
  {
    case VTK_TRIANGLE:
    case VTK_QUADRATIC_TRIANGLE:
    case VTK_BIQUADRATIC_TRIANGLE:
    case VTK_LAGRANGE_TRIANGLE:
    case VTK_BEZIER_TRIANGLE:
      return { CellKind::Element, CellShape::Triangle };
    case VTK_QUAD:
    case VTK_PIXEL:
    case VTK_QUADRATIC_QUAD:
    case VTK_QUADRATIC_LINEAR_QUAD:
    case VTK_BIQUADRATIC_QUAD:
    case VTK_LAGRANGE_QUADRILATERAL:
    case VTK_BEZIER_QUADRILATERAL:
      return { CellKind::Element, CellShape::Quadrilateral };
    case VTK_TETRA:
    case VTK_QUADRATIC_TETRA:
    case VTK_LAGRANGE_TETRAHEDRON:
    case VTK_BEZIER_TETRAHEDRON:
      return { CellKind::Element, CellShape::Tetrahedron };
    case VTK_WEDGE:
    case VTK_QUADRATIC_WEDGE:
    case VTK_QUADRATIC_LINEAR_WEDGE:
    case VTK_BIQUADRATIC_QUADRATIC_WEDGE:
    case VTK_LAGRANGE_WEDGE:
    case VTK_BEZIER_WEDGE:
      return { CellKind::Element, CellShape::Wedge };
    case VTK_HEXAHEDRON:
    case VTK_VOXEL:
    case VTK_QUADRATIC_HEXAHEDRON:
    case VTK_BIQUADRATIC_QUADRATIC_HEXAHEDRON:
    case VTK_TRIQUADRATIC_HEXAHEDRON:
    case VTK_LAGRANGE_HEXAHEDRON:
    case VTK_BEZIER_HEXAHEDRON:
      return { CellKind::Element, CellShape::Hexahedron };
    case VTK_POLYGON:
      if (numPoints == 3 || numPoints == 4)
      {
        return { CellKind::Element,
          numPoints == 3 ? CellShape::Triangle : CellShape::Quadrilateral };
      }
      return { CellKind::Other, CellShape::Curve };
    case VTK_EMPTY_CELL:
    case VTK_VERTEX:
    case VTK_POLY_VERTEX:
    case VTK_LINE:
    case VTK_POLY_LINE:
    case VTK_QUADRATIC_EDGE:
    case VTK_CUBIC_LINE:
    case VTK_LAGRANGE_CURVE:
    case VTK_BEZIER_CURVE:
      return { CellKind::Lower, CellShape::Curve };
    default:
      return { CellKind::Other, CellShape::Curve };
  }
}

/// From VTK's order to that of CornerParameters.
void OrderCorners(int type, CellShape shape, std::vector<int>& corners)
{
  if (type == VTK_PIXEL || type == VTK_VOXEL)
  {
    return;
  }
  if (shape == CellShape::Quadrilateral || shape == CellShape::Hexahedron)
  {
    std::swap(corners[2], corners[3]);
  }
  if (shape == CellShape::Hexahedron)
  {
    std::swap(corners[6], corners[7]);
  }
}

/// Points that are corners, numbered in their order.
void TakeCorners(vtkPointSet* data, StraightElements& elements)
{
  std::vector<int> numbers(static_cast<std::size_t>(data->GetNumberOfPoints()), -1);
  for (const int corner : elements.Corners)
  {
    numbers[static_cast<std::size_t>(corner)] = 0;
  }
  int count = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i)
  {
    if (numbers[i] >= 0)
    {
      numbers[i] = count++;
      elements.PointNumbers.push_back(static_cast<int>(i));
    }
  }
  elements.Points.resize(count, 3);
  for (std::size_t i = 0; i < numbers.size(); ++i)
  {
    if (numbers[i] >= 0)
    {
      data->GetPoint(static_cast<vtkIdType>(i), elements.Points.row(numbers[i]).data());
    }
  }
  for (int& corner : elements.Corners)
  {
    corner = numbers[static_cast<std::size_t>(corner)];
  }
}
}

Result<DecodedElements> DecodeStraightElements(vtkPointSet* data)
{
  const vtkIdType count = data ? data->GetNumberOfCells() : 0;
  // of order 4 a hexahedron has 125 points
  if (count > std::numeric_limits<int>::max() / 125 ||
    (data && data->GetNumberOfPoints() > std::numeric_limits<int>::max()))
  {
    return { ErrorCode::TooLarge, std::to_string(count) + " cells; give the mesh in parts" };
  }
  if (Status status = CheckCellSizes(data); data && !status)
  {
    return status;
  }
  int dimension = 0;
  vtkNew<vtkIdList> ids;
  for (vtkIdType cell = 0; cell < count; ++cell)
  {
    const int type = data->GetCellType(cell);
    data->GetCellPoints(cell, ids);
    const CellClass of = ClassOf(type, ids->GetNumberOfIds());
    if (of.Kind == CellKind::Other)
    {
      const char* name = vtkCellTypes::GetClassNameFromTypeId(type);
      return { ErrorCode::InvalidTopology,
        "cell " + std::to_string(cell) + " is a " + (name ? name : "cell") + " of " +
          std::to_string(ids->GetNumberOfIds()) +
          " points: triangles, quadrilaterals, tetrahedra, wedges and hexahedra are curved; "
          "divide or remove it" };
    }
    dimension =
      of.Kind == CellKind::Element ? std::max(dimension, NumParameters(of.Shape)) : dimension;
  }
  if (dimension == 0)
  {
    return { ErrorCode::EmptyInput,
      "the mesh has no triangles, quadrilaterals, tetrahedra, wedges or hexahedra to curve" };
  }
  Result<DecodedElements> decoded;
  for (vtkIdType cell = 0; cell < count; ++cell)
  {
    const int type = data->GetCellType(cell);
    data->GetCellPoints(cell, ids);
    const CellClass of = ClassOf(type, ids->GetNumberOfIds());
    if (of.Kind != CellKind::Element || NumParameters(of.Shape) < dimension)
    {
      ++decoded->NumLeftOut;
      continue;
    }
    if (ids->GetNumberOfIds() < NumCorners(of.Shape))
    {
      return { ErrorCode::InvalidTopology,
        "cell " + std::to_string(cell) + " has fewer points than corners; remove it" };
    }
    std::vector<int> corners(ids->begin(), ids->begin() + NumCorners(of.Shape));
    OrderCorners(type, of.Shape, corners);
    decoded->Elements.Add(of.Shape, corners);
    decoded->Elements.ElementNumbers.push_back(static_cast<int>(cell));
    decoded->Cells.push_back(cell);
  }
  TakeCorners(data, decoded->Elements);
  return decoded;
}

Result<std::vector<int>> DecodeRegions(
  vtkPointSet* data, const DecodedElements& decoded, const std::string& array)
{
  std::vector<int> regions;
  if (array.empty() || array == "None")
  {
    return regions;
  }
  vtkDataArray* const values = data->GetCellData()->GetArray(array.c_str());
  if (!values || values->GetNumberOfComponents() != 1)
  {
    return { ErrorCode::InvalidParameter,
      "the mesh has no cell array '" + array + "' of one number a cell" };
  }
  std::map<double, int> numbers;
  for (const vtkIdType cell : decoded.Cells)
  {
    regions.push_back(
      numbers.emplace(values->GetTuple1(cell), static_cast<int>(numbers.size())).first->second);
  }
  return regions;
}

void EncodeCurvedElements(
  const CurvedElements& elements, int order, bool isBezier, vtkUnstructuredGrid* grid)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(elements.Points.rows());
  for (Eigen::Index i = 0; i < elements.Points.rows(); ++i)
  {
    points->SetPoint(i, elements.Points.row(i).data());
  }
  grid->SetPoints(points);
  std::map<CellShape, std::vector<int>> orders;
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkUnsignedCharArray> types;
  std::vector<vtkIdType> ids;
  for (std::size_t e = 0; e < elements.Shapes.size(); ++e)
  {
    const CellShape shape = elements.Shapes[e];
    std::vector<int>& ofShape = orders[shape];
    ofShape = ofShape.empty() ? HigherOrderPointOrder(shape, order) : std::move(ofShape);
    ids.clear();
    for (const int coefficient : ofShape)
    {
      ids.push_back(elements.Nodes[elements.Begin[e] + static_cast<std::size_t>(coefficient)]);
    }
    cells->InsertNextCell(static_cast<vtkIdType>(ids.size()), ids.data());
    types->InsertNextValue(static_cast<unsigned char>(HigherOrderCellType(shape, isBezier)));
  }
  grid->SetCells(types, cells);
  if (isBezier)
  {
    const auto degrees = NamedArray<vtkDoubleArray>(
      "HigherOrderDegrees", 3, static_cast<vtkIdType>(elements.Shapes.size()));
    for (int c = 0; c < 3; ++c)
    {
      degrees->FillComponent(c, order);
    }
    grid->GetCellData()->SetHigherOrderDegrees(degrees);
  }
}
}
