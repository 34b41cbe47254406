// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "CellGluing.h"

/// Private to the injectivity proof: that two boundary sides meet nowhere but where they are known
/// to share a corner or an edge.
namespace knotwork
{
enum class SeparationState : std::uint8_t
{
  Separate,
  Boxes, ///< the limit was reached
  Stuck  ///< pieces too small to go on: At
};

struct SeparationResult
{
  SeparationState State = SeparationState::Separate;
  std::int64_t Boxes = 0;
  /// Parameters of both sides where the proof stopped.
  std::array<std::array<double, 3>, 2> At{};
};

struct SeparationInput
{
  const std::vector<BoundarySide>* Sides = nullptr;
  const CellLatticeTable* Lattices = nullptr;
  int NumComponents = 2;
  bool Rational = false;
  double CollapseTolerance = 0.0;
  /// Of the sides from the origin of the map, by a coordinate: the tolerance is relative to that.
  double Distance = 0.0;
};

/// Sides a and b, a == b for one side with itself. Depth first, so a place that cannot be separated
/// is found after few boxes.
SeparationResult SeparateSides(const SeparationInput& input, int a, int b, std::int64_t maxBoxes);
}
