// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/SplineGrid/vtkUnstructuredSpline.h>

#include <vtkVariant.h>

namespace knotwork
{
namespace
{
class UnstructuredJob : public FilterJob<vtkUnstructuredSpline>
{
public:
  explicit UnstructuredJob(CLI::App& app) : FilterJob(app)
  {
    this->AddInput(0, "mesh",
      "mesh of quadrilaterals or hexahedra (.off .obj .ply .vtk .vtp .vtu .mesh)", "", "input");
    this->AddOutput(0, "--output", Endings::Spline, "the spline");
    this->AddOutput(1, "--table", Endings::Table, "its numbers");
    this->AddProperties();
  }

protected:
  Status Prepare(Session&) override { return this->RequirePointSet(0); }

  Status AddNumbers(Session& session) override
  {
    vtkTable* table = this->Table(1);
    session.Report["policy_taken"] = table->GetValueByName(0, "Policy").ToString();
    ReportRow(table, 0,
      { "Functions", "Elements", "CreasedFacets", "InnerFacets", "ExtraordinaryPoints", "Repairs",
        "MaxNormalAngle", "MaxNormalAngleBefore", "MaxVertexDistance", "RmsVertexDistance",
        "FoldedCells", "StillFolded", "FoldedElements", "MovedPoints", "LargestMove" },
      session.Report);
    // the options have the names of the numbers
    session.Report["tangent_planes_made"] = table->GetValueByName(0, "TangentPlanes").ToInt();
    session.Report["polygons_split"] = table->GetValueByName(0, "SplitPolygons").ToInt();
    ReportTruths(table, 0, { "Orientable" }, session.Report);
    return {};
  }
};

const JobRegistration Registration{ "unstructured",
  "make one smooth spline of a mesh of quadrilaterals or hexahedra",
  "part.off --degree 3 --output part.vtu --report part.json", MakeJob<UnstructuredJob> };
}
}
