// SPDX-License-Identifier: BSD-3-Clause
// More and larger random meshes than every run of the tests takes.
#include "SmoothnessOracle.h"

TEST(ManyUnstructuredSpaces, FunctionsAreABasisOfAllSmoothSplines_ExactOracle)
{
  for (unsigned seed = 1; seed <= 1000; ++seed)
  {
    oracle::ExpectRandomSpace<2>(10000 + seed, 5, 120);
    oracle::ExpectRandomSpace<3>(10000 + seed, 3, 48);
  }
}
