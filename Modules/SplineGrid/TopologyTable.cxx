// SPDX-License-Identifier: BSD-3-Clause
#include "TopologyTable.h"

#include "FieldTables.h"
#include <knotwork/SplineCore/PatchDirections.h>

#include <algorithm>
#include <limits>

namespace knotwork
{
namespace
{
constexpr const char* InterfaceArray = "KnotworkInterfaces";
constexpr const char* PartArray = "KnotworkInterfaceParts";
constexpr const char* BoundaryArray = "KnotworkBoundary";
constexpr int InterfaceColumns = 6;
constexpr int PartColumns = 8;
// of version 1: sides count from 1, directions and senses as in PatchDirections
constexpr const char* OldInterfaceArray = "PatchInterfaces";
constexpr const char* OldBoundaryArray = "PatchBoundaries";
constexpr int OldInterfaceColumns = 10;

class Reader
{
public:
  Reader(vtkFieldData* data, const std::map<int, PatchPlace>& patches)
    : Data(data), Patches(patches)
  {
  }

  PatchTopology Read()
  {
    IntegerTable table;
    if (ReadIntegers(this->Data, InterfaceArray, InterfaceColumns, table))
    {
      ReadDoubles(this->Data, PartArray, this->Parts);
      this->ForEachRow(table, [&](std::size_t row) { return this->AddInterface(table, row); });
    }
    if (ReadIntegers(this->Data, OldInterfaceArray, OldInterfaceColumns, table))
    {
      this->ForEachRow(table, [&](std::size_t row) { return this->AddOldInterface(table, row); });
    }
    for (const int first : { 0, 1 }) // the number of the first side
    {
      if (ReadIntegers(this->Data, first == 0 ? BoundaryArray : OldBoundaryArray, 2, table))
      {
        this->ForEachRow(table,
          [&](std::size_t row)
          {
            PatchSide side;
            const bool found = this->FindSide(table, row, 0, first, side) > 0;
            if (found)
            {
              this->Topology.Boundary.push_back(side);
            }
            return found;
          });
      }
    }
    return std::move(this->Topology);
  }

  int Lost = 0; ///< rows

private:
  template <typename Add>
  void ForEachRow(const IntegerTable& table, Add&& add)
  {
    for (std::size_t row = 0; row < table.Rows(); ++row)
    {
      this->Lost += add(row) ? 0 : 1;
    }
  }

  static int Integer(const IntegerTable& table, std::size_t row, int column)
  {
    const std::int64_t value = table.At(row, column);
    const bool fits =
      value >= std::numeric_limits<int>::min() + 1 && value <= std::numeric_limits<int>::max();
    return fits ? static_cast<int>(value) : std::numeric_limits<int>::min();
  }

  /// The dimension of a side's patch; 0 when there is no such side.
  int FindSide(
    const IntegerTable& table, std::size_t row, int column, int firstSide, PatchSide& side) const
  {
    const auto found = this->Patches.find(Integer(table, row, column));
    const std::int64_t number = table.At(row, column + 1) - firstSide;
    if (found == this->Patches.end() || number < 0 || number >= 2 * found->second.Dimension)
    {
      return 0;
    }
    side = { found->second.Index, static_cast<int>(number) };
    return found->second.Dimension;
  }

  /// The dimension of both patches of an interface; 0 when there are no such sides.
  int FindSides(
    const IntegerTable& table, std::size_t row, int firstSide, PatchInterface& interface) const
  {
    const int dimension = this->FindSide(table, row, 0, firstSide, interface.Sides[0]);
    return this->FindSide(table, row, 2, firstSide, interface.Sides[1]) == dimension ? dimension
                                                                                     : 0;
  }

  bool AddInterface(const IntegerTable& table, std::size_t row)
  {
    PatchInterface made;
    made.Partial = table.At(row, 5) != 0;
    bool fits = true;
    if (made.Partial)
    {
      const Eigen::Index part = this->NextPart++;
      fits = this->Parts.cols() == PartColumns && part < this->Parts.rows() &&
        this->Parts.row(part).allFinite();
      for (Eigen::Index c = 0; fits && c < PartColumns; ++c)
      {
        ParametricBox<2>& box = made.Parts[static_cast<std::size_t>(c / 4)];
        (c % 4 < 2 ? box.Lower : box.Upper)[static_cast<std::size_t>(c % 2)] = this->Parts(part, c);
      }
    }
    const int dimension = this->FindSides(table, row, 0, made);
    const std::int64_t number = table.At(row, 4);
    fits = fits && dimension > 0 && number >= 0 &&
      number < static_cast<std::int64_t>(SideOrientations(dimension - 1).size());
    if (fits)
    {
      made.Orientation = SideOrientation::Make(static_cast<int>(number));
      this->Topology.Interfaces.push_back(made);
    }
    return fits;
  }

  bool AddOldInterface(const IntegerTable& table, std::size_t row)
  {
    PatchInterface made;
    const int dimension = this->FindSides(table, row, 1, made);
    PatchDirections along;
    for (int d = 0; d < dimension; ++d)
    {
      along.Direction[static_cast<std::size_t>(d)] = Integer(table, row, 4 + d);
      along.Sense[static_cast<std::size_t>(d)] = Integer(table, row, 7 + d);
    }
    const bool fits = dimension > 0 && SetDirections(along, dimension, made);
    if (fits)
    {
      this->Topology.Interfaces.push_back(made);
    }
    return fits;
  }

  vtkFieldData* Data;
  const std::map<int, PatchPlace>& Patches;
  PointMatrix Parts;
  Eigen::Index NextPart = 0;
  PatchTopology Topology;
};
}

bool WriteTopology(const PatchTopology& topology, vtkFieldData* fieldData)
{
  std::vector<std::int64_t> interfaces, boundary;
  std::vector<double> parts;
  for (const PatchInterface& row : topology.Interfaces)
  {
    interfaces.insert(interfaces.end(),
      { row.Sides[0].Patch, row.Sides[0].Side, row.Sides[1].Patch, row.Sides[1].Side,
        row.Orientation.Number(), row.Partial });
    for (std::size_t i = 0; row.Partial && i < 2; ++i)
    {
      parts.insert(parts.end(), row.Parts[i].Lower.begin(), row.Parts[i].Lower.end());
      parts.insert(parts.end(), row.Parts[i].Upper.begin(), row.Parts[i].Upper.end());
    }
  }
  for (const PatchSide& side : topology.Boundary)
  {
    boundary.insert(boundary.end(), { side.Patch, side.Side });
  }
  if (!interfaces.empty())
  {
    const char* const names[] = { "PatchA", "SideA", "PatchB", "SideB", "Orientation", "Partial" };
    WriteIntegers(fieldData, InterfaceArray, InterfaceColumns, interfaces, names);
  }
  if (!parts.empty())
  {
    WriteDoubles(fieldData, PartArray, PartColumns, parts);
  }
  if (!boundary.empty())
  {
    const char* const names[] = { "PatchId", "Side" };
    WriteIntegers(fieldData, BoundaryArray, 2, boundary, names);
  }
  return !interfaces.empty() || !boundary.empty();
}

PatchTopology ReadTopology(
  vtkFieldData* fieldData, const std::map<int, PatchPlace>& patches, int& lost)
{
  Reader reader(fieldData, patches);
  PatchTopology topology = reader.Read();
  lost = reader.Lost;
  return topology;
}
}
