// SPDX-License-Identifier: BSD-3-Clause
#include "FileFormats.h"

#include <algorithm>
#include <functional>

namespace knotwork
{
namespace
{
constexpr unsigned Splines = SplineGridContent | SplineCollectionContent;
constexpr unsigned Polygons = PolygonContent | PolygonCollectionContent;
constexpr unsigned PointsAndValues = PointContent | PointValueContent;

std::vector<std::string> EndingsWhere(const std::function<bool(const FileFormat&)>& isMeant)
{
  std::vector<std::string> endings;
  for (const FileFormat& format : FileFormats())
  {
    if (isMeant(format))
    {
      endings.insert(endings.end(), format.Endings.begin(), format.Endings.end());
    }
  }
  return endings;
}
}

const std::vector<FileFormat>& FileFormats()
{
  // PointContent of what is read: vtkPointCloudReader takes it.
  static const std::vector<FileFormat> formats = {
    { "VTK polygons", FormatFamily::VTKPolyData, { ".vtp" },
      PointsAndValues | PolylineContent | PolygonContent,
      PointsAndValues | PolylineContent | PolygonContent | CellContent },
    { "VTK grid", FormatFamily::VTKGrid, { ".vtu" },
      SplineGridContent | SplineCurveContent | CellContent,
      SplineGridContent | SplineCurveContent | TrimmedFaceContent | CellContent },
    { "VTK collection", FormatFamily::VTKCollection, { ".vtpc" },
      SplineCollectionContent | PolygonCollectionContent | CellContent,
      SplineCollectionContent | PolygonCollectionContent | CellContent },
    { "VTK legacy grid", FormatFamily::VTKLegacy, { ".vtk" }, SplineGridContent | CellContent, 0 },
    { "VTK image", FormatFamily::VTKImage, { ".vti" }, 0, ImageContent },
    { "G+Smo XML", FormatFamily::GismoXML, { ".xml" }, Splines | SplineCurveContent,
      Splines | SplineCurveContent },
    { "point text", FormatFamily::PointText, { ".xyz", ".txt" }, PointsAndValues, PointsAndValues },
    { "comma-separated values", FormatFamily::PointText, { ".csv" }, PointsAndValues,
      PointsAndValues | TableContent },
    { "GoTools", FormatFamily::GoToolsG2, { ".g2" }, Splines | SplineCurveContent | PointContent,
      Splines | SplineCurveContent | PointContent },
    { "STEP", FormatFamily::CAD, { ".step", ".stp" }, Splines | TrimmedFaceContent,
      Splines | TrimmedFaceContent },
    { "IGES", FormatFamily::CAD, { ".iges", ".igs" }, Splines | TrimmedFaceContent,
      Splines | TrimmedFaceContent },
    { "STL", FormatFamily::PolygonFile, { ".stl" }, PointContent | PolygonContent, Polygons },
    { "Wavefront OBJ", FormatFamily::PolygonFile, { ".obj" }, PointContent | PolygonContent,
      Polygons },
    { "PLY", FormatFamily::PolygonFile, { ".ply" }, PointsAndValues | PolygonContent, Polygons },
    { "OFF", FormatFamily::PolygonFile, { ".off" }, PointContent | PolygonContent, 0 },
    { "boundary of a domain", FormatFamily::BoundaryJSON, { ".json" }, BoundaryContent, 0 },
  };
  return formats;
}

const FileFormat* FormatOfEnding(const std::string& ending)
{
  for (const FileFormat& format : FileFormats())
  {
    if (std::find(format.Endings.begin(), format.Endings.end(), ending) != format.Endings.end())
    {
      return &format;
    }
  }
  return nullptr;
}

bool IsEndingOf(FormatFamily family, const std::string& ending)
{
  const FileFormat* format = FormatOfEnding(ending);
  return format && format->Family == family;
}

bool IsOfVTK(FormatFamily family)
{
  return family == FormatFamily::VTKPolyData || family == FormatFamily::VTKGrid ||
    family == FormatFamily::VTKCollection || family == FormatFamily::VTKLegacy ||
    family == FormatFamily::VTKImage;
}

std::vector<std::string> EndingsThatRead(unsigned contents)
{
  return EndingsWhere([contents](const FileFormat& one) { return (one.Reads & contents) != 0; });
}

std::vector<std::string> EndingsThatWrite(unsigned contents)
{
  return EndingsWhere([contents](const FileFormat& one) { return (one.Writes & contents) != 0; });
}

std::vector<std::string> EndingsOf(const std::vector<FormatFamily>& families)
{
  return EndingsWhere([&families](const FileFormat& one)
    { return std::find(families.begin(), families.end(), one.Family) != families.end(); });
}

std::string JoinEndings(const std::vector<std::string>& endings, const std::string& between)
{
  std::string text;
  for (const std::string& ending : endings)
  {
    text += (text.empty() ? "" : between) + ending;
  }
  return text;
}
}
