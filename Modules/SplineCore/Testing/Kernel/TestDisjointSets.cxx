// SPDX-License-Identifier: BSD-3-Clause
#include "RandomSplines.h"
#include <knotwork/SplineCore/DisjointSets.h>

#include <gtest/gtest.h>

using namespace knotwork;
using namespace knotwork::testing;

TEST(DisjointSets, AreThoseOfLabelsThatAreWrittenOver_CrossOracle)
{
  for (unsigned seed = 1; seed <= 20; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    DisjointSets sets(30);
    EXPECT_EQ(sets.Add(), 30);
    EXPECT_EQ(sets.Size(), 31);
    std::vector<int> label(31); // of a set: its smallest member
    std::iota(label.begin(), label.end(), 0);
    for (int step = 0; step < 40; ++step)
    {
      const int a = random.Int(0, 30);
      const int b = random.Int(0, 30);
      sets.Unite(a, b);
      const int low =
        std::min(label[static_cast<std::size_t>(a)], label[static_cast<std::size_t>(b)]);
      const int high =
        std::max(label[static_cast<std::size_t>(a)], label[static_cast<std::size_t>(b)]);
      std::replace(label.begin(), label.end(), high, low);
      for (int i = 0; i < 31; ++i)
      {
        ASSERT_EQ(sets.Find(i), label[static_cast<std::size_t>(i)]) << i;
      }
    }
  }
}

TEST(DisjointSets, LongChainsAreShortened_PropertyOracle)
{
  // every union puts the root below a smaller one: without shorter paths 10^12 steps / 2
  constexpr int n = 1000000;
  DisjointSets sets(n);
  for (int i = n - 1; i > 0; --i)
  {
    sets.Unite(n - 1, i - 1);
  }
  for (int i = 0; i < n; ++i)
  {
    ASSERT_EQ(sets.Find(i), 0);
  }
}
