// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/CADMeshing/vtkCADHexahedra.h>

#include <sstream>

namespace knotwork
{
namespace
{
class HexesJob : public FilterJob<vtkCADHexahedra>
{
public:
  explicit HexesJob(CLI::App& app) : FilterJob(app)
  {
    this->AddFile("part", "CAD part of solids (.step .stp .iges .igs .brep)");
    this->AddOutput(0, "--output", Endings::Writing(CellContent | GridContent), "the hexahedra");
    this->AddOutput(SolidTable, "--solid-table", Endings::Table, "how every solid was swept");
    this->AddProperties();
  }

protected:
  Status Prepare(Session& session) override
  {
    this->Filter->SetFileName(this->FileToRead().c_str());
    return session.Files.CheckInput(this->FileToRead());
  }

  Status AddNumbers(Session& session) override
  {
    ReportRow(this->Table(Numbers), 0,
      { "Hexahedra", "Points", "Solids", "PaddedHexahedra", "Verdict", "ValidCells",
        "ReversedCells", "InvalidCells", "UndecidedCells", "MinJacobianLower",
        "LeastScaledJacobian", "Volume", "Diagonal" },
      session.Report);
    session.Report["cuts"] = Lines(this->Table(Numbers)->GetValueByName(0, "Cuts").ToString());
    vtkTable* solids = this->Table(SolidTable);
    auto list = nlohmann::ordered_json::array();
    for (vtkIdType row = 0; row < solids->GetNumberOfRows(); ++row)
    {
      nlohmann::ordered_json entry = nlohmann::ordered_json::object();
      ReportRow(solids, row,
        { "SolidId", "SourceFaces", "TargetFaces", "LinkingFaces", "Layers", "Hexahedra",
          "LeastScaledJacobian" },
        entry);
      list.push_back(std::move(entry));
    }
    session.Report["solid_table"] = std::move(list);
    return {};
  }

private:
  static nlohmann::ordered_json Lines(const std::string& text)
  {
    auto lines = nlohmann::ordered_json::array();
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);)
    {
      lines.push_back(line);
    }
    return lines;
  }

  static constexpr int Numbers = 1;
  static constexpr int SolidTable = 2;
};

const JobRegistration Registration{ "hexes",
  "mesh the solids of a CAD part with conforming hexahedra",
  "solid.step --output hexes.vtu --report hexes.json", MakeJob<HexesJob> };
}
}
