// SPDX-License-Identifier: BSD-3-Clause
#include "InputChecks.h"

#include "vtkCellArray.h"
#include "vtkCellType.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"

namespace knotwork
{
namespace
{
bool IsBezier(int type)
{
  return type == VTK_BEZIER_CURVE || type == VTK_BEZIER_TRIANGLE ||
    type == VTK_BEZIER_QUADRILATERAL || type == VTK_BEZIER_TETRAHEDRON ||
    type == VTK_BEZIER_HEXAHEDRON || type == VTK_BEZIER_WEDGE || type == VTK_BEZIER_PYRAMID;
}
}

Status CheckCellSizes(vtkDataSet* data)
{
  auto* polydata = vtkPolyData::SafeDownCast(data);
  if (!polydata)
  {
    return {};
  }
  const struct
  {
    vtkCellArray* Cells;
    const char* Name;
    vtkIdType Least;
  } kinds[] = { { polydata->GetVerts(), "vertex", 1 }, { polydata->GetLines(), "line", 2 },
    { polydata->GetPolys(), "polygon", 3 }, { polydata->GetStrips(), "strip", 3 } };
  vtkIdType first = 0; // cell ids count through all kinds
  for (const auto& kind : kinds)
  {
    const vtkIdType count = kind.Cells ? kind.Cells->GetNumberOfCells() : 0;
    for (vtkIdType i = 0; i < count; ++i)
    {
      const vtkIdType corners = kind.Cells->GetCellSize(i);
      if (corners < kind.Least)
      {
        return { ErrorCode::InvalidTopology,
          "cell " + std::to_string(first + i) + " is a " + kind.Name + " of " +
            std::to_string(corners) + " corners, not of " + std::to_string(kind.Least) +
            " or more; remove it, for example with vtkCleanPolyData" };
      }
    }
    first += count;
  }
  return {};
}

Status CheckSampledPoints(vtkDataSet* data, const std::string& name)
{
  auto* grid = vtkUnstructuredGrid::SafeDownCast(data);
  for (vtkIdType cell = 0; grid && cell < grid->GetNumberOfCells(); ++cell)
  {
    if (IsBezier(grid->GetCellType(cell)))
    {
      return { ErrorCode::InvalidParameter,
        name + " is a spline (cell " + std::to_string(cell) +
          " is a Bezier cell): its points are control points, not points of the shape; make "
          "points " +
          "of it with tessellate or evaluate" };
    }
  }
  return {};
}
}
