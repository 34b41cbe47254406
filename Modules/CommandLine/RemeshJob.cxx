// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/SurfaceRemeshing/vtkSurfaceRemesh.h>

namespace knotwork
{
namespace
{
class RemeshJob : public FilterJob<vtkSurfaceRemesh>
{
public:
  explicit RemeshJob(CLI::App& app) : FilterJob(app)
  {
    this->AddInput(0, "mesh", "triangle mesh (.off .obj .ply .stl .vtp .vtu)", "", "input");
    this->AddOutput(0, "--output", Endings::Polygons, "the new triangles");
    this->AddOutput(1, "--lines", Endings::Points, "the sharp edges, rims and corners");
    this->AddProperties();
  }

protected:
  Status AddNumbers(Session& session) override
  {
    ReportRow(this->Table(Numbers), 0,
      { "PointsBefore", "PointsAfter", "TrianglesBefore", "TrianglesAfter", "PartsBefore",
        "PartsAfter", "EulerBefore", "EulerAfter", "AreaBefore", "AreaAfter", "VolumeBefore",
        "VolumeAfter", "LeastAngleBefore", "LeastAngleAfter", "MeanEdgeBefore", "MeanEdgeAfter",
        "FittingEdges", "Intersections", "DistanceFromInput", "DistanceToInput", "Diagonal" },
      session.Report);
    return {};
  }

private:
  static constexpr int Numbers = 2;
};

const JobRegistration Registration{ "remesh",
  "make triangles with edges of wanted lengths on a triangle mesh",
  "shell.off --sizing curvature --tolerance 0.002 --output fine.vtp --report remesh.json",
  MakeJob<RemeshJob> };
}
}
