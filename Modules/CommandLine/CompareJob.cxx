// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/TetMeshing/vtkVolumeComparison.h>

#include <vtkVariant.h>

#include <vector>

namespace knotwork
{
namespace
{
class CompareJob : public FilterJob<vtkVolumeComparison>
{
public:
  explicit CompareJob(CLI::App& app) : FilterJob(app)
  {
    this->AddInput(0, "spline", "spline volumes (.vtu .xml .g2 .bext .mesh)");
    this->AddInput(1, "mesh",
      "tetrahedra, wedges or hexahedra, straight or curved (.vtu .msh .inp .mesh)", " and ");
    this->AddInput(2, "--reference",
      "the shape that both stand for: a CAD part (.step .stp .iges .igs .brep), triangles (.stl "
      ".off .obj .ply .vtp) or a spline (.vtu .xml .g2); else it is the spline",
      " by ");
    this->AddOutput(Numbers, "--output", Endings::Table, "the numbers, one row an input");
    this->AddOutput(2, "--histogram", Endings::Table, "cells by their least scaled Jacobian");
    this->AddOutput(0, "--spline-boundary", Endings::Polygons,
      "the spline's boundary with its distances from the reference");
    this->AddOutput(1, "--mesh-boundary", Endings::Polygons, "the same of the mesh");
    this->AddProperties();
  }

protected:
  Status AddNumbers(Session& session) override
  {
    vtkTable* const table = this->Table(Numbers);
    ReportRow(table, 0, { "ReferenceVolume", "ReferenceVolumeBound", "Diagonal" }, session.Report);
    for (const auto& [row, prefix] : { std::pair(0, "spline"), std::pair(1, "mesh") })
    {
      nlohmann::ordered_json numbers;
      ReportRow(table, row,
        { "Elements", "Functions", "ValidElements", "ReversedElements", "InvalidElements",
          "UndecidedElements", "MinJacobianLower", "ScaledJacobianLower", "ScaledJacobianUpper",
          "ScaledJacobianMean", "Volume", "VolumeError", "ToReference", "FromReference",
          "LargestDistance", "RmsToReference", "RmsFromReference", "ChordalBound", "BoundaryPoints",
          "Memory" },
        numbers);
      numbers["certificate_seconds"] = this->Filter->GetSeconds(row, 0);
      numbers["measure_seconds"] = this->Filter->GetSeconds(row, 1);
      numbers["distance_seconds"] = this->Filter->GetSeconds(row, 2);
      for (const auto& [key, value] : numbers.items()) // the report is flat
      {
        session.Report[std::string(prefix) + "_" + key] = value;
      }
    }
    return {};
  }

private:
  static constexpr int Numbers = 3;
};

const JobRegistration Registration{ "compare",
  "compare a spline volume and a mesh of the same solid with a reference",
  "solid.vtu mesh.vtu --reference solid.step --output table.csv --report compare.json",
  MakeJob<CompareJob> };
}
}
