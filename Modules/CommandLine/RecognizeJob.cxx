// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/SurfaceTrimming/vtkSurfaceRecognition.h>

namespace knotwork
{
namespace
{
class RecognizeJob : public FilterJob<vtkSurfaceRecognition>
{
public:
  explicit RecognizeJob(CLI::App& app) : FilterJob(app)
  {
    this->AddInput(0, "mesh", "triangle mesh (.off .obj .ply .stl .vtp .vtu)", "", "input");
    this->AddOutput(
      0, "--output", Endings::Polygons, "the triangles with RegionId and SurfaceType");
    this->AddOutput(1, "--edges", Endings::Points, "the edges between regions, as lines");
    this->AddOutput(
      2, "--regions", Endings::Table, "type and numbers of the surface of every region");
    this->AddProperties();
  }

protected:
  Status AddNumbers(Session& session) override
  {
    ReportRow(this->Table(Numbers), 0,
      { "Regions", "Planes", "Cylinders", "Spheres", "Cones", "Tori", "Extrusions", "Revolutions",
        "FreeForms", "MaxDistance", "MaxSag", "Noise", "Tolerance", "SnappedSurfaces",
        "CommonDirections", "CommonPositions", "CommonSizes", "MaxTurn" },
      session.Report);
    return {};
  }

private:
  static constexpr int Numbers = 3;
};

const JobRegistration Registration{ "recognize",
  "find planes, cylinders, spheres, cones, tori, extrusions and revolutions in a triangle mesh",
  "shell.off --output regions.vtp --regions regions.csv --report regions.json",
  MakeJob<RecognizeJob> };
}
}
