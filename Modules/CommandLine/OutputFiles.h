// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>
#include <knotwork/SplineIO/FileFormats.h>

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
/// Endings of the files that outputs are written to, joined by '|', from the table of formats;
/// empty: any.
namespace Endings
{
inline std::string Writing(unsigned contents)
{
  return JoinEndings(EndingsThatWrite(contents), "|");
}
inline const std::string Any;
inline const std::string Anything =
  Writing(SplineGridContent | SplineCollectionContent | PointContent);
inline const std::string Cells = Writing(PolygonContent | PolygonCollectionContent | CellContent);
inline const std::string Contours = Writing(PolylineContent | SplineCurveContent);
inline const std::string Grid = JoinEndings(EndingsOf({ FormatFamily::VTKGrid }), "|");
inline const std::string Image = Writing(ImageContent);
inline const std::string Points = Writing(PointContent);
inline const std::string Polygons = Writing(PolygonContent | PointValueContent);
inline const std::string Sampled = Writing(PointContent | CellContent);
inline const std::string Spline = Writing(SplineGridContent);
inline const std::string Splines = Writing(SplineGridContent | SplineCollectionContent);
inline const std::string Surfaces = Writing(TrimmedFaceContent);
inline const std::string Table = Writing(TableContent);
}

/// " (did you mean '.step'?)" where an ending is no format's and a known one is near; else empty.
std::string SuggestEnding(const std::string& ending, const std::vector<std::string>& known);

/// Adds an option that names a file the job writes; main plans it before the job begins.
CLI::Option* AddOutput(CLI::App& app, const std::string& name, std::string& file,
  const std::string& endings, const std::string& help);

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
