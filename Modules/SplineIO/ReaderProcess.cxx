// SPDX-License-Identifier: BSD-3-Clause
#include "ReaderProcess.h"

#include "ReaderLimits.h"
#include <knotwork/SplineCore/FileEnding.h>

#include <cstdint>
#include <filesystem>

namespace fs = std::filesystem;

namespace knotwork
{
namespace
{
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

std::string InMegabytes(std::uint64_t bytes)
{
  return std::to_string(bytes >> 20U) + " MB";
}
}

Result<std::vector<std::string>> ReadInProcess(
  const std::string& program, const std::string& file, const std::vector<std::string>& options)
{
  const WorkerLimits limits = LimitsOfReader(BytesOf(file));
  std::vector<std::string> words{ file };
  words.insert(words.end(), options.begin(), options.end());
  WorkerAnswer answer = RunWorker(program, words, {}, limits);
  switch (answer.End)
  {
    case WorkerEnd::Done:
      return answer.Outcome ? Result<std::vector<std::string>>(std::move(answer.Parts))
                            : Result<std::vector<std::string>>(answer.Outcome);
    case WorkerEnd::Missing:
      return { ErrorCode::LibraryError,
        "'" + file + "' cannot be read: the program " + program +
          " is missing; install all of Knotwork, or set KNOTWORK_WORKERS to its folder" };
    case WorkerEnd::NotStarted:
      return { ErrorCode::LibraryError,
        "'" + file + "' cannot be read: no process could be started for it; end other programs" };
    case WorkerEnd::Late:
      return { ErrorCode::InvalidFormat,
        "'" + file + "' is damaged: its reader did not end within " +
          std::to_string(limits.CpuSeconds) + " s; write it again" };
    case WorkerEnd::OutOfMemory:
      return { ErrorCode::TooLarge,
        "'" + file + "' is damaged: its reader asked for more than " + InMegabytes(limits.Memory) +
          "; write it again, without compression if it is sound" };
    case WorkerEnd::Crashed:
    case WorkerEnd::Aborted:
      break;
  }
  return { ErrorCode::InvalidFormat,
    "'" + file + "' is damaged: its reader crashed; write it again" };
}
}
