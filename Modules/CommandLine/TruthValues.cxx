// SPDX-License-Identifier: BSD-3-Clause
#include "TruthValues.h"

#include <algorithm>
#include <array>

namespace knotwork
{
namespace
{
bool IsTruthWord(const std::string& word)
{
  constexpr std::array<const char*, 8> Words{ "0", "1", "true", "false", "on", "off", "yes", "no" };
  return std::find(Words.begin(), Words.end(), CLI::detail::to_lower(word)) != Words.end();
}

/// The job that is asked for: the first word.
const CLI::App* FindJob(const std::vector<std::string>& words, const CLI::App& app)
{
  const auto named = app.get_subcommands(
    [&](const CLI::App* job) { return !words.empty() && job->get_name() == words.front(); });
  return named.empty() ? nullptr : named.front();
}
}

std::vector<std::string> JoinTruthValues(int argc, const char* const* argv, const CLI::App& app)
{
  const std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  const CLI::App* job = FindJob(words, app);
  std::vector<std::string> joined;
  for (std::size_t i = 0; i < words.size(); ++i)
  {
    joined.push_back(words[i]);
    const bool isName = words[i].size() > 2 && words[i].compare(0, 2, "--") == 0;
    const CLI::Option* option = job && isName ? job->get_option_no_throw(words[i]) : nullptr;
    if (option && option->get_items_expected_max() == 0 && i + 1 < words.size() &&
      IsTruthWord(words[i + 1]))
    {
      joined.back() += "=" + words[++i];
    }
  }
  return joined;
}
}
