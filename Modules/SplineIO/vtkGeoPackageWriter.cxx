// SPDX-License-Identifier: BSD-3-Clause
#include "vtkGeoPackageWriter.h"

#include "GeoFiles.h"
#include "MapOutput.h"
#include <knotwork/SplineCore/FileEnding.h>
#include <knotwork/SplineGrid/DistributedInput.h>
#include <knotwork/SplineGrid/FilterErrorCode.h>

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkErrorCode.h"
#include "vtkIdList.h"
#include "vtkInformation.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

#include <cctype>
#include <cmath>
#include <filesystem>

vtkStandardNewMacro(vtkGeoPackageWriter);

namespace
{
using namespace knotwork;

/// patch_id of PatchId; heights have the name that maps give them.
std::string AttributeName(const std::string& array)
{
  if (array == "Level")
  {
    return "elevation";
  }
  std::string name;
  for (const char c : array)
  {
    const bool isUpper = std::isupper(static_cast<unsigned char>(c)) != 0;
    if (isUpper && !name.empty() && name.back() != '_')
    {
      name += '_';
    }
    name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return name;
}

bool HoldsIntegers(vtkDataArray* array)
{
  return array->GetDataType() != VTK_FLOAT && array->GetDataType() != VTK_DOUBLE;
}

/// Points of the polylines.
Status AddPoints(vtkPolyData* data, LineLayer& layer)
{
  vtkNew<vtkIdList> corners;
  layer.Begins.push_back(0);
  vtkCellArray* lines = data->GetLines();
  for (vtkIdType line = 0; line < lines->GetNumberOfCells(); ++line)
  {
    lines->GetCellAtId(line, corners);
    for (vtkIdType i = 0; i < corners->GetNumberOfIds(); ++i)
    {
      double point[3];
      data->GetPoint(corners->GetId(i), point);
      for (const double x : point)
      {
        if (!std::isfinite(x))
        {
          return { ErrorCode::NonFiniteInput,
            "point " + std::to_string(corners->GetId(i)) +
              " has a coordinate that is not finite; remove its line" };
        }
        layer.Points.push_back(x);
      }
    }
    layer.Begins.push_back(layer.Points.size() / 3);
  }
  return {};
}

/// Arrays of one number a cell; the names of others are left out.
std::string AddAttributes(vtkPolyData* data, LineLayer& layer)
{
  std::string leftOut;
  const vtkIdType first = data->GetNumberOfVerts();
  for (int a = 0; a < data->GetCellData()->GetNumberOfArrays(); ++a)
  {
    vtkDataArray* array = data->GetCellData()->GetArray(a);
    const char* name = data->GetCellData()->GetArrayName(a);
    if (!array || !name || array->GetNumberOfComponents() != 1)
    {
      leftOut += std::string(leftOut.empty() ? "" : ", ") + (name ? name : "one without a name");
      continue;
    }
    LineAttribute attribute;
    attribute.Name = AttributeName(name);
    attribute.IsInteger = HoldsIntegers(array);
    for (std::size_t line = 0; line + 1 < layer.Begins.size(); ++line)
    {
      attribute.Values.push_back(array->GetComponent(first + static_cast<vtkIdType>(line), 0));
    }
    layer.Attributes.push_back(std::move(attribute));
  }
  return leftOut;
}
}

vtkGeoPackageWriter::~vtkGeoPackageWriter()
{
  this->SetFileName(nullptr);
}

int vtkGeoPackageWriter::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  return 1;
}

Status vtkGeoPackageWriter::WriteLines()
{
  const std::string file = this->FileName ? this->FileName : "";
  if (LowerEnding(file) != ".gpkg")
  {
    return { ErrorCode::InvalidParameter,
      "'" + file + "': lines are written as .gpkg; change the ending" };
  }
  auto* data = vtkPolyData::SafeDownCast(this->GetInput());
  bool idle = false;
  Status status = CheckOneWriter(data, idle);
  if (!status || idle)
  {
    return status;
  }
  if (data->GetNumberOfLines() == 0)
  {
    return { ErrorCode::EmptyInput, "there are no lines; write contours or other polylines" };
  }
  std::vector<std::string> warnings;
  auto system = SystemToWrite(data, this->ReferenceSystem, warnings);
  if (!system)
  {
    return system.Status;
  }
  LineLayer layer;
  layer.Name = std::filesystem::path(file).stem().string();
  layer.ReferenceSystem = system.Value;
  if (status = AddPoints(data, layer); !status)
  {
    return status;
  }
  const std::string leftOut = AddAttributes(data, layer);
  if (!leftOut.empty())
  {
    warnings.push_back("attributes are single numbers; left out: " + leftOut);
  }
  if (data->GetNumberOfPolys() + data->GetNumberOfStrips() + data->GetNumberOfVerts() > 0)
  {
    warnings.emplace_back("points and polygons beside the lines are left out");
  }
  status =
    WriteStaged(file, [&layer](const std::string& name) { return WriteLineLayer(layer, name); });
  for (const std::string& warning : warnings)
  {
    vtkWarningMacro("'" << file << "': " << warning);
  }
  return status;
}

void vtkGeoPackageWriter::WriteData()
{
  this->SetErrorCode(vtkErrorCode::NoError);
  Status status;
  try
  {
    status = this->WriteLines();
  }
  catch (...) // of a library, out of memory
  {
    status = knotwork::StatusOfException();
  }
  if (!status)
  {
    this->SetErrorCode(knotwork::FilterErrorCode(status));
    vtkErrorMacro("" << status.Message());
  }
}
