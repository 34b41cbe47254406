// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/MeshParameterization/vtkMeshFeatures.h>

namespace knotwork
{
namespace
{
class FeaturesJob : public FilterJob<vtkMeshFeatures>
{
public:
  explicit FeaturesJob(CLI::App& app) : FilterJob(app)
  {
    this->AddInput(0, "mesh", "triangle mesh (.off .obj .ply .stl .vtp .vtu)", "", "input");
    this->AddInput(1, "--edges", "lines through points of the mesh that are edges, too (.vtp)",
      " with the edges ");
    this->AddOutput(0, "--output", Endings::Polygons, "the triangles with RegionId");
    this->AddOutput(1, "--lines", Endings::Points, "the chains of edges, as lines");
    this->AddOutput(2, "--corners", Endings::Points, "the corners, as points");
    this->AddProperties();
  }

protected:
  Status AddNumbers(Session& session) override
  {
    ReportRow(this->Table(Numbers), 0,
      { "SharpEdges", "RimEdges", "Chains", "ClosedChains", "Corners", "Regions", "JoinedRegions",
        "ClosedGaps", "NoiseLevel" },
      session.Report);
    return {};
  }

private:
  static constexpr int Numbers = 3;
};

const JobRegistration Registration{ "features",
  "find the sharp edges of a triangle mesh, its corners and the regions between them",
  "shell.off --output regions.vtp --lines lines.vtp --report features.json", MakeJob<FeaturesJob> };
}
}
