// SPDX-License-Identifier: BSD-3-Clause
#include "SideOverlap.h"

#include "PreimageProof.h"

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
std::optional<InjectivityWitness> TryOverlap(const MapBoundary& boundary,
  const std::array<int, 2>& sides, const std::array<std::array<double, 3>, 2>& stops, int turn,
  double along, double inside)
{
  const bool plane = boundary.Cells.NumComponents == 2;
  const std::size_t at = static_cast<std::size_t>(turn);
  const BoundarySide& from = boundary.Side(sides[at]);
  const BoundarySide& to = boundary.Side(sides[1 - at]);
  const CellLattice& lattice = boundary.LatticeOf(to.Cell);
  const auto start = SideToCell(boundary.Shape(to.Cell), to.Frame, stops[1 - at].data());
  const CellShape shape = boundary.Shape(from.Cell);
  std::array<double, 3> middle{};
  for (int c = 0; c < NumCorners(shape); ++c)
  {
    const auto u = CornerParameters(shape, c);
    for (std::size_t d = 0; d < 3; ++d)
    {
      middle[d] += u[d] / NumCorners(shape);
    }
  }
  for (int k = 0; k < (plane ? 3 : 9); ++k)
  {
    auto s = stops[at];
    s[0] = std::clamp(s[0] + (k % 3 - 1) * along, 0.0, 1.0);
    s[1] = plane ? 0.0 : std::clamp(s[1] + (k / 3 - 1) * along, 0.0, 1.0);
    if (from.Frame.Shape == CellShape::Triangle && s[0] + s[1] > 1.0)
    {
      continue;
    }
    auto u = SideToCell(shape, from.Frame, s.data());
    for (std::size_t d = 0; d < 3; ++d)
    {
      u[d] += inside * (middle[d] - u[d]);
    }
    const ImagePoint image = EvaluateImage(boundary.Cells, from.Cell, u.data());
    const auto preimage = ProvePreimage(boundary.Cells, lattice, to.Cell, start, image);
    if (!preimage)
    {
      continue;
    }
    double apart = 0.0;
    for (std::size_t d = 0; d < 3; ++d)
    {
      apart = std::max(apart, std::abs(preimage->Parameters[d] - u[d]));
    }
    if (from.Cell != to.Cell || apart > 2.0 * preimage->Radius)
    {
      InjectivityWitness overlap;
      overlap.Places = { PlaceInCell(boundary.Cells, from.Cell, -1, u),
        PlaceInCell(boundary.Cells, to.Cell, -1, preimage->Parameters) };
      overlap.Radius = preimage->Radius;
      return overlap;
    }
  }
  return {};
}
}

std::optional<InjectivityWitness> FindSideOverlap(const MapBoundary& boundary,
  const std::array<int, 2>& sides, const std::array<std::array<double, 3>, 2>& at)
{
  // from where the proof stopped along the side, and inside by as much or, where the boundaries
  // cross at an acute angle, by less
  for (int halving = 2; halving <= 41; halving += 3)
  {
    for (int less = 0; less <= 15; less += 5)
    {
      const double along = std::ldexp(1.0, -halving);
      const double inside = std::ldexp(along, -less);
      for (const int turn : { 0, 1 })
      {
        if (auto overlap = TryOverlap(boundary, sides, at, turn, along, inside))
        {
          return overlap;
        }
      }
    }
  }
  return {};
}
}
