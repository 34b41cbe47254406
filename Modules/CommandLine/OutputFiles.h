// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>

#include <filesystem>
#include <string>
#include <vector>

namespace CLI
{
class App;
class Option;
}

namespace knotwork
{
/// Endings of the files that outputs are written to, joined by '|'; empty: any.
namespace Endings
{
constexpr const char* Any = "";
constexpr const char* Anything = ".vtu|.vtp|.vtpc|.xml|.g2|.step|.stp|.iges|.igs|.xyz|.txt|.csv";
constexpr const char* Cells = ".vtp|.vtu|.vtpc|.stl|.obj|.ply";
constexpr const char* Contours = ".vtp|.vtu|.xml|.g2";
constexpr const char* Grid = ".vtu";
constexpr const char* Image = ".vti";
constexpr const char* Points = ".vtp|.xyz|.txt|.csv|.g2";
constexpr const char* Polygons = ".vtp|.stl|.obj|.ply|.xyz|.txt|.csv";
constexpr const char* Sampled = ".vtp|.vtu|.vtpc|.xyz|.txt|.csv|.g2";
constexpr const char* Spline = ".vtu|.xml|.g2|.step|.stp|.iges|.igs";
constexpr const char* Splines = ".vtu|.vtpc|.xml|.g2|.step|.stp|.iges|.igs";
constexpr const char* Surfaces = ".step|.stp|.iges|.igs|.vtu";
constexpr const char* Table = ".csv";
}

/// Adds an option that names a file the job writes; main plans it before the job begins.
CLI::Option* AddOutput(CLI::App& app, const std::string& name, std::string& file,
  const char* endings, const std::string& help);

/// The files that a job writes. What cannot be written is refused before the work; each is made in
/// a temporary folder beside its place, and all take their places together or none does.
///
/// Nothing goes but what is replaced: a file of the same name, and the pieces that an older .vtpc
/// of the same name lists. Symbolic links stay, what they point to is replaced. Devices and pipes
/// are written to as they are.
class OutputFiles
{
public:
  OutputFiles() = default;
  ~OutputFiles();
  OutputFiles(const OutputFiles&) = delete;
  OutputFiles& operator=(const OutputFiles&) = delete;

  bool Force = false; ///< inputs may be replaced

  /// Plans the outputs that were given to options of AddOutput.
  Status Plan(const CLI::App& job);
  /// Plans one. @param option  the one that names it.
  Status Plan(const std::string& option, const std::string& file, const std::string& endings);

  /// Refuses an input that is also an output, by whatever names.
  Status CheckInput(const std::string& file) const;

  /// Where to write an output that is planned (one that is not is planned now).
  Result<std::filesystem::path> Stage(const std::string& file);

  /// Forgets what was staged for a file.
  void Drop(const std::string& file);

  /// All staged files take their places.
  Status Commit();

private:
  struct Output
  {
    std::string Option;
    std::string Name;                   ///< as given
    std::filesystem::path Target;       ///< links followed
    std::filesystem::path Pieces;       ///< folder of the pieces of a .vtpc
    std::vector<std::string> OldPieces; ///< names in it that an older .vtpc lists
    bool IsStream = false;              ///< a device or pipe
    std::filesystem::path Folder;       ///< temporary
  };
  class Moves;

  Status PlanPieces(Output& output) const;
  Status CheckOthers(const Output& output) const;
  static Status WriteStream(const Output& output);
  static Status Move(const Output& output, Moves& moves);

  std::vector<Output> Outputs;
};
}
