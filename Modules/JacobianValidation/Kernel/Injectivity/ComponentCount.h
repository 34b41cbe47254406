// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "MapBoundary.h"

/// Private to the injectivity proof: how often a map covers what is beside its boundary.
namespace knotwork
{
struct ComponentCount
{
  InjectivityVerdict Verdict = InjectivityVerdict::Injective;
  InjectivityReason Reason = InjectivityReason::None;
  InjectivityWitness Witness; ///< unless Injective
  std::int64_t Boxes = 0;
};

/// The map covers a neighbourhood of one point of every component once, where that is not known.
/// A single simple component needs no look: the degree is 0 on one side of it and 1 on the other.
/// Components that touch are looked at side by side.
/// @param maxBoxes  over all; FirstBoxes each may be more.
ComponentCount CountAtComponents(const MapBoundary& boundary, std::int64_t maxBoxes, int threads);
}
