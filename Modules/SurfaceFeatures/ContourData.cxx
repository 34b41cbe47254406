// SPDX-License-Identifier: BSD-3-Clause
#include "ContourData.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"
#include <knotwork/SplineGrid/DistributedInput.h>
#include <knotwork/SplineGrid/MergeTables.h>
#include <knotwork/SplineGrid/NamedArray.h>
#include <knotwork/SplineGrid/Processes.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>
#include <variant>

namespace knotwork
{
namespace
{
constexpr int NumCoordinates = 3;
/// Of the cells of curves, beside those that all splines have.
constexpr std::array<const char*, 5> CurveArrays = { "Level", "ComponentId", "Closed", "SurfaceId",
  "MaxError" };

Status OfPatch(int patch, const Status& status)
{
  return { status.Code, "patch " + std::to_string(patch) + ": " + status.Detail };
}

/// The surface with the function as its last component. @param component  where it is.
Result<Spline<2>> SurfaceOf(const SplinePatch& patch, const ContourChoice& choice, int& component)
{
  const auto* surface = std::get_if<Spline<2>>(&patch.Geometry);
  if (!surface)
  {
    return { ErrorCode::DimensionMismatch,
      "curves and volumes have no contours here; select the surfaces" };
  }
  const auto outside = [&](int n)
  {
    return Status(ErrorCode::InvalidParameter,
      "there is no component " + std::to_string(choice.Component) + "; choose 0 to " +
        std::to_string(n - 1) + ", or -1 for the last");
  };
  if (choice.Field.empty())
  {
    component = choice.Component < 0 ? NumCoordinates - 1 : choice.Component;
    return component < NumCoordinates ? Result<Spline<2>>(*surface) : outside(NumCoordinates);
  }
  const auto field = std::find_if(patch.Fields.begin(), patch.Fields.end(),
    [&](const SplineField& f) { return f.Name == choice.Field; });
  if (field == patch.Fields.end())
  {
    std::string names;
    for (const SplineField& f : patch.Fields)
    {
      names += (names.empty() ? "" : ", ") + f.Name;
    }
    return { ErrorCode::InvalidParameter,
      "there is no field '" + choice.Field + "'; " +
        (names.empty() ? "the grid has none" : "choose one of " + names) };
  }
  const int n = static_cast<int>(field->Coefficients.cols());
  const int column = choice.Component < 0 ? n - 1 : choice.Component;
  if (column >= n)
  {
    return outside(n);
  }
  Spline<2> result = *surface;
  component = NumCoordinates;
  result.ControlPoints.conservativeResize(Eigen::NoChange, NumCoordinates + 1);
  result.ControlPoints.col(NumCoordinates) = field->Coefficients.col(column);
  return result;
}

/// Levels and tolerance of all patches together, where they are left open.
void CompleteParams(const ContourRanges& ranges, const ContourChoice& choice, ContourParams& params)
{
  const std::array<double, 2>& range = ranges.back();
  if (params.ChordTolerance == 0.0)
  {
    double squared = 0.0;
    for (std::size_t c = 0; c < NumCoordinates; ++c)
    {
      const std::array<double, 2>& side = ranges[c];
      squared += (side[1] - side[0]) * (side[1] - side[0]);
    }
    params.ChordTolerance = 1e-3 * std::sqrt(squared);
  }
  if (params.Tolerance == 0.0 && range[1] > range[0])
  {
    params.Tolerance = 1e-4 * (range[1] - range[0]);
  }
  if (!params.Levels.empty())
  {
    return;
  }
  if (!(choice.Range[0] < choice.Range[1]))
  {
    params.Levels = ContourLevels(range, params.NumLevels);
    return;
  }
  const int n = params.NumLevels;
  for (int i = 0; i < n; ++i)
  {
    const double share = n == 1 ? 0.5 : static_cast<double>(i) / (n - 1);
    params.Levels.push_back((1.0 - share) * choice.Range[0] + share * choice.Range[1]);
  }
}
}

Result<ContourPatches> PreparePatches(const SplineModel& model, const ContourChoice& choice)
{
  ContourPatches prepared;
  prepared.Ranges.fill({ HUGE_VAL, -HUGE_VAL });
  for (const SplinePatch& patch : model.Patches)
  {
    PatchContours made;
    made.PatchId = patch.Id;
    const Result<Spline<2>> surface = SurfaceOf(patch, choice, made.Component);
    if (!surface)
    {
      return OfPatch(patch.Id, surface.Status);
    }
    made.Form = MakeBezierForm(surface.Value, choice.Params.Threads);
    for (std::size_t c = 0; c < prepared.Ranges.size(); ++c)
    {
      const std::array<double, 2> corners =
        CornerRange(made.Form, c < NumCoordinates ? static_cast<int>(c) : made.Component);
      std::array<double, 2>& range = prepared.Ranges[c];
      range = { std::min(range[0], corners[0]), std::max(range[1], corners[1]) };
    }
    prepared.Patches.push_back(std::move(made));
  }
  return prepared;
}

Status TracePatches(const ContourChoice& choice, ContourPatches& prepared)
{
  ContourParams params = choice.Params;
  params.NumSpaceComponents = NumCoordinates;
  CompleteParams(prepared.Ranges, choice, params);
  std::vector<PatchContours>& patches = prepared.Patches;
  const double share = 1.0 / static_cast<double>(patches.size());
  for (std::size_t i = 0; i < patches.size(); ++i)
  {
    PatchContours& patch = patches[i];
    params.Component = patch.Component;
    if (choice.Params.Progress)
    {
      params.Progress = [&, i](double done)
      { return choice.Params.Progress(share * (static_cast<double>(i) + done)); };
    }
    Result<ContourSet> contours = TraceContours(patch.Form, params);
    if (!contours)
    {
      return OfPatch(patch.PatchId, contours.Status);
    }
    patch.Contours = std::move(contours.Value);
    if (choice.Curves)
    {
      Result<std::vector<ContourCurve>> curves =
        FitContourCurves(patch.Form, patch.Contours, params);
      if (!curves)
      {
        return OfPatch(patch.PatchId, curves.Status);
      }
      patch.Curves = std::move(curves.Value);
    }
  }
  return {};
}

Status EncodePolylines(
  const std::vector<PatchContours>& patches, bool projectToLevel, int threads, vtkPolyData* output)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> lines;
  const auto value = NamedArray<vtkDoubleArray>("Value");
  const auto element = NamedArray<vtkIntArray>("ElementId");
  const auto uv = NamedArray<vtkDoubleArray>("UV", 2);
  const auto level = NamedArray<vtkDoubleArray>("Level");
  const auto number = NamedArray<vtkIntArray>("ComponentId");
  const auto closed = NamedArray<vtkIntArray>("Closed");
  const auto patchId = NamedArray<vtkIntArray>("PatchId");
  const auto error = NamedArray<vtkDoubleArray>("MaxError");
  EvaluationParams params;
  params.Threads = threads;
  for (const PatchContours& patch : patches)
  {
    const ContourSet& contours = patch.Contours;
    EvaluationBatch at;
    const Status status =
      EvaluateElements(patch.Form, contours.Elements, contours.Local, params, at);
    if (!status)
    {
      return status;
    }
    for (const ContourComponent& component : contours.Components)
    {
      const double height = contours.Levels[static_cast<std::size_t>(component.Level)];
      const vtkIdType first = points->GetNumberOfPoints();
      lines->InsertNextCell(static_cast<int>(component.NumPoints + (component.Closed ? 1 : 0)));
      for (std::size_t k = 0; k < component.NumPoints; ++k)
      {
        const std::size_t i = component.First + k;
        const Eigen::Index row = static_cast<Eigen::Index>(i);
        const auto p = at.Values.row(row);
        lines->InsertCellPoint(points->InsertNextPoint(p[0], p[1], projectToLevel ? height : p[2]));
        value->InsertNextValue(p[patch.Component]);
        element->InsertNextValue(contours.Elements[i]);
        uv->InsertNextTuple2(contours.Parameters(row, 0), contours.Parameters(row, 1));
      }
      if (component.Closed)
      {
        lines->InsertCellPoint(first);
      }
      level->InsertNextValue(height);
      number->InsertNextValue(static_cast<int>(number->GetNumberOfValues()));
      closed->InsertNextValue(component.Closed ? 1 : 0);
      patchId->InsertNextValue(patch.PatchId);
      error->InsertNextValue(component.MaxError);
    }
  }
  output->SetPoints(points);
  output->SetLines(lines);
  for (vtkDataArray* array : std::initializer_list<vtkDataArray*>{ value, element, uv })
  {
    output->GetPointData()->AddArray(array);
  }
  for (vtkDataArray* array :
    std::initializer_list<vtkDataArray*>{ level, number, closed, patchId, error })
  {
    output->GetCellData()->AddArray(array);
  }
  output->GetCellData()->SetActiveScalars("Level"); // drawn first
  return {};
}

Status EncodeCurves(
  const std::vector<PatchContours>& patches, bool projectToLevel, vtkUnstructuredGrid* output)
{
  SplineModel model;
  std::vector<double> levels;
  std::vector<std::array<int, 2>> surfaces; // closed, patch
  std::vector<double> errors;
  for (const PatchContours& patch : patches)
  {
    for (const ContourCurve& curve : patch.Curves)
    {
      const ContourComponent& component =
        patch.Contours.Components[static_cast<std::size_t>(curve.Component)];
      levels.push_back(patch.Contours.Levels[static_cast<std::size_t>(component.Level)]);
      surfaces.push_back({ component.Closed ? 1 : 0, patch.PatchId });
      errors.push_back(curve.MaxError);
      SplinePatch encoded;
      encoded.Id = static_cast<int>(model.Patches.size());
      Spline<1> geometry = curve.Curve;
      geometry.ControlPoints = curve.Curve.ControlPoints.rightCols(NumCoordinates);
      if (projectToLevel)
      {
        geometry.ControlPoints.col(2).setConstant(levels.back());
      }
      encoded.Geometry = geometry;
      if (patch.Form.Space->HasDomain())
      {
        encoded.Fields.push_back({ "UV", curve.Curve.ControlPoints.leftCols(2) });
      }
      model.Patches.push_back(std::move(encoded));
    }
  }
  if (const Status status = EncodeSplineGrid(model, output); !status)
  {
    return status;
  }
  vtkDataArray* number = output->GetCellData()->GetArray("PatchId");
  const auto level = NamedArray<vtkDoubleArray>("Level");
  const auto component = NamedArray<vtkIntArray>("ComponentId");
  const auto closed = NamedArray<vtkIntArray>("Closed");
  const auto surface = NamedArray<vtkIntArray>("SurfaceId");
  const auto error = NamedArray<vtkDoubleArray>("MaxError");
  for (vtkIdType cell = 0; cell < output->GetNumberOfCells(); ++cell)
  {
    const std::size_t i = static_cast<std::size_t>(number->GetTuple1(cell));
    level->InsertNextValue(levels[i]);
    component->InsertNextValue(static_cast<int>(i));
    closed->InsertNextValue(surfaces[i][0]);
    surface->InsertNextValue(surfaces[i][1]);
    error->InsertNextValue(errors[i]);
  }
  for (vtkDataArray* array :
    std::initializer_list<vtkDataArray*>{ level, component, closed, surface, error })
  {
    output->GetCellData()->AddArray(array);
  }
  return {};
}

namespace
{
void AddToAll(vtkDataArray* numbers, int offset)
{
  for (vtkIdType i = 0; i < numbers->GetNumberOfTuples(); ++i)
  {
    numbers->SetTuple1(i, numbers->GetTuple1(i) + offset);
  }
}

/// Curves of the processes as one grid of patches in the first of them.
Status UniteCurves(int threads, vtkUnstructuredGrid* curves)
{
  SplineModel all;
  std::map<std::string, vtkSmartPointer<vtkDataArray>> arrays;
  for (const vtkSmartPointer<vtkDataObject>& data : CollectData(curves))
  {
    auto* grid = vtkUnstructuredGrid::SafeDownCast(data);
    if (!grid || grid->GetNumberOfCells() == 0)
    {
      continue;
    }
    auto model = DecodeSplineModel(grid, threads);
    if (!model)
    {
      return model.Status;
    }
    for (SplinePatch& patch : model->Patches)
    {
      patch.Id = static_cast<int>(all.Patches.size());
      all.Patches.push_back(std::move(patch));
    }
    for (const char* name : CurveArrays)
    {
      vtkDataArray* array = grid->GetCellData()->GetArray(name);
      vtkSmartPointer<vtkDataArray>& joined = arrays[name];
      if (!joined)
      {
        joined = vtkSmartPointer<vtkDataArray>::Take(array->NewInstance());
        joined->SetName(name);
      }
      joined->InsertTuples(joined->GetNumberOfTuples(), array->GetNumberOfTuples(), 0, array);
    }
  }
  curves->Initialize();
  if (all.Patches.empty())
  {
    return {};
  }
  if (const Status status = EncodeSplineGrid(all, curves); !status)
  {
    return status;
  }
  for (const char* name : CurveArrays)
  {
    curves->GetCellData()->AddArray(arrays[name]);
  }
  return {};
}
}

Status MergeContours(
  int threads, vtkPolyData* polylines, vtkUnstructuredGrid* curves, vtkTable* levels)
{
  MergedTable how;
  how.Key = "Level";
  how.Columns = { { "Components", Merging::Sum }, { "Closed", Merging::Sum },
    { "Points", Merging::Sum }, { "MaxError", Merging::Largest }, { "Undecided", Merging::Sum } };
  MergeTables(levels, how);
  const int before = Processes::SumBefore(static_cast<int>(polylines->GetNumberOfCells()));
  for (vtkDataSet* lines : std::initializer_list<vtkDataSet*>{ polylines, curves })
  {
    if (vtkDataArray* numbers = lines->GetCellData()->GetArray("ComponentId"))
    {
      AddToAll(numbers, before);
    }
  }
  return UniteCurves(threads, curves);
}

void EncodeLevels(const std::vector<PatchContours>& patches, vtkTable* output)
{
  const auto level = NamedArray<vtkDoubleArray>("Level");
  const auto components = NamedArray<vtkIntArray>("Components");
  const auto closed = NamedArray<vtkIntArray>("Closed");
  const auto points = NamedArray<vtkIdTypeArray>("Points");
  const auto error = NamedArray<vtkDoubleArray>("MaxError");
  const auto undecided = NamedArray<vtkIntArray>("Undecided");
  const auto tolerance = NamedArray<vtkDoubleArray>("Tolerance");
  const std::size_t n = patches.empty() ? 0 : patches[0].Contours.Levels.size();
  for (std::size_t l = 0; l < n; ++l)
  {
    int numComponents = 0;
    int numClosed = 0;
    int numUndecided = 0;
    vtkIdType numPoints = 0;
    double largest = 0.0;
    for (const PatchContours& patch : patches)
    {
      numComponents += patch.Contours.NumComponents[l];
      numClosed += patch.Contours.NumClosed[l];
      for (const ContourComponent& component : patch.Contours.Components)
      {
        if (component.Level == static_cast<int>(l))
        {
          numPoints += static_cast<vtkIdType>(component.NumPoints);
          largest = std::max(largest, component.MaxError);
        }
      }
      numUndecided += static_cast<int>(
        std::count_if(patch.Contours.Undecided.begin(), patch.Contours.Undecided.end(),
          [l](const UndecidedBox& box) { return box.Level == static_cast<int>(l); }));
    }
    level->InsertNextValue(patches[0].Contours.Levels[l]);
    components->InsertNextValue(numComponents);
    closed->InsertNextValue(numClosed);
    points->InsertNextValue(numPoints);
    error->InsertNextValue(largest);
    undecided->InsertNextValue(numUndecided);
    tolerance->InsertNextValue(patches[0].Contours.Tolerance);
  }
  for (vtkDataArray* array : std::initializer_list<vtkDataArray*>{
         level, components, closed, points, error, undecided, tolerance })
  {
    output->AddColumn(array);
  }
}

Status EncodeUndecided(const std::vector<PatchContours>& patches, int threads, vtkPolyData* output)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> quads;
  const auto level = NamedArray<vtkDoubleArray>("Level");
  const auto patchId = NamedArray<vtkIntArray>("PatchId");
  const auto element = NamedArray<vtkIntArray>("ElementId");
  const auto bounds = NamedArray<vtkDoubleArray>("ParametricBounds", 4);
  EvaluationParams params;
  params.Threads = threads;
  for (const PatchContours& patch : patches)
  {
    const std::vector<UndecidedBox>& boxes = patch.Contours.Undecided;
    std::vector<int> elements;
    PointMatrix local(4 * static_cast<Eigen::Index>(boxes.size()), 2);
    for (const UndecidedBox& undecided : boxes)
    {
      const ParametricBox<2>& box =
        patch.Form.Space->Elements[static_cast<std::size_t>(undecided.Element)].Box;
      constexpr int Corners[4][2] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } };
      quads->InsertNextCell(4);
      for (const auto& corner : Corners)
      {
        const Eigen::Index row = static_cast<Eigen::Index>(elements.size());
        elements.push_back(undecided.Element);
        for (std::size_t d = 0; d < 2; ++d)
        {
          const double at = corner[d] == 0 ? undecided.Box.Lower[d] : undecided.Box.Upper[d];
          local(row, static_cast<Eigen::Index>(d)) =
            std::clamp((at - box.Lower[d]) / (box.Upper[d] - box.Lower[d]), 0.0, 1.0);
        }
        quads->InsertCellPoint(points->GetNumberOfPoints() + row);
      }
      level->InsertNextValue(patch.Contours.Levels[static_cast<std::size_t>(undecided.Level)]);
      patchId->InsertNextValue(patch.PatchId);
      element->InsertNextValue(undecided.Element);
      bounds->InsertNextTuple4(undecided.Box.Lower[0], undecided.Box.Upper[0],
        undecided.Box.Lower[1], undecided.Box.Upper[1]);
    }
    EvaluationBatch at;
    const Status status = EvaluateElements(patch.Form, elements, local, params, at);
    if (!status)
    {
      return status;
    }
    for (Eigen::Index i = 0; i < at.Values.rows(); ++i)
    {
      points->InsertNextPoint(at.Values(i, 0), at.Values(i, 1), at.Values(i, 2));
    }
  }
  output->SetPoints(points);
  output->SetPolys(quads);
  for (vtkDataArray* array :
    std::initializer_list<vtkDataArray*>{ level, patchId, element, bounds })
  {
    output->GetCellData()->AddArray(array);
  }
  return {};
}
}
