// SPDX-License-Identifier: BSD-3-Clause
#include <knotwork/SplineGrid/WorkerMain.h>

#include "../WorkerStatus.h"

#include <cerrno>
#include <cstdlib>
#include <exception>
#include <new>
#include <stdexcept>

#include <linux/capability.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace knotwork
{
namespace
{
#if defined(__SANITIZE_ADDRESS__)
constexpr bool HasShadowMemory = true; // far more than any limit
#else
constexpr bool HasShadowMemory = false;
#endif

void Limit(int resource, rlim_t most)
{
  const rlimit limit{ most, most };
  setrlimit(static_cast<__rlimit_resource_t>(resource), &limit);
}

/// Of what the superuser may, reading files is all that remains.
void DropCapabilities()
{
  __user_cap_header_struct header{ _LINUX_CAPABILITY_VERSION_3, 0 };
  __user_cap_data_struct data[2] = {};
  if (syscall(SYS_capget, &header, data) != 0)
  {
    return;
  }
  const unsigned reading = 1U << CAP_DAC_READ_SEARCH;
  data[0].effective = data[0].permitted = data[0].permitted & reading;
  data[1].effective = data[1].permitted = 0;
  data[0].inheritable = data[1].inheritable = 0;
  syscall(SYS_capset, &header, data);
}

}

void ContainProcess(pid_t parent, rlim_t memory, rlim_t cpuSeconds, rlim_t written)
{
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) // it has ended before
  {
    _exit(1);
  }
  close_range(WorkerDescriptor + 1, ~0U, 0);
  prctl(PR_SET_DUMPABLE, 0);
  prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  DropCapabilities();
  Limit(RLIMIT_CORE, 0);
  Limit(RLIMIT_FSIZE, written);
  const rlimit cpu{ cpuSeconds, cpuSeconds + 1 }; // at the first it gets a signal that says why
  setrlimit(RLIMIT_CPU, &cpu);
  if (!HasShadowMemory)
  {
    Limit(RLIMIT_DATA, memory);
  }
}

namespace
{
void WriteAll(const char* from, std::size_t bytes)
{
  while (bytes > 0)
  {
    const ssize_t count = write(WorkerDescriptor, from, bytes);
    if (count < 0 && errno == EINTR)
    {
      continue;
    }
    if (count <= 0)
    {
      _exit(1);
    }
    from += count;
    bytes -= static_cast<std::size_t>(count);
  }
}

void ReadAll(char* to, std::size_t bytes)
{
  while (bytes > 0)
  {
    const ssize_t count = read(WorkerDescriptor, to, bytes);
    if (count < 0 && errno == EINTR)
    {
      continue;
    }
    if (count <= 0) // nobody waits any more
    {
      _exit(1);
    }
    to += count;
    bytes -= static_cast<std::size_t>(count);
  }
}

Parts ReadParts()
{
  Parts parts;
  while (true)
  {
    std::uint64_t length = 0;
    ReadAll(reinterpret_cast<char*>(&length), sizeof(length));
    if (length == WorkerLastPart)
    {
      return parts;
    }
    std::string& part = parts.emplace_back(static_cast<std::size_t>(length), '\0');
    ReadAll(part.data(), part.size());
  }
}

void WritePart(const std::string& part)
{
  const std::uint64_t length = part.size();
  WriteAll(reinterpret_cast<const char*>(&length), sizeof(length));
  WriteAll(part.data(), part.size());
}
}

void WorkerMain(int argc, char* argv[],
  const std::function<Status(const Parts& words, const Parts& input, Parts& found)>& work)
{
  if (argc < 4)
  {
    _exit(2);
  }
  ContainProcess(static_cast<pid_t>(std::atoi(argv[1])), std::strtoull(argv[2], nullptr, 10),
    std::strtoull(argv[3], nullptr, 10), 0);
  try
  {
    Parts found;
    const Status status = work(Parts(argv + 4, argv + argc), ReadParts(), found);
    WritePart(std::to_string(static_cast<int>(status.Code)));
    WritePart(status.Detail);
    for (std::size_t i = 0; i < found.size() && status; ++i)
    {
      WritePart(found[i]);
      found[i] = {};
    }
    WriteAll(reinterpret_cast<const char*>(&WorkerLastPart), sizeof(WorkerLastPart));
  }
  catch (const std::bad_alloc&)
  {
    _exit(WorkerOutOfMemory);
  }
  catch (const std::length_error&) // as much as no memory has
  {
    _exit(WorkerOutOfMemory);
  }
  catch (const std::exception&)
  {
    _exit(1);
  }
  _exit(0); // nothing is destroyed: that may crash too
}
}
