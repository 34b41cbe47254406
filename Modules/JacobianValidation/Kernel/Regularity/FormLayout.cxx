// SPDX-License-Identifier: BSD-3-Clause
#include "FormLayout.h"

#include <knotwork/SplineCore/Bernstein.h>

#include <algorithm>

namespace knotwork
{
namespace
{
struct GroupTable
{
  int NumGroups;
  int Slots[3];     // of each group
  int Direction[3]; // first parameter of each group
};
constexpr GroupTable Groups[NumCellShapes] = {
  { 1, { 2, 0, 0 }, { 0, 0, 0 } }, // Curve
  { 2, { 2, 2, 0 }, { 0, 1, 0 } }, // Quadrilateral
  { 3, { 2, 2, 2 }, { 0, 1, 2 } }, // Hexahedron
  { 1, { 3, 0, 0 }, { 0, 0, 0 } }, // Triangle
  { 1, { 4, 0, 0 }, { 0, 0, 0 } }, // Tetrahedron
  { 2, { 3, 2, 0 }, { 0, 2, 0 } }, // Wedge
};

bool IsInside(CellShape shape, const CellDegree& degree, int i, int j, int k)
{
  switch (shape)
  {
    case CellShape::Triangle:
      return i + j <= degree[0] && k == 0;
    case CellShape::Tetrahedron:
      return i + j + k <= degree[0];
    case CellShape::Wedge:
      return i + j <= degree[0] && k <= degree[2];
    default:
      return i <= degree[0] && j <= degree[1] && k <= degree[2];
  }
}

std::unique_ptr<FormLayout> MakeLayout(CellShape shape, const CellDegree& degree)
{
  auto layout = std::make_unique<FormLayout>();
  layout->Shape = shape;
  layout->Degree = degree;
  layout->Size = NumCellCoefficients(shape, degree);
  const GroupTable& table = Groups[static_cast<int>(shape)];
  layout->NumGroups = table.NumGroups;

  for (int k = 0; k <= degree[2]; ++k)
  {
    for (int j = 0; j <= degree[1]; ++j)
    {
      int length = 0;
      while (IsInside(shape, degree, length, j, k))
      {
        const int index[3] = { length, j, k };
        SlotExponents exponents{};
        double multinomial = 1.0;
        int slot = 0;
        for (int g = 0; g < table.NumGroups; ++g)
        {
          int left = degree[static_cast<std::size_t>(table.Direction[g])];
          for (int s = 1; s < table.Slots[g]; ++s)
          {
            const int e = index[table.Direction[g] + s - 1];
            multinomial *= Binomial(left, e);
            left -= e;
            exponents[static_cast<std::size_t>(slot + s)] = static_cast<std::uint8_t>(e);
          }
          exponents[static_cast<std::size_t>(slot)] = static_cast<std::uint8_t>(left);
          slot += table.Slots[g];
        }
        layout->NumSlots = slot;
        layout->Exponents.push_back(exponents);
        layout->Multinomials.push_back(multinomial);
        ++length;
      }
      if (length > 0)
      {
        const int start = static_cast<int>(layout->Exponents.size()) - length;
        layout->Rows.push_back({ j, k, start, length });
      }
    }
  }
  const double largest =
    *std::max_element(layout->Multinomials.begin(), layout->Multinomials.end());
  layout->MultinomialRoundings = largest < 0x1p53 ? 0 : 4;

  int slot = 0;
  for (int g = 0; g < table.NumGroups; ++g)
  {
    for (int s = 0; s < table.Slots[g]; ++s)
    {
      layout->GroupMasks[static_cast<std::size_t>(g)] |= static_cast<std::uint8_t>(1 << (slot + s));
    }
    for (int b = slot + 1; b < slot + table.Slots[g]; ++b)
    {
      for (int a = slot; a < b; ++a)
      {
        FormLayout::Edge edge;
        edge.From = a;
        edge.To = b;
        std::map<SlotExponents, std::vector<int>> lines; // by what is the same along them
        for (int i = 0; i < layout->Size; ++i)
        {
          SlotExponents key = layout->Exponents[static_cast<std::size_t>(i)];
          key[static_cast<std::size_t>(a)] = 0;
          key[static_cast<std::size_t>(b)] = 0;
          lines[key].push_back(i);
        }
        for (auto& [key, indices] : lines)
        {
          std::sort(indices.begin(), indices.end(),
            [&](int x, int y)
            {
              return layout->Exponents[static_cast<std::size_t>(x)][static_cast<std::size_t>(b)] <
                layout->Exponents[static_cast<std::size_t>(y)][static_cast<std::size_t>(b)];
            });
          edge.Lines.push_back(
            { static_cast<int>(edge.LineIndices.size()), static_cast<int>(indices.size()) });
          edge.LineIndices.insert(edge.LineIndices.end(), indices.begin(), indices.end());
        }
        layout->Edges.push_back(std::move(edge));
      }
    }
    slot += table.Slots[g];
  }

  for (int c = 0; c < NumCorners(shape); ++c)
  {
    const auto u = CornerParameters(shape, c);
    const int corner = layout->Index(static_cast<int>(u[0]) * degree[0],
      static_cast<int>(u[1]) * degree[1], static_cast<int>(u[2]) * degree[2]);
    layout->Corners.push_back(corner);
    // a slot vanishes at the corner unless it is its group's one that is 1 there
    std::uint8_t mask = 0;
    int first = 0;
    for (int g = 0; g < table.NumGroups; ++g)
    {
      int one = 0;
      for (int s = 1; s < table.Slots[g]; ++s)
      {
        one = u[static_cast<std::size_t>(table.Direction[g] + s - 1)] == 1.0 ? s : one;
      }
      for (int s = 0; s < table.Slots[g]; ++s)
      {
        mask = static_cast<std::uint8_t>(mask | (s != one ? 1 << (first + s) : 0));
      }
      first += table.Slots[g];
    }
    layout->CornerMasks.push_back(mask);
  }
  return layout;
}
}

int GroupOfDirection(CellShape shape, int direction)
{
  const GroupTable& table = Groups[static_cast<int>(shape)];
  int group = 0;
  while (group + 1 < table.NumGroups && table.Direction[group + 1] <= direction)
  {
    ++group;
  }
  return group;
}

int SlotOfDirection(CellShape shape, int direction)
{
  const GroupTable& table = Groups[static_cast<int>(shape)];
  const int group = GroupOfDirection(shape, direction);
  int slot = 1 + direction - table.Direction[group];
  for (int g = 0; g < group; ++g)
  {
    slot += table.Slots[g];
  }
  return slot;
}

CellDegree ChangedDegree(CellShape shape, CellDegree degree, int direction, int change)
{
  const GroupTable& table = Groups[static_cast<int>(shape)];
  const int group = GroupOfDirection(shape, direction);
  for (int d = 0; d + 1 < table.Slots[group]; ++d)
  {
    degree[static_cast<std::size_t>(table.Direction[group] + d)] += change;
  }
  return degree;
}

const FormLayout& LayoutCache::Get(CellShape shape, const CellDegree& degree)
{
  auto& layout = this->Layouts[{ shape, degree }];
  if (!layout)
  {
    layout = MakeLayout(shape, degree);
  }
  return *layout;
}
}
