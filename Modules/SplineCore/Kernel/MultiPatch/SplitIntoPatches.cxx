// SPDX-License-Identifier: BSD-3-Clause
#include "SplitIntoPatches.h"

#include "BezierForm.h"
#include "PatchSpaces.h"
#include "Recovery.h"

#include <algorithm>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

template <int Dim>
Result<Spline<Dim>> PatchSpline(const BezierForm<Dim>& form, const UnstructuredData<Dim>& data,
  const MeshPatches<Dim>& layout, const MeshPatch<Dim>& patch, int threads)
{
  auto space = MakePatchSpace(data, layout, patch);
  if (!space)
  {
    return space.Status;
  }
  BezierForm<Dim> part;
  part.Space = std::move(space.Value);
  part.NumComponents = form.NumComponents;
  part.Rational = form.Rational;
  part.Offsets.assign(1, 0);
  for (const int cell : patch.Cells)
  {
    const std::size_t size = form.Offsets[At(cell) + 1] - form.Offsets[At(cell)];
    part.Data.resize(part.Offsets.back() + size);
    const std::vector<int> turned = TurnedEntries<Dim>(data.Degree + 1, layout.AheadOf[At(cell)]);
    const double* from = form.Block(cell);
    double* to = part.Data.data() + part.Offsets.back();
    for (int plane = 0; plane < form.NumPlanes(); ++plane, from += turned.size())
    {
      for (const int own : turned)
      {
        *to++ = from[own];
      }
    }
    part.Offsets.push_back(part.Data.size());
  }
  RecoveryResult<Dim> recovered = RecoverSpline(part, threads);
  return recovered ? Result<Spline<Dim>>(std::move(recovered.Value))
                   : Result<Spline<Dim>>(recovered.Status);
}

/// Direction of a patch out of a side of one of its cells, as a side of the patch.
template <int Dim>
int SideOfPatch(const MeshPatches<Dim>& layout, int cell, int side)
{
  for (int d = 0; d < Dim; ++d)
  {
    const int ahead = layout.AheadOf[At(cell)][At(d)];
    if (ahead / 2 == side / 2)
    {
      return 2 * d + (ahead == side ? 1 : 0);
    }
  }
  return -1;
}

/// How the side of the patch beyond lies on this one, at a facet.
template <int Dim>
SideOrientation OrientationAt(const UnstructuredData<Dim>& data, const MeshPatches<Dim>& layout,
  const SideFacet& at, const PatchSide& side)
{
  const auto own = SideDirections<Dim>(side.Side);
  const auto beyond = SideDirections<Dim>(at.Beyond.Side);
  const FacetCrossing<Dim>& crossing = data.Topology.Crossing(at.Facet.Cell, at.Facet.Side);
  SideOrientation orientation;
  for (std::size_t k = 0; k + 1 < Dim; ++k)
  {
    // where this patch's direction goes on in the cell beyond, as a direction of its patch
    const int image = crossing.Image[At(layout.AheadOf[At(at.Facet.Cell)][own[k]])];
    const int there = SideOfPatch(layout, at.Other.Cell, image);
    for (std::size_t j = 0; j + 1 < Dim; ++j)
    {
      if (beyond[j] == At(there / 2))
      {
        orientation.Axis[j] = static_cast<int>(k);
        orientation.Reversed[j] = there % 2 == 0;
      }
    }
  }
  return orientation;
}

/// Lower end of a cell in its patch along a direction, and its interval.
template <int Dim>
std::array<double, 2> SpanOf(
  const Spline<Dim>& patch, const MeshPatches<Dim>& layout, int cell, std::size_t direction)
{
  const std::vector<double>& breaks = patch.Space->Knots[direction].Breaks();
  const std::size_t i = At(layout.IndexOf[At(cell)][direction]);
  return { breaks[i], breaks[i + 1] };
}

/// Sides of a patch in the plane meet others along runs of facets.
void AddRuns(const UnstructuredData<2>& data, const MeshPatches<2>& layout, const PatchSide& side,
  const std::vector<SideFacet>& facets, MultiPatch<2>& result)
{
  for (std::size_t begin = 0, end = 0; begin < facets.size(); begin = end)
  {
    const SideFacet& first = facets[begin];
    const SideOrientation orientation = OrientationAt(data, layout, first, side);
    const int step = orientation.Reversed[0] ? -1 : 1;
    const std::size_t along = SideDirections<2>(first.Beyond.Side)[0];
    const auto place = [&](const SideFacet& at)
    { return layout.IndexOf[At(at.Other.Cell)][along]; };
    for (end = begin + 1; end < facets.size() && facets[end].Beyond == first.Beyond &&
         place(facets[end]) == place(facets[end - 1]) + step;
         ++end)
    {
    }
    if (!(side < first.Beyond) && !(side == first.Beyond && place(first) > static_cast<int>(begin)))
    {
      continue; // stated from the other side
    }
    PatchInterface interface;
    interface.Sides = { side, first.Beyond };
    interface.Orientation = orientation;
    interface.Partial = true;
    const SideFacet& last = facets[end - 1];
    const std::size_t own = SideDirections<2>(side.Side)[0];
    const Spline<2>& patch = result.Patches[At(side.Patch)];
    const Spline<2>& beyond = result.Patches[At(first.Beyond.Patch)];
    interface.Parts[0].Lower[0] = SpanOf(patch, layout, first.Facet.Cell, own)[0];
    interface.Parts[0].Upper[0] = SpanOf(patch, layout, last.Facet.Cell, own)[1];
    interface.Parts[1].Lower[0] =
      SpanOf(beyond, layout, (step > 0 ? first : last).Other.Cell, along)[0];
    interface.Parts[1].Upper[0] =
      SpanOf(beyond, layout, (step > 0 ? last : first).Other.Cell, along)[1];
    result.Topology.Interfaces.push_back(interface);
  }
}

template <int Dim>
void StateSides(
  const SplineSpace<Dim>& space, const MeshPatches<Dim>& layout, MultiPatch<Dim>& result)
{
  const UnstructuredData<Dim>& data = *space.Unstructured;
  const auto count = [&](const PatchSide& side)
  {
    int facets = 1;
    for (const std::size_t d : SideDirections<Dim>(side.Side))
    {
      facets *= layout.Patches[At(side.Patch)].Size[d];
    }
    return facets;
  };
  for (int p = 0; p < static_cast<int>(layout.Patches.size()); ++p)
  {
    for (int s = 0; s < 2 * Dim; ++s)
    {
      const PatchSide side{ p, s };
      const std::vector<SideFacet> facets = FacetsOfSide(space, layout, side);
      const SideFacet& first = facets.front();
      const auto isAlike = [&](const SideFacet& at) { return at.Beyond == first.Beyond; };
      const bool isOne = std::all_of(facets.begin(), facets.end(), isAlike);
      if (isOne && first.Beyond.Patch < 0)
      {
        result.Topology.Boundary.push_back(side);
      }
      else if (isOne && !(first.Beyond == side) && count(first.Beyond) == count(side))
      {
        if (side < first.Beyond)
        {
          PatchInterface interface;
          interface.Sides = { side, first.Beyond };
          interface.Orientation = OrientationAt(data, layout, first, side);
          result.Topology.Interfaces.push_back(interface);
        }
      }
      else if constexpr (Dim == 2)
      {
        std::vector<SideFacet> inside; // a side may lie on the boundary in part
        std::copy_if(facets.begin(), facets.end(), std::back_inserter(inside),
          [](const SideFacet& at) { return at.Other.Cell >= 0; });
        AddRuns(data, layout, side, inside, result);
      }
    }
  }
}
}

template <int Dim>
std::vector<SideFacet> FacetsOfSide(
  const SplineSpace<Dim>& space, const MeshPatches<Dim>& layout, const PatchSide& side)
{
  const UnstructuredData<Dim>& data = *space.Unstructured;
  const std::size_t across = AcrossSide(side.Side);
  const MeshPatch<Dim>& patch = layout.Patches[At(side.Patch)];
  std::vector<SideFacet> facets;
  for (const int cell : patch.Cells)
  {
    const int index = layout.IndexOf[At(cell)][across];
    if (index != (side.Side % 2 == 0 ? 0 : patch.Size[across] - 1))
    {
      continue;
    }
    const int ahead = layout.AheadOf[At(cell)][across];
    SideFacet facet;
    facet.Facet = { cell, side.Side % 2 == 1 ? ahead : ahead ^ 1 };
    if (!data.Topology.IsBoundary(cell, facet.Facet.Side))
    {
      facet.Other = { data.Topology.Neighbour(cell, facet.Facet.Side),
        data.Topology.Crossing(cell, facet.Facet.Side).Side };
      facet.Beyond = { layout.PatchOf[At(facet.Other.Cell)],
        SideOfPatch(layout, facet.Other.Cell, facet.Other.Side) };
    }
    facets.push_back(facet);
  }
  return facets;
}

template <int Dim>
Result<MultiPatch<Dim>> SplitIntoPatches(
  const Spline<Dim>& spline, int threads, MeshPatches<Dim>* layout)
{
  if (!spline.Space)
  {
    return { ErrorCode::EmptyInput, "no space" };
  }
  if (spline.Space->Kind != SpaceKind::Unstructured)
  {
    return { ErrorCode::DimensionMismatch, "the spline is none on an unstructured mesh" };
  }
  if (Status status = spline.Check(); !status)
  {
    return status;
  }
  MeshPatches<Dim> found = FindSpacePatches(*spline.Space);
  const BezierForm<Dim> form = MakeBezierForm(spline, threads);
  Result<MultiPatch<Dim>> result;
  for (const MeshPatch<Dim>& patch : found.Patches)
  {
    auto made = PatchSpline(form, *spline.Space->Unstructured, found, patch, threads);
    if (!made)
    {
      return made.Status;
    }
    result->Patches.push_back(std::move(made.Value));
  }
  StateSides(*spline.Space, found, result.Value);
  if (layout)
  {
    *layout = std::move(found);
  }
  return result;
}

template std::vector<SideFacet> FacetsOfSide<2>(
  const SplineSpace<2>&, const MeshPatches<2>&, const PatchSide&);
template Result<MultiPatch<2>> SplitIntoPatches<2>(const Spline<2>&, int, MeshPatches<2>*);
template std::vector<SideFacet> FacetsOfSide<3>(
  const SplineSpace<3>&, const MeshPatches<3>&, const PatchSide&);
template Result<MultiPatch<3>> SplitIntoPatches<3>(const Spline<3>&, int, MeshPatches<3>*);
}
