// SPDX-License-Identifier: BSD-3-Clause
// The corpus of grids: of every group 40 grids of 60 cells.
#include "ValidatorCorpus.h"

namespace
{
class ValidatorCorpusWhole : public testing::TestWithParam<corpus::Group>
{
};

TEST_P(ValidatorCorpusWhole, NoneWrongHardlyOneUndecided_ExactOracle)
{
  corpus::RunCorpus(GetParam(), 100, 20, 60, 20);
}

INSTANTIATE_TEST_SUITE_P(All, ValidatorCorpusWhole, testing::ValuesIn(corpus::Groups()),
  [](const auto& group) { return "Group" + std::to_string(group.index); });
}
