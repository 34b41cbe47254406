// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"
#include "FlattenNumbers.h"

#include <knotwork/MeshParameterization/vtkMeshParameterization.h>

namespace knotwork
{
namespace
{
class FlattenJob : public FilterJob<vtkMeshParameterization>
{
public:
  explicit FlattenJob(CLI::App& app) : FilterJob(app)
  {
    this->AddInput(0, "mesh", "triangle mesh (.off .obj .ply .stl .vtp .vtu)", "", "input");
    this->AddOutput(0, "--output", Endings::Polygons, "the mesh with plane coordinates UV");
    this->AddOutput(1, "--loops", Endings::Points, "its boundary loops, the outer one first");
    this->AddOutput(2, "--table", Endings::Table, "the summary of distortions");
    this->AddProperties();
  }

protected:
  Status AddNumbers(Session& session) override
  {
    ReportFlattening(this->Filter, "", session.Report);
    return {};
  }
};

const JobRegistration Registration{ "flatten", "lay a triangle mesh with holes into the plane",
  "shell.off --method hlle --output flat.vtp --loops loops.vtp --report flat.json",
  MakeJob<FlattenJob> };
}
}
