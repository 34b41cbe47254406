// SPDX-License-Identifier: BSD-3-Clause
#include "Termination.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <iostream>
#include <system_error>
#include <thread>
#include <vector>

#include <unistd.h>

namespace fs = std::filesystem;

namespace knotwork::Termination
{
namespace
{
struct State
{
  std::mutex Mutex;
  std::vector<fs::path> Folders;
  std::vector<fs::path> OthersFolders;
  std::vector<int> Speakers;
  bool IsSilent = false;
  std::string Job;
  bool Done = false;
};

/// Never destroyed: the waiting thread may look at it until the end.
State& Shared()
{
  static State& state = *new State;
  return state;
}

/// Those that are not ignored.
sigset_t Awaited()
{
  sigset_t set;
  sigemptyset(&set);
  for (const int number : { SIGTERM, SIGINT, SIGHUP })
  {
    struct sigaction action
    {
    };
    if (sigaction(number, nullptr, &action) == 0 && action.sa_handler != SIG_IGN)
    {
      sigaddset(&set, number);
    }
  }
  return set;
}

sigset_t awaited;

void Block()
{
  awaited = Awaited();
  sigprocmask(SIG_BLOCK, &awaited, nullptr);
}

#ifdef __GLIBC__
/// Comes before the constructors of shared libraries: OpenBLAS makes its threads in one.
__attribute__((section(".preinit_array"), used)) void (*const BlockFirst)() = Block;
#endif

const char* NameOf(int number)
{
  return number == SIGTERM ? "SIGTERM" : number == SIGINT ? "SIGINT" : "SIGHUP";
}

/// Other threads still write into it: it is tried until it is gone.
void RemoveWhileInUse(const fs::path& folder)
{
  constexpr int MostTrials = 1000;
  std::error_code failure;
  for (int i = 0; i < MostTrials; ++i)
  {
    fs::remove_all(folder, failure);
    if (!fs::exists(folder, failure))
    {
      return;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

[[noreturn]] void End(int number)
{
  const auto lives = [](int process) { return kill(process, 0) == 0; };
  const bool isSilent =
    Shared().IsSilent || std::any_of(Shared().Speakers.begin(), Shared().Speakers.end(), lives);
  for (const auto* folders : { &Shared().Folders, &Shared().OthersFolders })
  {
    for (const fs::path& folder : *folders)
    {
      RemoveWhileInUse(folder);
    }
  }
  constexpr int BySignal = 128; // as shells have it
  if (isSilent)
  {
    _exit(BySignal + number);
  }
  const std::string line = (isatty(STDERR_FILENO) == 1 ? "\r" : "") + std::string("knotwork ") +
    Shared().Job + ": ended by " + NameOf(number) + "; no output is written\n";
  static_cast<void>(!write(STDERR_FILENO, line.data(), line.size()));
  _exit(BySignal + number);
}

void Wait()
{
  while (true)
  {
    int number = 0;
    if (sigwait(&awaited, &number) != 0)
    {
      return;
    }
    const auto lock = Hold();
    if (!Shared().Done)
    {
      End(number);
    }
  }
}
}

void Begin(const std::string& job)
{
  Shared().Job = job;
  Block(); // for systems that know nothing of the array above
  std::thread(Wait).detach();
}

void SpeakAfter(const std::vector<int>& processes)
{
  const auto lock = Hold();
  Shared().Speakers = processes;
}

void LastWord(const std::string& line)
{
  const auto lock = Hold();
  std::cerr << line << std::flush;
  Shared().IsSilent = true;
}

std::unique_lock<std::mutex> Hold()
{
  return std::unique_lock<std::mutex>(Shared().Mutex);
}

Result<fs::path> Folders::Make(const fs::path& pattern)
{
  const auto lock = Hold();
  auto made = TemporaryFolders::Make(pattern);
  if (made)
  {
    Shared().Folders.push_back(made.Value);
  }
  return made;
}

void Folders::Remove(const fs::path& folder)
{
  const auto lock = Hold();
  TemporaryFolders::Remove(folder);
  auto& folders = Shared().Folders;
  folders.erase(std::remove(folders.begin(), folders.end(), folder), folders.end());
}

void Folders::Guard(const fs::path& folder)
{
  const auto lock = Hold();
  Shared().OthersFolders.push_back(folder);
}

void Folders::Unguard()
{
  const auto lock = Hold();
  Shared().OthersFolders.clear();
}

Status Folders::Whole(const std::function<Status()>& work)
{
  const auto lock = Hold();
  const Status status = work();
  Shared().Done = static_cast<bool>(status);
  return status;
}
}
