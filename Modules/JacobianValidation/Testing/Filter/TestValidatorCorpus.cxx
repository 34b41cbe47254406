// SPDX-License-Identifier: BSD-3-Clause
// A sample of the corpus of grids; the slow tests have all of it.
#include "ValidatorCorpus.h"

TEST(ValidatorCorpus, Sample_ExactOracle)
{
  for (const corpus::Group& group : corpus::Groups())
  {
    corpus::RunCorpus(group, 1, 5, 12, 4);
  }
}
