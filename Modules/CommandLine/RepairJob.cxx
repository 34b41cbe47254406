// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/SurfaceRemeshing/vtkSurfaceRepair.h>

namespace knotwork
{
namespace
{
class RepairJob : public FilterJob<vtkSurfaceRepair>
{
public:
  explicit RepairJob(CLI::App& app) : FilterJob(app)
  {
    this->AddInput(0, "mesh", "triangle mesh (.off .obj .ply .stl .vtp .vtu)", "", "input");
    this->AddOutput(0, "--output", Endings::Polygons, "the repaired triangles");
    this->AddOutput(1, "--actions", Endings::Points, "the places of what was done, as points");
    this->AddProperties();
  }

protected:
  Status AddNumbers(Session& session) override
  {
    vtkTable* numbers = this->Table(Numbers);
    ReportTruths(numbers, 0, { "Changed", "Closed", "Wrapped" }, session.Report);
    ReportRow(numbers, 0,
      { "DegenerateFaces", "DuplicateFaces", "LooseFaces", "TurnedFaces", "Junctions", "Holes",
        "Intersections", "DividedEdges", "DividedPoints", "CutTips", "Overlaps", "InnerWalls",
        "SmallParts", "Patches", "MergedPoints", "PointsBefore", "PointsAfter", "TrianglesBefore",
        "TrianglesAfter", "PartsBefore", "PartsAfter", "EulerBefore", "EulerAfter", "AreaBefore",
        "AreaAfter", "VolumeBefore", "VolumeAfter", "DistanceFromInput", "DistanceToInput",
        "Diagonal" },
      session.Report);
    return {};
  }

private:
  static constexpr int Numbers = 2;
};

const JobRegistration Registration{ "repair",
  "repair a triangle mesh to a closed, oriented surface without intersections",
  "cow.off --output solid.vtp --actions places.vtp --report repair.json", MakeJob<RepairJob> };
}
}
