// SPDX-License-Identifier: BSD-3-Clause
#include "SegmentTable.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkVariant.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace knotwork
{
namespace
{
/// A segment, and where it stands in the input.
struct Row
{
  LRSegment Segment;
  std::optional<int> Patch;
};

Status Refuse(const std::string& reason)
{
  return { ErrorCode::InvalidParameter, "segments: " + reason };
}

std::string Lower(std::string name)
{
  std::transform(name.begin(), name.end(), name.begin(),
    [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return name;
}

vtkAbstractArray* Column(vtkTable* table, const char* name)
{
  for (vtkIdType c = 0; c < table->GetNumberOfColumns(); ++c)
  {
    const char* found = table->GetColumnName(c);
    if (found && Lower(found) == Lower(name))
    {
      return table->GetColumn(c);
    }
  }
  return nullptr;
}

/// A whole number, as an int.
bool AsWhole(double value, int& whole)
{
  whole = std::abs(value) <= 1e9 ? static_cast<int>(value) : 0;
  return whole == value;
}

Status RowsOfTable(vtkTable* table, std::vector<Row>& rows)
{
  constexpr std::array<const char*, 6> names{ "Direction", "Value", "Start", "End", "Multiplicity",
    "PatchId" };
  std::array<vtkAbstractArray*, 6> columns{};
  for (std::size_t c = 0; c < names.size(); ++c)
  {
    columns[c] = Column(table, names[c]);
    if (c < 4 && !columns[c])
    {
      return Refuse(std::string("the table has no column ") + names[c] +
        "; it needs Direction, Value, Start and End, and may have Multiplicity and PatchId");
    }
  }
  for (vtkIdType r = 0; r < table->GetNumberOfRows(); ++r)
  {
    std::array<double, 6> numbers{ 0.0, 0.0, 0.0, 0.0, 1.0, 0.0 };
    std::array<int, 6> whole{};
    for (std::size_t c = 0; c < names.size(); ++c)
    {
      if (!columns[c])
      {
        whole[c] = 1;
        continue;
      }
      bool isNumber = false;
      numbers[c] = columns[c]->GetVariantValue(r).ToDouble(&isNumber);
      const bool mustBeWhole = c == 0 || c > 3;
      if (!isNumber || (mustBeWhole && !AsWhole(numbers[c], whole[c])))
      {
        return Refuse("row " + std::to_string(r) + ": " + names[c] + " is no " +
          (mustBeWhole ? "whole number" : "number"));
      }
    }
    Row row{ { whole[0], numbers[1], numbers[2], numbers[3], whole[4] }, {} };
    if (columns[5])
    {
      row.Patch = whole[5];
    }
    rows.push_back(row);
  }
  return {};
}

Status WholeOfCell(vtkPolyData* lines, const char* name, vtkIdType cell, std::optional<int>& found)
{
  vtkDataArray* array = lines->GetCellData()->GetArray(name);
  int whole = 0;
  if (array && !AsWhole(array->GetTuple1(cell), whole))
  {
    return Refuse("line " + std::to_string(cell) + ": " + name + " is no whole number");
  }
  if (array)
  {
    found = whole;
  }
  return {};
}

Status RowsOfLines(vtkPolyData* lines, std::vector<Row>& rows)
{
  vtkNew<vtkIdList> points;
  for (vtkIdType cell = 0; cell < lines->GetNumberOfCells(); ++cell)
  {
    if (lines->GetCellType(cell) != VTK_LINE && lines->GetCellType(cell) != VTK_POLY_LINE)
    {
      continue;
    }
    std::optional<int> multiplicity;
    Row row;
    for (const Status& status : { WholeOfCell(lines, "Multiplicity", cell, multiplicity),
           WholeOfCell(lines, "PatchId", cell, row.Patch) })
    {
      if (!status)
      {
        return status;
      }
    }
    row.Segment.Multiplicity = multiplicity.value_or(1);
    lines->GetCellPoints(cell, points);
    for (vtkIdType i = 0; i + 1 < points->GetNumberOfIds(); ++i)
    {
      double a[3];
      double b[3];
      lines->GetPoint(points->GetId(i), a);
      lines->GetPoint(points->GetId(i + 1), b);
      const int d = a[0] == b[0] ? 0 : 1;
      if (a[d] != b[d])
      {
        return Refuse("line " + std::to_string(cell) +
          " runs along neither parameter: x or y must be the same at both of its ends");
      }
      row.Segment.Direction = d;
      row.Segment.Value = a[d];
      row.Segment.Start = std::min(a[1 - d], b[1 - d]);
      row.Segment.End = std::max(a[1 - d], b[1 - d]);
      rows.push_back(row);
    }
  }
  return {};
}
}

Result<SegmentsByPatch> ReadSegments(vtkDataObject* segments, const SplineModel& model)
{
  std::vector<Row> rows;
  Status status;
  if (auto* table = vtkTable::SafeDownCast(segments))
  {
    status = RowsOfTable(table, rows);
  }
  else if (auto* lines = vtkPolyData::SafeDownCast(segments))
  {
    status = RowsOfLines(lines, rows);
  }
  else
  {
    return Refuse("there are none; set a table or lines of them (input port 2)");
  }
  if (!status)
  {
    return status;
  }
  if (rows.empty())
  {
    return { ErrorCode::EmptyInput, "segments: the input holds none" };
  }
  SegmentsByPatch found;
  for (const Row& row : rows)
  {
    if (!row.Patch && model.Patches.size() != 1)
    {
      return Refuse("the spline has " + std::to_string(model.Patches.size()) +
        " patches; say of which they are by PatchId");
    }
    const int id = row.Patch.value_or(model.Patches.front().Id);
    const bool known = std::any_of(model.Patches.begin(), model.Patches.end(),
      [id](const SplinePatch& patch) { return patch.Id == id; });
    if (!known)
    {
      return Refuse("the spline has no patch " + std::to_string(id));
    }
    found[id].push_back(row.Segment);
  }
  return found;
}
}
