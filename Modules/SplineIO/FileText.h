// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>

#include <functional>
#include <string>

class vtkDataObject;

namespace knotwork
{
/// All bytes of a file. @return FileError with the name when it cannot be read.
Result<std::string> TextOfFile(const std::string& file);

/// The first 4096 bytes; none when the file cannot be read.
std::string BeginningOfFile(const std::string& file);

/// How the writing of a file ended: an error code as VTK's writers have them, and what to tell.
struct WriteOutcome
{
  unsigned long Code = 0;
  std::string Message; ///< empty when the file is written
};

/// What a writer does with its input: makes a text and writes it. Nothing is written unless all of
/// it could be made; a missing name, memory that does not suffice, or an exception of a library is
/// an outcome too. A rank that has no part of distributed data writes nothing (CheckOneWriter).
/// @param file  its name; null: none.
WriteOutcome WriteText(
  vtkDataObject* input, const char* file, const std::function<Status(std::string&)>& makeText);
}
