// SPDX-License-Identifier: BSD-3-Clause
#include "SingularCases.h"

namespace knotwork::testing
{
// Against 100000 uniform functions.
TEST(AdaptiveEdge, AgainstUniformRefinement_ExactOracle)
{
  ExpectEdge(12000, 35, 0.05);
}
}
