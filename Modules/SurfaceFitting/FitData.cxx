// SPDX-License-Identifier: BSD-3-Clause
#include "FitData.h"

#include <knotwork/MeshParameterization/MeshData.h>
#include <knotwork/SplineCore/HeightField.h>
#include <knotwork/SplineCore/Parallel.h>
#include <knotwork/SplineGrid/NamedArray.h>
#include <knotwork/SplineGrid/SplineModel.h>
#include <knotwork/SurfaceFitting/ClosestParameters.h>
#include <knotwork/SurfaceFitting/PlaneParameters.h>

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkIdTypeArray.h"
#include "vtkImageData.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkTable.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr std::size_t RowChunk = 16384;

/// Components [first, first + count) of an array become columns of a matrix, from `column` on.
void CopyArray(
  vtkDataArray* array, int first, int count, PointMatrix& to, Eigen::Index column, int threads)
{
  const int stride = array->GetNumberOfComponents();
  const auto copy = [&](const auto* values)
  {
    ParallelFor(static_cast<std::size_t>(to.rows()), RowChunk, threads,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t i = begin; i < end; ++i)
        {
          const auto* from = values + i * static_cast<std::size_t>(stride) + first;
          for (int c = 0; c < count; ++c)
          {
            to(static_cast<Eigen::Index>(i), column + c) = static_cast<double>(from[c]);
          }
        }
      });
  };
  if (auto* doubles = vtkDoubleArray::FastDownCast(array))
  {
    copy(doubles->GetPointer(0));
  }
  else if (auto* floats = vtkFloatArray::FastDownCast(array))
  {
    copy(floats->GetPointer(0));
  }
  else
  {
    for (Eigen::Index i = 0; i < to.rows(); ++i)
    {
      for (int c = 0; c < count; ++c)
      {
        to(i, column + c) = array->GetComponent(i, first + c);
      }
    }
  }
}

PointMatrix CopyArray(vtkDataArray* array, int count, int threads)
{
  PointMatrix to(array->GetNumberOfTuples(), count);
  CopyArray(array, 0, count, to, 0, threads);
  return to;
}

std::string Quoted(vtkDataArray* array)
{
  return std::string("'") + (array->GetName() ? array->GetName() : "") + "'";
}

Status CheckArray(vtkDataArray* array, vtkIdType points, int components, const char* what)
{
  if (!array)
  {
    return {};
  }
  if (array->GetNumberOfTuples() != points || array->GetNumberOfComponents() < components)
  {
    return { ErrorCode::SizeMismatch,
      std::string(what) + ": the array " + Quoted(array) + " has " +
        std::to_string(array->GetNumberOfTuples()) + " rows of " +
        std::to_string(array->GetNumberOfComponents()) + " numbers; " + std::to_string(points) +
        " rows of " + std::to_string(components) + " are needed, one a point" };
  }
  return {};
}

/// The arrays to fit along.
Status FindFields(vtkPointSet* data, const CloudChoice& choice, std::vector<vtkDataArray*>& fields)
{
  vtkPointData* arrays = data->GetPointData();
  const auto add = [&](vtkDataArray* array)
  {
    if (std::find(fields.begin(), fields.end(), array) == fields.end())
    {
      fields.push_back(array);
    }
  };
  for (const std::string& name : choice.Fields)
  {
    vtkDataArray* array = arrays->GetArray(name.c_str());
    if (!array)
    {
      return { ErrorCode::InvalidParameter,
        "there is no point array '" + name + "' of numbers to fit along; check the name" };
    }
    add(array);
  }
  for (int i = 0; choice.AllFields && i < arrays->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* array = arrays->GetArray(i);
    if (array && array->GetName() && array != choice.Given && array != choice.Tolerances &&
      array != choice.Significant)
    {
      add(array);
    }
  }
  for (vtkDataArray* array : fields)
  {
    if (Status status = CheckArray(array, data->GetNumberOfPoints(), 1, "array to fit along");
        !status)
    {
      return status;
    }
  }
  return {};
}

/// Plane coordinates of a mesh that covers all points.
Result<PointMatrix> MeshParameters(const TriangleMesh& mesh, int threads)
{
  FlattenParams params;
  params.Threads = threads;
  auto flat = FlattenMesh(mesh, params);
  if (!flat)
  {
    return { flat.Status.Code,
      flat.Status.Detail +
        "; a surface is fitted to triangles that are a disc with holes, with "
        "other parameters give an array of them" };
  }
  if (flat->Measures.FlippedTriangles > 0)
  {
    return { ErrorCode::NotInSpace,
      std::to_string(flat->Measures.FlippedTriangles) +
        " triangles are flipped in the plane; cut the mesh into charts, or give parameters" };
  }
  if (!flat->Injective)
  {
    return { ErrorCode::NotInSpace,
      flat->Injective.Detail + "; cut the mesh into charts, or give parameters" };
  }
  PointMatrix uv = PointMatrix::Zero(mesh.Points.rows(), 2);
  for (std::size_t i = 0; i < flat->Mesh.PointIds.size(); ++i)
  {
    uv.row(flat->Mesh.PointIds[i]) = flat->UV.row(static_cast<Eigen::Index>(i));
  }
  return uv;
}

/// @param over  what points may lie over in layers; triangles have a map that is injective.
Result<PointMatrix> FindParameters(vtkPointSet* data, const CloudChoice& choice, const char*& over)
{
  vtkDataArray* points = data->GetPoints()->GetData();
  if (choice.Parameters == CloudParameters::HeightField)
  {
    over = "x and y";
    return CopyArray(points, 2, choice.Threads);
  }
  if (choice.Parameters == CloudParameters::Given)
  {
    if (!choice.Given)
    {
      return { ErrorCode::InvalidParameter,
        "the parameters of the points are missing; name a point array of two components, or have "
        "them computed" };
    }
    over = "the parameters that are given";
    return CopyArray(choice.Given, 2, choice.Threads);
  }
  if (choice.Start)
  {
    over = "the surface that the fit starts from";
    return ClosestParameters(
      *choice.Start, CopyArray(points, 3, choice.Threads), choice.Threads, choice.Progress);
  }
  auto decoded = DecodeMesh(data);
  if (!decoded)
  {
    return decoded.Status;
  }
  if (!decoded->Mesh.Triangles.empty())
  {
    return MeshParameters(decoded->Mesh, choice.Threads);
  }
  over = "their plane of least squares";
  return PlaneParameters(CopyArray(points, 3, choice.Threads));
}

template <typename Array, typename Value>
void AddValues(vtkFieldData* data, const char* name, const std::vector<Value>& values)
{
  const auto array = NamedArray<Array>(name, 1, static_cast<vtkIdType>(values.size()));
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  data->AddArray(array);
}

/// Features of all parts, one set after the other, as cell arrays; numbers of things are integers.
void AddFeatures(const std::vector<FitFeatures>& sets, vtkFieldData* data)
{
  std::vector<double> values;
  for (int c = 0; c < NumFitFeatures; ++c)
  {
    values.clear();
    for (const FitFeatures& features : sets)
    {
      for (Eigen::Index k = 0; k < features.Values.rows(); ++k)
      {
        values.push_back(features.Values(k, c));
      }
    }
    const std::string name = FitFeatureNames[c];
    if (name.rfind("Num", 0) == 0)
    {
      AddValues<vtkIntArray>(data, name.c_str(), values);
    }
    else
    {
      AddValues<vtkDoubleArray>(data, name.c_str(), values);
    }
  }
}
}

Result<DecodedCloud> DecodeCloud(vtkPointSet* data, const CloudChoice& choice)
{
  const vtkIdType n = data->GetNumberOfPoints();
  if (n == 0)
  {
    return { ErrorCode::EmptyInput, "there are no points to fit a surface to" };
  }
  Status status = CheckArray(choice.Given, n, 2, "parameters");
  status = status ? CheckArray(choice.Tolerances, n, 1, "tolerances") : status;
  status = status ? CheckArray(choice.Significant, n, 1, "significant points") : status;
  std::vector<vtkDataArray*> fields;
  status = status ? FindFields(data, choice, fields) : status;
  if (!status)
  {
    return status;
  }
  DecodedCloud decoded;
  auto parameters = FindParameters(data, choice, decoded.Over);
  if (!parameters)
  {
    return parameters.Status;
  }
  decoded.NumMeasured = choice.Parameters == CloudParameters::HeightField ? 1 : 3;
  PointCloud& cloud = decoded.Cloud;
  cloud.Parameters = std::move(parameters.Value);
  Eigen::Index columns = decoded.NumMeasured;
  for (vtkDataArray* array : fields)
  {
    decoded.Names.emplace_back(array->GetName());
    decoded.Components.push_back(array->GetNumberOfComponents());
    columns += array->GetNumberOfComponents();
  }
  cloud.Values.resize(n, columns);
  CopyArray(data->GetPoints()->GetData(), 3 - decoded.NumMeasured, decoded.NumMeasured,
    cloud.Values, 0, choice.Threads);
  columns = decoded.NumMeasured;
  for (vtkDataArray* array : fields)
  {
    CopyArray(array, 0, array->GetNumberOfComponents(), cloud.Values, columns, choice.Threads);
    columns += array->GetNumberOfComponents();
  }
  if (choice.Tolerances)
  {
    cloud.Tolerances = CopyArray(choice.Tolerances, 1, choice.Threads).col(0);
  }
  for (vtkIdType i = 0; choice.Significant && i < n; ++i)
  {
    cloud.Significant.push_back(choice.Significant->GetComponent(i, 0) != 0.0 ? 1 : 0);
  }
  return decoded;
}

Result<const Spline<2>*> FindStart(const SplineModel& model)
{
  if (model.Patches.size() != 1)
  {
    return { model.Patches.empty() ? ErrorCode::EmptyInput : ErrorCode::DimensionMismatch,
      "the start has " + std::to_string(model.Patches.size()) +
        " patches; a fit starts from one surface" };
  }
  const auto* surface = std::get_if<Spline<2>>(&model.Patches[0].Geometry);
  if (!surface)
  {
    return { ErrorCode::DimensionMismatch,
      "the start is not a surface; give a spline grid of one surface" };
  }
  return surface;
}

Result<FitStart> MakeStart(const SplineModel& model, DecodedCloud& cloud, int threads)
{
  const SplinePatch& patch = model.Patches[0];
  const auto& surface = std::get<Spline<2>>(patch.Geometry);
  FitStart start;
  start.Surface = surface;
  start.DomainPoints = surface.ControlPoints.leftCols<2>();
  if (cloud.NumMeasured == 1 && surface.Space->HasDomain() && !surface.IsRational() &&
    !IsHeightField(MakeBezierForm<2>(surface, threads)))
  {
    return { ErrorCode::InvalidParameter,
      "the start is no height field: its x and y are not its parameters; give the points "
      "parameters, or have them computed" };
  }
  std::vector<const SplineField*> fields;
  for (std::size_t i = 0; i < cloud.Names.size(); ++i)
  {
    const auto found = std::find_if(patch.Fields.begin(), patch.Fields.end(),
      [&](const SplineField& field)
      { return field.Name == cloud.Names[i] && field.Coefficients.cols() == cloud.Components[i]; });
    if (found == patch.Fields.end())
    {
      return { ErrorCode::InvalidParameter,
        "the start has no field '" + cloud.Names[i] + "' of " +
          std::to_string(cloud.Components[i]) + " components; only its own fields can be fitted" };
    }
    fields.push_back(&*found);
  }
  for (const SplineField& field : patch.Fields)
  {
    if (std::find(fields.begin(), fields.end(), &field) == fields.end())
    {
      fields.push_back(&field);
      cloud.Names.push_back(field.Name);
      cloud.Components.push_back(static_cast<int>(field.Coefficients.cols()));
    }
  }
  Eigen::Index columns = cloud.NumMeasured;
  for (const SplineField* field : fields)
  {
    columns += field->Coefficients.cols();
  }
  PointMatrix& all = start.Surface.ControlPoints;
  all.resize(surface.ControlPoints.rows(), columns);
  all.leftCols(cloud.NumMeasured) = surface.ControlPoints.rightCols(cloud.NumMeasured);
  columns = cloud.NumMeasured;
  for (const SplineField* field : fields)
  {
    all.middleCols(columns, field->Coefficients.cols()) = field->Coefficients;
    columns += field->Coefficients.cols();
  }
  return start;
}

Status EncodeFit(const DecodedCloud& cloud, const SurfaceFit& fit, vtkUnstructuredGrid* output)
{
  const PointMatrix& values = fit.Surface.ControlPoints;
  Spline<2> surface;
  surface.Space = fit.Surface.Space;
  surface.ControlPoints.resize(values.rows(), 3);
  if (cloud.NumMeasured == 1)
  {
    surface.ControlPoints.leftCols<2>() = fit.DomainPoints;
  }
  surface.ControlPoints.rightCols(cloud.NumMeasured) = values.leftCols(cloud.NumMeasured);
  SplinePatch patch;
  patch.Geometry = std::move(surface);
  Eigen::Index column = cloud.NumMeasured;
  for (std::size_t i = 0; i < cloud.Names.size(); ++i)
  {
    patch.Fields.push_back({ cloud.Names[i], values.middleCols(column, cloud.Components[i]) });
    column += cloud.Components[i];
  }
  SplineModel model;
  model.Patches.push_back(std::move(patch));
  Status status = EncodeSplineGrid(model, output);
  if (status && !fit.ElementFeatures.empty())
  {
    AddFeatures({ fit.ElementFeatures.back() }, output->GetCellData()); // cells are elements
  }
  return status;
}

void EncodeDistances(const DecodedCloud& cloud, const SurfaceFit& fit, vtkPointSet* output)
{
  vtkPointData* data = output->GetPointData();
  AddValues<vtkDoubleArray>(data, "Distance", fit.Distances);
  AddValues<vtkDoubleArray>(data, "Tolerance", fit.Tolerances);
  std::vector<std::uint8_t> outliers = fit.Outliers;
  outliers.resize(fit.Distances.size(), 0);
  AddValues<vtkUnsignedCharArray>(data, "Outlier", outliers);
  if (cloud.NumMeasured == 3)
  {
    const PointMatrix& uv = fit.Parameters.size() > 0 ? fit.Parameters : cloud.Cloud.Parameters;
    const auto array = NamedArray<vtkDoubleArray>("UV", 2, uv.rows());
    std::copy(uv.data(), uv.data() + uv.size(), array->GetPointer(0));
    data->AddArray(array);
  }
}

void EncodeIterations(const SurfaceFit& fit, vtkTable* output)
{
  using Row = const FitIteration&;
  const auto whole = [&](const char* name, auto value)
  { output->AddColumn(ArrayOf<vtkIdTypeArray>(name, fit.Iterations, value)); };
  const auto real = [&](const char* name, auto value)
  { output->AddColumn(ArrayOf<vtkDoubleArray>(name, fit.Iterations, value)); };
  whole("Iteration", [](Row r) { return static_cast<vtkIdType>(r.Iteration); });
  output->AddColumn(ArrayOf<vtkStringArray>(
    "Method", fit.Iterations, [](Row r) { return r.LeastSquares ? "least-squares" : "mba"; }));
  whole("Functions", [](Row r) { return static_cast<vtkIdType>(r.NumFunctions); });
  whole("Elements", [](Row r) { return static_cast<vtkIdType>(r.NumElements); });
  real("MaxError", [](Row r) { return r.MaxError; });
  real("MeanError", [](Row r) { return r.MeanError; });
  real("RmsError", [](Row r) { return r.RmsError; });
  whole("PointsOutside", [](Row r) { return static_cast<vtkIdType>(r.NumOutside); });
  whole("Outliers", [](Row r) { return static_cast<vtkIdType>(r.NumOutliers); });
  whole("SignificantPoints", [](Row r) { return static_cast<vtkIdType>(r.NumSignificant); });
  real("MaxSignificantError", [](Row r) { return r.MaxSignificantError; });
  real("MeanSignificantError", [](Row r) { return r.MeanSignificantError; });
  whole(
    "SignificantOutside", [](Row r) { return static_cast<vtkIdType>(r.NumSignificantOutside); });
  real("LogLikelihood", [](Row r) { return r.LogLikelihood; });
  real("DegreesOfFreedom", [](Row r) { return r.DegreesOfFreedom; });
  real("AIC", [](Row r) { return r.AIC; });
  real("BIC", [](Row r) { return r.BIC; });
}

void EncodeGridFeatures(const SurfaceFit& fit, vtkImageData* output)
{
  if (fit.GridFeatures.empty())
  {
    return;
  }
  const ParametricBox<2> domain = fit.Surface.Space->Domain();
  const auto layers = static_cast<int>(fit.GridFeatures.size());
  const auto n = static_cast<int>(
    std::lround(std::sqrt(static_cast<double>(fit.GridFeatures[0].Values.rows()))));
  output->SetDimensions(n + 1, n + 1, layers > 1 ? layers + 1 : 1);
  output->SetOrigin(domain.Lower[0], domain.Lower[1], 0.0);
  output->SetSpacing(
    (domain.Upper[0] - domain.Lower[0]) / n, (domain.Upper[1] - domain.Lower[1]) / n, 1.0);
  AddFeatures(fit.GridFeatures, output->GetCellData());
}

void EncodeElementFeatures(const SurfaceFit& fit, vtkPolyData* output)
{
  if (fit.ElementFeatures.empty())
  {
    return;
  }
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> rectangles;
  const auto iterations = NamedArray<vtkIntArray>("Iteration");
  const auto elements = NamedArray<vtkIntArray>("ElementId");
  const std::size_t first = fit.Iterations.size() - fit.ElementFeatures.size();
  for (std::size_t k = 0; k < fit.ElementFeatures.size(); ++k)
  {
    int element = 0;
    for (const ParametricBox<2>& box : fit.ElementFeatures[k].Boxes)
    {
      const vtkIdType corner = points->InsertNextPoint(box.Lower[0], box.Lower[1], 0.0);
      points->InsertNextPoint(box.Upper[0], box.Lower[1], 0.0);
      points->InsertNextPoint(box.Upper[0], box.Upper[1], 0.0);
      points->InsertNextPoint(box.Lower[0], box.Upper[1], 0.0);
      rectangles->InsertNextCell({ corner, corner + 1, corner + 2, corner + 3 });
      iterations->InsertNextValue(fit.Iterations[first + k].Iteration);
      elements->InsertNextValue(element++);
    }
  }
  output->SetPoints(points);
  output->SetPolys(rectangles);
  output->GetCellData()->AddArray(iterations);
  output->GetCellData()->AddArray(elements);
  AddFeatures(fit.ElementFeatures, output->GetCellData());
}
}
