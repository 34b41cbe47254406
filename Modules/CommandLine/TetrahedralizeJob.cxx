// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/TetMeshing/vtkTetGenMesher.h>

#include <vtkVariant.h>

namespace knotwork
{
namespace
{
class TetrahedralizeJob : public FilterJob<vtkTetGenMesher>
{
public:
  explicit TetrahedralizeJob(CLI::App& app) : FilterJob(app)
  {
    this->AddInput(0, "surface",
      "closed triangle mesh (.off .obj .ply .stl .vtp), a spline (.vtu .xml .g2 .step), or an "
      "image "
      "of volume (.vti)",
      "", "input");
    this->AddInput(1, "--target",
      "the shape that cells of order 2 and 3 follow: a CAD part (.step .stp .iges .igs .brep), "
      "triangles (.stl .off .obj .ply .vtp) or a spline (.vtu .xml .g2)",
      " onto ");
    this->AddInput(2, "--sizes",
      "lengths of edges as an array: volumes with a field of them (.vtu .vti), or points alone, "
      "one "
      "in each region (.vtp .csv)",
      " by ");
    this->AddOutput(0, "--output", Endings::Writing(CellContent | GridContent), "the tetrahedra");
    this->AddOutput(1, "--boundary", Endings::Polygons, "the straight triangles of the boundary");
    this->AddProperties();
  }

protected:
  Status AddNumbers(Session& session) override
  {
    vtkTable* table = this->Table(Numbers);
    ReportRow(table, 0,
      { "Points", "Tetrahedra", "Regions", "BoundaryTriangles", "SmallestDihedralAngle",
        "LargestDihedralAngle", "WorstRadiusEdgeRatio", "Volume", "SurfaceVolume" },
      session.Report);
    ReportTruths(table, 0, { "Repaired" }, session.Report);
    ReportRow(table, 0,
      { "DistanceToSurface", "DistanceFromSurface", "MinJacobianLower", "BoundaryElements",
        "RelaxedElements", "OversizedElements", "Diagonal" },
      session.Report);
    if (!this->InputFile(1).empty())
    {
      ReportRow(table, 0, { "StraightToTarget", "CurvedToTarget" }, session.Report);
    }
    session.Report["verdict"] = table->GetValueByName(0, "Verdict").ToString();
    return {};
  }

private:
  static constexpr int Numbers = 2;
};

const JobRegistration Registration{ "tetrahedralize",
  "fill a closed surface or what an image shows with straight or curved tetrahedra",
  "solid.step --order 2 --output part.vtu --report part.json", MakeJob<TetrahedralizeJob> };
}
}
