// SPDX-License-Identifier: BSD-3-Clause
// The corpus of grids: 20 groups of 20 grids of 60 cells.
#include "ValidatorCorpus.h"

TEST(ValidatorCorpus, Whole_ExactOracle)
{
  corpus::RunCorpus(100, 20, 60, 20);
}
