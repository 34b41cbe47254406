// SPDX-License-Identifier: BSD-3-Clause
#include "FileText.h"

#include <knotwork/SplineCore/FileOutput.h>
#include <knotwork/SplineGrid/DistributedInput.h>
#include <knotwork/SplineGrid/FilterErrorCode.h>

#include "vtkErrorCode.h"

#include <exception>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace knotwork
{
Result<std::string> TextOfFile(const std::string& file)
{
  if (file.empty())
  {
    return { ErrorCode::EmptyInput, "there is no file name" };
  }
  std::ifstream stream(file, std::ios::binary | std::ios::ate);
  std::error_code ignored;
  const bool opened = stream && !std::filesystem::is_directory(file, ignored);
  const std::streamoff size = opened ? static_cast<std::streamoff>(stream.tellg()) : -1;
  std::string text;
  if (size >= 0)
  {
    text.resize(static_cast<std::size_t>(size));
    stream.seekg(0);
    stream.read(text.data(), size);
  }
  if (size < 0 || !stream)
  {
    return { ErrorCode::FileError,
      "'" + file + "' cannot be read; check its name and permissions" };
  }
  return text;
}

std::string BeginningOfFile(const std::string& file)
{
  std::ifstream stream(file, std::ios::binary);
  std::string beginning(4096, '\0');
  stream.read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
  beginning.resize(static_cast<std::size_t>(stream.gcount()));
  return beginning;
}

WriteOutcome WriteText(
  vtkDataObject* input, const char* file, const std::function<Status(std::string&)>& makeText)
{
  std::string text;
  bool idle = false;
  Status status = CheckOneWriter(input, idle);
  if (idle)
  {
    return {};
  }
  if (status && (!file || file[0] == '\0'))
  {
    status = { ErrorCode::InvalidParameter, "there is no file name" };
  }
  try
  {
    status = status ? makeText(text) : status;
  }
  catch (...) // out of memory, or of a library below the kernel
  {
    status = StatusOfException();
  }
  if (!status)
  {
    return { FilterErrorCode(status), status.Message() };
  }
  FileOutput output(file);
  output.Stream().write(text.data(), static_cast<std::streamsize>(text.size()));
  status = output.Finish();
  const unsigned long code = status ? vtkErrorCode::NoError : vtkErrorCode::CannotOpenFileError;
  return { code, status.Detail };
}
}
