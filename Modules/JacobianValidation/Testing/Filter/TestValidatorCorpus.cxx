// SPDX-License-Identifier: BSD-3-Clause
// A sample of the corpus of grids; the slow tests have all of it.
#include "ValidatorCorpus.h"

TEST(ValidatorCorpus, Sample_ExactOracle)
{
  corpus::RunCorpus(1, 5, 20, 5);
}
