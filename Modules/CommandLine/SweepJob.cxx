// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/CADMeshing/vtkSweepToHexahedra.h>

#include <vtkVariant.h>

namespace knotwork
{
namespace
{
class SweepJob : public FilterJob<vtkSweepToHexahedra>
{
public:
  explicit SweepJob(CLI::App& app) : FilterJob(app)
  {
    this->AddInput(0, "mesh", "quadrilaterals (.off .obj .ply .vtp .vtu .msh)", "", "input");
    this->AddInput(1, "--path", "one line of straight pieces (.vtp)", " along ");
    this->AddOutput(0, "--output", Endings::Writing(CellContent | GridContent), "the hexahedra");
    this->AddProperties();
  }

protected:
  Status AddNumbers(Session& session) override
  {
    vtkTable* numbers = this->Table(Numbers);
    ReportTruths(numbers, 0, { "Ring" }, session.Report);
    ReportRow(numbers, 0,
      { "Hexahedra", "Points", "Layers", "Verdict", "ValidCells", "ReversedCells", "InvalidCells",
        "UndecidedCells", "MinJacobianLower", "LeastScaledJacobian", "Volume" },
      session.Report);
    return {};
  }

private:
  static constexpr int Numbers = 1;
};

const JobRegistration Registration{ "sweep",
  "move quadrilaterals along a path and fill the way with hexahedra",
  "section.vtu --direction 0 0 5 --layers 20 --twist 45 --output bar.vtu --report bar.json",
  MakeJob<SweepJob> };
}
}
