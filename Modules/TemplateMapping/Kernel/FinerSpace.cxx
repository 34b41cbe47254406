// SPDX-License-Identifier: BSD-3-Clause
#include "FinerSpace.h"

#include <knotwork/SplineCore/HierarchicalSpace.h>

#include <cmath>
#include <numeric>
#include <set>

namespace knotwork
{
namespace
{
/// Index of an element among the cells of its level.
template <int Dim>
std::array<std::int64_t, Dim> LevelCell(const SplineSpace<Dim>& space, int e)
{
  const auto& element = space.Elements[static_cast<std::size_t>(e)];
  std::array<std::int64_t, Dim> cell;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    const KnotVector& knots = space.Knots[d];
    const double lower = element.Box.Lower[d];
    const int root = knots.FindElement(0.5 * (lower + element.Box.Upper[d]));
    const double begin = knots.Breaks()[static_cast<std::size_t>(root)];
    const double end = knots.Breaks()[static_cast<std::size_t>(root) + 1];
    const std::int64_t parts = std::int64_t(1) << element.Level;
    cell[d] = root * parts + std::llround((lower - begin) / (end - begin) * double(parts));
  }
  return cell;
}
}

template <int Dim>
Result<SplineSpacePtr<Dim>> RefineAround(
  const SplineSpacePtr<Dim>& space, const PointMatrix& points, int extension, int maxLevel)
{
  std::set<std::pair<int, std::array<std::int64_t, Dim>>> marked;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    double local[Dim];
    const int e = space->Locate(points.row(i).data(), local);
    const int level = space->Elements[static_cast<std::size_t>(e)].Level;
    if (level >= maxLevel)
    {
      continue;
    }
    std::array<std::int64_t, Dim> cell = LevelCell(*space, e);
    for (std::size_t d = 0; d < Dim; ++d)
    {
      cell[d] = 2 * cell[d] + (local[d] >= 0.5 ? 1 : 0);
    }
    marked.insert({ level + 1, cell });
  }
  if (marked.empty())
  {
    return space;
  }
  std::vector<HierarchyBox<Dim>> boxes;
  for (const auto& [level, cell] : marked)
  {
    HierarchyBox<Dim> box;
    box.Level = level;
    box.Lower = cell;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      box.Upper[d] = cell[d] + 1;
    }
    boxes.push_back(box);
  }
  RefinementParams params;
  params.Extension = extension;
  params.MaxLevel = maxLevel;
  return RefineBoxes(space, boxes, params);
}

template <int Dim>
Result<SplineSpacePtr<Dim>> RefineHeld(
  const SplineSpacePtr<Dim>& space, const std::vector<int>& elements, int extension, int maxLevel)
{
  std::vector<int> marked;
  for (const int e : elements)
  {
    if (space->Elements[static_cast<std::size_t>(e)].Level < maxLevel)
    {
      marked.push_back(e);
    }
  }
  if (marked.empty())
  {
    return space;
  }
  RefinementParams params;
  params.Extension = extension;
  params.MaxLevel = maxLevel;
  return RefineElements(space, marked, params);
}

template <int Dim>
Result<SplineSpacePtr<Dim>> RefineEverywhere(const SplineSpacePtr<Dim>& space, int maxLevel)
{
  std::vector<int> all(space->Elements.size());
  std::iota(all.begin(), all.end(), 0);
  RefinementParams params;
  params.MaxLevel = maxLevel;
  return RefineElements(space, all, params);
}

template Result<SplineSpacePtr<2>> RefineAround(
  const SplineSpacePtr<2>&, const PointMatrix&, int, int);
template Result<SplineSpacePtr<3>> RefineAround(
  const SplineSpacePtr<3>&, const PointMatrix&, int, int);
template Result<SplineSpacePtr<2>> RefineHeld(
  const SplineSpacePtr<2>&, const std::vector<int>&, int, int);
template Result<SplineSpacePtr<3>> RefineHeld(
  const SplineSpacePtr<3>&, const std::vector<int>&, int, int);
template Result<SplineSpacePtr<2>> RefineEverywhere(const SplineSpacePtr<2>&, int);
template Result<SplineSpacePtr<3>> RefineEverywhere(const SplineSpacePtr<3>&, int);
}
