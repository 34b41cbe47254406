// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>

#include <functional>
#include <vector>

namespace CLI
{
class App;
}

namespace knotwork
{
class Session;

/// What a job does once its options are parsed.
using Job = std::function<Status(Session&)>;

/// What a job makes of a start by mpirun.
enum class JobProcesses
{
  One,    ///< it refuses
  Several ///< its work is divided among them
};

/// A verb of the program.
struct JobEntry
{
  const char* Name;
  const char* Help;
  const char* Example;    ///< words behind the name, for --help
  Job (*Make)(CLI::App&); ///< adds the options to the job's subcommand and returns the job
  JobProcesses RunsIn;
};

/// Makes a job known to the program: one constant in the job's own file.
class JobRegistration
{
public:
  JobRegistration(const char* name, const char* help, const char* example, Job (*make)(CLI::App&),
    JobProcesses runsIn = JobProcesses::One);
};

/// All jobs, by their names.
std::vector<JobEntry> RegisteredJobs();
}
