// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryGrid.h"

#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <map>

namespace knotwork
{
namespace
{
constexpr const char* ArrayNames[] = { "FaceId", "LoopId", "CurveId", "InParameterPlane",
  "PreferParameter", "LoopTolerance" };
constexpr int NumArrays = 6;
using Row = std::array<double, NumArrays>;

void AddCurve(const Spline<1>& curve, const Row& row, SplineModel& model, std::map<int, Row>& rows)
{
  if (!curve.Space)
  {
    return;
  }
  SplinePatch patch;
  patch.Id = static_cast<int>(model.Patches.size());
  Spline<1> geometry = curve;
  geometry.ControlPoints = PointMatrix::Zero(curve.ControlPoints.rows(), 3);
  geometry.ControlPoints.leftCols(curve.NumComponents()) = curve.ControlPoints;
  patch.Geometry = std::move(geometry);
  rows[patch.Id] = row;
  model.Patches.push_back(std::move(patch));
}

/// An entry of a list that is numbered from 0; made when it is the next one.
template <typename T>
T* EntryOf(std::vector<T>& list, double number)
{
  if (number == static_cast<double>(list.size()))
  {
    list.emplace_back();
  }
  const bool inside = number >= 0.0 && number < static_cast<double>(list.size()) &&
    number == static_cast<double>(static_cast<std::size_t>(number));
  return inside ? &list[static_cast<std::size_t>(number)] : nullptr;
}
}

Status EncodeBoundaries(const SplineFile& file, vtkUnstructuredGrid* output)
{
  SplineModel model;
  std::map<int, Row> rows;
  for (const BoundedSurface& bounded : file.Bounded)
  {
    const auto spline = static_cast<std::size_t>(bounded.Spline);
    const double face = file.Ids.empty() ? bounded.Spline : file.Ids[spline];
    for (std::size_t l = 0; l < bounded.Loops.size(); ++l)
    {
      const SurfaceLoop& loop = bounded.Loops[l];
      for (std::size_t c = 0; c < loop.Curves.size(); ++c)
      {
        const LoopCurve& curve = loop.Curves[c];
        Row row{ face, static_cast<double>(l), static_cast<double>(c), 1.0,
          curve.PreferParameter ? 1.0 : 0.0, loop.Tolerance };
        AddCurve(curve.Parameter, row, model, rows);
        row[3] = 0.0;
        AddCurve(curve.Space, row, model, rows);
      }
    }
  }
  if (Status status = EncodeSplineGrid(model, output); !status || model.Patches.empty())
  {
    return status;
  }
  vtkDataArray* ids = output->GetCellData()->GetArray("PatchId");
  for (int a = 0; a < NumArrays; ++a)
  {
    vtkSmartPointer<vtkDataArray> array;
    array.TakeReference(a + 1 < NumArrays ? static_cast<vtkDataArray*>(vtkIntArray::New())
                                          : static_cast<vtkDataArray*>(vtkDoubleArray::New()));
    array->SetName(ArrayNames[a]);
    for (vtkIdType cell = 0; cell < output->GetNumberOfCells(); ++cell)
    {
      array->InsertNextTuple1(
        rows[static_cast<int>(ids->GetComponent(cell, 0))][static_cast<std::size_t>(a)]);
    }
    output->GetCellData()->AddArray(array);
  }
  return {};
}

Status DecodeBoundaries(vtkDataObject* grid, SplineFile& file)
{
  auto* cells = vtkUnstructuredGrid::SafeDownCast(grid);
  const Result<SplineModel> model = DecodeSplineModel(grid, 1);
  if (!model)
  {
    return { model.Status.Code, "boundary curves: " + model.Status.Detail };
  }
  for (const SplinePatch& patch : model->Patches)
  {
    const std::string place = "boundary curve, patch " + std::to_string(patch.Id);
    const auto* spline = std::get_if<Spline<1>>(&patch.Geometry);
    if (!spline || !cells || patch.Cells.empty())
    {
      return { ErrorCode::DimensionMismatch, place + ": it is no curve of one grid" };
    }
    Row row{};
    for (std::size_t a = 0; a < NumArrays; ++a)
    {
      vtkDataArray* array = cells->GetCellData()->GetArray(ArrayNames[a]);
      if (!array)
      {
        return { ErrorCode::InvalidTopology,
          place + ": the cell array '" + ArrayNames[a] + "' is missing; the reader makes it" };
      }
      row[a] = array->GetComponent(patch.Cells.front(), 0);
    }
    std::size_t face = 0;
    while (face < file.Splines.size() &&
      row[0] != (file.Ids.empty() ? static_cast<double>(face) : file.Ids[face]))
    {
      ++face;
    }
    if (face == file.Splines.size())
    {
      continue;
    }
    auto found = std::find_if(file.Bounded.begin(), file.Bounded.end(),
      [&](const BoundedSurface& bounded) { return bounded.Spline == static_cast<int>(face); });
    if (found == file.Bounded.end())
    {
      file.Bounded.push_back({ static_cast<int>(face), {} });
      found = file.Bounded.end() - 1;
    }
    SurfaceLoop* loop = EntryOf(found->Loops, row[1]);
    LoopCurve* curve = loop ? EntryOf(loop->Curves, row[2]) : nullptr;
    if (!curve)
    {
      return { ErrorCode::InvalidTopology,
        place + ": loops and curves are not numbered without gaps in the order of the cells" };
    }
    loop->Tolerance = row[5];
    curve->PreferParameter = row[4] != 0.0;
    Spline<1>& target = row[3] != 0.0 ? curve->Parameter : curve->Space;
    target = *spline;
    target.ControlPoints = PointMatrix(spline->ControlPoints.leftCols(row[3] != 0.0 ? 2 : 3));
  }
  return {};
}
}
