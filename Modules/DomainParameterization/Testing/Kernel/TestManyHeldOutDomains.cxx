// SPDX-License-Identifier: BSD-3-Clause
#include "HeldOutChecks.h"

namespace knotwork
{
namespace
{
TEST(ManyHeldOutDomains, PlanesWithAKnownMapEndValid_PropertyOracle)
{
  cases::HeldOutSums sums;
  for (unsigned seed = 100; seed < 300; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    cases::ExpectFound<2>(cases::RandomPlane(seed), sums);
  }
  cases::Print("planes", sums);
}

TEST(ManyHeldOutDomains, SolidsWithAKnownMapEndValid_PropertyOracle)
{
  cases::HeldOutSums sums;
  for (unsigned seed = 100; seed < 300; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    cases::ExpectFound<3>(cases::RandomSolid(seed), sums);
  }
  cases::Print("solids", sums);
}

TEST(ManyHeldOutDomains, ImpossibleOnesNameThePlace_PropertyOracle)
{
  cases::HeldOutSums sums;
  for (unsigned seed = 100; seed < 160; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    cases::ExpectNamed<2>(cases::ImpossiblePlane(seed), sums);
    cases::ExpectNamed<3>(cases::ImpossibleSolid(seed), sums);
  }
  cases::Print("impossible", sums);
}
}
}
