// SPDX-License-Identifier: BSD-3-Clause
#include "Jobs.h"
#include "Options.h"
#include "Session.h"

#include "vtkMeshParameterization.h"

#include <vtkNew.h>
#include <vtkTable.h>
#include <vtkVariant.h>

#include <memory>

namespace knotwork
{
namespace
{
struct FlattenJob
{
  std::string Input;
  std::string Output;
  std::string Loops;
  std::string Table;
  vtkNew<vtkMeshParameterization> Filter;
  std::unique_ptr<Options> FilterOptions;

  Status Run(Session& session)
  {
    auto input = session.Read(this->Input);
    if (!input)
    {
      return input.Status;
    }
    session.Report["input"] = this->Input;
    session.Report["output"] = this->Output;
    this->Filter->SetInputDataObject(input.Value);
    this->FilterOptions->Apply(session.Report);
    this->Filter->SetThreads(session.Threads);
    if (Status status = session.Run(this->Filter, "'" + this->Input + "'"); !status)
    {
      return status;
    }
    this->AddNumbers(session.Report);
    return session.WriteOutputs(this->Filter, { this->Output, this->Loops, this->Table });
  }

  void AddNumbers(nlohmann::ordered_json& report)
  {
    vtkTable* table = vtkTable::SafeDownCast(this->Filter->GetOutputDataObject(2));
    const auto value = [table](const char* name) { return table->GetValueByName(0, name); };
    const bool fallback = value("Fallback").ToInt() != 0;
    report["requested_method"] = value("RequestedMethod").ToString();
    report["method"] = value("Method").ToString(); // the one that was used
    report["fallback"] = fallback;
    report["fallback_reason"] = value("FallbackReason").ToString();
    for (const char* name :
      { "Points", "Triangles", "Loops", "TurnedTriangles", "FlippedTriangles" })
    {
      report[Options::SnakeCase(name)] = value(name).ToInt();
    }
    for (const char* name : { "MeanStretch", "MaxStretch", "MinSingularValue", "MaxSingularValue",
           "MeanAreaDistortion", "MaxAreaDistortion", "IsometryError", "DistanceError" })
    {
      report[Options::SnakeCase(name)] = value(name).ToDouble();
    }
    report["seconds_of_method"] = value("Seconds").ToDouble();
  }
};
}

Job MakeFlattenJob(CLI::App& app)
{
  auto job = std::make_shared<FlattenJob>();
  app
    .add_option("mesh", job->Input, "triangle mesh with a boundary (.off .obj .ply .stl .vtp .vtu)")
    ->required();
  app.add_option("--output", job->Output, "the mesh with plane coordinates UV (.vtp)")->required();
  app.add_option("--loops", job->Loops, "its boundary loops, the outer one first (.vtp)");
  app.add_option("--table", job->Table, "the summary of distortions (.csv)");
  job->FilterOptions = std::make_unique<Options>(app);
  Options& options = *job->FilterOptions;
  vtkMeshParameterization* filter = job->Filter;
  options.AddChoice(
    "Method", { "hlle", "isomap", "laplacian", "lscm", "arap", "injective" }, filter->GetMethod(),
    [filter](int method) { filter->SetMethod(method); }, "how the mesh is laid into the plane");
  options.AddChoice(
    "LaplacianWeights", { "cotangent", "graph" }, filter->GetLaplacianWeights(),
    [filter](int weights) { filter->SetLaplacianWeights(weights); }, "of Laplacian eigenmaps");
  options.AddChoice(
    "Geodesics", { "unfolding", "edge-graph" }, filter->GetGeodesics(),
    [filter](int geodesics) { filter->SetGeodesics(geodesics); },
    "distances of Isomap and of the distance error");
  KNOTWORK_OPTION(options, filter, Neighbours, "geodesic neighbours of a vertex for HLLE");
  KNOTWORK_OPTION(options, filter, Landmarks, "points whose distances Isomap takes");
  KNOTWORK_OPTION(options, filter, MaximumIterations, "iterations of ARAP and Injective at most");
  KNOTWORK_OPTION(options, filter, MinimumParticipation,
    "HLLE rejects eigenvectors that live on a smaller part of the area");
  KNOTWORK_FREE_OPTION(
    options, filter, Fallback, "whether HLLE is replaced when it folds or fails");
  KNOTWORK_FREE_OPTION(options, filter, LargestComponent,
    "take the component of the most triangles instead of refusing several ones");
  KNOTWORK_FREE_OPTION(options, filter, FlatOutput, "points of the output are (u, v, 0)");
  return [job](Session& session) { return job->Run(session); };
}
}
