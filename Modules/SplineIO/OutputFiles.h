// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "vtkKnotworkSplineIOModule.h" // for export macro
#include <knotwork/SplineCore/Status.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace knotwork
{
/// Makes and removes temporary folders. A program that is ended by signals derives its own, which
/// knows what is left to remove.
class VTKKNOTWORKSPLINEIO_EXPORT TemporaryFolders
{
public:
  TemporaryFolders() = default;
  TemporaryFolders(const TemporaryFolders&) = delete;
  TemporaryFolders& operator=(const TemporaryFolders&) = delete;
  virtual ~TemporaryFolders() = default;

  /// Makes a folder of a name that ends in XXXXXX.
  virtual Result<std::filesystem::path> Make(const std::filesystem::path& pattern);
  virtual void Remove(const std::filesystem::path& folder);
  /// Runs what must not be interrupted half done. @return its status.
  virtual Status Whole(const std::function<Status()>& work) { return work(); }
};

/// What is said of a staged file, said of the one that was asked for.
VTKKNOTWORKSPLINEIO_EXPORT Status AboutFile(
  Status status, const std::string& file, const std::string& staged);

/// The files that are written together. What cannot be written is refused before the work; each is
/// made in a temporary folder beside its place, and all take their places together or none does.
///
/// Nothing goes but what is replaced: a file of the same name, and the pieces that an older .vtpc
/// or .tiles of the same name lists. Symbolic links stay, what they point to is replaced. Devices
/// and pipes are written to as they are.
class VTKKNOTWORKSPLINEIO_EXPORT OutputFiles
{
public:
  /// @param folders  null: plain ones.
  explicit OutputFiles(std::shared_ptr<TemporaryFolders> folders = nullptr);
  ~OutputFiles();
  OutputFiles(const OutputFiles&) = delete;
  OutputFiles& operator=(const OutputFiles&) = delete;

  bool Force = false; ///< inputs may be replaced

  /// Plans an output.
  /// @param option  the one that names it.
  /// @param endings  that it may have; empty: any.
  Status Plan(const std::string& option, const std::string& file,
    const std::vector<std::string>& endings = {});

  /// Refuses an input that is also an output, by whatever names.
  Status CheckInput(const std::string& file) const;

  /// Where to write an output that is planned (one that is not is planned now).
  Result<std::filesystem::path> Stage(const std::string& file);

  /// Forgets what was staged for a file.
  void Drop(const std::string& file);

  /// Forgets all: nothing is left of what was staged.
  void Abandon();

  /// All staged files take their places.
  Status Commit();

private:
  struct Output
  {
    std::string Option;
    std::string Name;                   ///< as given
    std::filesystem::path Target;       ///< links followed
    std::filesystem::path Pieces;       ///< folder of the pieces of a .vtpc or .tiles
    std::vector<std::string> OldPieces; ///< names in it that an older one lists
    bool IsStream = false;              ///< a device or pipe
    std::filesystem::path Folder;       ///< temporary
  };
  class Moves;

  Status PlanPieces(Output& output) const;
  Status CheckOthers(const Output& output) const;
  static Status WriteStream(const Output& output);
  static Status Move(const Output& output, Moves& moves);
  Status MoveAll() const;

  std::shared_ptr<TemporaryFolders> Folders;
  std::vector<Output> Outputs;
};
}
