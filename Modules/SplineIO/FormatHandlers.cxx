// SPDX-License-Identifier: BSD-3-Clause
#include "FormatHandlers.h"

#include "PolygonText.h"
#include "VTKText.h"
#include "vtkCADReader.h"
#include "vtkCADWriter.h"
#include "vtkDomainBoundaryReader.h"
#include "vtkGismoXMLReader.h"
#include "vtkGismoXMLWriter.h"
#include "vtkGoToolsG2Reader.h"
#include "vtkGoToolsG2Writer.h"
#include "vtkPointCloudReader.h"
#include "vtkPointCloudWriter.h"
#include <knotwork/SplineCore/FileEnding.h>
#include <knotwork/SplineCore/FileOutput.h>
#include <knotwork/SplineGrid/FilterErrorCode.h>
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkTable.h"

namespace knotwork
{
namespace
{
template <typename Reader>
ErrorCode Update(Reader* reader, const std::string& file, DataFile& found)
{
  reader->SetFileName(file.c_str());
  reader->Update();
  found.Data = reader->GetOutputDataObject(0);
  if (auto* own = vtkSplineAlgorithm::SafeDownCast(reader))
  {
    for (int i = 0; i < own->GetNumberOfPartsLeftOut(); ++i)
    {
      found.LeftOut.push_back(own->GetPartLeftOut(i));
    }
  }
  return CodeOfFilter(reader);
}

template <typename Reader>
ErrorCode ReadWith(const std::string& file, DataFile& found)
{
  vtkNew<Reader> reader;
  return Update(reader.Get(), file, found);
}

ErrorCode ReadG2(const std::string& file, DataFile& found)
{
  vtkNew<vtkPointCloudReader> points;
  if (points->CanReadFile(file.c_str()) != 0)
  {
    return Update(points.Get(), file, found);
  }
  vtkNew<vtkGoToolsG2Reader> reader;
  const ErrorCode code = Update(reader.Get(), file, found);
  vtkDataObject* curves = reader->GetOutputDataObject(1);
  found.Curves = curves->GetNumberOfElements(vtkDataObject::POINT) > 0 ? curves : nullptr;
  return code;
}

ErrorCode ReadFaces(const std::string& file, DataFile& found)
{
  vtkNew<vtkCADReader> reader;
  reader->TriangulationOff();
  const ErrorCode code = Update(reader.Get(), file, found);
  found.Curves = reader->GetOutputDataObject(1);
  return code;
}

/// A writer of ours tells why it has failed as an error of VTK.
Status Outcome(vtkWriter* writer)
{
  return writer->Write() == 1 ? Status() : Status(CodeOfFilter(writer), "");
}

template <typename Writer>
Status WriteWith(vtkDataObject* data, const std::string& file, const DataFileParams&)
{
  vtkNew<Writer> writer;
  writer->SetFileName(file.c_str());
  writer->SetInputDataObject(data);
  return Outcome(writer);
}

Status WriteFaces(vtkDataObject* data, const std::string& file, const DataFileParams& params)
{
  vtkNew<vtkCADWriter> writer;
  writer->SetFileName(file.c_str());
  writer->SetInputDataObject(data);
  if (params.Curves)
  {
    writer->SetInputDataObject(1, params.Curves);
  }
  return Outcome(writer);
}

Status WriteG2(vtkDataObject* data, const std::string& file, const DataFileParams& params)
{
  if (vtkPolyData::SafeDownCast(data))
  {
    return WriteWith<vtkPointCloudWriter>(data, file, params);
  }
  vtkNew<vtkGoToolsG2Writer> writer;
  writer->SetFileName(file.c_str());
  writer->SetInputDataObject(data);
  if (params.Curves)
  {
    writer->SetCurvesData(params.Curves);
  }
  return Outcome(writer);
}

Status WritePointText(vtkDataObject* data, const std::string& file, const DataFileParams& params)
{
  return vtkTable::SafeDownCast(data) ? PutText(TextOfTable(data), file)
                                      : WriteWith<vtkPointCloudWriter>(data, file, params);
}

Status WritePolygons(vtkDataObject* data, const std::string& file, const DataFileParams&)
{
  const auto text = PolygonText(data, LowerEnding(file));
  return text ? PutText(text.Value, file) : text.Status;
}

Status WriteOfVTK(vtkDataObject* data, const std::string& file, const DataFileParams& params)
{
  return WriteVTKFile(data, file, params.Encoding);
}
}

FormatHandler HandlerOf(FormatFamily family)
{
  switch (family)
  {
    case FormatFamily::VTKPolyData:
    case FormatFamily::VTKGrid:
    case FormatFamily::VTKCollection:
    case FormatFamily::VTKImage:
      return { nullptr, WriteOfVTK };
    case FormatFamily::VTKLegacy:
      return { nullptr, nullptr };
    case FormatFamily::GismoXML:
      return { ReadWith<vtkGismoXMLReader>, WriteWith<vtkGismoXMLWriter> };
    case FormatFamily::GoToolsG2:
      return { ReadG2, WriteG2 };
    case FormatFamily::CAD:
      return { ReadFaces, WriteFaces };
    case FormatFamily::BoundaryJSON:
      return { ReadWith<vtkDomainBoundaryReader>, nullptr };
    case FormatFamily::PointText:
      return { ReadWith<vtkPointCloudReader>, WritePointText };
    case FormatFamily::PolygonFile:
      return { ReadWith<vtkPointCloudReader>, WritePolygons };
  }
  return { nullptr, nullptr };
}
}
