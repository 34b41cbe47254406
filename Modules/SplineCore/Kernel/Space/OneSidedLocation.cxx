// SPDX-License-Identifier: BSD-3-Clause
#include "OneSidedLocation.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
constexpr double SameKnot = 1e-12; // of the domain's size, as Locate
constexpr int MostSteps = 40;      // each one twice as far, from the last place on
}

template <int Dim>
int LocateOneSided(const SplineSpace<Dim>& space, const double* u,
  const std::array<bool, static_cast<std::size_t>(Dim)>& fromBelow, double* local)
{
  int e = space.Locate(u, local);
  if (e < 0)
  {
    return e;
  }
  const ParametricBox<Dim> domain = space.Domain();
  RealArray<Dim> probe;
  std::copy_n(u, Dim, probe.begin());
  for (std::size_t d = 0; d < static_cast<std::size_t>(Dim); ++d)
  {
    const double knot = space.Elements[static_cast<std::size_t>(e)].Box.Lower[d];
    const double size = domain.Upper[d] - domain.Lower[d];
    if (!fromBelow[d] || u[d] - knot > SameKnot * size || knot <= domain.Lower[d])
    {
      continue;
    }
    const double unit =
      std::numeric_limits<double>::epsilon() * std::max({ std::fabs(knot), size });
    int lower = e;
    for (int k = 0;
         k < MostSteps && !(space.Elements[static_cast<std::size_t>(lower)].Box.Lower[d] < knot);
         ++k)
    {
      probe[d] = std::max(knot - std::ldexp(unit, k), domain.Lower[d]);
      lower = space.Locate(probe.data(), local);
    }
    e = lower;
  }
  // the place itself in the element that was found; a line may end at the knot of another direction
  const ParametricBox<Dim>& box = space.Elements[static_cast<std::size_t>(e)].Box;
  for (std::size_t d = 0; d < static_cast<std::size_t>(Dim); ++d)
  {
    local[d] = std::clamp((u[d] - box.Lower[d]) / (box.Upper[d] - box.Lower[d]), 0.0, 1.0);
  }
  return e;
}

template int LocateOneSided<1>(
  const SplineSpace<1>&, const double*, const std::array<bool, 1>&, double*);
template int LocateOneSided<2>(
  const SplineSpace<2>&, const double*, const std::array<bool, 2>&, double*);
template int LocateOneSided<3>(
  const SplineSpace<3>&, const double*, const std::array<bool, 3>&, double*);
}
