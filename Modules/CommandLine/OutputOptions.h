// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>
#include <knotwork/SplineIO/FileFormats.h>

#include <string>

namespace CLI
{
class App;
class Option;
}

namespace knotwork
{
class OutputFiles;

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
inline const std::string Grid = Writing(GridContent);
inline const std::string Image = Writing(ImageContent);
inline const std::string Points = Writing(PointContent);
inline const std::string Polygons = Writing(PolygonContent | PointValueContent);
inline const std::string Sampled = Writing(PointContent | CellContent);
inline const std::string Spline = Writing(SplineGridContent);
inline const std::string Splines = Writing(SplineGridContent | SplineCollectionContent);
inline const std::string Surfaces = Writing(TrimmedFaceContent);
inline const std::string Table = Writing(TableContent);
}

/// Adds an option that names a file the job writes; main plans it before the job begins.
CLI::Option* AddOutput(CLI::App& app, const std::string& name, std::string& file,
  const std::string& endings, const std::string& help);

/// Plans the outputs that were given to options of AddOutput.
Status PlanOutputs(const CLI::App& job, OutputFiles& files);
/// Plans one. @param option  the one that names it.
Status PlanOutput(const std::string& option, const std::string& file, const std::string& endings,
  OutputFiles& files);
}
