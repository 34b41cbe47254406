// SPDX-License-Identifier: BSD-3-Clause
#include "PatchTopology.h"

#include <knotwork/SplineCore/PatchDirections.h>

#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkFieldData.h"
#include "vtkIntArray.h"
#include "vtkNew.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace knotwork
{
namespace
{
constexpr const char* InterfacesName = "PatchInterfaces";
constexpr const char* BoundariesName = "PatchBoundaries";
constexpr int InterfaceColumns = 10;
constexpr int BoundaryColumns = 2;

vtkDataArray* FindArray(vtkDataObject* data, const char* name, int columns)
{
  vtkDataArray* array = data->GetFieldData()->GetArray(name);
  return array && array->GetNumberOfComponents() == columns ? array : nullptr;
}

int SplineDimension(const SplineFile& file, int spline)
{
  return static_cast<int>(file.Splines[static_cast<std::size_t>(spline)].index()) + 1;
}

/// Values of a row as integers; what is none becomes -1.
std::array<int, InterfaceColumns> Row(vtkDataArray* array, vtkIdType row)
{
  std::array<int, InterfaceColumns> values{};
  for (int c = 0; c < array->GetNumberOfComponents(); ++c)
  {
    const double value = array->GetComponent(row, c);
    values[static_cast<std::size_t>(c)] =
      value >= 0.0 && value <= 2147483647.0 && value == std::floor(value) ? static_cast<int>(value)
                                                                          : -1;
  }
  return values;
}
}

void SetPatchTopology(const SplineFile& file, vtkDataObject* data)
{
  vtkNew<vtkIntArray> interfaces, boundaries;
  interfaces->SetName(InterfacesName);
  interfaces->SetNumberOfComponents(InterfaceColumns);
  boundaries->SetName(BoundariesName);
  boundaries->SetNumberOfComponents(BoundaryColumns);
  const auto id = [&](const PatchSide& side)
  { return file.Ids[static_cast<std::size_t>(side.Patch)]; };
  for (const StatedPatches& patches : file.MultiPatches)
  {
    for (const PatchInterface& row : patches.Topology.Interfaces)
    {
      const PatchDirections along = DirectionsOf(row, patches.Dimension);
      const int values[] = { id(row.Sides[0]), row.Sides[0].Side + 1, id(row.Sides[1]),
        row.Sides[1].Side + 1, along.Direction[0], along.Direction[1], along.Direction[2],
        along.Sense[0], along.Sense[1], along.Sense[2] };
      interfaces->InsertNextTypedTuple(values);
    }
    for (const PatchSide& side : patches.Topology.Boundary)
    {
      const int values[] = { id(side), side.Side + 1 };
      boundaries->InsertNextTypedTuple(values);
    }
  }
  if (interfaces->GetNumberOfTuples() > 0)
  {
    data->GetFieldData()->AddArray(interfaces);
  }
  if (boundaries->GetNumberOfTuples() > 0)
  {
    data->GetFieldData()->AddArray(boundaries);
  }
}

std::string GetPatchTopology(vtkDataObject* data, SplineFile& file)
{
  std::map<int, int> splineOfId;
  std::array<StatedPatches, 4> made; // by dimension
  for (int i = 0; i < static_cast<int>(file.Splines.size()); ++i)
  {
    splineOfId[file.Ids[static_cast<std::size_t>(i)]] = i;
    made[static_cast<std::size_t>(SplineDimension(file, i))].Splines.push_back(i);
  }
  // The dimension of a side's patch; 0 when there is no such side.
  const auto findSide = [&](int id, int number, PatchSide& side)
  {
    const auto found = splineOfId.find(id);
    if (found == splineOfId.end())
    {
      return 0;
    }
    side = { found->second, number - 1 };
    const int dimension = SplineDimension(file, side.Patch);
    return number >= 1 && number <= 2 * dimension ? dimension : 0;
  };
  vtkIdType lost = 0;
  vtkDataArray* interfaces = FindArray(data, InterfacesName, InterfaceColumns);
  for (vtkIdType i = 0; interfaces && i < interfaces->GetNumberOfTuples(); ++i)
  {
    const auto row = Row(interfaces, i);
    PatchInterface next;
    const int dimension = findSide(row[0], row[1], next.Sides[0]);
    const bool fits = dimension > 0 && findSide(row[2], row[3], next.Sides[1]) == dimension;
    PatchDirections along;
    std::copy_n(row.begin() + 4, dimension, along.Direction.begin());
    std::copy_n(row.begin() + 7, dimension, along.Sense.begin());
    if (fits && SetDirections(along, dimension, next))
    {
      made[static_cast<std::size_t>(dimension)].Topology.Interfaces.push_back(next);
    }
    else
    {
      ++lost;
    }
  }
  vtkDataArray* boundaries = FindArray(data, BoundariesName, BoundaryColumns);
  for (vtkIdType i = 0; boundaries && i < boundaries->GetNumberOfTuples(); ++i)
  {
    const auto row = Row(boundaries, i);
    PatchSide side;
    const int dimension = findSide(row[0], row[1], side);
    if (dimension > 0)
    {
      made[static_cast<std::size_t>(dimension)].Topology.Boundary.push_back(side);
    }
    else
    {
      ++lost;
    }
  }
  for (int dimension = 1; dimension <= 3; ++dimension)
  {
    StatedPatches& patches = made[static_cast<std::size_t>(dimension)];
    patches.Dimension = dimension;
    if (patches.Splines.size() > 1 || !patches.Topology.Interfaces.empty() ||
      !patches.Topology.Boundary.empty())
    {
      file.MultiPatches.push_back(std::move(patches));
    }
  }
  return lost > 0
    ? std::to_string(lost) + " interfaces or boundaries of patches that are not there are left out"
    : std::string();
}

void PassPatchTopology(vtkDataObject* from, vtkDataObject* to)
{
  for (const char* name : { InterfacesName, BoundariesName })
  {
    if (vtkDataArray* array = from->GetFieldData()->GetArray(name))
    {
      to->GetFieldData()->AddArray(array);
    }
  }
}
}
