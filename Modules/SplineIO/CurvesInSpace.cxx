// SPDX-License-Identifier: BSD-3-Clause
#include "CurvesInSpace.h"

#include <knotwork/SplineCore/TensorSpace.h>
#include <knotwork/SplineGrid/SplineModel.h>

#include <vtkCellArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPolyData.h>

namespace knotwork
{
namespace
{
std::vector<Spline<1>> LinesOf(vtkPolyData* data)
{
  std::vector<Spline<1>> curves;
  vtkNew<vtkIdList> ids;
  for (vtkIdType line = 0; line < data->GetLines()->GetNumberOfCells(); ++line)
  {
    data->GetLines()->GetCellAtId(line, ids);
    const auto count = static_cast<int>(ids->GetNumberOfIds());
    if (count < 2)
    {
      continue;
    }
    Spline<1> curve;
    curve.Space = MakeTensorSpace<1>({ KnotVector::Uniform(1, count - 1, 0.0, count - 1) }).Value;
    curve.ControlPoints.resize(count, 3);
    for (int i = 0; i < count; ++i)
    {
      data->GetPoint(ids->GetId(i), curve.ControlPoints.row(i).data());
    }
    curves.push_back(std::move(curve));
  }
  return curves;
}
}

Result<std::vector<Spline<1>>> CurvesInSpace(vtkDataObject* data, int threads)
{
  std::vector<Spline<1>> curves;
  if (auto* polydata = vtkPolyData::SafeDownCast(data))
  {
    curves = LinesOf(polydata);
  }
  else
  {
    auto model = DecodeSplineModel(data, threads);
    if (!model)
    {
      return model.Status;
    }
    for (SplinePatch& patch : model->Patches)
    {
      if (auto* curve = std::get_if<Spline<1>>(&patch.Geometry))
      {
        curves.push_back(std::move(*curve));
      }
    }
  }
  if (curves.empty())
  {
    return { ErrorCode::EmptyInput, "there is no line and no curve; give lines or spline curves" };
  }
  return curves;
}
}
