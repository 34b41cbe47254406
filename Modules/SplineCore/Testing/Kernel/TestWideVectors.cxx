// SPDX-License-Identifier: BSD-3-Clause
#include <knotwork/SplineCore/LargePages.h>
#include <knotwork/SplineCore/WideVectors.h>

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <numeric>
#include <vector>

namespace knotwork
{
namespace
{
/// Whole numbers, whose sums of products no instruction rounds.
std::vector<double> WholeNumbers(int n)
{
  std::vector<double> numbers(static_cast<std::size_t>(n));
  std::iota(numbers.begin(), numbers.end(), 1.0);
  return numbers;
}

TEST(WideVectors, WorkIsDoneOnceWithEitherWidth_ExactOracle)
{
  const std::vector<double> numbers = WholeNumbers(1000);
  double sum = 0.0;
  int width = 0;
  const auto work = [&](auto vector)
  {
    constexpr int Width = decltype(vector)::value;
    width = Width;
    Doubles<Width> sums{};
    for (std::size_t i = 0; i < numbers.size(); i += Width)
    {
      Doubles<Width> next;
      std::memcpy(&next, numbers.data() + i, sizeof(next));
      sums += next * next;
    }
    for (int l = 0; l < Width; ++l)
    {
      sum += sums[l];
    }
  };
  WithWidestVectors(work);
  EXPECT_EQ(width, HasWideVectors() ? 4 : 2);
  EXPECT_EQ(sum, 1000.0 * 1001.0 * 2001.0 / 6.0);
  work(VectorWidth<2>());
  EXPECT_EQ(sum, 2.0 * 1000.0 * 1001.0 * 2001.0 / 6.0);
}

TEST(WideVectors, ArraysAreAlignedForAllVectors_PropertyOracle)
{
  for (std::size_t n = 1; n < 20; ++n)
  {
    const VectorArray<Doubles<4>> array(n);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(array.data()) % 64, 0u);
  }
}

TEST(LargePages, ContentsStay_ExactOracle)
{
  std::vector<double> numbers = WholeNumbers(1 << 20);
  PreferLargePages(numbers.data(), numbers.size() * sizeof(double));
  PreferLargePages(numbers.data() + 1, 8);
  PreferLargePages(numbers.data(), 0);
  EXPECT_EQ(numbers, WholeNumbers(1 << 20));
}
}
}
