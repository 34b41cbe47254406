// SPDX-License-Identifier: BSD-3-Clause
#include "TrialRead.h"

#include <algorithm>
#include <array>
#include <exception>

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

std::string ReadAll(int file)
{
  std::string text;
  std::array<char, 4096> buffer;
  for (ssize_t n = 0; (n = ::read(file, buffer.data(), buffer.size())) > 0;)
  {
    text.append(buffer.data(), static_cast<std::size_t>(n));
  }
  return text;
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
  std::string errors = child > 0 ? ReadAll(ends[0]) : std::string();
  close(ends[0]);
  int outcome = 0;
  if (child <= 0 || waitpid(child, &outcome, 0) != child)
  {
    return {};
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
