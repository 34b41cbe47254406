// SPDX-License-Identifier: BSD-3-Clause
#include "ReaderProcess.h"

#include "ReaderLimits.h"
#include "WorkerStatus.h"
#include <knotwork/SplineCore/FileEnding.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>

#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace fs = std::filesystem;

namespace knotwork
{
namespace
{
using Clock = std::chrono::steady_clock;

/// Full path of a program of Worker/; empty without one.
std::string PathOfWorker(const std::string& program)
{
  std::vector<fs::path> folders;
  if (const char* folder = std::getenv("KNOTWORK_WORKERS"); folder && *folder)
  {
    folders.emplace_back(folder);
  }
  else
  {
    Dl_info library{};
    if (dladdr(reinterpret_cast<const void*>(&PathOfWorker), &library) == 0 || !library.dli_fname)
    {
      return {};
    }
    std::error_code ignored;
    const fs::path beside = fs::absolute(library.dli_fname, ignored).parent_path();
    folders = { beside, beside / KNOTWORK_WORKER_FOLDER, beside / "../libexec/knotwork" };
  }
  for (const fs::path& folder : folders)
  {
    const std::string path = (folder / program).string();
    if (access(path.c_str(), X_OK) == 0)
    {
      return path;
    }
  }
  return {};
}

/// Size of a file; the pieces of a .vtpc lie in a folder of its name.
std::uint64_t BytesOf(const std::string& file)
{
  std::error_code error;
  const auto size = [&error](const fs::path& path) -> std::uint64_t
  {
    const auto bytes = fs::file_size(path, error);
    return error ? 0 : bytes;
  };
  std::uint64_t bytes = size(file);
  if (LowerEnding(file) == ".vtpc")
  {
    for (fs::directory_iterator piece(fs::path(file).replace_extension(), error), end;
         !error && piece != end; piece.increment(error))
    {
      bytes += piece->is_regular_file(error) ? size(piece->path()) : 0;
    }
  }
  return bytes;
}

/// The reading end of a pipe whose writing end a child has as descriptor 3.
class Child
{
public:
  Child(const std::string& program, const std::vector<std::string>& words)
  {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0)
    {
      return;
    }
    fcntl(ends[1], F_SETPIPE_SZ, 1 << 20); // fewer changes between the processes
    std::vector<char*> arguments{ const_cast<char*>(program.c_str()) };
    for (const std::string& word : words)
    {
      arguments.push_back(const_cast<char*>(word.c_str()));
    }
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, ends[1], WorkerDescriptor);
    for (int standard = 0; standard < 3; ++standard) // libraries print as they like
    {
      posix_spawn_file_actions_addopen(&files, standard, "/dev/null", O_RDWR, 0);
    }
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    sigset_t none;
    sigset_t all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawnattr_setflags(
      &attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
    this->Running =
      posix_spawn(&this->Id, program.c_str(), &files, &attributes, arguments.data(), environ) == 0;
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&files);
    close(ends[1]);
    this->Pipe = ends[0];
  }

  ~Child()
  {
    this->Kill();
    if (this->Pipe >= 0)
    {
      close(this->Pipe);
    }
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  bool IsRunning() const { return this->Running; }

  /// Some bytes at least one, none at the end; nothing when the time is over.
  std::optional<std::size_t> Read(char* to, std::size_t most, Clock::time_point end) const
  {
    while (true)
    {
      const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
      pollfd ready{ this->Pipe, POLLIN, 0 };
      const int found = left > 0 ? poll(&ready, 1, static_cast<int>(left)) : 0;
      if (found == 0)
      {
        return std::nullopt;
      }
      const ssize_t count = found > 0 ? read(this->Pipe, to, most) : -1;
      if (count >= 0)
      {
        return static_cast<std::size_t>(count);
      }
      if (errno != EINTR)
      {
        return std::size_t{ 0 };
      }
    }
  }

  void Kill()
  {
    if (this->Running)
    {
      kill(this->Id, SIGKILL);
      this->Wait();
    }
  }

  /// How it ended, as of waitpid; 0 where somebody else has asked before.
  int Wait()
  {
    int outcome = 0;
    while (this->Running && waitpid(this->Id, &outcome, 0) < 0 && errno == EINTR)
    {
    }
    this->Running = false;
    return outcome;
  }

private:
  pid_t Id = -1;
  int Pipe = -1;
  bool Running = false;
};

enum class Outcome
{
  Done,
  Late,
  Stopped ///< before it had said all
};

/// Exactly so many bytes.
Outcome ReadAll(const Child& child, char* to, std::size_t bytes, Clock::time_point end)
{
  while (bytes > 0)
  {
    const auto count = child.Read(to, bytes, end);
    if (!count || *count == 0)
    {
      return count ? Outcome::Stopped : Outcome::Late;
    }
    to += *count;
    bytes -= *count;
  }
  return Outcome::Done;
}

/// Parts until the last one, each a length of eight bytes and so many bytes.
Outcome ReadParts(
  const Child& child, std::uint64_t limit, Clock::time_point end, std::vector<std::string>& parts)
{
  while (true)
  {
    std::array<char, 8> head;
    if (const Outcome outcome = ReadAll(child, head.data(), head.size(), end);
        outcome != Outcome::Done)
    {
      return outcome;
    }
    std::uint64_t length = 0;
    std::memcpy(&length, head.data(), head.size());
    if (length == WorkerLastPart)
    {
      return Outcome::Done;
    }
    if (length > limit)
    {
      return Outcome::Stopped;
    }
    limit -= length;
    std::string& part = parts.emplace_back(static_cast<std::size_t>(length), '\0');
    if (const Outcome outcome = ReadAll(child, part.data(), part.size(), end);
        outcome != Outcome::Done)
    {
      return outcome;
    }
  }
}

std::string InMegabytes(std::uint64_t bytes)
{
  return std::to_string(bytes >> 20U) + " MB";
}
}

Result<std::vector<std::string>> ReadInProcess(
  const std::string& program, const std::string& file, const std::vector<std::string>& options)
{
  const std::string path = PathOfWorker(program);
  if (path.empty())
  {
    return { ErrorCode::LibraryError,
      "'" + file + "' cannot be read: the program " + program +
        " is missing; install all of Knotwork, or set KNOTWORK_WORKERS to its folder" };
  }
  const ReaderLimits limits = LimitsOfReader(BytesOf(file));
  std::vector<std::string> words{ std::to_string(getpid()), std::to_string(limits.Memory),
    std::to_string(limits.CpuSeconds), file };
  words.insert(words.end(), options.begin(), options.end());
  const auto end = Clock::now() + std::chrono::seconds(limits.Seconds);
  Child child(path, words);
  if (!child.IsRunning())
  {
    return { ErrorCode::LibraryError,
      "'" + file + "' cannot be read: no process could be started for it; end other programs" };
  }
  std::vector<std::string> parts;
  const Outcome outcome = ReadParts(child, limits.Memory, end, parts);
  if (outcome == Outcome::Late)
  {
    child.Kill();
  }
  const int status = child.Wait();
  if (outcome == Outcome::Done && parts.size() >= 2)
  {
    const auto code = static_cast<ErrorCode>(std::atoi(parts[0].c_str()));
    if (code != ErrorCode::Ok)
    {
      return { code, parts[1] };
    }
    parts.erase(parts.begin(), parts.begin() + 2);
    return parts;
  }
  if (outcome == Outcome::Late || (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU))
  {
    return { ErrorCode::InvalidFormat,
      "'" + file + "' is damaged: its reader did not end within " +
        std::to_string(limits.CpuSeconds) + " s; write it again" };
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == WorkerOutOfMemory)
  {
    return { ErrorCode::TooLarge,
      "'" + file + "' is damaged: its reader asked for more than " + InMegabytes(limits.Memory) +
        "; write it again, without compression if it is sound" };
  }
  return { ErrorCode::InvalidFormat,
    "'" + file + "' is damaged: its reader crashed; write it again" };
}
}
