// SPDX-License-Identifier: BSD-3-Clause
#include "FlattenOptions.h"

#include "Options.h"

#include <knotwork/MeshParameterization/vtkMeshParameterization.h>

#include <vtkTable.h>
#include <vtkVariant.h>

namespace knotwork
{
void AddFlattenOptions(Options& options, vtkMeshParameterization* filter, const char* methodName)
{
  options.AddChoice(
    methodName, { "hlle", "isomap", "laplacian", "lscm", "arap", "injective" }, filter->GetMethod(),
    [filter](int method) { filter->SetMethod(method); }, "how the mesh is laid into the plane");
  KNOTWORK_CHOICE(
    options, filter, LaplacianWeights, "of Laplacian eigenmaps", "cotangent", "graph");
  KNOTWORK_CHOICE(options, filter, Geodesics, "distances of Isomap and of the distance error",
    "unfolding", "edge-graph");
  KNOTWORK_OPTION(options, filter, Neighbours, "geodesic neighbours of a vertex for HLLE");
  KNOTWORK_OPTION(options, filter, Landmarks, "points whose distances Isomap takes");
  KNOTWORK_OPTION(options, filter, MaximumIterations, "iterations of ARAP and Injective at most");
  KNOTWORK_OPTION(options, filter, MinimumParticipation,
    "HLLE rejects eigenvectors that live on a smaller part of the area");
  KNOTWORK_OPTION(options, filter, MaximumStretch,
    "above 1: cut the mesh into charts that are stretched less; 0: one chart");
  KNOTWORK_OPTION(options, filter, MaximumCharts, "charts at most");
  KNOTWORK_OPTION(options, filter, CreaseAngle, "degrees; cuts run along sharper edges");
  KNOTWORK_FREE_OPTION(options, filter, Fallback,
    "whether HLLE is replaced when it folds or fails, or stretches a chart too much");
  KNOTWORK_FREE_OPTION(options, filter, LargestComponent,
    "take the component of the most triangles instead of refusing several ones");
}

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
