// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplineDefinition.h"

#include "FilterErrorCode.h"
#include "SplineModel.h"
#include <knotwork/SplineCore/SpaceFamily.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkObjectFactory.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>

vtkStandardNewMacro(vtkSplineDefinition);

namespace
{
using namespace knotwork;

const char* const DirectionNames[] = { "first", "second", "third" };

std::vector<double> ValuesOf(vtkDataArray* array)
{
  std::vector<double> values(static_cast<std::size_t>(array->GetNumberOfTuples()));
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    values[i] = array->GetComponent(static_cast<vtkIdType>(i), 0);
  }
  return values;
}

/// Rows of 2 or 3 coordinates as rows of 3.
PointMatrix PointsOf(vtkDataArray* array)
{
  const int components = std::min(array->GetNumberOfComponents(), 3);
  PointMatrix points = PointMatrix::Zero(array->GetNumberOfTuples(), 3);
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
  {
    for (int c = 0; c < components; ++c)
    {
      points(i, c) = array->GetComponent(i, c);
    }
  }
  return points;
}

void Fill(vtkDoubleArray* array, const double* values, Eigen::Index rows, int components)
{
  array->Initialize();
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(rows);
  std::copy_n(values, rows * components, array->GetPointer(0));
}

template <int Dim>
Result<AnySpline> MakeTensorSpline(vtkDataArray* degrees,
  const std::array<vtkDataArray*, 3>& knotArrays, vtkDataArray* points, vtkDataArray* weights)
{
  std::array<KnotVector, Dim> knots;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    const std::string where = std::string("knots of the ") + DirectionNames[d] + " direction";
    if (!knotArrays[d])
    {
      return { ErrorCode::EmptyInput, where + ": there are none" };
    }
    const int degree = static_cast<int>(degrees->GetComponent(static_cast<vtkIdType>(d), 0));
    auto made = KnotVector::Create(degree, ValuesOf(knotArrays[d]));
    if (!made)
    {
      return { made.Status.Code, where + ": " + made.Status.Detail };
    }
    knots[d] = std::move(made.Value);
  }
  auto space = MakeTensorSpace<Dim>(knots);
  if (!space)
  {
    return space.Status;
  }
  Spline<Dim> spline;
  spline.Space = space.Value;
  spline.ControlPoints = PointsOf(points);
  if (weights)
  {
    const std::vector<double> values = ValuesOf(weights);
    spline.Weights =
      Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  }
  if (Status status = spline.Check(); !status)
  {
    return status;
  }
  return AnySpline(std::move(spline));
}
}

vtkSplineDefinition::vtkSplineDefinition() : Model(std::make_unique<SplineModel>()) {}

vtkSplineDefinition::~vtkSplineDefinition() = default;

bool vtkSplineDefinition::End(const Status& status)
{
  this->ErrorCode = status ? 0 : FilterErrorCode(status);
  this->ErrorText = status ? "" : status.Message();
  return static_cast<bool>(status);
}

bool vtkSplineDefinition::AddTensorPatch(int dimension, vtkDataArray* degrees, vtkDataArray* knots0,
  vtkDataArray* knots1, vtkDataArray* knots2, vtkDataArray* points, vtkDataArray* weights)
{
  if (dimension < 1 || dimension > 3)
  {
    return this->End({ knotwork::ErrorCode::DimensionMismatch,
      "a patch has 1 to 3 parameters, not " + std::to_string(dimension) });
  }
  if (!degrees || degrees->GetNumberOfTuples() < dimension)
  {
    return this->End(
      { knotwork::ErrorCode::SizeMismatch, "a degree is wanted for every direction" });
  }
  if (!points || points->GetNumberOfComponents() < 2 || points->GetNumberOfComponents() > 3)
  {
    return this->End(
      { knotwork::ErrorCode::SizeMismatch, "control points are rows of 2 or 3 coordinates" });
  }
  const std::array<vtkDataArray*, 3> knots{ knots0, knots1, knots2 };
  Result<AnySpline> made = dimension == 1 ? MakeTensorSpline<1>(degrees, knots, points, weights)
    : dimension == 2                      ? MakeTensorSpline<2>(degrees, knots, points, weights)
                                          : MakeTensorSpline<3>(degrees, knots, points, weights);
  if (made)
  {
    SplinePatch patch;
    patch.Id = static_cast<int>(this->Model->Patches.size());
    patch.Geometry = std::move(made.Value);
    this->Model->Patches.push_back(std::move(patch));
    this->Modified();
  }
  return this->End(made.Status);
}

bool vtkSplineDefinition::MakeGrid(vtkUnstructuredGrid* grid)
{
  return this->End(EncodeSplineGrid(*this->Model, grid));
}

bool vtkSplineDefinition::Decode(vtkDataObject* splines)
{
  auto model = DecodeSplineModel(splines, 0);
  if (model)
  {
    *this->Model = std::move(model.Value);
    this->Modified();
  }
  return this->End(model.Status);
}

int vtkSplineDefinition::GetNumberOfPatches()
{
  return static_cast<int>(this->Model->Patches.size());
}

const knotwork::AnySpline* vtkSplineDefinition::Geometry(int patch)
{
  const bool exists = patch >= 0 && patch < this->GetNumberOfPatches();
  return exists ? &this->Model->Patches[static_cast<std::size_t>(patch)].Geometry : nullptr;
}

int vtkSplineDefinition::GetPatchId(int patch)
{
  return this->Geometry(patch) ? this->Model->Patches[static_cast<std::size_t>(patch)].Id : -1;
}

int vtkSplineDefinition::GetDimension(int patch)
{
  const AnySpline* geometry = this->Geometry(patch);
  return geometry ? static_cast<int>(geometry->index()) + 1 : 0;
}

std::string vtkSplineDefinition::GetFamily(int patch)
{
  const AnySpline* geometry = this->Geometry(patch);
  return geometry
    ? std::visit(
        [](const auto& spline) -> std::string { return FamilyOf(*spline.Space).Name(); }, *geometry)
    : "";
}

int vtkSplineDefinition::GetDegree(int patch, int direction)
{
  if (direction < 0 || direction >= this->GetDimension(patch))
  {
    return 0;
  }
  return std::visit(
    [d = static_cast<std::size_t>(direction)](const auto& spline)
    {
      const auto& elements = spline.Space->Elements;
      const int degree = elements.empty() ? 0 : elements.front().Degree[d];
      const bool everywhere = std::all_of(elements.begin(), elements.end(),
        [&](const auto& element) { return element.Degree[d] == degree; });
      return everywhere ? degree : 0;
    },
    *this->Geometry(patch));
}

void vtkSplineDefinition::GetKnots(int patch, int direction, vtkDoubleArray* knots)
{
  std::vector<double> values;
  if (direction >= 0 && direction < this->GetDimension(patch))
  {
    std::visit(
      [&](const auto& spline)
      {
        values = FamilyOf(*spline.Space)
                   .Describe(*spline.Space)
                   .Knots[static_cast<std::size_t>(direction)];
      },
      *this->Geometry(patch));
  }
  Fill(knots, values.data(), static_cast<Eigen::Index>(values.size()), 1);
}

void vtkSplineDefinition::GetControlPoints(int patch, vtkDoubleArray* points)
{
  Fill(points, nullptr, 0, 3);
  if (const AnySpline* geometry = this->Geometry(patch))
  {
    std::visit([&](const auto& spline)
      { Fill(points, spline.ControlPoints.data(), spline.ControlPoints.rows(), 3); },
      *geometry);
  }
}

void vtkSplineDefinition::GetWeights(int patch, vtkDoubleArray* weights)
{
  Fill(weights, nullptr, 0, 1);
  if (const AnySpline* geometry = this->Geometry(patch))
  {
    std::visit([&](const auto& spline)
      { Fill(weights, spline.Weights.data(), spline.Weights.size(), 1); },
      *geometry);
  }
}
