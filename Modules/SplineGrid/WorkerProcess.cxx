// SPDX-License-Identifier: BSD-3-Clause
#include "WorkerProcess.h"

#include "WorkerStatus.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace fs = std::filesystem;

namespace knotwork
{
namespace
{
using Clock = std::chrono::steady_clock;

/// Full path of a file in one of the folders; empty without one.
/// @param mode  what this process may do with it, as of access().
std::string PathOfFile(
  const std::vector<fs::path>& folders, const std::string& name, int mode = X_OK)
{
  for (const fs::path& folder : folders)
  {
    const std::string path = (folder / name).string();
    std::error_code error;
    if (fs::is_regular_file(path, error) && access(path.c_str(), mode) == 0)
    {
      return path;
    }
  }
  return {};
}

std::string PathOfWorker(const std::string& name, int mode = X_OK)
{
  if (const char* folder = std::getenv("KNOTWORK_WORKERS"); folder && *folder)
  {
    return PathOfFile({ folder }, name, mode);
  }
  Dl_info library{};
  if (dladdr(reinterpret_cast<const void*>(&PathOfWorker), &library) == 0 || !library.dli_fname)
  {
    return {};
  }
  std::error_code ignored;
  const fs::path beside = fs::absolute(library.dli_fname, ignored).parent_path();
  return PathOfFile(
    { beside, beside / KNOTWORK_WORKER_FOLDER, beside / "../libexec/knotwork" }, name, mode);
}

std::string PathOfForeignProgram(const std::string& program)
{
  const char* path = std::getenv("PATH");
  const std::string all = path ? path : "/usr/local/bin:/usr/bin:/bin";
  std::vector<fs::path> folders;
  for (std::size_t at = 0; at <= all.size();)
  {
    const std::size_t end = std::min(all.find(':', at), all.size());
    if (end > at) // an empty one would be the working folder
    {
      folders.emplace_back(all.substr(at, end - at));
    }
    at = end + 1;
  }
  return PathOfFile(folders, program);
}

enum class Outcome
{
  Done,
  Late,
  Stopped, ///< before it had said all
  Aborted
};

/// A process that has one end of a socket as descriptor 3; the other end is here.
class Child
{
public:
  Child(const std::string& program, const std::vector<std::string>& words, Clock::time_point end,
    const std::function<bool()>& goOn)
    : End(end), GoOn(goOn)
  {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
    {
      return;
    }
    for (const int each : ends)
    {
      const int bytes = 1 << 20; // fewer changes between the processes
      setsockopt(each, SOL_SOCKET, SO_SNDBUF, &bytes, sizeof(bytes));
    }
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
    this->Socket = ends[0];
  }

  ~Child()
  {
    this->Kill();
    if (this->Socket >= 0)
    {
      close(this->Socket);
    }
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  bool IsRunning() const { return this->Running; }

  /// Some bytes: at least one, none at the end.
  Outcome Read(char* to, std::size_t most, std::size_t& count) const
  {
    count = 0;
    return this->Transfer(POLLIN,
      [&]
      {
        const ssize_t got = recv(this->Socket, to, most, MSG_DONTWAIT);
        count = got > 0 ? static_cast<std::size_t>(got) : 0;
        return got;
      });
  }

  Outcome Write(const char* from, std::size_t bytes) const
  {
    Outcome outcome = Outcome::Done;
    while (bytes > 0 && outcome == Outcome::Done)
    {
      outcome = this->Transfer(POLLOUT,
        [&]
        {
          const ssize_t count = send(this->Socket, from, bytes, MSG_DONTWAIT | MSG_NOSIGNAL);
          from += std::max<ssize_t>(count, 0);
          bytes -= static_cast<std::size_t>(std::max<ssize_t>(count, 0));
          return count;
        });
    }
    return outcome;
  }

  void Kill()
  {
    if (this->Running)
    {
      kill(-this->Id, SIGKILL); // it leads its group
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
  /// Tries when the socket is ready, until the time is over or the caller does not want it any
  /// more.
  template <typename Try>
  Outcome Transfer(short event, const Try& attempt) const
  {
    constexpr std::chrono::milliseconds most(100); // between two questions to the caller
    while (true)
    {
      const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(this->End - Clock::now());
      if (left.count() <= 0)
      {
        return Outcome::Late;
      }
      pollfd ready{ this->Socket, event, 0 };
      const int found =
        poll(&ready, 1, static_cast<int>((this->GoOn ? std::min(left, most) : left).count()));
      if (found == 0 && this->GoOn && !this->GoOn())
      {
        return Outcome::Aborted;
      }
      if (found > 0 && attempt() >= 0)
      {
        return Outcome::Done;
      }
      if (found != 0 && errno != EINTR && errno != EAGAIN)
      {
        return Outcome::Stopped;
      }
    }
  }

  Clock::time_point End;
  std::function<bool()> GoOn;
  pid_t Id = -1;
  int Socket = -1;
  bool Running = false;
};

Outcome WriteParts(const Child& child, const std::vector<std::string>& parts)
{
  const auto length = [&child](std::uint64_t count)
  { return child.Write(reinterpret_cast<const char*>(&count), sizeof(count)); };
  for (const std::string& part : parts)
  {
    Outcome outcome = length(part.size());
    outcome = outcome == Outcome::Done ? child.Write(part.data(), part.size()) : outcome;
    if (outcome != Outcome::Done)
    {
      return outcome;
    }
  }
  return length(WorkerLastPart);
}

/// Exactly so many bytes.
Outcome ReadAll(const Child& child, char* to, std::size_t bytes)
{
  while (bytes > 0)
  {
    std::size_t count = 0;
    if (const Outcome outcome = child.Read(to, bytes, count); outcome != Outcome::Done)
    {
      return outcome;
    }
    if (count == 0)
    {
      return Outcome::Stopped;
    }
    to += count;
    bytes -= count;
  }
  return Outcome::Done;
}

Outcome ReadParts(const Child& child, std::uint64_t limit, std::vector<std::string>& parts)
{
  while (true)
  {
    std::uint64_t length = 0;
    if (const Outcome outcome = ReadAll(child, reinterpret_cast<char*>(&length), sizeof(length));
        outcome != Outcome::Done)
    {
      return outcome;
    }
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
    if (const Outcome outcome = ReadAll(child, part.data(), part.size()); outcome != Outcome::Done)
    {
      return outcome;
    }
  }
}

/// What the program prints until it ends.
Outcome ReadPrinted(const Child& child, std::string& printed)
{
  constexpr std::size_t kept = 1 << 16;
  std::array<char, 4096> buffer;
  while (true)
  {
    std::size_t count = 0;
    const Outcome outcome = child.Read(buffer.data(), buffer.size(), count);
    if (outcome != Outcome::Done || count == 0)
    {
      return outcome;
    }
    printed.append(buffer.data(), count);
    printed.erase(0, printed.size() - std::min(printed.size(), kept));
  }
}

WorkerEnd EndOf(Outcome outcome, int status)
{
  if (outcome == Outcome::Aborted)
  {
    return WorkerEnd::Aborted;
  }
  if (outcome == Outcome::Late || (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU))
  {
    return WorkerEnd::Late;
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == WorkerOutOfMemory)
  {
    return WorkerEnd::OutOfMemory;
  }
  return WorkerEnd::Crashed;
}

std::vector<std::string> FirstWords(const WorkerLimits& limits)
{
  return { std::to_string(getpid()), std::to_string(limits.Memory),
    std::to_string(limits.CpuSeconds) };
}
}

WorkerAnswer RunWorker(const std::string& program, const std::vector<std::string>& words,
  const std::vector<std::string>& input, const WorkerLimits& limits,
  const std::function<bool()>& goOn)
{
  WorkerAnswer answer;
  const std::string path = PathOfWorker(program);
  if (path.empty())
  {
    answer.End = WorkerEnd::Missing;
    return answer;
  }
  std::vector<std::string> all = FirstWords(limits);
  all.insert(all.end(), words.begin(), words.end());
  Child child(path, all, Clock::now() + std::chrono::seconds(limits.Seconds), goOn);
  if (!child.IsRunning())
  {
    answer.End = WorkerEnd::NotStarted;
    return answer;
  }
  Outcome outcome = WriteParts(child, input);
  if (outcome == Outcome::Done || outcome == Outcome::Stopped) // it may have answered already
  {
    outcome = ReadParts(child, limits.Memory, answer.Parts);
  }
  if (outcome == Outcome::Late || outcome == Outcome::Aborted)
  {
    child.Kill();
  }
  const int status = child.Wait();
  if (outcome != Outcome::Done || answer.Parts.size() < 2)
  {
    answer.Parts.clear();
    answer.End = EndOf(outcome, status);
    return answer;
  }
  answer.End = WorkerEnd::Done;
  answer.Outcome = { static_cast<ErrorCode>(std::atoi(answer.Parts[0].c_str())), answer.Parts[1] };
  answer.Parts.erase(answer.Parts.begin(), answer.Parts.begin() + 2);
  return answer;
}

ProgramAnswer RunForeignProgram(const std::string& program, const std::vector<std::string>& words,
  const std::string& folder, const WorkerLimits& limits, const std::function<bool()>& goOn)
{
  ProgramAnswer answer;
  const std::string runner = PathOfWorker("knotwork-run");
  const std::string path = PathOfForeignProgram(program);
  if (runner.empty() || path.empty())
  {
    answer.End = WorkerEnd::Missing;
    return answer;
  }
  std::vector<std::string> all = FirstWords(limits);
  all.insert(all.end(), { folder, path });
  all.insert(all.end(), words.begin(), words.end());
  Child child(runner, all, Clock::now() + std::chrono::seconds(limits.Seconds), goOn);
  if (!child.IsRunning())
  {
    answer.End = WorkerEnd::NotStarted;
    return answer;
  }
  const Outcome outcome = ReadPrinted(child, answer.Printed);
  if (outcome == Outcome::Late || outcome == Outcome::Aborted)
  {
    child.Kill();
  }
  const int status = child.Wait();
  answer.ExitStatus = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
  answer.End = outcome != Outcome::Done || !WIFEXITED(status) ? EndOf(outcome, status)
    : answer.ExitStatus == WorkerNotStarted                   ? WorkerEnd::NotStarted
                                                              : WorkerEnd::Done;
  return answer;
}

std::string PathOfWorkerScript(const std::string& name)
{
  return PathOfWorker(name, R_OK);
}

TemporaryFolder::TemporaryFolder()
{
  std::error_code error;
  std::string name = (fs::temp_directory_path(error) / "knotwork-XXXXXX").string();
  if (!error && mkdtemp(name.data()))
  {
    this->Folder = name;
  }
}

TemporaryFolder::~TemporaryFolder()
{
  std::error_code ignored;
  if (!this->Folder.empty())
  {
    fs::remove_all(this->Folder, ignored);
  }
}
}
