// SPDX-License-Identifier: BSD-3-Clause
#include "SkeletonCells.h"

#include "vtkCellArray.h"
#include "vtkCellArrayIterator.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkCellTypes.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
bool IsCurve(SkeletonCellKind kind)
{
  return kind == SkeletonCellKind::Polyline || kind == SkeletonCellKind::BezierCurve;
}

bool IsBezierKind(SkeletonCellKind kind)
{
  return kind >= SkeletonCellKind::BezierCurve;
}

/// "polyline", "Bezier triangle", ...
std::string KindName(SkeletonCellKind kind)
{
  constexpr const char* names[] = { "polyline", "polygon", "triangle strip", "Bezier curve",
    "Bezier quadrilateral", "Bezier triangle" };
  return names[static_cast<int>(kind)];
}

/// @return false for a type that a skeleton cannot have.
bool KindOf(int type, SkeletonCellKind& kind)
{
  switch (type)
  {
    case VTK_LINE:
    case VTK_POLY_LINE:
      kind = SkeletonCellKind::Polyline;
      return true;
    case VTK_TRIANGLE:
    case VTK_QUAD:
    case VTK_PIXEL:
    case VTK_POLYGON:
      kind = SkeletonCellKind::Polygon;
      return true;
    case VTK_TRIANGLE_STRIP:
      kind = SkeletonCellKind::TriangleStrip;
      return true;
    case VTK_BEZIER_CURVE:
      kind = SkeletonCellKind::BezierCurve;
      return true;
    case VTK_BEZIER_QUADRILATERAL:
      kind = SkeletonCellKind::BezierQuadrilateral;
      return true;
    case VTK_BEZIER_TRIANGLE:
      kind = SkeletonCellKind::BezierTriangle;
      return true;
    default:
      return false;
  }
}

std::string CellOf(vtkIdType cell, const std::string& name)
{
  return "cell " + std::to_string(cell) + " of the " + name;
}
}

Result<SkeletonCells> SkeletonCells::Read(vtkDataSet* data, const std::string& name)
{
  SkeletonCells cells;
  if (Status status = cells.ReadCells(data, name); !status)
  {
    return status;
  }
  if (Status status = cells.CheckKinds(name); !status)
  {
    return status;
  }
  const vtkIdType numPoints = data->GetNumberOfPoints();
  for (vtkIdType cell = 0; cell < cells.Count(); ++cell)
  {
    const vtkIdType* points = cells.Points(cell);
    for (vtkIdType i = 0; i < cells.NumPoints(cell); ++i)
    {
      if (points[i] < 0 || points[i] >= numPoints)
      {
        return { ErrorCode::InvalidTopology,
          CellOf(cell, name) + " has the point id " + std::to_string(points[i]) + " of " +
            std::to_string(numPoints) };
      }
    }
  }
  return cells;
}

Status SkeletonCells::ReadCells(vtkDataSet* data, const std::string& name)
{
  if (auto* polygons = vtkPolyData::SafeDownCast(data))
  {
    if (polygons->GetNumberOfVerts() > 0)
    {
      return { ErrorCode::InvalidTopology,
        "the " + name + " has vertices; patches are curves or faces" };
    }
    const auto append = [&](vtkCellArray* array, SkeletonCellKind kind)
    {
      auto cell = vtk::TakeSmartPointer(array->NewIterator());
      for (cell->GoToFirstCell(); !cell->IsDoneWithTraversal(); cell->GoToNextCell())
      {
        vtkIdType count = 0;
        const vtkIdType* points = nullptr;
        cell->GetCurrentCell(count, points);
        this->Add(kind, count, points);
      }
    };
    append(polygons->GetLines(), SkeletonCellKind::Polyline); // in the order of cell ids
    append(polygons->GetPolys(), SkeletonCellKind::Polygon);
    append(polygons->GetStrips(), SkeletonCellKind::TriangleStrip);
    return {};
  }
  auto* grid = vtkUnstructuredGrid::SafeDownCast(data);
  for (vtkIdType cell = 0; grid && cell < grid->GetNumberOfCells(); ++cell)
  {
    const int type = grid->GetCellType(cell);
    SkeletonCellKind kind = SkeletonCellKind::Polyline;
    if (!KindOf(type, kind))
    {
      const char* typeName = vtkCellTypes::GetClassNameFromTypeId(type);
      return { ErrorCode::InvalidTopology,
        CellOf(cell, name) + " is a " + (typeName ? typeName : "cell") + " (type " +
          std::to_string(type) +
          "): patches are polylines, polygons, triangle strips or Bezier curves, quadrilaterals "
          "and triangles" };
    }
    vtkIdType count = 0;
    const vtkIdType* points = nullptr;
    grid->GetCellPoints(cell, count, points);
    if (type == VTK_PIXEL && count == 4)
    {
      const std::array<vtkIdType, 4> around{ points[0], points[1], points[3], points[2] };
      this->Add(kind, count, around.data());
      continue;
    }
    this->Add(kind, count, points);
  }
  return {};
}

void SkeletonCells::Add(SkeletonCellKind kind, vtkIdType count, const vtkIdType* points)
{
  this->Kinds.push_back(kind);
  this->Ids.insert(this->Ids.end(), points, points + count);
  this->Offsets.push_back(this->Ids.size());
}

Status SkeletonCells::CheckKinds(const std::string& name) const
{
  for (std::size_t cell = 1; cell < this->Kinds.size(); ++cell)
  {
    const SkeletonCellKind first = this->Kinds.front();
    const SkeletonCellKind kind = this->Kinds[cell];
    const std::string both = "cell 0 of the " + name + " is a " + KindName(first) + ", cell " +
      std::to_string(cell) + " a " + KindName(kind) + ": ";
    if (IsCurve(first) != IsCurve(kind))
    {
      return { ErrorCode::InvalidTopology,
        both + "the patches of a skeleton are all curves (in the plane) or all faces (in space)" };
    }
    if (IsBezierKind(first) != IsBezierKind(kind))
    {
      return { ErrorCode::InvalidTopology,
        both + "give the Bezier cells as polylines or polygons too (vtkSplineTessellate)" };
    }
  }
  return {};
}

Status SkeletonCells::ReadPatchIds(vtkDataSet* data, const std::string& name)
{
  vtkDataArray* ids = data->GetCellData()->GetArray("PatchId");
  if (!ids)
  {
    return { ErrorCode::InvalidTopology, "the " + name + " has no cell array PatchId" };
  }
  if (ids->GetNumberOfTuples() < this->Count() || ids->GetNumberOfComponents() < 1)
  {
    return { ErrorCode::InvalidTopology,
      "the cell array PatchId of the " + name + " is not one number a cell" };
  }
  for (vtkIdType cell = 0; cell < this->Count(); ++cell)
  {
    const double value = ids->GetComponent(cell, 0);
    if (!(std::abs(value) <= std::numeric_limits<int>::max()) || value != std::floor(value))
    {
      return { ErrorCode::InvalidTopology,
        "PatchId of " + CellOf(cell, name) + " is not an integer" };
    }
    this->PatchIds.push_back(static_cast<int>(value));
  }
  return {};
}

int SkeletonCells::Dimension() const
{
  return this->Kinds.empty() ? 0 : IsCurve(this->Kinds.front()) ? 2 : 3;
}

bool SkeletonCells::IsBezier() const
{
  return !this->Kinds.empty() && IsBezierKind(this->Kinds.front());
}

bool SkeletonCells::HasBezierTriangles() const
{
  return std::find(this->Kinds.begin(), this->Kinds.end(), SkeletonCellKind::BezierTriangle) !=
    this->Kinds.end();
}
}
