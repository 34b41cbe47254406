// SPDX-License-Identifier: BSD-3-Clause
#include "HeldOutChecks.h"

namespace knotwork
{
namespace
{
TEST(ManyHeldOutDomains, PlanesWithAKnownMapEndValid_PropertyOracle)
{
  cases::ExpectPlanesFound(100, 300);
}

TEST(ManyHeldOutDomains, SolidsWithAKnownMapEndValid_PropertyOracle)
{
  cases::ExpectSolidsFound(100, 300);
}

TEST(ManyHeldOutDomains, ImpossibleOnesNameThePlace_PropertyOracle)
{
  cases::ExpectAllNamed(100, 160);
}
}
}
