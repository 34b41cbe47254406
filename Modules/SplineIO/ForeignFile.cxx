// SPDX-License-Identifier: BSD-3-Clause
#include "ForeignFile.h"

#include "CADParts.h"
#include "DataParts.h"
#include "ReaderProcess.h"

#include <vtkDataObject.h>

namespace knotwork
{
Result<vtkSmartPointer<vtkDataObject>> ReadVTKFile(const std::string& file)
{
  auto parts = ReadInProcess("knotwork-read-vtk", file);
  if (!parts)
  {
    return parts.Status;
  }
  std::size_t next = 0;
  vtkSmartPointer<vtkDataObject> data = TakeData(parts.Value, next);
  if (!data)
  {
    return { ErrorCode::InvalidFormat,
      "'" + file + "' is damaged: its data cannot be handed over; write it again" };
  }
  return data;
}

Result<CADContents> ReadCADInProcess(const std::string& file, const CADReadParams& params)
{
  auto parts = ReadInProcess("knotwork-read-cad", file,
    { std::to_string(static_cast<int>(params.Unit)), ExactText(params.Tolerance) });
  if (!parts)
  {
    return parts.Status;
  }
  auto contents = TakeCAD(parts.Value);
  return contents
    ? std::move(contents)
    : Result<CADContents>(contents.Status.Code, "'" + file + "': " + contents.Status.Detail);
}
}
