// SPDX-License-Identifier: BSD-3-Clause
#include "HierarchicalSpace.h"

#include "Hierarchy.h"
#include "LRSpace.h"

#include <algorithm>
#include <limits>
#include <string>

namespace knotwork
{
namespace
{
template <int Dim>
std::string Describe(const HierarchyBox<Dim>& box)
{
  std::string text = "[";
  for (std::size_t d = 0; d < Dim; ++d)
  {
    text += (d > 0 ? ", " : "") + std::to_string(box.Lower[d]) + ":" + std::to_string(box.Upper[d]);
  }
  return text + ") of level " + std::to_string(box.Level);
}

/// InvalidTopology unless the box is a box of an existing level's grid.
template <int Dim>
Status CheckBox(const HierarchyBox<Dim>& box, const LevelIndex<Dim>& shape, std::size_t number)
{
  bool fits = box.Level >= 1 && box.Level <= MaxHierarchyLevel;
  for (std::size_t d = 0; fits && d < Dim; ++d)
  {
    fits =
      box.Lower[d] >= 0 && box.Lower[d] <= box.Upper[d] && box.Upper[d] <= shape[d] << box.Level;
  }
  if (!fits)
  {
    return { ErrorCode::InvalidTopology,
      "box " + std::to_string(number) + " is " + Describe(box) +
        "; levels are 1 to 24, cells count from 0, and level l has 2^l cells a direction in every "
        "knot span" };
  }
  return {};
}

Status TooManyCells()
{
  return { ErrorCode::TooLarge, "a hierarchical space has at most 2^31 - 1 cells" };
}

Status CheckParams(const RefinementParams& params)
{
  if (params.Extension < 0)
  {
    return { ErrorCode::InvalidParameter,
      "the extension is " + std::to_string(params.Extension) + " cells; it must not be negative" };
  }
  if (params.AdmissibleClass != 0 && params.AdmissibleClass < 2)
  {
    return { ErrorCode::InvalidParameter,
      "the admissible class is " + std::to_string(params.AdmissibleClass) +
        "; it must be 0 (no grading) or at least 2" };
  }
  if (params.MaxLevel < 0 || params.MaxLevel > MaxHierarchyLevel)
  {
    return { ErrorCode::InvalidParameter,
      "the maximum level is " + std::to_string(params.MaxLevel) + "; it must be in [0, 24]" };
  }
  return {};
}

/// Errors of a space that cannot be refined.
template <int Dim>
Status CheckSpace(const SplineSpacePtr<Dim>& space)
{
  if (!space)
  {
    return { ErrorCode::EmptyInput, "there is no space to refine" };
  }
  if (space->Kind != SpaceKind::Tensor && space->Kind != SpaceKind::Hierarchical)
  {
    return { ErrorCode::DimensionMismatch,
      "only tensor-product and hierarchical spaces can be refined by levels" };
  }
  return {};
}

/// Refines a box that is grown by the extension, clipped to the domain and cut off at MaxLevel.
template <int Dim>
bool RefineGrownBox(
  RefinementTree<Dim>& tree, HierarchyBox<Dim> box, const RefinementParams& params)
{
  for (std::size_t d = 0; d < Dim; ++d)
  {
    if (box.Lower[d] >= box.Upper[d])
    {
      return true;
    }
    box.Lower[d] = std::max<std::int64_t>(box.Lower[d] - params.Extension, 0);
    box.Upper[d] = std::min(box.Upper[d] + params.Extension, tree.Shape()[d] << box.Level);
  }
  for (; box.Level > params.MaxLevel; --box.Level)
  {
    for (std::size_t d = 0; d < Dim; ++d)
    {
      box.Lower[d] >>= 1;
      box.Upper[d] = (box.Upper[d] + 1) >> 1;
    }
  }
  return box.Level < 1 || tree.RefineBox(box.Level, box.Lower, box.Upper);
}

/// Grades the tree: the functions of level k = l - m + 2 alive on a refined cell of level l must be
/// inside Omega^k, so that nothing coarser than k is left on the cell's children. Going from fine
/// to coarse levels meets every cell that the grading itself refines. This is the closure under
/// the neighbourhoods of Buffa & Giannelli, for any tree.
/// @source  Buffa, Giannelli, M3AS 26 (2016) 1-25, definitions of S(Q, k) and N(Q, m).
template <int Dim>
bool GradeTree(
  RefinementTree<Dim>& tree, const std::vector<DyadicKnots>& knots, int admissibleClass)
{
  for (int level = MaxHierarchyLevel; level >= admissibleClass - 1; --level)
  {
    const int coarse = level - admissibleClass + 2;
    std::vector<LevelIndex<Dim>> ancestors;
    tree.ForEachCell(
      [&](int l, const LevelIndex<Dim>& cell, bool isRefined)
      {
        if (l != level || !isRefined)
        {
          return;
        }
        LevelIndex<Dim> ancestor;
        for (std::size_t d = 0; d < Dim; ++d)
        {
          ancestor[d] = cell[d] >> (level - coarse);
        }
        if (ancestors.empty() || ancestors.back() != ancestor)
        {
          ancestors.push_back(ancestor);
        }
      });
    for (const LevelIndex<Dim>& ancestor : ancestors)
    {
      LevelIndex<Dim> lower, upper;
      for (std::size_t d = 0; d < Dim; ++d)
      {
        const std::int64_t first = knots[d].FirstFunction(coarse, ancestor[d]);
        lower[d] = knots[d].Support(coarse, first).First;
        upper[d] = knots[d].Support(coarse, first + knots[d].Degree()).Last + 1;
      }
      if (!tree.RefineBox(coarse, lower, upper))
      {
        return false;
      }
    }
  }
  return true;
}

/// Grades the tree if asked to and makes its space, or gives the old one if nothing has changed.
template <int Dim>
Result<SplineSpacePtr<Dim>> FinishRefinement(
  const SplineSpacePtr<Dim>& space, RefinementTree<Dim>& tree, const RefinementParams& params)
{
  if (params.AdmissibleClass >= 2 &&
    !GradeTree(tree, MakeDyadicKnots<Dim>(space->Knots), params.AdmissibleClass))
  {
    return TooManyCells();
  }
  return tree.IsChanged() ? MakeSpaceOfTree<Dim>(space->Knots, tree) : space;
}
}

template <int Dim>
Result<SplineSpacePtr<Dim>> MakeHierarchicalSpace(
  const std::array<KnotVector, Dim>& knots, const std::vector<HierarchyBox<Dim>>& boxes)
{
  double roots = 1.0;
  for (const KnotVector& k : knots)
  {
    roots *= k.NumElements();
  }
  if (roots > std::numeric_limits<int>::max())
  {
    return TooManyCells();
  }
  RefinementTree<Dim> tree(knots);
  for (std::size_t i = 0; i < boxes.size(); ++i)
  {
    if (const Status status = CheckBox<Dim>(boxes[i], tree.Shape(), i); !status)
    {
      return status;
    }
  }
  for (const HierarchyBox<Dim>& box : boxes)
  {
    if (!tree.RefineBox(box.Level, box.Lower, box.Upper))
    {
      return TooManyCells();
    }
  }
  return MakeSpaceOfTree<Dim>(knots, tree);
}

template <int Dim>
std::vector<HierarchyBox<Dim>> HierarchyBoxes(const SplineSpace<Dim>& space)
{
  if (space.Kind != SpaceKind::Hierarchical)
  {
    return {};
  }
  // Refined cells as boxes of one cell, then merged in one direction after the other: boxes that
  // agree in all other directions and touch in this one.
  std::vector<HierarchyBox<Dim>> boxes;
  RefinementTree<Dim>(space).ForEachCell(
    [&](int level, const LevelIndex<Dim>& cell, bool isRefined)
    {
      if (isRefined)
      {
        HierarchyBox<Dim> box;
        box.Level = level + 1;
        for (std::size_t d = 0; d < Dim; ++d)
        {
          box.Lower[d] = 2 * cell[d];
          box.Upper[d] = 2 * cell[d] + 2;
        }
        boxes.push_back(box);
      }
    });
  for (std::size_t merged = 0; merged < Dim; ++merged)
  {
    // Everything that must agree, then the place in the merged direction.
    const auto key = [merged](const HierarchyBox<Dim>& box)
    {
      std::array<std::int64_t, 2 * Dim + 2> k{ box.Level };
      for (std::size_t d = 0; d < Dim; ++d)
      {
        k[2 * (Dim - d) - 1] = d == merged ? 0 : box.Lower[d];
        k[2 * (Dim - d)] = d == merged ? 0 : box.Upper[d];
      }
      k[2 * Dim + 1] = box.Lower[merged];
      return k;
    };
    std::sort(boxes.begin(), boxes.end(),
      [&](const HierarchyBox<Dim>& a, const HierarchyBox<Dim>& b) { return key(a) < key(b); });
    std::vector<HierarchyBox<Dim>> result;
    for (const HierarchyBox<Dim>& box : boxes)
    {
      if (!result.empty())
      {
        HierarchyBox<Dim> joined = result.back();
        joined.Lower[merged] = joined.Upper[merged];
        if (key(joined) == key(box))
        {
          result.back().Upper[merged] = box.Upper[merged];
          continue;
        }
      }
      result.push_back(box);
    }
    boxes = std::move(result);
  }
  return boxes;
}

template <int Dim>
Result<SplineSpacePtr<Dim>> RefineElements(const SplineSpacePtr<Dim>& space,
  const std::vector<int>& elements, const RefinementParams& params)
{
  Status status = CheckSpace(space);
  status = status ? CheckParams(params) : status;
  if (!status)
  {
    return status;
  }
  std::vector<char> isMarked(space->Elements.size(), 0);
  for (int e : elements)
  {
    if (e < 0 || e >= space->NumElements())
    {
      return { ErrorCode::InvalidParameter,
        "element " + std::to_string(e) + " does not exist; the space has " +
          std::to_string(space->NumElements()) + " elements" };
    }
    isMarked[static_cast<std::size_t>(e)] = 1;
  }
  // The order of the elements is the order of the leaves in both families.
  const RefinementTree<Dim> old(*space);
  RefinementTree<Dim> tree = old;
  std::size_t element = 0;
  bool fits = true;
  old.ForEachCell(
    [&](int level, const LevelIndex<Dim>& cell, bool isRefined)
    {
      if (isRefined || !isMarked[element++] || level >= params.MaxLevel || !fits)
      {
        return;
      }
      HierarchyBox<Dim> box;
      box.Level = level + 1;
      for (std::size_t d = 0; d < Dim; ++d)
      {
        box.Lower[d] = 2 * cell[d];
        box.Upper[d] = 2 * cell[d] + 2;
      }
      fits = RefineGrownBox(tree, box, params);
    });
  if (!fits)
  {
    return TooManyCells();
  }
  return FinishRefinement(space, tree, params);
}

template <int Dim>
Result<SplineSpacePtr<Dim>> RefineBoxes(const SplineSpacePtr<Dim>& space,
  const std::vector<HierarchyBox<Dim>>& boxes, const RefinementParams& params)
{
  Status status = CheckSpace(space);
  status = status ? CheckParams(params) : status;
  if (!status)
  {
    return status;
  }
  RefinementTree<Dim> tree(*space);
  for (std::size_t i = 0; i < boxes.size(); ++i)
  {
    status = CheckBox<Dim>(boxes[i], tree.Shape(), i);
    if (!status)
    {
      return status;
    }
    if (!RefineGrownBox(tree, boxes[i], params))
    {
      return TooManyCells();
    }
  }
  return FinishRefinement(space, tree, params);
}

#define KNOTWORK_INSTANTIATE(Dim)                                                                  \
  template Result<SplineSpacePtr<Dim>> MakeHierarchicalSpace<Dim>(                                 \
    const std::array<KnotVector, Dim>&, const std::vector<HierarchyBox<Dim>>&);                    \
  template std::vector<HierarchyBox<Dim>> HierarchyBoxes<Dim>(const SplineSpace<Dim>&);            \
  template Result<SplineSpacePtr<Dim>> RefineElements<Dim>(                                        \
    const SplineSpacePtr<Dim>&, const std::vector<int>&, const RefinementParams&);                 \
  template Result<SplineSpacePtr<Dim>> RefineBoxes<Dim>(                                           \
    const SplineSpacePtr<Dim>&, const std::vector<HierarchyBox<Dim>>&, const RefinementParams&);
KNOTWORK_INSTANTIATE(1)
KNOTWORK_INSTANTIATE(2)
KNOTWORK_INSTANTIATE(3)
#undef KNOTWORK_INSTANTIATE
}
