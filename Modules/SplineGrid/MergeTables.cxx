// SPDX-License-Identifier: BSD-3-Clause
#include "MergeTables.h"

#include "Bytes.h"
#include "Processes.h"

#include "vtkAbstractArray.h"
#include "vtkDataArray.h"
#include "vtkSmartPointer.h"
#include "vtkTable.h"
#include "vtkType.h"
#include "vtkVariant.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace knotwork
{
namespace
{
/// A value of a column: a number or a text.
struct Value
{
  int Type = VTK_DOUBLE; ///< of the column
  double Number = 0.0;
  std::string Text;
};
using Row = std::map<std::string, Value>;

/// The rows of a table: of every value its column's type and name, the number and the text.
std::string Pack(vtkTable* table)
{
  Bytes bytes;
  for (vtkIdType row = 0; row < table->GetNumberOfRows(); ++row)
  {
    for (vtkIdType c = 0; c < table->GetNumberOfColumns(); ++c)
    {
      vtkAbstractArray* column = table->GetColumn(c);
      auto* numbers = vtkDataArray::SafeDownCast(column);
      bytes.Add(column->GetDataType());
      bytes.Add(std::string(column->GetName()));
      bytes.Add(numbers ? numbers->GetComponent(row, 0) : 0.0);
      bytes.Add(numbers ? std::string() : std::string(column->GetVariantValue(row).ToString()));
    }
  }
  return bytes.Get();
}

/// @param names  gets those of the columns that it has not yet.
std::vector<Row> RowsOf(const std::string& packed, std::vector<std::string>& names)
{
  std::vector<Row> rows;
  for (Bytes bytes(packed); !bytes.IsAtEnd();)
  {
    Value value;
    value.Type = bytes.Take<int>();
    auto name = bytes.Take<std::string>();
    value.Number = bytes.Take<double>();
    value.Text = bytes.Take<std::string>();
    if (std::find(names.begin(), names.end(), name) == names.end())
    {
      names.push_back(name);
    }
    if (rows.empty() || rows.back().count(name) > 0)
    {
      rows.emplace_back();
    }
    rows.back().emplace(std::move(name), std::move(value));
  }
  return rows;
}

double Merged(Merging how, double a, double weightOfA, double b, double weightOfB)
{
  const double weight = weightOfA + weightOfB;
  if (how != Merging::Sum && weight > 0.0 && (weightOfA == 0.0 || weightOfB == 0.0))
  {
    return weightOfA == 0.0 ? b : a; // nothing has no extrema
  }
  switch (how)
  {
    case Merging::Sum:
      return a + b;
    case Merging::Least:
      return std::min(a, b);
    case Merging::Largest:
      return std::max(a, b);
    case Merging::Mean:
      return weight > 0.0 ? (weightOfA * a + weightOfB * b) / weight : 0.0;
    case Merging::QuadraticMean:
      break;
  }
  return weight > 0.0 ? std::sqrt((weightOfA * a * a + weightOfB * b * b) / weight) : 0.0;
}

void Add(const Row& from, const MergedTable& how, Row& to)
{
  const auto weightOf = [&how](const Row& row)
  {
    const auto found = row.find(how.Weight);
    return found == row.end() ? 0.0 : found->second.Number;
  };
  const double before = weightOf(to);
  const double more = weightOf(from);
  for (const MergedColumn& column : how.Columns)
  {
    const auto value = to.find(column.Name);
    if (value != to.end())
    {
      value->second.Number =
        Merged(column.How, value->second.Number, before, from.at(column.Name).Number, more);
    }
  }
}
}

void MergeTables(vtkTable* table, const MergedTable& how)
{
  const auto order = [&how](const Row& row)
  {
    const double key = how.Key.empty() ? 0.0 : row.at(how.Key).Number;
    return std::pair(how.LastKey && key == *how.LastKey, key);
  };
  std::vector<std::string> names;
  std::map<std::pair<bool, double>, Row> rows;
  const std::vector<std::string> pieces = Processes::Exchange(Pack(table));
  for (const std::string& piece : pieces)
  {
    for (Row& row : RowsOf(piece, names))
    {
      const auto key = order(row);
      const auto known = rows.find(key);
      if (known == rows.end())
      {
        rows.emplace(key, std::move(row));
      }
      else
      {
        Add(row, how, known->second);
      }
    }
  }
  table->Initialize();
  for (const std::string& name : Processes::Own() == 0 ? names : std::vector<std::string>())
  {
    const int type = rows.begin()->second.at(name).Type;
    const auto column =
      vtkSmartPointer<vtkAbstractArray>::Take(vtkAbstractArray::CreateArray(type));
    column->SetName(name.c_str());
    column->SetNumberOfTuples(static_cast<vtkIdType>(rows.size()));
    vtkIdType place = 0;
    for (const auto& [key, row] : rows)
    {
      const Value& value = row.at(name);
      column->SetVariantValue(
        place++, type == VTK_STRING ? vtkVariant(value.Text) : vtkVariant(value.Number));
    }
    table->AddColumn(column);
  }
}
}
