// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>

#include <string>
#include <vector>

namespace knotwork
{
/// Reads a file in a process of its own, by a program of Worker/ (RunWorker runs it).
/// @param program  its name.
/// @param options  more arguments for it.
/// @return what it found, in parts; its own error; LibraryError: there is no such program
/// or no process; InvalidFormat: it crashed or did not end in time; TooLarge: it asked for too much
/// memory. Messages name the file.
/// @complexity that of the reader, and about 10 ms (STEP and IGES: 60 ms)
Result<std::vector<std::string>> ReadInProcess(const std::string& program, const std::string& file,
  const std::vector<std::string>& options = {});
}
