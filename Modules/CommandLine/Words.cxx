// SPDX-License-Identifier: BSD-3-Clause
#include "Words.h"
#include <knotwork/SplineIO/NearestName.h>

#include <algorithm>
#include <array>
#include <cstddef>

namespace knotwork
{
namespace
{
bool IsTruthWord(const std::string& word)
{
  constexpr std::array<const char*, 8> Words{ "0", "1", "true", "false", "on", "off", "yes", "no" };
  return std::find(Words.begin(), Words.end(), CLI::detail::to_lower(word)) != Words.end();
}

bool BeginsWith(const std::string& word, const std::string& lead)
{
  return word.compare(0, lead.size(), lead) == 0;
}

/// The job that is asked for: the first word.
const CLI::App* FindJob(const std::vector<std::string>& words, const CLI::App& app)
{
  const auto named = app.get_subcommands(
    [&](const CLI::App* job) { return !words.empty() && job->get_name() == words.front(); });
  return named.empty() ? nullptr : named.front();
}

/// The option of a job that a word names; null if it names none.
const CLI::Option* FindOption(const std::string& word, const CLI::App* job)
{
  const bool isName = word.size() > 1 && word.front() == '-' && word != "--";
  return job && isName ? job->get_option_no_throw(word.substr(0, word.find('='))) : nullptr;
}

/// The word, or the present spelling of an old one.
std::string Renew(const std::string& word, const CLI::App& job, std::vector<std::string>& warnings)
{
  const std::string old = "--max-";
  if (!BeginsWith(word, old))
  {
    return word;
  }
  const std::string renewed = "--maximum-" + word.substr(old.size());
  const std::string name = renewed.substr(0, renewed.find('='));
  if (!job.get_option_no_throw(name))
  {
    return word;
  }
  warnings.push_back(
    "'" + word.substr(0, word.find('=')) + "' is an old spelling of '" + name + "'");
  return renewed;
}

/// Names of the jobs of the program, or of the options of a job.
std::vector<std::string> KnownNames(const CLI::App& app)
{
  std::vector<std::string> names;
  for (const CLI::App* job : app.get_subcommands([](const CLI::App*) { return true; }))
  {
    names.push_back(job->get_name());
  }
  for (const CLI::Option* option : app.get_options())
  {
    if (!option->get_positional())
    {
      names.push_back(option->get_name());
    }
  }
  return names;
}

/// "there is no ...; did you mean ...?" of the first word that nothing knows; empty without one.
std::string ExplainUnknown(const CLI::App& app, bool isJob)
{
  const std::vector<std::string> words = app.remaining();
  const auto isOption = [](const std::string& word) { return BeginsWith(word, "-"); };
  auto unknown = std::find_if(words.begin(), words.end(), isOption);
  if (unknown == words.end())
  {
    unknown = words.begin();
  }
  if (unknown == words.end())
  {
    return {};
  }
  const std::string word = unknown->substr(0, unknown->find('='));
  const std::string nearest = NearestName(word, KnownNames(app));
  return (isOption(word) ? "there is no option '" + word + "'"
             : isJob     ? "'" + word + "' is one word too many"
                         : "there is no job '" + word + "'") +
    (nearest.empty() ? "" : "; did you mean '" + nearest + "'?");
}
}

PreparedWords PrepareWords(int argc, const char* const* argv, const CLI::App& app)
{
  std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  if (!words.empty() && words.front() == "help")
  {
    words.erase(words.begin());
    if (words.empty() || FindJob(words, app)) // else the word is told to be none
    {
      words.emplace_back("--help");
    }
  }
  const CLI::App* job = FindJob(words, app);
  PreparedWords prepared;
  for (std::size_t i = 0; i < words.size(); ++i)
  {
    const std::string word = job ? Renew(words[i], *job, prepared.Warnings) : words[i];
    prepared.Words.push_back(word);
    const bool hasValue = word.find('=') != std::string::npos;
    const CLI::Option* option = hasValue ? nullptr : FindOption(word, job);
    if (!option || i + 1 == words.size())
    {
      continue;
    }
    if (option->get_items_expected_max() == 0 && IsTruthWord(words[i + 1]))
    {
      prepared.Words.back() += "=" + words[++i];
    }
    else if (option->get_items_expected_min() > 0 && FindOption(words[i + 1], job) &&
      prepared.Wrong.empty())
    {
      prepared.Wrong = "knotwork " + job->get_name() + ": '" + word +
        "' needs a value, and the option '" + words[i + 1] + "' follows; 'knotwork " +
        job->get_name() + " --help' lists its options";
    }
  }
  return prepared;
}

std::string ExplainUsage(const CLI::App& app, const CLI::ParseError& error)
{
  const std::vector<CLI::App*> jobs = app.get_subcommands();
  const CLI::App& asked = jobs.empty() ? app : *jobs.front();
  const std::string program = jobs.empty() ? "knotwork" : "knotwork " + asked.get_name();
  std::string wrong = ExplainUnknown(asked, !jobs.empty());
  if (wrong.empty())
  {
    wrong = jobs.empty() ? "a job is required" : error.what();
  }
  return program + ": " + wrong + (wrong.back() == '?' ? " '" : "; '") + program +
    " --help' lists " + (jobs.empty() ? "the jobs" : "its options");
}
}
