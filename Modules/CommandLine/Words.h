// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace knotwork
{
/// The words of a command line as the parser takes them: old spellings of options are the present
/// ones, and the values of truth options are joined to them.
struct PreparedWords
{
  std::vector<std::string> Words;
  std::vector<std::string> Warnings; ///< one sentence for every old spelling
  /// One line, where an option stands in the place of another one's value: a file of that name can
  /// be given as `--report=--quiet`.
  std::string Wrong;
};

/// Truth options are flags of the parser, which take a value only as `--measures=0`: `--measures 0`
/// becomes that. A truth option followed by anything else, such as a file, stays as it is: on.
/// Truth words are 0, 1, true, false, on, off, yes and no, in any case. Options that began with
/// `--max-` begin with `--maximum-`. `help JOB` is `JOB --help`, `help` alone `--help`.
///
/// @param app  has one subcommand a job.
PreparedWords PrepareWords(int argc, const char* const* argv, const CLI::App& app);

/// What is wrong with the usage, in one line with a remedy. A word that nothing knows is named
/// before anything that is missing: most often it is why.
///
/// @param app  has been given the words, and has thrown the error.
std::string ExplainUsage(const CLI::App& app, const CLI::ParseError& error);
}
