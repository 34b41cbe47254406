// SPDX-License-Identifier: BSD-3-Clause
#include "MapData.h"

#include <knotwork/SplineGrid/SplineModel.h>

#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkNew.h"
#include "vtkStringArray.h"
#include "vtkUnstructuredGrid.h"

#include <variant>

namespace knotwork
{
namespace
{
void AddText(vtkUnstructuredGrid* grid, const char* name, const char* text)
{
  vtkNew<vtkStringArray> array;
  array->SetName(name);
  array->InsertNextValue(text);
  grid->GetFieldData()->AddArray(array);
}
}

template <int Dim>
Result<Spline<Dim>> DecodeInitialMap(
  vtkDataObject* data, int threads, std::vector<std::string>& warnings)
{
  Result<SplineModel> model = DecodeSplineModel(data, threads);
  if (!model)
  {
    return { model.Status.Code, "initial map: " + model.Status.Detail };
  }
  for (const std::string& warning : model->Warnings)
  {
    warnings.push_back("initial map: " + warning);
  }
  if (model->Patches.size() != 1)
  {
    return { ErrorCode::InvalidTopology,
      "the initial map has " + std::to_string(model->Patches.size()) + " patches, not one" };
  }
  auto* map = std::get_if<Spline<Dim>>(&model->Patches[0].Geometry);
  if (!map)
  {
    return { ErrorCode::DimensionMismatch,
      "the initial map does not have " + std::to_string(Dim) + " parameters, as the " +
        (Dim == 2 ? "plane" : "space") + " of the template has" };
  }
  const double size = map->ControlPoints.cwiseAbs().maxCoeff();
  for (Eigen::Index i = 0; Dim == 2 && i < map->ControlPoints.rows(); ++i)
  {
    if (!(std::abs(map->ControlPoints(i, 2)) <= 1e-9 * size))
    {
      return { ErrorCode::DimensionMismatch,
        "control point " + std::to_string(i) + " of the initial map has z = " +
          std::to_string(map->ControlPoints(i, 2)) + "; maps of the plane lie in z = 0" };
    }
  }
  map->ControlPoints.conservativeResize(Eigen::NoChange, Dim);
  return std::move(*map);
}

template <int Dim>
Status EncodeMap(const TemplateMapResult<Dim>& result, bool injectivity, vtkUnstructuredGrid* grid)
{
  Spline<Dim> map = result.Map;
  map.ControlPoints.conservativeResize(Eigen::NoChange, 3);
  map.ControlPoints.rightCols(3 - Dim).setZero();
  SplineModel model;
  model.Patches.emplace_back();
  model.Patches.back().Geometry = std::move(map);
  if (Status status = EncodeSplineGrid(model, grid); !status)
  {
    return status;
  }
  vtkDataArray* elements = grid->GetCellData()->GetArray("ElementId");
  const auto addCells = [&](const char* name, const std::vector<double>& ofElement)
  {
    vtkNew<vtkDoubleArray> values;
    values->SetName(name);
    for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
    {
      values->InsertNextValue(ofElement[static_cast<std::size_t>(elements->GetComponent(cell, 0))]);
    }
    grid->GetCellData()->AddArray(values);
  };
  addCells("MaxError", result.ElementErrors);
  addCells("JacobianMinLower", result.ElementMinJacobian);
  addCells("JacobianMaxUpper", result.ElementMaxJacobian);
  vtkNew<vtkDoubleArray> bound;
  bound->SetName("MinJacobianBound");
  bound->InsertNextValue(result.MinJacobianBound);
  grid->GetFieldData()->AddArray(bound);
  if (injectivity)
  {
    AddText(grid, "Injective", ToString(result.Injectivity.Verdict));
    AddText(grid, "InjectivityReason", ToString(result.Injectivity.Reason));
  }
  return {};
}

template Result<Spline<2>> DecodeInitialMap(vtkDataObject*, int, std::vector<std::string>&);
template Result<Spline<3>> DecodeInitialMap(vtkDataObject*, int, std::vector<std::string>&);
template Status EncodeMap(const TemplateMapResult<2>&, bool, vtkUnstructuredGrid*);
template Status EncodeMap(const TemplateMapResult<3>&, bool, vtkUnstructuredGrid*);
}
