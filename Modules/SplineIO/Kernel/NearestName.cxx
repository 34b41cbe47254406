// SPDX-License-Identifier: BSD-3-Clause
#include "NearestName.h"

#include <algorithm>
#include <cstddef>

namespace knotwork
{
namespace
{
/// Letters changed, inserted, left out or exchanged with their neighbour between two words.
std::size_t Difference(const std::string& a, const std::string& b)
{
  std::vector<std::vector<std::size_t>> steps(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i)
  {
    for (std::size_t j = 0; j <= b.size(); ++j)
    {
      if (i == 0 || j == 0)
      {
        steps[i][j] = i + j;
        continue;
      }
      steps[i][j] = std::min({ steps[i - 1][j] + 1, steps[i][j - 1] + 1,
        steps[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1) });
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
      {
        steps[i][j] = std::min(steps[i][j], steps[i - 2][j - 2] + 1);
      }
    }
  }
  return steps[a.size()][b.size()];
}
}

std::string NearestName(const std::string& word, const std::vector<std::string>& names)
{
  std::string nearest;
  std::size_t least = word.size() / 3 + 1; // more letters than that are another word
  for (const std::string& name : names)
  {
    const std::size_t difference = Difference(word, name);
    if (difference < least || (difference == least && nearest.empty()))
    {
      least = difference;
      nearest = name;
    }
  }
  return nearest;
}
}
