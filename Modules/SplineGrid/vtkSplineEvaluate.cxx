// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplineEvaluate.h"

#include "ReferenceSystem.h"
#include "SplineModel.h"
#include <knotwork/SplineCore/ClosestPoint.h>
#include <knotwork/SplineCore/OneSidedLocation.h>

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <limits>
#include <map>

using knotwork::BezierForm;
using knotwork::ErrorCode;
using knotwork::PointMatrix;
using knotwork::Result;
using knotwork::Spline;
using knotwork::SplineModel;
using knotwork::Status;

vtkStandardNewMacro(vtkSplineEvaluate);

namespace
{
/// Where each point lies on the model.
struct Places
{
  std::vector<int> Patches; ///< index into the model's patches
  std::vector<int> Elements;
  PointMatrix Local;         ///< n x 3, unused columns 0
  Eigen::VectorXd Distances; ///< of a probe, else empty
};

std::string PointName(vtkIdType i)
{
  return "point " + std::to_string(i);
}

PointMatrix Coordinates(vtkPointSet* points)
{
  PointMatrix result(points->GetNumberOfPoints(), 3);
  for (Eigen::Index i = 0; i < result.rows(); ++i)
  {
    points->GetPoint(i, result.row(i).data());
  }
  return result;
}

/// Finds the patch and the element of points given by parameters.
Status LocateParameters(const SplineModel& model, const PointMatrix& parameters,
  vtkDataArray* patchIds, int patchId, const int* fromBelow, Places& places)
{
  std::map<int, int> patchOfId;
  for (std::size_t k = 0; k < model.Patches.size(); ++k)
  {
    const int id = model.Patches[k].Id;
    if (!patchOfId.emplace(id, static_cast<int>(k)).second)
    {
      return { ErrorCode::InvalidTopology,
        "PatchId " + std::to_string(id) +
          " stands for patches of several blocks; extract a block" };
    }
  }
  if (!patchIds && patchId < 0 && model.Patches.size() != 1)
  {
    return { ErrorCode::InvalidParameter,
      "the splines have " + std::to_string(model.Patches.size()) +
        " patches; choose one by PatchId or by a point array" };
  }
  for (Eigen::Index i = 0; i < parameters.rows(); ++i)
  {
    int& patch = places.Patches[static_cast<std::size_t>(i)];
    if (patchIds || patchId >= 0)
    {
      const int id = patchIds ? static_cast<int>(patchIds->GetTuple1(i)) : patchId;
      const auto position = patchOfId.find(id);
      if (position == patchOfId.end())
      {
        return { ErrorCode::InvalidTopology,
          PointName(i) + " asks for PatchId " + std::to_string(id) +
            ", which the splines do not have" };
      }
      patch = position->second;
    }
    const Status status = std::visit(
      [&](const auto& spline) -> Status
      {
        const auto& space = *spline.Space;
        constexpr int dimension = std::tuple_size_v<decltype(space.Domain().Lower)>;
        if (!space.HasDomain())
        {
          return { ErrorCode::DimensionMismatch,
            "patch " + std::to_string(model.Patches[static_cast<std::size_t>(patch)].Id) +
              " is a Bezier grid without a parameter domain; probe by position" };
        }
        if (parameters.cols() < dimension)
        {
          return { ErrorCode::DimensionMismatch,
            "the parameters have " + std::to_string(parameters.cols()) + " components, patch " +
              std::to_string(model.Patches[static_cast<std::size_t>(patch)].Id) + " needs " +
              std::to_string(dimension) };
        }
        int& element = places.Elements[static_cast<std::size_t>(i)];
        std::array<bool, static_cast<std::size_t>(dimension)> sides;
        std::transform(
          fromBelow, fromBelow + dimension, sides.begin(), [](int side) { return side != 0; });
        element = knotwork::LocateOneSided<static_cast<int>(dimension)>(
          space, parameters.row(i).data(), sides, places.Local.row(i).data());
        if (element < 0)
        {
          return { ErrorCode::OutsideDomain, PointName(i) };
        }
        return {};
      },
      model.Patches[static_cast<std::size_t>(patch)].Geometry);
    if (!status)
    {
      return status;
    }
  }
  return {};
}

/// Finds the nearest points of all patches with Dim parameters, where they are nearer than before.
template <int Dim>
Status ProbePatches(const SplineModel& model, const PointMatrix& queries, int threads,
  const knotwork::ProgressCallback& progress, Places& places)
{
  std::vector<BezierForm<Dim>> forms;
  std::vector<int> indices;
  for (std::size_t k = 0; k < model.Patches.size(); ++k)
  {
    if (const auto* spline = std::get_if<Spline<Dim>>(&model.Patches[k].Geometry))
    {
      forms.push_back(knotwork::MakeBezierForm(*spline, threads));
      indices.push_back(static_cast<int>(k));
    }
  }
  if (forms.empty())
  {
    return {};
  }
  knotwork::ClosestPointParams params;
  params.Threads = threads;
  params.Progress = progress;
  const auto search = knotwork::ClosestPointSearch<Dim>::Create(std::move(forms), params);
  if (!search)
  {
    return search.Status;
  }
  knotwork::ClosestPoints found;
  if (Status status = search->Find(queries, found); !status)
  {
    return status;
  }
  for (Eigen::Index i = 0; i < queries.rows(); ++i)
  {
    const auto row = static_cast<std::size_t>(i);
    if (found.Distances[i] < places.Distances[i])
    {
      places.Patches[row] = indices[static_cast<std::size_t>(found.Patches[row])];
      places.Elements[row] = found.Elements[row];
      places.Local.row(i).setZero();
      places.Local.row(i).template head<Dim>() = found.Local.row(i);
      places.Distances[i] = found.Distances[i];
    }
  }
  return {};
}

/// Result arrays by name; rows of points that an array does not concern stay zero.
class ResultArrays
{
public:
  explicit ResultArrays(vtkIdType numPoints) : NumPoints(numPoints) {}
  /// Scatters columns [first, first + components) of rows to the points.
  void Set(const std::string& name, const PointMatrix& rows, Eigen::Index first, int components,
    const std::vector<Eigen::Index>& points)
  {
    vtkSmartPointer<vtkDoubleArray>& array = this->Arrays[name];
    if (!array)
    {
      array = vtkSmartPointer<vtkDoubleArray>::New();
      array->SetName(name.c_str());
      array->SetNumberOfComponents(components);
      array->SetNumberOfTuples(this->NumPoints);
      array->FillValue(0.0);
    }
    if (array->GetNumberOfComponents() != components)
    {
      return; // a field of this name has other components on another patch
    }
    for (std::size_t k = 0; k < points.size(); ++k)
    {
      array->SetTuple(points[k], rows.row(static_cast<Eigen::Index>(k)).data() + first);
    }
  }
  void AddTo(vtkPointData* pointData) const
  {
    for (const auto& [name, array] : this->Arrays)
    {
      pointData->AddArray(array);
    }
  }

private:
  vtkIdType NumPoints;
  std::map<std::string, vtkSmartPointer<vtkDoubleArray>> Arrays;
};

/// Evaluates the geometry or a field of one patch at the points on it.
template <int Dim>
Status EvaluateCoefficients(const Spline<Dim>& spline, const std::string& name,
  const std::string& derivativePrefix, const std::vector<Eigen::Index>& points,
  const Places& places, const knotwork::EvaluationParams& params, ResultArrays& arrays)
{
  std::vector<int> elements;
  PointMatrix local(static_cast<Eigen::Index>(points.size()), Dim);
  for (std::size_t k = 0; k < points.size(); ++k)
  {
    elements.push_back(places.Elements[static_cast<std::size_t>(points[k])]);
    local.row(static_cast<Eigen::Index>(k)) = places.Local.row(points[k]).template head<Dim>();
  }
  knotwork::EvaluationBatch batch;
  const Status status = knotwork::EvaluateElements(
    knotwork::MakeBezierForm(spline, params.Threads), elements, local, params, batch);
  if (!status)
  {
    return status;
  }
  static const char* directions[] = { "u", "v", "w" };
  const int components = spline.NumComponents();
  arrays.Set(name, batch.Values, 0, components, points);
  int pair = 0;
  for (int a = 0; a < Dim && params.Derivatives >= 1; ++a)
  {
    const std::string first = derivativePrefix + "_" + directions[a];
    arrays.Set(first, batch.First, a * components, components, points);
    for (int b = a; b < Dim && params.Derivatives >= 2; ++b, ++pair)
    {
      arrays.Set(first + directions[b], batch.Second, pair * components, components, points);
    }
  }
  return {};
}
}

vtkSplineEvaluate::vtkSplineEvaluate()
{
  this->SetInputTypes({ Splines(), { { "vtkPointSet" } } });
  knotwork::KeepReferenceSystem(this);
}

int vtkSplineEvaluate::FillOutputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkPointSet");
  return 1;
}

int vtkSplineEvaluate::RequestDataObject(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  MakeOutputLike(outputs, 0, vtkPointSet::GetData(inputs[1], 0));
  return 1;
}

Status vtkSplineEvaluate::Compute(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkPointSet* points = vtkPointSet::GetData(inputs[1], 0);
  vtkPointSet* output = vtkPointSet::GetData(outputs, 0);
  const vtkIdType numPoints = points->GetNumberOfPoints();
  if (numPoints == 0)
  {
    return {};
  }
  const Result<SplineModel> decoded = this->DecodeInput(this->WholeInput(inputs));
  if (!decoded)
  {
    return decoded.Status;
  }
  const SplineModel& model = decoded.Value;
  if (model.Patches.empty())
  {
    return { ErrorCode::EmptyInput, "there is no spline to evaluate at the points" };
  }

  Places places;
  places.Patches.assign(static_cast<std::size_t>(numPoints), 0);
  places.Elements.assign(static_cast<std::size_t>(numPoints), -1);
  places.Local = PointMatrix::Zero(numPoints, 3);
  PointMatrix given = Coordinates(points);
  Status status;
  if (this->Mode == PARAMETERS)
  {
    if (!this->ParameterArray.empty() && this->ParameterArray != "None")
    {
      vtkDataArray* array = points->GetPointData()->GetArray(this->ParameterArray.c_str());
      if (!array)
      {
        return { ErrorCode::EmptyInput,
          "input 1 has no point array '" + this->ParameterArray + "' with numbers" };
      }
      given.resize(numPoints, array->GetNumberOfComponents());
      for (vtkIdType i = 0; i < numPoints; ++i)
      {
        array->GetTuple(i, given.row(i).data());
      }
    }
    vtkDataArray* patchIds = points->GetPointData()->GetArray(this->PatchIdArray.c_str());
    status = LocateParameters(model, given, patchIds, this->PatchId, this->FromBelow, places);
  }
  else
  {
    places.Distances.setConstant(numPoints, std::numeric_limits<double>::infinity());
    const auto progress = this->Progress();
    status = ProbePatches<1>(model, given, this->KernelThreads(), progress, places);
    status =
      status ? ProbePatches<2>(model, given, this->KernelThreads(), progress, places) : status;
    status =
      status ? ProbePatches<3>(model, given, this->KernelThreads(), progress, places) : status;
  }
  if (!status)
  {
    return status;
  }

  std::vector<std::vector<Eigen::Index>> pointsOfPatch(model.Patches.size());
  for (vtkIdType i = 0; i < numPoints; ++i)
  {
    pointsOfPatch[static_cast<std::size_t>(places.Patches[static_cast<std::size_t>(i)])].push_back(
      i);
  }
  const knotwork::EvaluationParams params{ this->Derivatives, this->KernelThreads() };
  static const char* const positionName = "Knotwork::Position"; // becomes the points
  ResultArrays geometry(numPoints);
  for (std::size_t k = 0; k < model.Patches.size() && status; ++k)
  {
    const knotwork::SplinePatch& patch = model.Patches[k];
    if (pointsOfPatch[k].empty())
    {
      continue;
    }
    status = std::visit(
      [&](const auto& spline)
      {
        Status each = EvaluateCoefficients(
          spline, positionName, "Derivative", pointsOfPatch[k], places, params, geometry);
        for (const knotwork::SplineField& field : patch.Fields)
        {
          auto coefficients = spline;
          coefficients.ControlPoints = field.Coefficients;
          each = each ? EvaluateCoefficients(coefficients, field.Name, field.Name, pointsOfPatch[k],
                          places, params, geometry)
                      : each;
        }
        return each;
      },
      patch.Geometry);
  }
  if (!status)
  {
    return status;
  }

  output->CopyStructure(points);
  output->GetPointData()->PassData(points->GetPointData());
  output->GetCellData()->PassData(points->GetCellData());
  output->GetFieldData()->PassData(points->GetFieldData());
  geometry.AddTo(output->GetPointData());
  vtkSmartPointer<vtkDataArray> position = output->GetPointData()->GetArray(positionName);
  output->GetPointData()->RemoveArray(positionName);
  position->SetName("Points");
  vtkNew<vtkPoints> moved;
  moved->SetDataTypeToDouble();
  moved->SetData(position);
  output->SetPoints(moved);

  vtkNew<vtkIntArray> patchIds;
  vtkNew<vtkIntArray> elementIds;
  vtkNew<vtkDoubleArray> local;
  patchIds->SetName("PatchId");
  elementIds->SetName("ElementId");
  local->SetName("LocalParameters");
  local->SetNumberOfComponents(3);
  for (vtkIdType i = 0; i < numPoints; ++i)
  {
    const auto row = static_cast<std::size_t>(i);
    patchIds->InsertNextValue(model.Patches[static_cast<std::size_t>(places.Patches[row])].Id);
    elementIds->InsertNextValue(places.Elements[row]);
    local->InsertNextTuple(places.Local.row(i).data());
  }
  output->GetPointData()->AddArray(patchIds);
  output->GetPointData()->AddArray(elementIds);
  output->GetPointData()->AddArray(local);
  if (this->Mode == PROBE)
  {
    vtkNew<vtkDoubleArray> distance;
    distance->SetName("Distance");
    for (vtkIdType i = 0; i < numPoints; ++i)
    {
      distance->InsertNextValue(places.Distances[i]);
    }
    output->GetPointData()->AddArray(distance);
  }
  return {};
}
