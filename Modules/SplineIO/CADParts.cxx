// SPDX-License-Identifier: BSD-3-Clause
#include "CADParts.h"

#include "DataParts.h"
#include <knotwork/SurfaceTrimming/TrimmedGrids.h>

#include <vtkDataObject.h>
#include <vtkNew.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>

namespace knotwork
{
std::string ExactText(double value)
{
  char digits[32];
  return { digits, std::to_chars(digits, digits + sizeof(digits), value).ptr };
}

double ExactNumber(const std::string& text)
{
  double value = 0.0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

Status AppendCAD(const CADContents& contents, std::vector<std::string>& parts)
{
  vtkNew<vtkUnstructuredGrid> surfaces;
  vtkNew<vtkUnstructuredGrid> curves;
  const Status status = EncodeTrimmedModel(contents.Model, surfaces, curves);
  if (status)
  {
    AppendParts(surfaces, parts);
    AppendParts(curves, parts);
    parts.push_back(ExactText(contents.MaxGap));
    parts.push_back(std::to_string(contents.NumRefitted));
    parts.push_back(std::to_string(contents.LeftOut.size()));
    parts.insert(parts.end(), contents.LeftOut.begin(), contents.LeftOut.end());
    parts.insert(parts.end(), contents.Warnings.begin(), contents.Warnings.end());
  }
  return status;
}

Result<CADContents> TakeCAD(std::vector<std::string>& parts)
{
  std::size_t next = 0;
  const vtkSmartPointer<vtkDataObject> surfaces = TakeData(parts, next);
  const vtkSmartPointer<vtkDataObject> curves = TakeData(parts, next);
  if (!surfaces || !curves || next + 3 > parts.size())
  {
    return { ErrorCode::InvalidFormat,
      "the file is damaged: its faces cannot be handed over; write it again" };
  }
  auto model = DecodeTrimmedModel(surfaces, curves);
  if (!model)
  {
    return model.Status;
  }
  CADContents contents;
  contents.Model = std::move(model.Value);
  contents.MaxGap = ExactNumber(parts[next++]);
  contents.NumRefitted = std::atoi(parts[next++].c_str());
  const auto numLeftOut =
    std::min(std::strtoull(parts[next].c_str(), nullptr, 10), 0ULL + parts.size() - next - 1);
  const auto leftOut = parts.begin() + static_cast<std::ptrdiff_t>(next + 1);
  const auto warnings = leftOut + static_cast<std::ptrdiff_t>(numLeftOut);
  contents.LeftOut.assign(leftOut, warnings);
  contents.Warnings.assign(warnings, parts.end());
  return contents;
}
}
