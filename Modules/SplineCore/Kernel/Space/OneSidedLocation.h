// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/SplineSpace.h>

namespace knotwork
{
/// SplineSpace::Locate for limits at knots: the element on one side of a point on the border of
/// elements, where derivatives (and values, at knots of full multiplicity) jump.
/// @param fromBelow  a direction: the limit from smaller parameters, which at the lower end of the
/// domain there is not: the one from above then. Else as Locate: from larger ones.
/// @return as Locate. Parameters within 1e-12 of the domain's size of a knot are that knot.
template <int Dim>
int LocateOneSided(const SplineSpace<Dim>& space, const double* u,
  const std::array<bool, static_cast<std::size_t>(Dim)>& fromBelow, double* local);
}
