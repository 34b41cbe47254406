// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/MultiPatch.h>

namespace knotwork
{
/// The orientation of an interface in terms of all parameters, as G+Smo writes it: parameter d of
/// the first patch runs along parameter Direction[d] of the second, in the same sense when Sense[d]
/// is 1, in the opposite when 0. Entries beyond the number of parameters are 0.
struct PatchDirections
{
  std::array<int, 3> Direction{};
  std::array<int, 3> Sense{};
};
PatchDirections DirectionsOf(const PatchInterface& interface, int dimension);

/// Sets the orientation of an interface whose sides are set. The sense across the sides follows
/// from them.
/// @return false when the directions are no permutation that sends the direction across the first
/// side to that across the second, or a sense is neither 0 nor 1.
bool SetDirections(const PatchDirections& directions, int dimension, PatchInterface& interface);
}
