// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/SurfaceFitting/vtkSplineSurfaceFit.h>

#include <vtkCellArray.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPolyData.h>
#include <vtkTable.h>
#include <vtkVariant.h>

#include <filesystem>

namespace knotwork
{
namespace
{
/// Points of a grid as polydata, for formats of points.
vtkSmartPointer<vtkPolyData> AsPolyData(vtkPointSet* data)
{
  if (auto* polydata = vtkPolyData::SafeDownCast(data))
  {
    return polydata;
  }
  auto points = vtkSmartPointer<vtkPolyData>::New();
  points->SetPoints(data->GetPoints());
  points->GetPointData()->ShallowCopy(data->GetPointData());
  vtkNew<vtkCellArray> vertices;
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    vertices->InsertNextCell(1, &i);
  }
  points->SetVerts(vertices);
  return points;
}

/// Of vtkSplineSurfaceFit.
enum Port
{
  Surface,
  Points,
  Iterations,
  Features,
  Elements
};

class FitJob : public FilterJob<vtkSplineSurfaceFit>
{
public:
  explicit FitJob(CLI::App& app) : FilterJob(app)
  {
    this->AddInput(0, "points",
      "points (.xyz .txt .csv .g2 .las .ply .vtp .vtu, meshes .stl .obj .off)", "", "input");
    this->AddInput(1, "--start", "the spline surface that the fit starts from and updates",
      " starting from ", "start");
    this->AddOutput(Surface, "--output", Endings::Spline, "the surface");
    this->AddOutput(
      Points, "--points", Endings::Points, "the points with distances, tolerances, outliers");
    this->AddOutput(Iterations, "--table", Endings::Table, "the iterations");
    this->AddOutput(Features, "--features", Endings::Image, "the feature grid");
    this->AddOutput(Elements, "--elements", Endings::Cells, "the elements with their features");
    this->AddArrayOptions();
    this->AddProperties();
  }

protected:
  Status Prepare(Session& session) override
  {
    for (const std::string& name : this->Fields)
    {
      this->Filter->AddFieldArray(name.c_str());
    }
    for (std::size_t i = 0; i < this->Arrays.size(); ++i)
    {
      if (!this->Arrays[i].empty())
      {
        this->Filter->SetInputArrayToProcess(static_cast<int>(i), 0, 0,
          vtkDataObject::FIELD_ASSOCIATION_POINTS, this->Arrays[i].c_str());
      }
    }
    const std::vector<double>& boxes = this->ToleranceBoxes;
    for (std::size_t i = 0; i + 4 < boxes.size(); i += 5)
    {
      this->Filter->AddToleranceBox(
        boxes[i], boxes[i + 1], boxes[i + 2], boxes[i + 3], boxes[i + 4]);
    }
    session.Report["fields"] = this->Fields;
    session.Report["parameter_array"] = this->Arrays[0];
    session.Report["tolerance_array"] = this->Arrays[1];
    session.Report["significant_array"] = this->Arrays[2];
    session.Report["tolerance_boxes"] = this->ToleranceBoxes;
    return this->RequirePointSet(0);
  }

  Status AddNumbers(Session& session) override
  {
    auto* points = vtkPointSet::SafeDownCast(this->Filter->GetOutputDataObject(Points));
    vtkTable* table = this->Table(Iterations);
    const vtkIdType last = table->GetNumberOfRows() - 1;
    const auto value = [&](const char* name) { return table->GetValueByName(last, name); };
    double tolerances[2] = { 0.0, 0.0 };
    points->GetPointData()->GetArray("Tolerance")->GetRange(tolerances);
    auto& report = session.Report;
    report["points"] = points->GetNumberOfPoints();
    report["smallest_tolerance"] = tolerances[0];
    report["largest_tolerance"] = tolerances[1];
    report["functions"] = value("Functions").ToLongLong();
    report["elements"] = value("Elements").ToLongLong();
    report["iterations"] = value("Iteration").ToLongLong();
    report["max_error"] = value("MaxError").ToDouble();
    report["mean_error"] = value("MeanError").ToDouble();
    report["rms_error"] = value("RmsError").ToDouble();
    report["points_outside"] = value("PointsOutside").ToLongLong();
    report["outliers"] = value("Outliers").ToLongLong();
    report["significant_points"] = value("SignificantPoints").ToLongLong();
    report["max_significant_error"] = value("MaxSignificantError").ToDouble();
    report["mean_significant_error"] = value("MeanSignificantError").ToDouble();
    report["significant_outside"] = value("SignificantOutside").ToLongLong();
    report["aic"] = value("AIC").ToDouble();
    report["bic"] = value("BIC").ToDouble();
    report["within_tolerance"] = value("PointsOutside").ToLongLong() == 0;
    report["seconds_of_fit"] = this->Filter->GetSeconds();
    return {};
  }

  Status Write(Session& session) override
  {
    Status status = this->WriteSurface(session);
    status = status ? session.WriteOutputs(this->Filter,
                        { {}, {}, this->OutputFile(Iterations), this->OutputFile(Features),
                          this->OutputFile(Elements) })
                    : status;
    return status && !this->OutputFile(Points).empty()
      ? session.Write(
          AsPolyData(vtkPointSet::SafeDownCast(this->Filter->GetOutputDataObject(Points))),
          this->OutputFile(Points))
      : status;
  }

private:
  /// A surface that is too large as the tensor product that its format needs is not lost.
  Status WriteSurface(Session& session)
  {
    vtkDataObject* surface = this->Filter->GetOutputDataObject(Surface);
    const std::string& file = this->MainOutput();
    Status status = session.Write(surface, file);
    const std::string instead = std::filesystem::path(file).replace_extension(".vtu").string();
    if (status.Code != ErrorCode::TooLarge || std::filesystem::exists(instead))
    {
      return status;
    }
    session.Files.Drop(file);
    session.LeftOut.push_back(status.Detail + "; the surface is in '" + instead + "'");
    session.Warn({ session.LeftOut.back() });
    return session.Write(surface, instead);
  }

  void AddArrayOptions()
  {
    this->App.add_option("--field", this->Fields, "point arrays that are fitted along")
      ->expected(1)
      ->take_all();
    this->App.add_option("--parameter-array", this->Arrays[0],
      "point array of given parameters; without one UV, then the texture coordinates");
    this->App.add_option("--tolerance-array", this->Arrays[1], "point array of tolerances");
    this->App.add_option("--significant-array", this->Arrays[2],
      "point array that is not 0 where a point is significant");
    this->App
      .add_option("--tolerance-box", this->ToleranceBoxes,
        "u0 u1 v0 v1 tolerance of the points in a box of parameters; several boxes one after the "
        "other")
      ->type_size(5)
      ->expected(1, 100000);
  }

  std::vector<std::string> Fields;
  std::array<std::string, 3> Arrays; ///< parameters, tolerances, significant points
  std::vector<double> ToleranceBoxes;
};

const JobRegistration Registration{ "fit", "fit a spline surface to scattered points",
  "scan.xyz --tolerance 0.01 --output terrain.vtu --report terrain.json", MakeJob<FitJob> };
}
}
