// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>
#include <knotwork/SplineIO/OutputFiles.h>

#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

/// SIGTERM, SIGINT and SIGHUP end the program at once: temporary folders are removed, one line says
/// so on stderr, and the exit status is 128 + the signal's number.
///
/// The signals are blocked in every thread before any library's code runs, those of libraries that
/// make threads while they are loaded included, and a thread of ours waits for them. So handlers
/// that libraries install (METIS, OpenCASCADE) are never called, and cleaning up may do whatever a
/// thread may do. A signal that is ignored when the program begins (nohup) stays ignored.
namespace knotwork::Termination
{
/// Begins to wait. @param job  is named in the line.
void Begin(const std::string& job);

/// Processes of this machine that say the line in place of this one while they live: one is said
/// where all are ended.
void SpeakAfter(const std::vector<int>& processes);

/// Prints a line about a failure, or nothing; from here on a signal ends this process without a
/// line: all is said.
void LastWord(const std::string& line);

/// While this is held, no signal ends the program: what is done is done whole.
std::unique_lock<std::mutex> Hold();

/// Folders that are removed when a signal comes, before Whole has succeeded: then it is too late.
class Folders : public TemporaryFolders
{
public:
  Result<std::filesystem::path> Make(const std::filesystem::path& pattern) override;
  void Remove(const std::filesystem::path& folder) override;
  /// A folder of another process, which may be ended before it removes it; none any more.
  static void Guard(const std::filesystem::path& folder);
  static void Unguard();
  Status Whole(const std::function<Status()>& work) override;
};
}
