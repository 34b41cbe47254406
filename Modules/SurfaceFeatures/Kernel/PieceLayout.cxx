// SPDX-License-Identifier: BSD-3-Clause
#include "PieceLayout.h"

#include <knotwork/SplineCore/PatchSides.h>

#include <algorithm>
#include <map>
#include <set>

namespace knotwork
{
namespace
{
using Ids = std::vector<int>;

/// Control points of a side along the other direction. Sides as in PieceJoin.
Ids SideIds(const SplineSpace<2>& space, int e, int side)
{
  const IntArray<2>& degree = space.Elements[static_cast<std::size_t>(e)].Degree;
  const int* ids = space.LocalFunctions(e);
  Ids result;
  for (const int i : EntityIndices<2>({ degree[0] + 1, degree[1] + 1 }, EntityOfSide<2>(side)))
  {
    result.push_back(ids[i]);
  }
  return result;
}

struct ElementSide
{
  int Element = 0;
  int Side = 0;
};

class Placer
{
public:
  explicit Placer(const SplineSpace<2>& space)
    : Space(space), Placed(space.Elements.size()), IsPlaced(space.Elements.size(), false)
  {
    for (int e = 0; e < space.NumElements(); ++e)
    {
      for (int side = 0; side < 4; ++side)
      {
        this->Sides[Key(SideIds(space, e, side))].push_back({ e, side });
      }
    }
  }

  Status Place()
  {
    for (int e = 0; e < this->Space.NumElements(); ++e)
    {
      if (this->IsPlaced[static_cast<std::size_t>(e)])
      {
        continue;
      }
      const std::size_t first = this->Order.size();
      this->Cells.clear();
      if (!this->Put(e, {}))
      {
        return this->Fold(e);
      }
      for (std::size_t k = first; k < this->Order.size(); ++k)
      {
        for (int side = 0; side < 4; ++side)
        {
          const Status status = this->Across(this->Order[k], side);
          if (!status)
          {
            return status;
          }
        }
      }
      this->MoveRight(first);
    }
    return {};
  }

  const SplineSpace<2>& Space;
  std::vector<PlacedElement> Placed;

private:
  static Ids Key(const Ids& ids)
  {
    Ids reversed(ids.rbegin(), ids.rend());
    return std::min(ids, reversed);
  }

  static Status Fold(int element)
  {
    return { ErrorCode::InvalidTopology,
      "element " + std::to_string(element) +
        ": the Bezier elements cannot be laid out in a plane (they close, or other than four meet "
        "at a corner); give a spline with a parameter domain, or its parts one by one" };
  }

  bool Put(int e, const PlacedElement& at)
  {
    if (!this->Cells.insert({ at.Cell[0], at.Cell[1] }).second)
    {
      return false;
    }
    this->Placed[static_cast<std::size_t>(e)] = at;
    this->IsPlaced[static_cast<std::size_t>(e)] = true;
    this->Order.push_back(e);
    return true;
  }

  /// Places the neighbour of element e across its own side, or compares.
  Status Across(int e, int side)
  {
    const Ids ids = SideIds(this->Space, e, side);
    if (std::all_of(ids.begin(), ids.end(), [&](int id) { return id == ids.front(); }))
    {
      return {};
    }
    const std::vector<ElementSide>& both = this->Sides[Key(ids)];
    if (both.size() == 1)
    {
      return {};
    }
    if (both.size() > 2 || both[0].Element == both[1].Element)
    {
      return Fold(e);
    }
    const ElementSide& other = both[0].Element == e ? both[1] : both[0];
    const PlacedElement& mine = this->Placed[static_cast<std::size_t>(e)];
    const auto a = static_cast<std::size_t>(side / 2);
    const auto b = static_cast<std::size_t>(other.Side / 2);
    const int normal = mine.Axis[a];
    const bool upper = (side % 2 == 1) != mine.Reversed[a];
    PlacedElement next;
    next.Cell = mine.Cell;
    next.Cell[static_cast<std::size_t>(normal)] += upper ? 1 : -1;
    next.Axis[b] = normal;
    next.Axis[1 - b] = 1 - normal;
    // the neighbour touches with its lower end where mine is the upper one
    next.Reversed[b] = (other.Side % 2 == 1) == upper;
    const bool sameWay = SideIds(this->Space, other.Element, other.Side) == ids;
    next.Reversed[1 - b] = sameWay == mine.Reversed[1 - a];
    if (this->IsPlaced[static_cast<std::size_t>(other.Element)])
    {
      const PlacedElement& there = this->Placed[static_cast<std::size_t>(other.Element)];
      const bool same =
        there.Cell == next.Cell && there.Axis == next.Axis && there.Reversed == next.Reversed;
      return same ? Status{} : Fold(e);
    }
    return this->Put(other.Element, next) ? Status{} : Fold(other.Element);
  }

  /// Moves what was placed last beyond everything before it.
  void MoveRight(std::size_t first)
  {
    int low = 0;
    int high = 0;
    for (std::size_t k = first; k < this->Order.size(); ++k)
    {
      const int x = this->Placed[static_cast<std::size_t>(this->Order[k])].Cell[0];
      low = std::min(low, x);
      high = std::max(high, x);
    }
    for (std::size_t k = first; k < this->Order.size(); ++k)
    {
      this->Placed[static_cast<std::size_t>(this->Order[k])].Cell[0] += this->NextColumn - low;
    }
    this->NextColumn += high - low + 2;
  }

  std::map<Ids, std::vector<ElementSide>> Sides;
  std::vector<bool> IsPlaced;
  std::vector<int> Order;
  std::set<std::pair<int, int>> Cells; ///< of the part in work
  int NextColumn = 0;
};
}

Result<std::vector<PlacedElement>> PlaceElements(const SplineSpace<2>& space)
{
  Placer placer(space);
  const Status status = placer.Place();
  if (!status)
  {
    return status;
  }
  return std::move(placer.Placed);
}
}
