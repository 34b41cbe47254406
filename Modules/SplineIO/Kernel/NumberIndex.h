// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace knotwork
{
/// Rows of things by their numbers in a file: a table where the numbers are dense, a hash where
/// they are not, so that memory follows the things and not their numbers.
class NumberIndex
{
public:
  /// @param expected  how many there are about.
  explicit NumberIndex(std::size_t expected) : Most(4 * static_cast<std::int64_t>(expected) + 1024)
  {
  }
  /// @return false: the number is there already.
  bool Add(std::int64_t number, std::int64_t row)
  {
    if (number < 0 || number > this->Most)
    {
      return this->Sparse.emplace(number, row).second;
    }
    const auto at = static_cast<std::size_t>(number);
    if (at >= this->Dense.size())
    {
      this->Dense.resize(at + 1 + at / 2, -1);
    }
    const bool isNew = this->Dense[at] < 0;
    this->Dense[at] = isNew ? row : this->Dense[at];
    return isNew;
  }
  /// @return -1: the number is not there.
  std::int64_t Find(std::int64_t number) const
  {
    if (number >= 0 && number <= this->Most)
    {
      const auto at = static_cast<std::size_t>(number);
      return at < this->Dense.size() ? this->Dense[at] : -1;
    }
    const auto found = this->Sparse.find(number);
    return found == this->Sparse.end() ? -1 : found->second;
  }

private:
  std::int64_t Most;
  std::vector<std::int64_t> Dense;
  std::unordered_map<std::int64_t, std::int64_t> Sparse;
};
}
