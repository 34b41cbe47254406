// SPDX-License-Identifier: BSD-3-Clause
#include "Jobs.h"

#include <algorithm>
#include <string_view>

namespace knotwork
{
namespace
{
/// Made on first use: the files that register come in no known order.
std::vector<JobEntry>& Entries()
{
  static std::vector<JobEntry> entries;
  return entries;
}
}

JobRegistration::JobRegistration(const char* name, const char* help, const char* example,
  Job (*make)(CLI::App&), JobProcesses runsIn)
{
  Entries().push_back({ name, help, example, make, runsIn });
}

std::vector<JobEntry> RegisteredJobs()
{
  std::vector<JobEntry> jobs = Entries();
  std::sort(jobs.begin(), jobs.end(),
    [](const JobEntry& a, const JobEntry& b)
    { return std::string_view(a.Name) < std::string_view(b.Name); });
  return jobs;
}
}
