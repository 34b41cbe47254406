// SPDX-License-Identifier: BSD-3-Clause
#include "OutputFiles.h"

#include "FileFormats.h"
#include "FileText.h"
#include "PieceFiles.h"
#include <knotwork/SplineCore/FileEnding.h>
#include <knotwork/SplineIO/TileIndex.h>

#include <pugixml.hpp>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

namespace fs = std::filesystem;

namespace knotwork
{
namespace
{
constexpr const char* Backup = ".knotwork-before"; ///< in the temporary folder

Status CannotWrite(const std::string& file, const std::string& reason)
{
  return { ErrorCode::FileError, "'" + file + "' cannot be written: " + reason };
}

std::string SystemReason()
{
  return std::generic_category().message(errno);
}

bool Exists(const fs::path& file)
{
  std::error_code ignored;
  return fs::exists(file, ignored);
}

/// Whether two names are of one file that exists: by device and number, so links count.
bool AreSame(const fs::path& a, const fs::path& b)
{
  std::error_code ignored;
  return fs::equivalent(a, b, ignored);
}

/// Whether it lies in the folder, directly or deeper.
bool LiesIn(const fs::path& folder, const fs::path& file)
{
  std::error_code ignored;
  const fs::path outer = fs::weakly_canonical(folder, ignored);
  const fs::path inner = fs::weakly_canonical(file, ignored);
  const auto ends = std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end());
  return !outer.empty() && ends.first == outer.end() && ends.second != inner.end();
}

/// What a name stands for when links are followed, which may be something that is not there.
fs::path FollowLinks(const fs::path& file)
{
  constexpr int MostLinks = 40; // as the system itself
  std::error_code ignored;
  fs::path target = fs::absolute(file);
  for (int i = 0; i < MostLinks && fs::is_symlink(target, ignored); ++i)
  {
    target = target.parent_path() / fs::read_symlink(target, ignored);
  }
  return fs::canonical(target.parent_path(), ignored) / target.filename();
}

/// Devices, pipes, and what goes by their names: /dev/stdout may be a file.
bool IsStream(const std::string& file)
{
  const std::string name = fs::absolute(file).lexically_normal().string();
  std::error_code ignored;
  return Exists(file) && !fs::is_directory(file, ignored) &&
    (!fs::is_regular_file(file, ignored) || name == "/dev/stdout" || name == "/dev/stderr" ||
      name.rfind("/dev/fd/", 0) == 0 || name.rfind("/proc/", 0) == 0);
}

/// Whether a file has pieces in a folder of its name: collections, and indices of tiles.
bool HasPieces(const fs::path& file)
{
  const std::string ending = LowerEnding(file.string());
  return ending == ".vtpc" || ending == ".tiles" || IsPieceIndex(file.string());
}

/// Files that a collection or an index of tiles names.
std::vector<fs::path> PiecesOf(const fs::path& collection)
{
  std::vector<fs::path> pieces;
  std::error_code ignored;
  if (LowerEnding(collection.string()) == ".tiles" && fs::is_regular_file(collection, ignored))
  {
    const auto text = TextOfFile(collection.string());
    const auto index = text ? ReadTileIndex(text.Value) : text.Status;
    for (const CloudTile& tile : index.Value.Tiles)
    {
      pieces.push_back(collection.parent_path() / tile.File);
    }
  }
  if (IsPieceIndex(collection.string()))
  {
    return ReadPieceIndex(collection.string()).Value;
  }
  pugi::xml_document document;
  if (LowerEnding(collection.string()) == ".vtpc" && fs::is_regular_file(collection, ignored) &&
    document.load_file(collection.c_str(), pugi::parse_minimal))
  {
    for (const pugi::xpath_node& node :
      document.select_nodes("/VTKFile[@type='vtkPartitionedDataSetCollection']//DataSet[@file]"))
    {
      pieces.push_back(collection.parent_path() / node.node().attribute("file").value());
    }
  }
  return pieces;
}
}

Status AboutFile(Status status, const std::string& file, const std::string& staged)
{
  const std::string lead = "'" + staged + "' cannot be written: ";
  const auto at = status.Detail.find(lead);
  if (!status)
  {
    status.Detail = "'" + file + "' cannot be written: " +
      (at == std::string::npos ? status.Detail : status.Detail.substr(at + lead.size()));
  }
  return status;
}

Result<fs::path> TemporaryFolders::Make(const fs::path& pattern)
{
  std::string name = pattern.string();
  if (!mkdtemp(name.data()))
  {
    return { ErrorCode::FileError, SystemReason() };
  }
  return fs::path(name);
}

void TemporaryFolders::Remove(const fs::path& folder)
{
  std::error_code ignored;
  fs::remove_all(folder, ignored);
}

/// Renames that can be taken back.
class OutputFiles::Moves
{
public:
  explicit Moves(fs::path folder) : Folder(std::move(folder)) {}
  ~Moves()
  {
    std::error_code ignored;
    for (auto move = this->Made.rbegin(); move != this->Made.rend(); ++move)
    {
      if (move->Before.empty())
      {
        fs::remove(move->After, ignored);
      }
      else
      {
        fs::rename(move->Before, move->After, ignored);
      }
    }
  }
  Moves(const Moves&) = delete;
  Moves& operator=(const Moves&) = delete;

  void Keep() { this->Made.clear(); }

  /// Where the files are kept that go.
  void Use(const fs::path& folder) { this->Folder = folder; }

  void MakeFolder(const fs::path& folder)
  {
    if (fs::create_directory(folder))
    {
      this->Made.push_back({ {}, folder });
    }
  }

  void Remove(const fs::path& file)
  {
    const fs::path before = this->NameBackup();
    fs::rename(file, before);
    this->Made.push_back({ before, file });
  }

  /// At every moment there is a file of that name if there was one.
  void Rename(const fs::path& from, const fs::path& to)
  {
    std::error_code failure;
    fs::path before;
    if (Exists(to))
    {
      before = this->NameBackup();
      fs::create_hard_link(to, before, failure);
      if (failure) // a file system without links
      {
        fs::copy_file(to, before);
      }
      fs::permissions(from, fs::status(to).permissions(), failure);
    }
    fs::rename(from, to);
    this->Made.push_back({ before, to });
  }

private:
  fs::path NameBackup()
  {
    const fs::path folder = this->Folder / Backup;
    fs::create_directory(folder);
    return folder / std::to_string(this->Next++);
  }

  struct Move
  {
    fs::path Before; ///< where the file is that was there; empty: none
    fs::path After;
  };
  fs::path Folder;
  int Next = 0;
  std::vector<Move> Made;
};

OutputFiles::~OutputFiles()
{
  this->Abandon();
}

void OutputFiles::Abandon()
{
  for (Output& output : this->Outputs)
  {
    if (!output.Folder.empty())
    {
      this->Folders->Remove(output.Folder);
      output.Folder.clear();
    }
  }
}

OutputFiles::OutputFiles(std::shared_ptr<TemporaryFolders> folders)
  : Folders(folders ? std::move(folders) : std::make_shared<TemporaryFolders>())
{
}

Status OutputFiles::Plan(
  const std::string& option, const std::string& file, const std::vector<std::string>& known)
{
  if (!known.empty() && std::find(known.begin(), known.end(), LowerEnding(file)) == known.end())
  {
    return { ErrorCode::InvalidParameter,
      "'" + file + "': " + option + " is written as " + JoinEndings(known) + "; change the ending" +
        SuggestEnding(LowerEnding(file), known) };
  }
  Output output;
  output.Option = option;
  output.Name = file;
  output.IsStream = IsStream(file);
  std::error_code error;
  if (output.IsStream)
  {
    if (HasPieces(file))
    {
      return CannotWrite(file, "its pieces need a folder");
    }
    if (access(file.c_str(), W_OK) != 0)
    {
      return CannotWrite(file, SystemReason());
    }
    output.Target = file;
    this->Outputs.push_back(output);
    return {};
  }
  output.Target = FollowLinks(file);
  const fs::path folder = output.Target.parent_path();
  const fs::path name = fs::path(file).filename();
  if (name.empty() || name == "." || name == ".." || folder.empty() ||
    !fs::is_directory(folder, error))
  {
    return { ErrorCode::FileError, "'" + file + "': there is no folder for it" };
  }
  if (fs::is_symlink(output.Target, error))
  {
    return CannotWrite(file, "its links lead nowhere");
  }
  if (access(folder.c_str(), W_OK | X_OK) != 0)
  {
    return CannotWrite(file, "its folder: " + SystemReason());
  }
  if (fs::is_directory(output.Target, error))
  {
    return CannotWrite(file, "it is a folder; give another name");
  }
  if (Exists(output.Target) && access(output.Target.c_str(), W_OK) != 0)
  {
    return CannotWrite(file, SystemReason());
  }
  if (HasPieces(file))
  {
    if (Status status = this->PlanPieces(output); !status)
    {
      return status;
    }
  }
  if (Status status = this->CheckOthers(output); !status)
  {
    return status;
  }
  this->Outputs.push_back(output);
  return {};
}

/// Pieces of a collection stand in a folder of its name; one that holds anything else than the
/// pieces of an older collection of that name is not ours.
Status OutputFiles::PlanPieces(Output& output) const
{
  output.Pieces = output.Target;
  output.Pieces.replace_extension();
  std::error_code error;
  const fs::file_status before = fs::symlink_status(output.Pieces, error);
  if (before.type() == fs::file_type::not_found)
  {
    return {};
  }
  const std::string name = output.Pieces.filename().string();
  if (output.Pieces == output.Target || !fs::is_directory(output.Pieces, error))
  {
    return CannotWrite(output.Name,
      "its pieces need the folder '" + name + "', and there is something else of that name");
  }
  for (const fs::path& piece : PiecesOf(output.Target))
  {
    const bool isDirect = AreSame(piece.parent_path(), output.Pieces);
    const std::string ending = LowerEnding(piece.string());
    const bool isPiece = ending.rfind(".vt", 0) == 0 || ending == ".las" || ending == ".ply";
    if (isDirect && isPiece && fs::is_regular_file(fs::symlink_status(piece, error)))
    {
      output.OldPieces.push_back(piece.filename().string());
    }
  }
  if (output.OldPieces.empty() && !fs::is_empty(output.Pieces, error))
  {
    return CannotWrite(output.Name,
      "its pieces need the folder '" + name +
        "', which holds other files; give another name or move them");
  }
  return {};
}

/// No two outputs have one name, be it of a folder of pieces.
Status OutputFiles::CheckOthers(const Output& output) const
{
  for (const Output& other : this->Outputs)
  {
    const auto claims = [](const Output& a, const Output& b)
    {
      return !a.Pieces.empty() &&
        (a.Pieces == b.Target || a.Pieces == b.Pieces || LiesIn(a.Pieces, b.Target));
    };
    if (other.Target == output.Target || AreSame(other.Target, output.Target) ||
      claims(other, output) || claims(output, other))
    {
      return { ErrorCode::InvalidParameter,
        "'" + output.Name + "' is given to " + other.Option + " and " + output.Option +
          "; every output needs a name of its own" };
    }
  }
  return {};
}

Status OutputFiles::CheckInput(const std::string& file) const
{
  if (this->Force)
  {
    return {};
  }
  std::vector<fs::path> inputs = PiecesOf(file);
  inputs.emplace_back(file);
  for (const Output& output : this->Outputs)
  {
    for (const fs::path& input : inputs)
    {
      if (!output.IsStream && Exists(input) &&
        (AreSame(input, output.Target) || (!output.Pieces.empty() && LiesIn(output.Pieces, input))))
      {
        return { ErrorCode::InvalidParameter,
          "'" + output.Name + "' (" + output.Option + ") would replace the input '" + file +
            "'; give another name, or --force" };
      }
    }
  }
  return {};
}

Result<fs::path> OutputFiles::Stage(const std::string& file)
{
  const auto isIt = [&file](const Output& output)
  { return output.Name == file && output.Folder.empty(); };
  auto output = std::find_if(this->Outputs.begin(), this->Outputs.end(), isIt);
  if (output == this->Outputs.end())
  {
    if (Status status = this->Plan("an output", file); !status)
    {
      return status;
    }
    output = std::prev(this->Outputs.end());
  }
  std::error_code error;
  const fs::path place =
    output->IsStream ? fs::temp_directory_path(error) : output->Target.parent_path();
  auto folder = this->Folders->Make(place / ".knotwork-XXXXXX");
  if (!folder)
  {
    return CannotWrite(file, "its folder: " + folder.Status.Detail);
  }
  output->Folder = folder.Value;
  // formats go by the ending that was asked for, pieces by the name of what links point to
  return folder.Value /
    (output->Pieces.empty() ? fs::path(file).filename() : output->Target.filename());
}

void OutputFiles::Drop(const std::string& file)
{
  for (Output& output : this->Outputs)
  {
    if (output.Name == file && !output.Folder.empty())
    {
      this->Folders->Remove(output.Folder);
      output.Folder.clear();
    }
  }
}

/// Copies what has been made into a device or pipe.
Status OutputFiles::WriteStream(const Output& output)
{
  const fs::path made = output.Folder / fs::path(output.Name).filename();
  const int from = open(made.c_str(), O_RDONLY | O_CLOEXEC);
  const int to = open(output.Target.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  bool isGood = from >= 0 && to >= 0;
  std::array<char, 1 << 16> bytes;
  for (ssize_t n = 1; isGood && n > 0;)
  {
    n = read(from, bytes.data(), bytes.size());
    isGood = n >= 0;
    for (ssize_t done = 0; isGood && done < n;)
    {
      const ssize_t written = write(to, bytes.data() + done, static_cast<std::size_t>(n - done));
      isGood = written > 0;
      done += written;
    }
  }
  Status status = isGood ? Status() : CannotWrite(output.Name, SystemReason());
  if (from >= 0)
  {
    close(from);
  }
  if (to >= 0 && close(to) != 0 && status)
  {
    status = CannotWrite(output.Name, SystemReason());
  }
  return status;
}

/// @throws std::filesystem::filesystem_error
Status OutputFiles::Move(const Output& output, Moves& moves)
{
  moves.Use(output.Folder);
  for (const std::string& old : output.OldPieces)
  {
    moves.Remove(output.Pieces / old);
  }
  std::vector<fs::path> made;
  for (const fs::directory_entry& entry : fs::directory_iterator(output.Folder))
  {
    if (entry.path().filename() != Backup)
    {
      made.push_back(entry.path());
    }
  }
  for (const fs::path& entry : made)
  {
    if (!fs::is_directory(entry))
    {
      moves.Rename(entry, output.Target);
      continue;
    }
    moves.MakeFolder(output.Pieces);
    for (const fs::directory_entry& piece : fs::directory_iterator(entry))
    {
      const fs::path target = output.Pieces / piece.path().filename();
      if (fs::symlink_status(target).type() != fs::file_type::not_found)
      {
        return CannotWrite(
          output.Name, "'" + target.string() + "' is none of its pieces; move it away");
      }
      moves.Rename(piece.path(), target);
    }
  }
  return {};
}

Status OutputFiles::Commit()
{
  for (const Output& output : this->Outputs)
  {
    if (output.IsStream && !output.Folder.empty())
    {
      if (Status status = WriteStream(output); !status)
      {
        return status;
      }
    }
  }
  return this->Folders->Whole([this] { return this->MoveAll(); });
}

Status OutputFiles::MoveAll() const
{
  Moves moves{ {} };
  for (const Output& output : this->Outputs)
  {
    if (output.IsStream || output.Folder.empty())
    {
      continue;
    }
    try
    {
      if (Status status = Move(output, moves); !status)
      {
        return status;
      }
    }
    catch (const fs::filesystem_error& failure)
    {
      return CannotWrite(output.Name, failure.code().message());
    }
  }
  moves.Keep();
  return {};
}
}
