// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "Status.h"

#include <string>

namespace knotwork
{
/// All bytes of a file. @return EmptyInput with the name when it cannot be read.
Result<std::string> TextOfFile(const std::string& file);

/// The first 4096 bytes; none when the file cannot be read.
std::string BeginningOfFile(const std::string& file);

/// The ending of a name with its point, in small letters.
std::string LowerEnding(const std::string& file);

/// Writes a whole file or none. @return whether it could be opened, and written.
struct WriteOutcome
{
  bool Opened = false;
  bool Written = false;
};
WriteOutcome WriteText(const std::string& file, const std::string& text);
}
