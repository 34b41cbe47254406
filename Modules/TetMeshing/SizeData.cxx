// SPDX-License-Identifier: BSD-3-Clause
#include "SizeData.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkDataSetTriangleFilter.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>

namespace knotwork
{
namespace
{
struct SizeArray
{
  vtkDataArray* Values = nullptr;
  bool IsOfCells = false;
};

Result<SizeArray> FindArray(vtkDataSet* data, const std::string& name)
{
  std::vector<SizeArray> found;
  for (const bool isOfCells : { false, true })
  {
    vtkDataSetAttributes* attributes =
      data->GetAttributes(isOfCells ? vtkDataObject::CELL : vtkDataObject::POINT);
    for (int i = 0; i < attributes->GetNumberOfArrays(); ++i)
    {
      vtkDataArray* array = attributes->GetArray(i);
      if (array && array->GetNumberOfComponents() == 1 && array->GetName() &&
        (name.empty() || name == array->GetName()))
      {
        found.push_back({ array, isOfCells });
      }
    }
  }
  if (found.size() == 1 || (!name.empty() && !found.empty()))
  {
    return found.front();
  }
  return { ErrorCode::InvalidParameter,
    (name.empty() ? "the sizes have " + std::to_string(found.size()) +
          " arrays of one component; name the one with the lengths of edges"
                  : "the sizes have no array '" + name +
          "' of one component; name the one with the lengths of edges") +
      " (SizeArray)" };
}

Status CheckValues(const SizeArray& array)
{
  for (vtkIdType i = 0; i < array.Values->GetNumberOfTuples(); ++i)
  {
    const double value = array.Values->GetComponent(i, 0);
    if (!(value > 0.0 && value <= VTK_FLOAT_MAX))
    {
      return { ErrorCode::InvalidParameter,
        "the array '" + std::string(array.Values->GetName()) + "' is not above 0 at " +
          (array.IsOfCells ? "cell " : "point ") + std::to_string(i) + "; give lengths of edges" };
    }
  }
  return {};
}

/// The most dimensions of a cell; 0 without cells.
int LargestDimension(vtkDataSet* data)
{
  int most = 0;
  for (vtkIdType c = 0; c < data->GetNumberOfCells() && most < 3; ++c)
  {
    most = std::max(most, data->GetCell(c)->GetCellDimension());
  }
  return most;
}

void AddField(vtkDataSet* data, const SizeArray& array, SizeField& field)
{
  vtkNew<vtkDataSetTriangleFilter> divide;
  divide->SetInputData(data);
  divide->TetrahedraOnlyOn();
  divide->Update();
  vtkUnstructuredGrid* cells = divide->GetOutput();
  vtkDataArray* values =
    cells->GetAttributes(array.IsOfCells ? vtkDataObject::CELL : vtkDataObject::POINT)
      ->GetArray(array.Values->GetName());
  field.Points.resize(cells->GetNumberOfPoints(), 3);
  for (vtkIdType p = 0; p < cells->GetNumberOfPoints(); ++p)
  {
    cells->GetPoint(p, field.Points.row(p).data());
  }
  vtkNew<vtkIdList> ids;
  for (vtkIdType c = 0; c < cells->GetNumberOfCells(); ++c)
  {
    cells->GetCellPoints(c, ids);
    std::array<int, 4> corners{};
    std::array<double, 4> lengths{};
    for (std::size_t k = 0; k < corners.size(); ++k)
    {
      const vtkIdType corner = ids->GetId(static_cast<vtkIdType>(k));
      corners[k] = static_cast<int>(corner);
      lengths[k] = values->GetComponent(array.IsOfCells ? c : corner, 0);
    }
    field.Cells.push_back(corners);
    field.Lengths.push_back(lengths);
  }
}
}

Status DecodeSizes(vtkDataSet* data, const std::string& name, TetrahedraParams& params)
{
  const auto array = FindArray(data, name);
  if (!array)
  {
    return array.Status;
  }
  if (Status status = CheckValues(array.Value); !status)
  {
    return status;
  }
  const int dimension = LargestDimension(data);
  if (dimension == 3)
  {
    AddField(data, array.Value, params.Sizes);
    return {};
  }
  if (dimension > 0)
  {
    return { ErrorCode::InvalidTopology,
      "the sizes have cells, but no volumes; give volumes with lengths of edges, or points alone, "
      "one in each region" };
  }
  if (array->IsOfCells)
  {
    return { ErrorCode::InvalidParameter,
      "sizes of regions are values of points; '" + std::string(array->Values->GetName()) +
        "' is of cells" };
  }
  for (vtkIdType p = 0; p < data->GetNumberOfPoints(); ++p)
  {
    RegionSize& size = params.RegionSizes.emplace_back();
    data->GetPoint(p, size.Point.data());
    size.Length = array->Values->GetComponent(p, 0);
  }
  return {};
}
}
