// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>

#include <memory>
#include <sstream> // for std::ostream
#include <string>

namespace knotwork
{
/// A file that is there whole or not at all: what is streamed goes to a new file beside it, which
/// takes its place when all of it has been written. Symbolic links stay and what they point to is
/// replaced; devices and pipes are written to directly. The one place below the filters that
/// writes: OpenCASCADE's formats and all others go through it.
class FileOutput
{
public:
  explicit FileOutput(const std::string& file);
  /// Removes what has not been finished; a file that was there before is as it was.
  ~FileOutput();
  FileOutput(const FileOutput&) = delete;
  FileOutput& operator=(const FileOutput&) = delete;

  /// Bad as soon as something cannot be written.
  std::ostream& Stream();

  /// Writes the rest, closes and names the file.
  /// @return FileError with the file and the reason that the system gives, also of what
  /// went wrong before.
  Status Finish();

private:
  class Buffer;
  std::unique_ptr<Buffer> Bytes;
  std::ostream Text;
  std::string File;      ///< as asked for
  std::string Target;    ///< links followed
  std::string Temporary; ///< beside it; empty: written directly
};

/// Writes a file whose text is at hand. @return that of FileOutput::Finish.
Status PutText(const std::string& text, const std::string& file);
}
