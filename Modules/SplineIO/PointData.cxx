// SPDX-License-Identifier: BSD-3-Clause
#include "PointData.h"

#include <knotwork/SplineGrid/ReferenceSystem.h>

#include "vtkCellArray.h"
#include "vtkDoubleArray.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>

namespace knotwork
{
namespace
{
constexpr const char* GroupArray = "CloudId";
constexpr const char* ColorArray = "Color";

/// "a" and the number behind it for "a:3"; -1 without one.
int Component(const std::string& name, std::string& stem)
{
  const std::size_t colon = name.rfind(':');
  const std::string digits = colon == std::string::npos ? "" : name.substr(colon + 1);
  if (colon == 0 || digits.empty() || digits.size() > 3 ||
    digits.find_first_not_of("0123456789") != std::string::npos)
  {
    stem = name;
    return -1;
  }
  stem = name.substr(0, colon);
  return std::stoi(digits);
}

void AddChannels(const PointFile& file, vtkPolyData* output)
{
  const Eigen::Index n = file.Points.rows();
  for (std::size_t first = 0; first < file.Names.size();)
  {
    std::string stem;
    std::string other;
    int components = 1;
    if (Component(file.Names[first], stem) == 0)
    {
      while (first + static_cast<std::size_t>(components) < file.Names.size() &&
        Component(file.Names[first + static_cast<std::size_t>(components)], other) == components &&
        other == stem)
      {
        ++components;
      }
    }
    else
    {
      stem = file.Names[first];
    }
    vtkNew<vtkDoubleArray> array;
    array->SetName(stem.c_str());
    array->SetNumberOfComponents(components);
    array->SetNumberOfTuples(n);
    double* to = array->GetPointer(0);
    for (Eigen::Index i = 0; i < n; ++i)
    {
      for (int c = 0; c < components; ++c)
      {
        *to++ = file.Channels(i, static_cast<Eigen::Index>(first) + c);
      }
    }
    output->GetPointData()->AddArray(array);
    first += static_cast<std::size_t>(components);
  }
}

void AddGroups(const PointFile& file, vtkPolyData* output)
{
  const Eigen::Index n = file.Points.rows();
  const bool colored = std::any_of(
    file.Groups.begin(), file.Groups.end(), [](const PointGroup& group) { return group.HasColor; });
  vtkNew<vtkIntArray> ids;
  ids->SetName(GroupArray);
  vtkNew<vtkUnsignedCharArray> colors;
  colors->SetName(ColorArray);
  colors->SetNumberOfComponents(4);
  for (std::size_t g = 0; g < file.Groups.size(); ++g)
  {
    const PointGroup& group = file.Groups[g];
    const Eigen::Index end = g + 1 < file.Groups.size() ? file.Groups[g + 1].Begin : n;
    for (Eigen::Index i = group.Begin; i < end; ++i)
    {
      ids->InsertNextValue(static_cast<int>(g));
      for (int share : group.Color)
      {
        colors->InsertNextValue(static_cast<unsigned char>(group.HasColor ? share : 0));
      }
    }
  }
  if (file.Groups.size() > 1)
  {
    output->GetPointData()->AddArray(ids);
  }
  if (colored)
  {
    output->GetPointData()->AddArray(colors);
  }
}

vtkSmartPointer<vtkCellArray> CellsOf(const std::vector<std::vector<int>>& corners)
{
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  for (const std::vector<int>& cell : corners)
  {
    cells->InsertNextCell(static_cast<int>(cell.size()));
    for (int corner : cell)
    {
      cells->InsertCellPoint(corner);
    }
  }
  return cells;
}

/// Groups as EncodePoints wrote them; none when the arrays say something else.
std::vector<PointGroup> FindGroups(vtkPointSet* data)
{
  const vtkIdType n = data->GetNumberOfPoints();
  vtkDataArray* ids = data->GetPointData()->GetArray(GroupArray);
  vtkDataArray* colors = data->GetPointData()->GetArray(ColorArray);
  colors = colors && colors->GetNumberOfComponents() == 4 ? colors : nullptr;
  std::vector<PointGroup> groups;
  for (vtkIdType i = 0; (ids || colors) && i < n; ++i)
  {
    PointGroup group;
    group.Begin = i;
    for (int c = 0; colors && c < 4; ++c)
    {
      group.Color[static_cast<std::size_t>(c)] =
        static_cast<int>(std::clamp(colors->GetComponent(i, c), 0.0, 255.0));
    }
    group.HasColor = group.Color != std::array<int, 4>{};
    const bool begins = i == 0 || (ids && ids->GetComponent(i, 0) != ids->GetComponent(i - 1, 0));
    if (begins && i > 0 && ids->GetComponent(i, 0) < ids->GetComponent(i - 1, 0))
    {
      return {};
    }
    if (begins)
    {
      groups.push_back(group);
    }
    else if (group.Color != groups.back().Color)
    {
      return {};
    }
  }
  return groups;
}
}

void EncodePoints(const PointFile& file, vtkPolyData* output)
{
  const Eigen::Index n = file.Points.rows();
  vtkNew<vtkDoubleArray> coordinates;
  coordinates->SetNumberOfComponents(3);
  coordinates->SetNumberOfTuples(n);
  std::copy(file.Points.data(), file.Points.data() + 3 * n, coordinates->GetPointer(0));
  vtkNew<vtkPoints> points;
  points->SetData(coordinates);
  output->SetPoints(points);
  if (file.Polygons.empty() && file.Lines.empty())
  {
    vtkNew<vtkCellArray> vertices;
    vertices->AllocateExact(n, n);
    for (vtkIdType i = 0; i < n; ++i)
    {
      vertices->InsertNextCell(1, &i);
    }
    output->SetVerts(vertices);
  }
  if (!file.Polygons.empty())
  {
    output->SetPolys(CellsOf(file.Polygons));
  }
  if (!file.Lines.empty())
  {
    output->SetLines(CellsOf(file.Lines));
  }
  AddChannels(file, output);
  AddGroups(file, output);
  if (!file.ReferenceSystem.empty())
  {
    SetReferenceSystem(output, file.ReferenceSystem);
  }
  if (output->GetPointData()->HasArray("TCoords"))
  {
    output->GetPointData()->SetActiveTCoords("TCoords");
  }
}

PointFile DecodePoints(vtkPointSet* data)
{
  const vtkIdType n = data->GetNumberOfPoints();
  PointFile file;
  file.Points.resize(n, 3);
  for (vtkIdType i = 0; i < n; ++i)
  {
    data->GetPoint(i, file.Points.row(i).data());
  }
  file.Groups = FindGroups(data);
  std::vector<vtkDataArray*> arrays;
  for (int i = 0; i < data->GetPointData()->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* array = data->GetPointData()->GetArray(i);
    const std::string name = array && array->GetName() ? array->GetName() : "";
    if (name.empty() || (!file.Groups.empty() && (name == GroupArray || name == ColorArray)))
    {
      continue;
    }
    arrays.push_back(array);
    const int components = array->GetNumberOfComponents();
    for (int c = 0; c < components; ++c)
    {
      file.Names.push_back(components > 1 ? name + ":" + std::to_string(c) : name);
    }
  }
  file.Channels.resize(n, static_cast<Eigen::Index>(file.Names.size()));
  Eigen::Index column = 0;
  for (vtkDataArray* array : arrays)
  {
    for (vtkIdType i = 0; i < n; ++i)
    {
      array->GetTuple(i, file.Channels.row(i).data() + column);
    }
    column += array->GetNumberOfComponents();
  }
  return file;
}
}
