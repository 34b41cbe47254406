// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/TetMeshing/vtkSplineBoundary.h>

namespace knotwork
{
namespace
{
class BoundaryJob : public FilterJob<vtkSplineBoundary>
{
public:
  explicit BoundaryJob(CLI::App& app) : FilterJob(app)
  {
    this->AddInput(0, "spline",
      "volumes or surfaces (.vtu .vtpc .xml .g2 .bext .mesh), or trimmed faces (.step .iges)", "",
      "input");
    this->AddOutput(0, "--output", Endings::Polygons, "the triangles");
    this->AddProperties();
  }

protected:
  Status AddNumbers(Session& session) override
  {
    vtkTable* table = this->Table(Numbers);
    ReportTruths(table, 0, { "Closed" }, session.Report);
    ReportRow(
      table, 0, { "Points", "Triangles", "Area", "Volume", "ChordalBound" }, session.Report);
    return {};
  }

private:
  static constexpr int Numbers = 1;
};

const JobRegistration Registration{ "boundary",
  "turn the boundary of a spline into a closed surface of triangles",
  "solid.step --chordal-tolerance 1e-4 --output solid.vtp --report solid.json",
  MakeJob<BoundaryJob> };
}
}
