// SPDX-License-Identifier: BSD-3-Clause
#include "FlattenOptions.h"
#include "Jobs.h"
#include "Options.h"
#include "Session.h"

#include "vtkMeshParameterization.h"

#include <vtkNew.h>

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
    ReportFlattening(this->Filter, "", session.Report);
    return session.WriteOutputs(this->Filter, { this->Output, this->Loops, this->Table });
  }
};

Job Make(CLI::App& app)
{
  auto job = std::make_shared<FlattenJob>();
  app.add_option("mesh", job->Input, "triangle mesh (.off .obj .ply .stl .vtp .vtu)")->required();
  AddOutput(app, "--output", job->Output, Endings::Polygons, "the mesh with plane coordinates UV")
    ->required();
  AddOutput(app, "--loops", job->Loops, Endings::Points, "its boundary loops, the outer one first");
  AddOutput(app, "--table", job->Table, Endings::Table, "the summary of distortions");
  job->FilterOptions = std::make_unique<Options>(app);
  Options& options = *job->FilterOptions;
  vtkMeshParameterization* filter = job->Filter;
  AddFlattenOptions(options, filter, "Method");
  KNOTWORK_FREE_OPTION(options, filter, FlatOutput, "points of the output are (u, v, 0)");
  return [job](Session& session) { return job->Run(session); };
}

const JobRegistration Registration{ "flatten", "lay a triangle mesh with holes into the plane",
  "shell.off --method hlle --output flat.vtp --loops loops.vtp --report flat.json", Make };
}
}
