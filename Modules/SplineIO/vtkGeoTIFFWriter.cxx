// SPDX-License-Identifier: BSD-3-Clause
#include "vtkGeoTIFFWriter.h"

#include "HeightRaster.h"
#include "MapOutput.h"
#include "RasterPoints.h"
#include <knotwork/SplineCore/FileEnding.h>
#include <knotwork/SplineGrid/DistributedInput.h>
#include <knotwork/SplineGrid/FilterErrorCode.h>

#include "vtkDataObject.h"
#include "vtkErrorCode.h"
#include "vtkInformation.h"
#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkGeoTIFFWriter);

vtkGeoTIFFWriter::~vtkGeoTIFFWriter()
{
  this->SetFileName(nullptr);
}

int vtkGeoTIFFWriter::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkUnstructuredGrid");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPartitionedDataSetCollection");
  return 1;
}

knotwork::Status vtkGeoTIFFWriter::WriteRaster()
{
  using namespace knotwork;
  const std::string file = this->FileName ? this->FileName : "";
  if (!IsRasterEnding(LowerEnding(file)))
  {
    return { ErrorCode::InvalidParameter,
      "'" + file + "': a raster is written as .tif or .tiff; change the ending" };
  }
  bool idle = false;
  Status status = CheckOneWriter(this->GetInput(), idle);
  if (!status || idle)
  {
    return status;
  }
  std::vector<std::string> warnings;
  const auto system = SystemToWrite(this->GetInput(), this->ReferenceSystem, warnings);
  if (!system)
  {
    return system.Status;
  }
  HeightRasterParams params;
  params.CellSize = this->CellSize;
  params.Corner = { this->Corner[0], this->Corner[1] };
  params.NoData = this->NoData;
  params.IsDouble = this->DoublePrecision;
  params.MaxCells = this->MaximumCells;
  params.ReferenceSystem = system.Value;
  params.Threads = this->Threads;
  params.Progress = [this](double share)
  {
    this->UpdateProgress(share);
    return this->GetAbortExecute() == 0;
  };
  status = WriteStaged(file,
    [&](const std::string& name)
    {
      const auto written = WriteHeightRaster(this->GetInput(), name, params);
      this->Summary = written.Value;
      return written.Status;
    });
  for (const std::string& warning : warnings)
  {
    vtkWarningMacro("'" << file << "': " << warning);
  }
  return status;
}

void vtkGeoTIFFWriter::WriteData()
{
  this->SetErrorCode(vtkErrorCode::NoError);
  knotwork::Status status;
  try
  {
    status = this->WriteRaster();
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
