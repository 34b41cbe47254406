// SPDX-License-Identifier: BSD-3-Clause
#include "MfemGrid.h"

#include <knotwork/SplineGrid/HigherOrderCells.h>
#include <knotwork/SplineGrid/MeshVertices.h>
#include <knotwork/SplineGrid/NamedArray.h>
#include <knotwork/SplineGrid/SplineModel.h>

#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDoubleArray.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <map>

namespace knotwork
{
namespace
{
constexpr const char* AttributeArray = "Attribute";

struct CellKind
{
  unsigned char Linear;
  unsigned char Bezier;
  int Dimension;
  int NumCorners;
};

CellKind KindOf(MfemShape shape)
{
  switch (shape)
  {
    case MfemShape::Point:
      break; // no cell of a mesh
    case MfemShape::Segment:
      return { VTK_LINE, VTK_BEZIER_CURVE, 1, 2 };
    case MfemShape::Triangle:
      return { VTK_TRIANGLE, VTK_BEZIER_TRIANGLE, 2, 3 };
    case MfemShape::Quadrilateral:
      return { VTK_QUAD, VTK_BEZIER_QUADRILATERAL, 2, 4 };
    case MfemShape::Tetrahedron:
      return { VTK_TETRA, VTK_BEZIER_TETRAHEDRON, 3, 4 };
    case MfemShape::Hexahedron:
      return { VTK_HEXAHEDRON, VTK_BEZIER_HEXAHEDRON, 3, 8 };
    case MfemShape::Wedge:
      return { VTK_WEDGE, VTK_BEZIER_WEDGE, 3, 6 };
    case MfemShape::Pyramid:
      return { VTK_PYRAMID, VTK_EMPTY_CELL, 3, 5 };
  }
  return { VTK_VERTEX, VTK_EMPTY_CELL, 0, 1 };
}

/// Number of the coefficient, first direction fastest, of every point of VTK's cell.
std::vector<int> PointOrder(MfemShape shape, int p)
{
  switch (shape)
  {
    case MfemShape::Segment:
      return HigherOrderPointOrder(CellShape::Curve, p);
    case MfemShape::Triangle:
      return HigherOrderPointOrder(CellShape::Triangle, p);
    case MfemShape::Quadrilateral:
      return HigherOrderPointOrder(CellShape::Quadrilateral, p);
    case MfemShape::Tetrahedron:
      return HigherOrderPointOrder(CellShape::Tetrahedron, p);
    case MfemShape::Hexahedron:
      return HigherOrderPointOrder(CellShape::Hexahedron, p);
    case MfemShape::Wedge:
      return HigherOrderPointOrder(CellShape::Wedge, p);
    default:
      return {};
  }
}
}

void EncodeMfemCells(const MfemMesh& mesh, vtkUnstructuredGrid* grid)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(mesh.Points.rows());
  for (Eigen::Index row = 0; row < mesh.Points.rows(); ++row)
  {
    points->SetPoint(row, mesh.Points.row(row).data());
  }
  grid->SetPoints(points);
  const auto count = static_cast<vtkIdType>(mesh.Cells.size());
  grid->Allocate(count);
  const bool isBezier = mesh.Degree > 0;
  int most = 0;
  for (const MfemCell& cell : mesh.Cells)
  {
    most = std::max(most, KindOf(cell.Shape).NumCorners);
  }
  const auto attributes = NamedArray<vtkIntArray>(AttributeArray, 1, count);
  const auto vertices = NamedArray<vtkIntArray>(name::MeshVertices, most, count);
  const auto degrees = NamedArray<vtkDoubleArray>("HigherOrderDegrees", 3, count);
  std::map<MfemShape, std::vector<int>> orders;
  std::vector<vtkIdType> ids;
  for (vtkIdType c = 0; c < count; ++c)
  {
    const MfemCell& cell = mesh.Cells[static_cast<std::size_t>(c)];
    const CellKind kind = KindOf(cell.Shape);
    ids.clear();
    if (isBezier)
    {
      std::vector<int>& order = orders[cell.Shape];
      order = order.empty() ? PointOrder(cell.Shape, mesh.Degree) : std::move(order);
      const std::int64_t begin = mesh.CellBegin[static_cast<std::size_t>(c)];
      for (const int coefficient : order)
      {
        ids.push_back(mesh.CellPoints[static_cast<std::size_t>(begin + coefficient)]);
      }
    }
    else
    {
      ids.assign(cell.Corners.begin(), cell.Corners.begin() + kind.NumCorners);
    }
    grid->InsertNextCell(
      isBezier ? kind.Bezier : kind.Linear, static_cast<vtkIdType>(ids.size()), ids.data());
    attributes->SetValue(c, cell.Attribute);
    for (int k = 0; k < most; ++k)
    {
      vertices->SetTypedComponent(c, k, cell.Corners[static_cast<std::size_t>(k)]);
    }
    for (int d = 0; d < 3; ++d)
    {
      degrees->SetTypedComponent(c, d, d < kind.Dimension ? mesh.Degree : 0);
    }
  }
  grid->GetCellData()->AddArray(attributes);
  if (isBezier)
  {
    grid->GetCellData()->AddArray(vertices);
    grid->GetCellData()->SetHigherOrderDegrees(degrees);
  }
}

void AddPatchAttributes(const MfemMesh& mesh, vtkUnstructuredGrid* grid)
{
  auto* patches = vtkIntArray::SafeDownCast(grid->GetCellData()->GetArray("PatchId"));
  const vtkIdType count = patches ? grid->GetNumberOfCells() : 0;
  const auto attributes = NamedArray<vtkIntArray>(AttributeArray, 1, count);
  for (vtkIdType c = 0; c < count; ++c)
  {
    attributes->SetValue(c, mesh.Cells[static_cast<std::size_t>(patches->GetValue(c))].Attribute);
  }
  grid->GetCellData()->AddArray(attributes);
}
}
