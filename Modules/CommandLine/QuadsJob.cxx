// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/CADMeshing/vtkCADQuads.h>

#include <vtkVariant.h>

namespace knotwork
{
namespace
{
class QuadsJob : public FilterJob<vtkCADQuads>
{
public:
  explicit QuadsJob(CLI::App& app) : FilterJob(app)
  {
    this->AddFile("part", "CAD part (.step .stp .iges .igs .brep)");
    this->AddOutput(0, "--output", Endings::Polygons, "the quadrilaterals");
    this->AddOutput(FaceTable, "--face-table", Endings::Table, "numbers of every face");
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
    vtkTable* numbers = this->Table(Numbers);
    ReportTruths(numbers, 0, { "Closed" }, session.Report);
    ReportRow(numbers, 0,
      { "Quads", "Points", "Faces", "MappedFaces", "UnstructuredFaces", "Edges", "Solids",
        "LeastScaledJacobian", "ExtraordinaryPoints", "EulerNumber", "Distance", "Diagonal" },
      session.Report);
    vtkTable* faces = this->Table(FaceTable);
    auto list = nlohmann::ordered_json::array();
    for (vtkIdType row = 0; row < faces->GetNumberOfRows(); ++row)
    {
      nlohmann::ordered_json entry = nlohmann::ordered_json::object();
      ReportRow(faces, row,
        { "FaceId", "SecondFaceId", "SolidId", "SecondSolidId", "JoinedFaces", "Quads",
          "ExtraordinaryPoints", "LeastScaledJacobian", "Distance" },
        entry);
      ReportTruths(faces, row, { "Mapped" }, entry);
      entry["composite"] = faces->GetValueByName(row, "Composite").ToString();
      list.push_back(std::move(entry));
    }
    session.Report["face_table"] = std::move(list);
    return {};
  }

private:
  static constexpr int Numbers = 1;
  static constexpr int FaceTable = 2;
};

const JobRegistration Registration{ "quads",
  "mesh the faces of a CAD part with conforming quadrilaterals",
  "solid.step --output quads.vtp --report quads.json", MakeJob<QuadsJob> };
}
}
