// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/SurfaceRemeshing/vtkQuadRemesher.h>

namespace knotwork
{
namespace
{
class QuadRemeshJob : public FilterJob<vtkQuadRemesher>
{
public:
  explicit QuadRemeshJob(CLI::App& app) : FilterJob(app)
  {
    this->AddInput(0, "mesh", "closed triangle mesh (.off .obj .ply .stl .vtp .vtu)", "", "input");
    this->AddOutput(0, "--output", Endings::Polygons, "the quadrilaterals");
    this->AddOutput(1, "--tries", Endings::Table, "what was asked of blender and what came of it");
    this->AddProperties();
  }

protected:
  Status AddNumbers(Session& session) override
  {
    vtkTable* numbers = this->Table(Numbers);
    ReportRow(numbers, 0,
      { "Quads", "Points", "Parts", "DividedParts", "LooseParts", "EulerNumber",
        "ExtraordinaryPoints", "Tries", "LeastScaledJacobian", "LeastScaledJacobianBefore",
        "DistanceFromInput", "DistanceToInput", "Diagonal", "Volume", "InputVolume" },
      session.Report);
    return {};
  }

private:
  static constexpr int Numbers = 2;
};

const JobRegistration Registration{ "quadremesh",
  "make quadrilaterals on a closed triangle mesh, by QuadriFlow in the program blender",
  "cow.off --output quads.vtp --faces 3000 --report quads.json", MakeJob<QuadRemeshJob> };
}
}
