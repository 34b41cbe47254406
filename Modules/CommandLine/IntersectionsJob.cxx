// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/SurfaceTrimming/vtkFaceIntersections.h>

#include <vtkIntArray.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkVariant.h>

#include <iostream>

namespace knotwork
{
namespace
{
constexpr int FoundStatus = 3;
constexpr int UndecidedStatus = 4;

class IntersectionsJob : public FilterJob<vtkFaceIntersections>
{
public:
  explicit IntersectionsJob(CLI::App& app) : FilterJob(app)
  {
    this->DecisivePort = Numbers; // no points are the best result
    this->AddInput(0, "input", "faces, trimmed or whole (.step .iges .vtu .vtpc .xml .g2)");
    this->AddOutput(0, "--output", Endings::Points, "a point a pair of faces that meet, or may")
      ->required(false);
    this->AddOutput(Numbers, "--table", Endings::Table, "the verdict and numbers of pairs");
    this->AddProperties();
  }

protected:
  Status AddNumbers(Session& session) override
  {
    vtkTable* table = this->Table(Numbers);
    const std::string verdict = table->GetValueByName(0, "Verdict").ToString();
    session.Report["verdict"] = verdict;
    ReportRow(table, 0, { "Found", "Undecided", "Faces", "PairsOfFaces", "Pairs" }, session.Report);
    session.Report["tolerance"] = table->GetValueByName(0, "Tolerance").ToDouble();
    auto* points = vtkPolyData::SafeDownCast(this->Filter->GetOutputDataObject(0));
    auto* faces = vtkIntArray::SafeDownCast(points->GetPointData()->GetArray("Faces"));
    // of all pairs the first that decides
    session.Report["point"] = nullptr;
    for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
    {
      const double kind = points->GetPointData()->GetArray("Verdict")->GetTuple1(i);
      if (kind == (verdict == "found" ? 2.0 : 1.0))
      {
        double x[3];
        points->GetPoint(i, x);
        session.Report["point"] = std::vector<double>{ x[0], x[1], x[2] };
        session.Report["point_faces"] =
          std::vector<int>{ faces->GetTypedComponent(i, 0), faces->GetTypedComponent(i, 1) };
        break;
      }
    }
    session.ExitStatus = verdict == "found" ? FoundStatus
      : verdict == "undecided"              ? UndecidedStatus
                                            : 0;
    if (!session.Quiet)
    {
      std::cout << "intersections " << verdict;
      if (verdict != "absent")
      {
        const auto& pair = session.Report["point_faces"];
        const auto& at = session.Report["point"];
        std::cout << ": " << session.Report["found"] << " pairs of faces meet, "
                  << session.Report["undecided"] << " undecided; the first: faces " << pair[0]
                  << " and " << pair[1] << " at (" << at[0] << ", " << at[1] << ", " << at[2]
                  << ")";
      }
      std::cout << "\n";
    }
    return {};
  }

private:
  static constexpr int Numbers = 1;
};

const JobRegistration Registration{ "intersections",
  "prove that faces meet along edges only, or show where they do not",
  "part.step --output points.vtp --report intersections.json", MakeJob<IntersectionsJob> };
}
}
