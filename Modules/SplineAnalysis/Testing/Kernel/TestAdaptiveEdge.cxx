// SPDX-License-Identifier: BSD-3-Clause
#include "SingularCases.h"

namespace knotwork::testing
{
// Against 100000 uniform functions.
TEST(AdaptiveEdge, AgainstUniformRefinement_ExactOracle)
{
  ExpectEdge(2, 12000, 35, 0.05);
}

TEST(AdaptiveEdge, CubicAgainstUniformRefinement_ExactOracle)
{
  ExpectEdge(3, 12000, 34, 0.1);
}
}
