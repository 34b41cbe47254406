// SPDX-License-Identifier: BSD-3-Clause
#include "MapOutput.h"

#include "GeoFiles.h"
#include "OutputFiles.h"
#include <knotwork/SplineGrid/ReferenceSystem.h>

namespace knotwork
{
Result<std::string> SystemToWrite(
  vtkDataObject* data, const std::string& stated, std::vector<std::string>& warnings)
{
  const std::string text = stated.empty() ? ReferenceSystemOf(data) : stated;
  if (text.empty())
  {
    return std::string();
  }
  auto found = FindReferenceSystem(text);
  if (!found && stated.empty() && found.Status.Code == ErrorCode::InvalidParameter)
  {
    warnings.push_back("it is written without its reference system: " + found.Status.Detail);
    return std::string();
  }
  return found ? Result<std::string>(found->Wkt) : found.Status;
}

Result<std::string> WktOfReferenceSystem(const std::string& stated)
{
  auto found = stated.empty() ? Result<MapReferenceSystem>() : FindReferenceSystem(stated);
  return found ? Result<std::string>(std::move(found->Wkt)) : found.Status;
}

Result<std::string> StateReferenceSystem(const std::string& stated, vtkDataObject* data)
{
  const std::string text = stated.empty() ? ReferenceSystemOf(data) : stated;
  auto found = text.empty() ? Result<MapReferenceSystem>() : FindReferenceSystem(text);
  if (!found && stated.empty() && found.Status.Code == ErrorCode::InvalidParameter)
  {
    return std::string("unknown");
  }
  if (found && !stated.empty())
  {
    SetReferenceSystem(data, found->Wkt);
  }
  return found ? Result<std::string>(found->Name) : found.Status;
}

Status WriteStaged(const std::string& file, const std::function<Status(const std::string&)>& write)
{
  OutputFiles files;
  Status status = files.Plan("the file", file);
  auto staged = status ? files.Stage(file) : status;
  if (!staged)
  {
    return staged.Status;
  }
  status = write(staged->string());
  if (status.Code == ErrorCode::FileError)
  {
    return AboutFile(status, file, staged->string());
  }
  return status ? files.Commit() : status;
}
}
