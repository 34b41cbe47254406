// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/SplineGrid/vtkMeshPatches.h>

#include <vtkPolyData.h>

namespace knotwork
{
namespace
{
class PatchesJob : public FilterJob<vtkMeshPatches>
{
public:
  explicit PatchesJob(CLI::App& app) : FilterJob(app)
  {
    this->AddInput(0, "mesh",
      "mesh of quadrilaterals or hexahedra (.off .obj .ply .vtk .vtp .vtu .mesh)", "", "input");
    this->AddOutput(
      0, "--output", Endings::Grid, "the mesh with the patch and place of every cell");
    this->AddOutput(1, "--cuts", Endings::Polygons, "the cuts and T-joints");
    this->AddOutput(2, "--table", Endings::Table, "the sizes of the patches");
    this->AddProperties();
  }

protected:
  Status Prepare(Session&) override { return this->RequirePointSet(0); }

  Status AddNumbers(Session& session) override
  {
    auto* cuts = vtkPolyData::SafeDownCast(this->Filter->GetOutputDataObject(1));
    session.Report["patches"] = this->Table(2)->GetNumberOfRows();
    session.Report["cells"] =
      this->Filter->GetOutputDataObject(0)->GetNumberOfElements(vtkDataObject::CELL);
    session.Report["cut_facets"] = cuts->GetNumberOfCells() - cuts->GetNumberOfVerts();
    session.Report["t_joints"] = cuts->GetNumberOfVerts();
    return {};
  }
};

const JobRegistration Registration{ "patches",
  "cut a mesh of quadrilaterals or hexahedra into grids of cells",
  "part.off --layout motorcycle-graph --output patches.vtu --cuts cuts.vtp", MakeJob<PatchesJob> };
}
}
