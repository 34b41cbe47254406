// SPDX-License-Identifier: BSD-3-Clause
#include "CellMeasurement.h"

#include <knotwork/SplineGrid/Processes.h>

#include "vtkCellData.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace knotwork
{
namespace
{
/// Volume of a cell's box in the domain of its patch, from the cell array ParametricBounds; 1
/// without one.
double ParametricVolume(vtkUnstructuredGrid* grid, vtkIdType cell, int parameters)
{
  vtkDataArray* bounds = grid->GetCellData()->GetArray("ParametricBounds");
  double volume = 1.0;
  for (int d = 0; bounds && bounds->GetNumberOfComponents() == 6 && d < parameters; ++d)
  {
    volume *= bounds->GetComponent(cell, 2 * d + 1) - bounds->GetComponent(cell, 2 * d);
  }
  return volume > 0.0 ? volume : 1.0;
}
}

void Measurement::CompareWithAll()
{
  const auto all = Processes::Exchange(this->Lists);
  for (std::size_t i = 0; i < this->Lists.size(); ++i)
  {
    const MeasuredCells& own = this->Lists[i];
    double measure = 0.0;
    double volume = 0.0;
    for (const std::vector<MeasuredCells>& lists : all)
    {
      for (const MeasuredCells& list : lists)
      {
        measure += own.IsLike(list) ? list.Measure : 0.0;
        volume += own.IsLike(list) ? list.ParametricVolume : 0.0;
      }
    }
    const double factor = own.Measure / own.ParametricVolume / (measure / volume);
    for (const int cell : this->CellsOfLists[i])
    {
      CellMeasure& m = this->Cells[static_cast<std::size_t>(cell)];
      m.UniformityMin *= factor;
      m.UniformityMax *= factor;
      if (m.UniformityMin > m.UniformityMax)
      {
        std::swap(m.UniformityMin, m.UniformityMax); // a negative mean turns the order round
      }
    }
  }
}

Result<Measurement> MeasureGrids(const BernsteinCells& cells, const CellMaps& maps,
  const std::vector<GridPair>& grids, CellMeasuresParams params)
{
  Measurement found;
  found.Cells.resize(static_cast<std::size_t>(cells.NumCells()));
  const auto add = [&](std::vector<int> which, MeasuredCells list) -> Status
  {
    if (which.empty())
    {
      return {};
    }
    params.ParametricVolumes.clear();
    for (const int cell : which)
    {
      const GridPair& owner = OwnerOf(grids, static_cast<std::size_t>(cell));
      params.ParametricVolumes.push_back(
        ParametricVolume(owner.Input, cell - static_cast<vtkIdType>(owner.FirstCell),
          NumParameters(cells.Shapes[static_cast<std::size_t>(cell)])));
      list.ParametricVolume += params.ParametricVolumes.back();
    }
    const auto measured = MeasureCells(SelectCells(cells, which, list.Components), params);
    if (!measured)
    {
      return measured.Status;
    }
    for (std::size_t i = 0; i < which.size(); ++i)
    {
      found.Cells[static_cast<std::size_t>(which[i])] = measured->Cells[i];
    }
    list.Measure = measured->Total.Measure;
    found.Lists.push_back(list);
    found.CellsOfLists.push_back(std::move(which));
    return {};
  };
  Status status;
  for (const auto& plane : maps.Planes)
  {
    double x[3] = {};
    EvaluateCell(cells, plane.front(), {}, x);
    status = status ? add(plane, { 2, 2, x[2] }) : status;
  }
  status = status ? add(maps.Volumes, { 3, 3 }) : status;
  for (const int parameters : { 1, 2 })
  {
    std::vector<int> others;
    std::copy_if(maps.Others.begin(), maps.Others.end(), std::back_inserter(others),
      [&](int cell)
      { return NumParameters(cells.Shapes[static_cast<std::size_t>(cell)]) == parameters; });
    status = status ? add(std::move(others), { parameters, 3 }) : status;
  }
  return status ? Result<Measurement>(std::move(found)) : status;
}
}
