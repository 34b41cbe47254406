// SPDX-License-Identifier: BSD-3-Clause
/// knotwork <job> [input...] --output FILE [--report FILE.json] [options]
/// Exit status: 0 done; 1 bad input or failure, one line on stderr; 2 wrong usage; 5 done, but part
/// of the input was left out (named on stderr and in the report); of validate also 3 invalid, 4
/// undecided; 128 + n ended by signal n.
#include "Jobs.h"
#include "ParallelStart.h"
#include "Ranges.h"
#include "Session.h"
#include "Termination.h"
#include "Words.h"
#include <knotwork/SplineGrid/Processes.h>
#include <knotwork/SplineIO/OneLine.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <exception>
#include <iostream>
#include <set>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace
{
constexpr int Failure = 1;
constexpr int WrongUsage = 2;

constexpr const char* ExitStatus =
  "Exit status: 0 done, 1 bad input or failure, 2 wrong usage, 5 done but part of the input was "
  "left out, 128 + n ended by signal n; of validate also 3 invalid, 4 undecided.";

constexpr const char* General = "General"; // title in --help

/// The parser would take 010 for eight, as in C; whole numbers are decimal.
void RefuseOctalNumbers(CLI::App& job)
{
  const auto check = [](const std::string& word)
  {
    const std::size_t first = word.find_first_not_of("+-");
    return first != std::string::npos && first + 1 < word.size() && word[first] == '0'
      ? "'" + word + "' begins with 0; write a decimal number"
      : std::string();
  };
  for (CLI::Option* option : job.get_options())
  {
    const std::string type = option->get_type_name();
    if (type.rfind("INT", 0) == 0 || type.rfind("UINT", 0) == 0)
    {
      option->check(check);
    }
  }
}

/// One line, whatever the message holds.
int Fail(const std::string& job, const std::string& message)
{
  knotwork::Termination::LastWord("knotwork " + job + ": " + knotwork::OneLine(message) + "\n");
  return Failure;
}

/// Prints help or version, or what is wrong with the usage in one line that shows the words of the
/// user.
int Explain(const CLI::App& app, const CLI::ParseError& error)
{
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success))
  {
    return app.exit(error, std::cout, std::cerr);
  }
  std::cerr << knotwork::OneLine(knotwork::ExplainUsage(app, error)) << "\n";
  return WrongUsage;
}

/// What has been printed on standard output has arrived there.
knotwork::Status FlushOutput()
{
  errno = 0;
  if (std::cout.flush())
  {
    return {};
  }
  return { knotwork::ErrorCode::FileError,
    "standard output cannot be written: " + std::generic_category().message(errno) };
}

/// Where one process must do it all.
int RefuseProcesses(const std::string& job, const knotwork::ParallelStart& start,
  const std::vector<std::string>& divided)
{
  std::string names;
  for (const std::string& name : divided)
  {
    names += (names.empty() ? "" : ", ") + name;
  }
  Fail(job,
    "started as one of several processes (" + start.Variable + " is " +
      std::to_string(start.NumProcesses) +
      "), each of which would do the whole job; start it without mpirun (it uses all cores), or "
      "unset " +
      start.Variable + ". Jobs that processes divide among them: " + names);
  return WrongUsage;
}

/// Plans the outputs, runs the job and puts the outputs into their places.
knotwork::Status Run(const CLI::App& job, const knotwork::Job& run, knotwork::Session& session)
{
  knotwork::Status status = knotwork::Processes::Agree(knotwork::PlanOutputs(job, session.Files));
  if (status && knotwork::Processes::Count() > 1 && session.Threads == 0)
  {
    session.Threads = knotwork::ProcessGroup::ThreadsOfEach();
  }
  if (status)
  {
    session.Report["job"] = job.get_name();
    session.Report["threads"] = session.Threads;
    status = run(session);
  }
  if (status)
  {
    status = knotwork::Processes::Agree(FlushOutput());
  }
  return status ? session.Commit() : status;
}
}

int main(int argc, char* argv[])
{
#ifdef __GLIBC__
  // Large arrays come from the heap and stay there: given back to the system and fetched again,
  // their pages would be cleared each time, which threads wait for.
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  mallopt(M_TOP_PAD, 64 << 20);
#endif
  CLI::App app("Spline geometry that is fitted, refined and proved valid.", "knotwork");
  app.require_subcommand(1);
  app.set_version_flag("--version", KNOTWORK_VERSION);
  app.footer("knotwork help JOB lists what a job takes.\n\nFiles that are read: " +
    knotwork::JoinEndings(knotwork::EndingsThatRead(knotwork::AnyContent)) +
    "\nFiles that are written: " +
    knotwork::JoinEndings(knotwork::EndingsThatWrite(knotwork::AnyContent)) + "\n\n" + ExitStatus);

  knotwork::Session session;
  std::vector<std::pair<CLI::App*, knotwork::Job>> jobs;
  std::vector<std::string> divided; // jobs that several processes do together
  std::set<const CLI::App*> isDivided;
  for (const knotwork::JobEntry& entry : knotwork::RegisteredJobs())
  {
    CLI::App* job = app.add_subcommand(entry.Name, entry.Help);
    job->footer(
      "Example: knotwork " + std::string(entry.Name) + " " + entry.Example + "\n\n" + ExitStatus);
    jobs.emplace_back(job, entry.Make(*job));
    if (entry.RunsIn == knotwork::JobProcesses::Several)
    {
      divided.emplace_back(entry.Name);
      isDivided.insert(job);
    }
    knotwork::AddOutput(*job, "--report", session.ReportFile, knotwork::Endings::Any,
      "JSON file for the numbers of the job");
    job->add_flag("--force", session.Files.Force, "an output may take the place of an input")
      ->group(General);
    job->add_option("--threads", session.Threads, "threads, 0 = all cores")
      ->check(knotwork::InRange(0, 1024))
      ->capture_default_str()
      ->group(General);
    job->add_flag("--quiet", session.Quiet, "no progress and no warnings")->group(General);
    job->set_help_flag("-h,--help", "Print this help message and exit")->group(General);
    RefuseOctalNumbers(*job);
  }
  const knotwork::PreparedWords prepared = knotwork::PrepareWords(argc, argv, app);
  if (!prepared.Wrong.empty())
  {
    if (knotwork::FindParallelStart().IsFirst)
    {
      std::cerr << knotwork::OneLine(prepared.Wrong) << "\n";
    }
    return WrongUsage;
  }
  try
  {
    std::vector<std::string> words = prepared.Words;
    std::reverse(words.begin(), words.end()); // as the parser takes them
    app.parse(std::move(words));
  }
  catch (const CLI::ParseError& error)
  {
    return knotwork::FindParallelStart().IsFirst ? Explain(app, error) : WrongUsage;
  }
  if (knotwork::FindParallelStart().IsFirst)
  {
    session.Warn(prepared.Warnings);
  }

  for (const auto& [job, run] : jobs)
  {
    if (!job->parsed())
    {
      continue;
    }
    const knotwork::ParallelStart start = knotwork::FindParallelStart();
    if (!start.Variable.empty() && isDivided.count(job) == 0)
    {
      return start.IsFirst ? RefuseProcesses(job->get_name(), start, divided) : WrongUsage;
    }
    knotwork::Termination::Begin(job->get_name());
    // a limit of the size of files, or a reader that has gone, is an error like a full disk
    std::signal(SIGXFSZ, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);
    knotwork::ProcessGroup group;
    try
    {
      knotwork::Status status =
        start.Variable.empty() ? knotwork::Status() : group.Join(start, argc, argv);
      if (!status && !start.IsFirst)
      {
        return Failure;
      }
      status = status ? Run(*job, run, session) : status;
      if (knotwork::Processes::Own() != 0)
      {
        knotwork::Termination::LastWord(""); // what fails in one of several has failed in all
      }
      else if (!status)
      {
        Fail(job->get_name(), status.Detail);
      }
      if (!status)
      {
        // mpirun ends the others when one leaves: none does before the first has spoken
        static_cast<void>(knotwork::Processes::Agree({}));
      }
      return status ? session.ExitStatus : Failure;
    }
    catch (...) // of a library, e.g. out of memory
    {
      const int failure = Fail(job->get_name(), knotwork::StatusOfException().Detail);
      if (knotwork::Processes::Count() > 1)
      {
        session.Files.Abandon();
        knotwork::ProcessGroup::Abandon(failure);
      }
      return failure;
    }
  }
  return WrongUsage;
}
