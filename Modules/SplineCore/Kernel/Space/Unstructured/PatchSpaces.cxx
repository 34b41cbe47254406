// SPDX-License-Identifier: BSD-3-Clause
#include "PatchSpaces.h"

#include "DualFunctionals.h"
#include "TensorSpace.h"

#include <algorithm>
#include <string>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

template <int Dim>
Result<KnotVector> PatchKnots(const UnstructuredData<Dim>& data, const MeshPatches<Dim>& layout,
  const MeshPatch<Dim>& patch, std::size_t direction)
{
  const int p = data.Degree;
  const int layers = patch.Size[direction];
  std::vector<double> intervals(At(layers));
  std::vector<int> continuity(At(layers), p - 1); // at the upper ends
  for (const int cell : patch.Cells)
  {
    const int ahead = layout.AheadOf[At(cell)][direction];
    const std::size_t layer = At(layout.IndexOf[At(cell)][direction]);
    intervals[layer] = data.Length(cell, ahead / 2);
    continuity[layer] = std::min<int>(continuity[layer], data.ContinuityOf(cell, ahead));
  }
  std::vector<double> knots(At(p + 1), 0.0);
  for (std::size_t layer = 0; layer < intervals.size(); ++layer)
  {
    const bool isEnd = layer + 1 == intervals.size();
    const double end = knots.back() + intervals[layer];
    knots.insert(knots.end(), At(isEnd ? p + 1 : p - continuity[layer]), end);
  }
  return KnotVector::Create(p, std::move(knots));
}

/// Whether the B-splines of the patch are those of a cell: it ends everywhere at facets that are
/// C^0, and the facets of a layer are all alike.
template <int Dim>
bool HasOwnKnots(const UnstructuredData<Dim>& data, const MeshPatches<Dim>& layout, int cell,
  const MeshPatch<Dim>& patch, const SplineSpace<Dim>& patchSpace)
{
  for (std::size_t d = 0; d < Dim; ++d)
  {
    const int ahead = layout.AheadOf[At(cell)][d];
    const int index = layout.IndexOf[At(cell)][d];
    for (int upper = 0; upper < 2; ++upper)
    {
      const auto continuity = data.ContinuityOf(cell, upper ? ahead : ahead ^ 1);
      const int layer = index + upper;
      const bool isEnd = layer == 0 || layer == patch.Size[d];
      if (isEnd ? continuity > 0
                : data.Degree - continuity != patchSpace.Knots[d].Multiplicity(layer))
      {
        return false;
      }
    }
  }
  return true;
}
}

template <int Dim>
Result<SplineSpacePtr<Dim>> MakePatchSpace(
  const UnstructuredData<Dim>& data, const MeshPatches<Dim>& layout, const MeshPatch<Dim>& patch)
{
  std::array<KnotVector, Dim> knots;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    auto made = PatchKnots(data, layout, patch, d);
    if (!made)
    {
      return made.Status;
    }
    knots[d] = std::move(made.Value);
  }
  return MakeTensorSpace<Dim>(knots);
}

template <int Dim>
std::vector<int> TurnedEntries(int points, const IntArray<Dim>& ahead)
{
  IntArray<Dim> stride;
  IntArray<Dim> index{};
  int first = 0; // at the lower corner of the patch's directions
  int count = 1;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    int ownStride = 1;
    for (int a = 0; a < ahead[d] / 2; ++a)
    {
      ownStride *= points;
    }
    first += ahead[d] % 2 == 1 ? 0 : (points - 1) * ownStride;
    stride[d] = ahead[d] % 2 == 1 ? ownStride : -ownStride;
    count *= points;
  }
  std::vector<int> entries(At(count));
  for (int& entry : entries)
  {
    entry = first;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      entry += index[d] * stride[d];
    }
    for (std::size_t d = 0; d < Dim && ++index[d] >= points; ++d)
    {
      index[d] = 0;
    }
  }
  return entries;
}

template <int Dim>
Result<std::vector<int>> FunctionsOfPatch(const SplineSpace<Dim>& space,
  const MeshPatches<Dim>& layout, int patch, const SplineSpace<Dim>& patchSpace)
{
  const UnstructuredData<Dim>& data = *space.Unstructured;
  const MeshPatch<Dim>& box = layout.Patches[At(patch)];
  std::vector<int> functions(At(patchSpace.NumFunctions), -1);
  for (std::size_t e = 0; e < box.Cells.size(); ++e)
  {
    const int cell = box.Cells[e];
    bool isOwn = HasOwnKnots(data, layout, cell, box, patchSpace);
    const std::vector<int> turned = TurnedEntries<Dim>(data.Degree + 1, layout.AheadOf[At(cell)]);
    for (std::size_t j = 0; j < turned.size() && isOwn; ++j)
    {
      int& known = functions[At(patchSpace.LocalFunctions(static_cast<int>(e))[j])];
      const int function = OwnFunction(space, space.LocalFunctions(cell)[turned[j]]);
      isOwn = function >= 0 && (known < 0 || known == function);
      known = function;
    }
    if (!isOwn)
    {
      return { ErrorCode::NotInSpace,
        "patch " + std::to_string(patch) + " has no control points of its own at cell " +
          std::to_string(cell) + ": a side that is C^1 or smoother, or next to a T-joint" };
    }
  }
  return functions;
}

template Result<SplineSpacePtr<2>> MakePatchSpace<2>(
  const UnstructuredData<2>&, const MeshPatches<2>&, const MeshPatch<2>&);
template std::vector<int> TurnedEntries<2>(int, const IntArray<2>&);
template Result<std::vector<int>> FunctionsOfPatch<2>(
  const SplineSpace<2>&, const MeshPatches<2>&, int, const SplineSpace<2>&);
template Result<SplineSpacePtr<3>> MakePatchSpace<3>(
  const UnstructuredData<3>&, const MeshPatches<3>&, const MeshPatch<3>&);
template std::vector<int> TurnedEntries<3>(int, const IntArray<3>&);
template Result<std::vector<int>> FunctionsOfPatch<3>(
  const SplineSpace<3>&, const MeshPatches<3>&, int, const SplineSpace<3>&);
}
