// SPDX-License-Identifier: BSD-3-Clause
// What the files of trivariate LR B-splines share, private to the family.
#pragma once
#include "LRVolume.h"
#include "SpaceFamily.h"

#include <functional>

namespace knotwork
{
/// How the space of a volume keeps its data behind SplineSpace::LocallyRefined, which knows those
/// of a surface by name only.
struct LRVolumeData final : LRData
{
  LRVolume Volume;
};

/// The part of a plane over knots [Lower, Upper) of the other directions.
struct LRCrossSection
{
  int Direction;
  int Plane;
  std::array<int, 2> Lower;
  std::array<int, 2> Upper;
};

/// The cross-section of a function's support. @param local  all its local knots.
LRCrossSection CrossSectionOf(const LRVolumeBasis& basis, const int* local, int d, int plane);

/// Whether every face of a cross-section has a multiplicity above a number.
bool Exceeds(const LRVolumeBasis& basis, const LRCrossSection& section, int multiplicity);

/// MakeLRVolumeSpace for functions that are right by construction.
Result<SplineSpacePtr<3>> AssembleLRVolume(LRVolumeBasis basis, int threads);

/// TooLarge when the grid of all knots is.
Status CheckLRVolumeSize(const LRVolumeBasis& basis);

/// The family's entry in the table for three parameters.
const SpaceFamily<3>& LRVolumeFamily();
}
