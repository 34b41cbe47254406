// SPDX-License-Identifier: BSD-3-Clause
#include "GismoHierarchy.h"

#include <algorithm>
#include <set>
#include <string>
#include <tuple>

namespace knotwork
{
namespace
{
constexpr int MaxLevel = 24;

template <int Dim>
using Cell = std::array<std::int64_t, Dim>;

template <int Dim>
double NumCells(const HierarchyBox<Dim>& box)
{
  double cells = 1.0;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    cells *= static_cast<double>(box.Upper[d] - box.Lower[d]);
  }
  return cells;
}

/// The smallest box of the level before that holds a box.
template <int Dim>
HierarchyBox<Dim> Parent(const HierarchyBox<Dim>& box)
{
  HierarchyBox<Dim> parent;
  parent.Level = box.Level - 1;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    parent.Lower[d] = box.Lower[d] >> 1;
    parent.Upper[d] = (box.Upper[d] + 1) >> 1;
  }
  return parent;
}

template <int Dim>
std::string Describe(const HierarchyBox<Dim>& box)
{
  std::string text = "box";
  for (const auto* corner : { &box.Lower, &box.Upper })
  {
    for (std::int64_t index : *corner)
    {
      text += " " + std::to_string(index);
    }
  }
  return text + " of level " + std::to_string(box.Level);
}

/// InvalidTopology unless the box lies in its level's grid.
template <int Dim>
Status CheckBox(const std::array<KnotVector, Dim>& knots, const HierarchyBox<Dim>& box)
{
  bool fits = box.Level >= 0 && box.Level <= MaxLevel;
  for (std::size_t d = 0; fits && d < Dim; ++d)
  {
    const std::int64_t cells = static_cast<std::int64_t>(knots[d].NumElements()) << box.Level;
    fits = box.Lower[d] >= 0 && box.Lower[d] <= box.Upper[d] && box.Upper[d] <= cells;
  }
  if (!fits)
  {
    return { ErrorCode::InvalidTopology,
      Describe(box) +
        " does not lie in the mesh; levels are 0 to 24, and level l has 2^l elements a parameter "
        "in "
        "every knot span" };
  }
  return {};
}

/// TooLarge when refining the boxes may make more cells of all levels than a number. Boxes that
/// overlap count each, equal ancestors once.
template <int Dim>
Status CheckNumCells(const std::array<KnotVector, Dim>& knots,
  const std::vector<HierarchyBox<Dim>>& boxes, double maxCells)
{
  double cells = 1.0;
  for (const KnotVector& k : knots)
  {
    cells *= k.NumElements();
  }
  std::set<std::array<std::int64_t, 2 * Dim + 1>> counted;
  for (HierarchyBox<Dim> box : boxes)
  {
    for (; box.Level > 0 && cells <= maxCells; box = Parent(box))
    {
      std::array<std::int64_t, 2 * Dim + 1> key{ box.Level };
      std::copy(box.Lower.begin(), box.Lower.end(), key.begin() + 1);
      std::copy(box.Upper.begin(), box.Upper.end(), key.begin() + 1 + Dim);
      if (!counted.insert(key).second)
      {
        break;
      }
      // whole parents are split
      cells += NumCells(Parent(box)) * (1 << Dim);
    }
  }
  if (cells > maxCells)
  {
    return { ErrorCode::TooLarge,
      "the boxes have more cells than a file of this size can have coefficients for" };
  }
  return {};
}

/// Every element of a level > 0 must lie in a box of this level.
template <int Dim>
Status CheckCovered(const SplineSpace<Dim>& space, const std::vector<HierarchyBox<Dim>>& boxes)
{
  std::vector<char> covered(space.Elements.size(), 0);
  for (const HierarchyBox<Dim>& box : boxes)
  {
    if (box.Level == 0 || NumCells(box) == 0.0)
    {
      continue;
    }
    Cell<Dim> cell = box.Lower;
    bool more = true;
    while (more)
    {
      std::int64_t root = 0;
      for (std::size_t d = Dim; d-- > 0;)
      {
        root = root * space.Knots[d].NumElements() + (cell[d] >> box.Level);
      }
      int node = space.RootCells[static_cast<std::size_t>(root)];
      int level = 0;
      for (; node < 0 && level < box.Level; ++level)
      {
        std::size_t child = 0;
        for (std::size_t d = 0; d < Dim; ++d)
        {
          child |= static_cast<std::size_t>(cell[d] >> (box.Level - level - 1) & 1) << d;
        }
        node = space.Tree[static_cast<std::size_t>(-1 - node) * (1U << Dim) + child];
      }
      if (node >= 0 && level == box.Level)
      {
        covered[static_cast<std::size_t>(node)] = 1;
      }
      more = false;
      for (std::size_t d = 0; d < Dim && !more; ++d)
      {
        more = ++cell[d] < box.Upper[d];
        cell[d] = more ? cell[d] : box.Lower[d];
      }
    }
  }
  for (std::size_t e = 0; e < covered.size(); ++e)
  {
    const auto& element = space.Elements[e];
    if (element.Level > 0 && covered[e] == 0)
    {
      return { ErrorCode::InvalidTopology,
        "the boxes of level " + std::to_string(element.Level) +
          " and above end inside an element of level " + std::to_string(element.Level - 1) +
          "; let them cover whole elements of the level before" };
    }
  }
  return {};
}
}

template <int Dim>
Result<SplineSpacePtr<Dim>> MakeGismoSpace(const std::array<KnotVector, Dim>& knots,
  std::vector<HierarchyBox<Dim>> boxes, double maxLocalFunctions)
{
  int functions = 1;
  for (const KnotVector& k : knots)
  {
    functions *= k.Degree() + 1;
  }
  for (const HierarchyBox<Dim>& box : boxes)
  {
    if (Status status = CheckBox<Dim>(knots, box); !status)
    {
      return status;
    }
  }
  const auto isVoid = [](const HierarchyBox<Dim>& box)
  { return box.Level == 0 || NumCells(box) == 0.0; };
  boxes.erase(std::remove_if(boxes.begin(), boxes.end(), isVoid), boxes.end());
  // one of each: the work below is that of the boxes' cells
  const auto key = [](const HierarchyBox<Dim>& box)
  { return std::tie(box.Level, box.Lower, box.Upper); };
  std::sort(boxes.begin(), boxes.end(),
    [&](const HierarchyBox<Dim>& a, const HierarchyBox<Dim>& b) { return key(a) < key(b); });
  boxes.erase(
    std::unique(boxes.begin(), boxes.end(),
      [&](const HierarchyBox<Dim>& a, const HierarchyBox<Dim>& b) { return key(a) == key(b); }),
    boxes.end());
  if (Status status = CheckNumCells<Dim>(knots, boxes, maxLocalFunctions / functions); !status)
  {
    return status;
  }
  Result<SplineSpacePtr<Dim>> space = MakeHierarchicalSpace<Dim>(knots, boxes);
  if (space)
  {
    if (Status status = CheckCovered(*space.Value, boxes); !status)
    {
      return status;
    }
  }
  return space;
}

#define KNOTWORK_INSTANTIATE(Dim)                                                                  \
  template Result<SplineSpacePtr<Dim>> MakeGismoSpace<Dim>(                                        \
    const std::array<KnotVector, Dim>&, std::vector<HierarchyBox<Dim>>, double);
KNOTWORK_INSTANTIATE(1)
KNOTWORK_INSTANTIATE(2)
KNOTWORK_INSTANTIATE(3)
#undef KNOTWORK_INSTANTIATE
}
