// SPDX-License-Identifier: BSD-3-Clause
// Cubic splines on eight elements have eleven functions.
#include <knotwork/SplineCore/KnotVector.h>

int main()
{
  const auto knots = knotwork::KnotVector::Uniform(3, 8);
  return knots.NumFunctions() == 11 ? 0 : 1;
}
