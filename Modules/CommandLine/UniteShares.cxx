// SPDX-License-Identifier: BSD-3-Clause
#include "Shares.h"

#include <knotwork/SplineGrid/Processes.h>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

namespace knotwork
{
namespace
{
/// Cells of one piece that follow each other.
struct CellRun
{
  vtkDataSet* Piece = nullptr;
  vtkCellArray* Cells = nullptr;
  vtkIdType First = 0;     ///< in Cells
  vtkIdType FirstData = 0; ///< in the attributes
  vtkIdType Count = 0;
};

/// Cells of each dimension of a piece, in order.
std::array<std::vector<CellRun>, 4> RunsOf(vtkDataSet* piece)
{
  std::array<std::vector<CellRun>, 4> runs;
  if (auto* polygons = vtkPolyData::SafeDownCast(piece))
  {
    const vtkIdType lines = polygons->GetNumberOfLines();
    runs[1].push_back({ piece, polygons->GetLines(), 0, 0, lines });
    runs[2].push_back({ piece, polygons->GetPolys(), 0, lines, polygons->GetNumberOfPolys() });
    return runs;
  }
  auto* grid = vtkUnstructuredGrid::SafeDownCast(piece);
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    const int type = grid->GetCellType(cell);
    auto& own = runs[type == VTK_LINE ? 1U : type == VTK_HEXAHEDRON ? 3U : 2U];
    if (own.empty() || own.back().First + own.back().Count != cell)
    {
      own.push_back({ piece, grid->GetCells(), cell, cell, 0 });
    }
    ++own.back().Count;
  }
  return runs;
}

/// Arrays like those of a piece, with other tuples, and their rows from the pieces.
void UniteArrays(vtkDataSetAttributes* like, vtkIdType tuples, vtkDataSetAttributes* to,
  const std::function<void(const char* name, vtkAbstractArray* array)>& fill)
{
  for (int i = 0; i < like->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = like->GetAbstractArray(i);
    if (array == like->GetGlobalIds())
    {
      continue;
    }
    const auto made = vtkSmartPointer<vtkAbstractArray>::Take(array->NewInstance());
    made->SetName(array->GetName());
    made->SetNumberOfComponents(array->GetNumberOfComponents());
    made->CopyComponentNames(array);
    made->SetNumberOfTuples(tuples);
    fill(array->GetName(), made);
    to->AddArray(made);
    if (array == like->GetNormals())
    {
      to->SetActiveNormals(array->GetName());
    }
  }
}

vtkSmartPointer<vtkDataObject> UnitePieces(
  const std::vector<vtkSmartPointer<vtkDataObject>>& pieces)
{
  std::vector<vtkDataSet*> sets;
  vtkIdType numPoints = 0;
  std::array<std::vector<CellRun>, 4> runs;
  for (const auto& piece : pieces)
  {
    sets.push_back(vtkDataSet::SafeDownCast(piece));
    auto* ids = vtkIdTypeArray::SafeDownCast(sets.back()->GetPointData()->GetGlobalIds());
    for (vtkIdType i = 0; i < ids->GetNumberOfTuples(); ++i)
    {
      numPoints = std::max(numPoints, ids->GetValue(i) + 1);
    }
    const auto own = RunsOf(sets.back());
    for (std::size_t d = 0; d < runs.size(); ++d)
    {
      runs[d].insert(runs[d].end(), own[d].begin(), own[d].end());
    }
  }
  // rows of points with following numbers at once
  const auto copyPoints = [&](vtkAbstractArray* to, const auto& arrayOf)
  {
    for (vtkDataSet* set : sets)
    {
      auto* ids = vtkIdTypeArray::SafeDownCast(set->GetPointData()->GetGlobalIds());
      const vtkIdType count = ids->GetNumberOfTuples();
      for (vtkIdType begin = 0, end = 0; begin < count; begin = end)
      {
        do
        {
          ++end;
        } while (end < count && ids->GetValue(end) == ids->GetValue(end - 1) + 1);
        to->InsertTuples(ids->GetValue(begin), end - begin, begin, arrayOf(set));
      }
    }
  };
  vtkIdType numCells = 0;
  std::array<vtkNew<vtkCellArray>, 4> cells;
  vtkNew<vtkUnsignedCharArray> types;
  for (std::size_t d = 0; d < runs.size(); ++d)
  {
    for (const CellRun& run : runs[d])
    {
      numCells += run.Count;
      auto* ids = vtkIdTypeArray::SafeDownCast(run.Piece->GetPointData()->GetGlobalIds());
      std::vector<vtkIdType> corners;
      for (vtkIdType cell = run.First; cell < run.First + run.Count; ++cell)
      {
        vtkIdType count = 0;
        const vtkIdType* points = nullptr;
        run.Cells->GetCellAtId(cell, count, points);
        corners.clear();
        std::transform(points, points + count, std::back_inserter(corners),
          [ids](vtkIdType point) { return ids->GetValue(point); });
        cells[d]->InsertNextCell(count, corners.data());
        types->InsertNextValue(static_cast<unsigned char>(
          run.Piece->GetCellType(run.FirstData + cell - run.First)));
      }
    }
  }
  const auto united = vtkSmartPointer<vtkPointSet>::Take(
    vtkPointSet::SafeDownCast(sets.front()->NewInstance()));
  const auto pointsOf = [](vtkDataSet* set)
  { return vtkPointSet::SafeDownCast(set)->GetPoints()->GetData(); };
  vtkNew<vtkPoints> points;
  points->SetDataType(vtkPointSet::SafeDownCast(sets.front())->GetPoints()->GetDataType());
  points->SetNumberOfPoints(numPoints);
  copyPoints(points->GetData(), pointsOf);
  united->SetPoints(points);
  if (auto* polygons = vtkPolyData::SafeDownCast(united))
  {
    polygons->SetLines(cells[1]);
    polygons->SetPolys(cells[2]);
  }
  else
  {
    vtkNew<vtkCellArray> all;
    for (const auto& some : cells)
    {
      all->Append(some);
    }
    vtkUnstructuredGrid::SafeDownCast(united)->SetCells(types, all);
  }
  UniteArrays(sets.front()->GetPointData(), numPoints, united->GetPointData(),
    [&](const char* name, vtkAbstractArray* to)
    {
      copyPoints(
        to, [name](vtkDataSet* set) { return set->GetPointData()->GetAbstractArray(name); });
    });
  UniteArrays(sets.front()->GetCellData(), numCells, united->GetCellData(),
    [&](const char* name, vtkAbstractArray* to)
    {
      vtkIdType next = 0;
      for (const auto& some : runs)
      {
        for (const CellRun& run : some)
        {
          to->InsertTuples(next, run.Count, run.FirstData,
            run.Piece->GetCellData()->GetAbstractArray(name));
          next += run.Count;
        }
      }
    });
  united->GetFieldData()->ShallowCopy(sets.front()->GetFieldData());
  return united;
}
}

Result<vtkSmartPointer<vtkDataObject>> UniteShares(vtkDataObject* output)
{
  auto pieces = CollectPieces(output);
  if (!pieces)
  {
    return pieces.Status;
  }
  return Processes::Own() != 0 || pieces.Value.empty() ? vtkSmartPointer<vtkDataObject>(output)
                                                       : UnitePieces(pieces.Value);
}
}
