// SPDX-License-Identifier: BSD-3-Clause
#include "FlattenNumbers.h"

#include "FilterJob.h"

#include <knotwork/MeshParameterization/vtkMeshParameterization.h>

#include <vtkTable.h>
#include <vtkVariant.h>

namespace knotwork
{
void ReportFlattening(
  vtkMeshParameterization* filter, const std::string& prefix, nlohmann::ordered_json& report)
{
  vtkTable* table = vtkTable::SafeDownCast(filter->GetOutputDataObject(2));
  report[prefix + "method"] =
    table->GetValueByName(0, "Method").ToString(); // the one that was used
  ReportTruths(table, 0, { "Fallback", "Injective" }, report);
  ReportRow(table, 0,
    { "RequestedMethod", "FallbackReason", "Charts", "Points", "Triangles", "Loops",
      "TurnedTriangles", "FlippedTriangles", "DividedFaces", "MeanStretch", "MaxStretch",
      "MinSingularValue", "MaxSingularValue", "MeanAreaDistortion", "MaxAreaDistortion",
      "IsometryError", "DistanceError" },
    report);
  report["seconds_of_method"] = filter->GetSeconds();
}
}
