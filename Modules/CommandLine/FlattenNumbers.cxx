// SPDX-License-Identifier: BSD-3-Clause
#include "FlattenNumbers.h"

#include "Options.h"

#include <knotwork/MeshParameterization/vtkMeshParameterization.h>

#include <vtkTable.h>
#include <vtkVariant.h>

namespace knotwork
{
void ReportFlattening(
  vtkMeshParameterization* filter, const std::string& prefix, nlohmann::ordered_json& report)
{
  vtkTable* table = vtkTable::SafeDownCast(filter->GetOutputDataObject(2));
  const auto value = [table](const char* name) { return table->GetValueByName(0, name); };
  report[prefix + "method"] = value("Method").ToString(); // the one that was used
  report["requested_method"] = value("RequestedMethod").ToString();
  report["fallback"] = value("Fallback").ToInt() != 0;
  report["fallback_reason"] = value("FallbackReason").ToString();
  for (const char* name : { "Charts", "Points", "Triangles", "Loops", "TurnedTriangles",
         "FlippedTriangles", "DividedFaces" })
  {
    report[Options::SnakeCase(name)] = value(name).ToInt();
  }
  for (const char* name : { "MeanStretch", "MaxStretch", "MinSingularValue", "MaxSingularValue",
         "MeanAreaDistortion", "MaxAreaDistortion", "IsometryError", "DistanceError" })
  {
    report[Options::SnakeCase(name)] = value(name).ToDouble();
  }
  report["seconds_of_method"] = filter->GetSeconds();
}
}
