// SPDX-License-Identifier: BSD-3-Clause
#include "FileOutput.h"

#include <array>
#include <cerrno>
#include <streambuf>
#include <system_error>

#include <fcntl.h>
#include <limits.h>
#include <sys/stat.h>
#include <unistd.h>

namespace knotwork
{
namespace
{
constexpr mode_t AllMayWrite = 0666; ///< less the mask of the process
constexpr mode_t AllModes = 0777;

/// What a name stands for, which need not be there.
std::string FollowLinks(std::string file)
{
  constexpr int MostLinks = 40; // as the system itself
  std::array<char, PATH_MAX> to;
  for (int i = 0; i < MostLinks; ++i)
  {
    const ssize_t length = ::readlink(file.c_str(), to.data(), to.size());
    if (length <= 0)
    {
      break;
    }
    const std::string next(to.data(), static_cast<std::size_t>(length));
    file = next[0] == '/' ? next : file.substr(0, file.rfind('/') + 1) + next;
  }
  return file;
}
}

/// Bytes on their way into a descriptor; keeps the first error.
class FileOutput::Buffer : public std::streambuf
{
public:
  Buffer() { this->setp(this->Bytes.data(), this->Bytes.data() + this->Bytes.size()); }
  ~Buffer() override { this->Close(); }

  void Open(int descriptor)
  {
    this->Descriptor = descriptor;
    this->Error = descriptor < 0 ? errno : 0;
  }

  void Close()
  {
    if (this->Descriptor >= 0)
    {
      this->sync();
      this->Keep(::close(this->Descriptor) == 0);
      this->Descriptor = -1;
    }
  }

  int Error = EBADF; ///< errno of what failed first; 0 = nothing

protected:
  int_type overflow(int_type c) override
  {
    if (this->sync() != 0)
    {
      return traits_type::eof();
    }
    if (!traits_type::eq_int_type(c, traits_type::eof()))
    {
      this->sputc(traits_type::to_char_type(c));
    }
    return traits_type::not_eof(c);
  }

  int sync() override
  {
    const char* next = this->pbase();
    while (this->Error == 0 && next < this->pptr())
    {
      const ssize_t n =
        ::write(this->Descriptor, next, static_cast<std::size_t>(this->pptr() - next));
      this->Keep(n > 0 || (n < 0 && errno == EINTR));
      next += n > 0 ? n : 0;
    }
    this->setp(this->Bytes.data(), this->Bytes.data() + this->Bytes.size());
    return this->Error == 0 ? 0 : -1;
  }

private:
  void Keep(bool isGood)
  {
    if (!isGood && this->Error == 0)
    {
      this->Error = errno == 0 ? EIO : errno;
    }
  }

  std::array<char, 1 << 16> Bytes;
  int Descriptor = -1;
};

FileOutput::FileOutput(const std::string& file)
  : Bytes(std::make_unique<Buffer>()), Text(Bytes.get()), File(file)
{
  struct stat before
  {
  };
  const bool exists = ::stat(file.c_str(), &before) == 0;
  if (exists && !S_ISREG(before.st_mode))
  {
    this->Bytes->Open(::open(file.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC));
    return;
  }
  this->Target = FollowLinks(file);
  int descriptor = -1;
  for (int i = 0; i == 0 || (descriptor < 0 && errno == EEXIST); ++i)
  {
    this->Temporary =
      this->Target + "-" + std::to_string(::getpid()) + "-" + std::to_string(i) + ".part";
    descriptor =
      ::open(this->Temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, AllMayWrite);
  }
  this->Bytes->Open(descriptor);
  if (descriptor < 0)
  {
    this->Temporary.clear();
    return;
  }
  if (exists)
  {
    static_cast<void>(::fchmod(descriptor, before.st_mode & AllModes)); // a kindness: may fail
  }
}

FileOutput::~FileOutput()
{
  this->Bytes->Close();
  if (!this->Temporary.empty())
  {
    ::unlink(this->Temporary.c_str());
  }
}

std::ostream& FileOutput::Stream()
{
  return this->Text;
}

Status FileOutput::Finish()
{
  this->Bytes->Close();
  if (this->Bytes->Error == 0 && !this->Temporary.empty())
  {
    if (::rename(this->Temporary.c_str(), this->Target.c_str()) == 0)
    {
      this->Temporary.clear();
    }
    else
    {
      this->Bytes->Error = errno;
    }
  }
  if (this->Bytes->Error == 0)
  {
    return {};
  }
  return { ErrorCode::FileError,
    "'" + this->File +
      "' cannot be written: " + std::generic_category().message(this->Bytes->Error) };
}

Status PutText(const std::string& text, const std::string& file)
{
  FileOutput output(file);
  output.Stream().write(text.data(), static_cast<std::streamsize>(text.size()));
  return output.Finish();
}
}
