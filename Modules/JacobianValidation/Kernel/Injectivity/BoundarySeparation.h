// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "MapBoundary.h"
#include "SideSeparation.h"

#include <optional>

/// Private to the injectivity proof: that no two sides of a boundary meet but where they are known
/// to.
namespace knotwork
{
/// A pair of sides gets so many boxes at first, and a place where preimages are counted at least.
inline constexpr std::int64_t FirstBoxes = 4096;

struct BoundarySeparation
{
  std::optional<InjectivityWitness> Overlap; ///< ends the search
  std::vector<InterfaceGap> Gaps;
  /// Of the pairs that were not separated: one that is stuck before one that reached the limit.
  SeparationState Obstacle = SeparationState::Separate;
  std::array<InjectivityWitness::Place, 2> ObstaclePlaces;
  std::int64_t Boxes = 0;
};

/// Works through all pairs of sides that come near each other, in their order.
/// @param maxBoxes  over all; what is left open at first shares what is left of them.
/// @param report    of the whole proof, from 0.2 to 0.8.
/// @param found     result. @return false when aborted.
bool SeparateBoundary(const MapBoundary& boundary, const InjectivityParams& params,
  std::int64_t maxBoxes, const ProgressCallback& report, BoundarySeparation& found);
}
