// SPDX-License-Identifier: BSD-3-Clause
#include "TrialRead.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <exception>
#include <filesystem>

#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

namespace knotwork
{
namespace
{
[[noreturn]] void RunChild(int errors, const std::function<void()>& read)
{
  dup2(errors, STDERR_FILENO);
  try
  {
    read();
  }
  catch (const std::exception&) // out of memory
  {
    _exit(1);
  }
  _exit(0); // nothing of the parent is flushed or destroyed here
}

/// What a child writes until it ends; false when it has not ended in time.
bool ReadAll(int file, std::chrono::seconds limit, std::string& text)
{
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + limit;
  std::array<char, 4096> buffer;
  while (true)
  {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now());
    pollfd ready{ file, POLLIN, 0 };
    if (left.count() <= 0 || poll(&ready, 1, static_cast<int>(left.count())) == 0)
    {
      return false;
    }
    const ssize_t n = ::read(file, buffer.data(), buffer.size());
    if (n <= 0)
    {
      return true;
    }
    text.append(buffer.data(), static_cast<std::size_t>(n));
  }
}

/// Far above what sound files take.
std::chrono::seconds TimeLimit(const std::string& file)
{
  std::error_code failure;
  const auto bytes = std::filesystem::file_size(file, failure);
  const auto megabytes = failure ? 0 : std::min<std::uintmax_t>(bytes >> 20U, 10'000);
  return std::chrono::seconds(60 + 60 * static_cast<int>(megabytes));
}
}

Status TrialRead(const std::string& file, const std::function<void()>& read)
{
  int ends[2];
  if (pipe(ends) != 0)
  {
    return {}; // no trial; the reader may still do
  }
  const pid_t child = fork();
  if (child == 0)
  {
    close(ends[0]);
    RunChild(ends[1], read);
  }
  close(ends[1]);
  std::string errors;
  const auto limit = TimeLimit(file);
  const bool ended = child <= 0 || ReadAll(ends[0], limit, errors);
  close(ends[0]);
  if (!ended)
  {
    kill(child, SIGKILL);
  }
  int outcome = 0;
  if (child <= 0 || waitpid(child, &outcome, 0) != child)
  {
    return {};
  }
  if (!ended)
  {
    return { ErrorCode::InvalidFormat,
      "'" + file + "' is damaged: its reader did not end within " + std::to_string(limit.count()) +
        " s; write it again" };
  }
  if (outcome == 0 && errors.empty())
  {
    return {};
  }
  errors.resize(std::min(errors.find('\n'), errors.size()));
  return { ErrorCode::InvalidTopology,
    "'" + file + "' is damaged or not what its ending says" +
      (errors.empty() ? std::string() : ": " + errors) };
}
}
