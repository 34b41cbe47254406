// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace knotwork
{
/// Words of the command line with the values of truth options joined to them: `--measures 0`
/// becomes
/// `--measures=0`, as a flag takes it. A truth option followed by anything else, such as a file,
/// stays as it is: on.
/// Truth words are 0, 1, true, false, on, off, yes and no, in any case.
///
/// @param app  has one subcommand a job.
std::vector<std::string> JoinTruthValues(int argc, const char* const* argv, const CLI::App& app);
}
