// SPDX-License-Identifier: BSD-3-Clause
#include "Shares.h"

#include <knotwork/SplineGrid/Processes.h>
#include <knotwork/SplineGrid/vtkSplineTessellate.h>

#include <vtkAbstractArray.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <iterator>
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

vtkIdTypeArray* NumbersOf(vtkDataSet* piece)
{
  return vtkIdTypeArray::SafeDownCast(piece->GetPointData()->GetGlobalIds());
}

vtkIdTypeArray* CountsOf(vtkDataSet* piece)
{
  return vtkIdTypeArray::SafeDownCast(
    piece->GetFieldData()->GetArray(vtkSplineTessellate::PointsByDimension()));
}

constexpr std::size_t NumDimensions = 3;
using RunsByDimension = std::array<std::vector<CellRun>, NumDimensions>;

/// Cells of curves, surfaces and solids, in order: each has points of its own.
void AddRuns(vtkDataSet* piece, vtkCellArray* cells, vtkIdType firstData, RunsByDimension& runs)
{
  auto* counts = CountsOf(piece);
  auto* numbers = NumbersOf(piece);
  for (vtkIdType cell = 0; cell < cells->GetNumberOfCells(); ++cell)
  {
    vtkIdType count = 0;
    const vtkIdType* points = nullptr;
    cells->GetCellAtId(cell, count, points);
    std::size_t dimension = 0;
    vtkIdType number = numbers->GetValue(points[0]);
    while (number >= counts->GetValue(static_cast<vtkIdType>(dimension)))
    {
      number -= counts->GetValue(static_cast<vtkIdType>(dimension++));
    }
    auto& own = runs[dimension];
    if (own.empty() || own.back().Cells != cells || own.back().First + own.back().Count != cell)
    {
      own.push_back({ piece, cells, cell, firstData + cell, 0 });
    }
    ++own.back().Count;
  }
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
  RunsByDimension runs;
  for (const auto& piece : pieces)
  {
    sets.push_back(vtkDataSet::SafeDownCast(piece));
    if (auto* polygons = vtkPolyData::SafeDownCast(piece))
    {
      AddRuns(polygons, polygons->GetLines(), 0, runs);
      AddRuns(polygons, polygons->GetPolys(), polygons->GetNumberOfLines(), runs);
    }
    else
    {
      AddRuns(sets.back(), vtkUnstructuredGrid::SafeDownCast(piece)->GetCells(), 0, runs);
    }
  }
  const auto numPoints = static_cast<vtkIdType>(NumberOfTessellationPoints(sets.front()));
  // rows of points with following numbers at once
  const auto copyPoints = [&](vtkAbstractArray* to, const auto& arrayOf)
  {
    for (vtkDataSet* set : sets)
    {
      auto* ids = NumbersOf(set);
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
  std::array<vtkNew<vtkCellArray>, NumDimensions> cells;
  vtkNew<vtkUnsignedCharArray> types;
  for (std::size_t d = 0; d < runs.size(); ++d)
  {
    for (const CellRun& run : runs[d])
    {
      numCells += run.Count;
      auto* ids = NumbersOf(run.Piece);
      auto* grid = vtkUnstructuredGrid::SafeDownCast(run.Piece);
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
        if (grid)
        {
          types->InsertNextValue(static_cast<unsigned char>(grid->GetCellType(cell)));
        }
      }
    }
  }
  const auto united =
    vtkSmartPointer<vtkPointSet>::Take(vtkPointSet::SafeDownCast(sets.front()->NewInstance()));
  const auto pointsOf = [](vtkDataSet* set)
  { return vtkPointSet::SafeDownCast(set)->GetPoints()->GetData(); };
  vtkNew<vtkPoints> points;
  points->SetDataType(vtkPointSet::SafeDownCast(sets.front())->GetPoints()->GetDataType());
  points->SetNumberOfPoints(numPoints);
  copyPoints(points->GetData(), pointsOf);
  united->SetPoints(points);
  if (auto* polygons = vtkPolyData::SafeDownCast(united))
  {
    polygons->SetLines(cells[0]);
    cells[1]->Append(cells[2]);
    polygons->SetPolys(cells[1]);
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
          to->InsertTuples(
            next, run.Count, run.FirstData, run.Piece->GetCellData()->GetAbstractArray(name));
          next += run.Count;
        }
      }
    });
  united->GetFieldData()->ShallowCopy(sets.front()->GetFieldData());
  united->GetFieldData()->RemoveArray(vtkSplineTessellate::PointsByDimension());
  return united;
}
}

std::int64_t NumberOfTessellationPoints(vtkDataObject* part)
{
  auto* counts = CountsOf(vtkDataSet::SafeDownCast(part));
  return counts ? counts->GetValue(0) + counts->GetValue(1) + counts->GetValue(2) : 0;
}

Result<vtkSmartPointer<vtkDataObject>> UniteTessellation(vtkDataObject* output)
{
  auto pieces = CollectPieces(output);
  if (!pieces)
  {
    return pieces.Status;
  }
  if (Processes::Own() != 0 || pieces.Value.empty())
  {
    output->GetAttributes(vtkDataObject::POINT)->SetGlobalIds(nullptr);
    output->GetFieldData()->RemoveArray(vtkSplineTessellate::PointsByDimension());
    return vtkSmartPointer<vtkDataObject>(output);
  }
  return UnitePieces(pieces.Value);
}
}
