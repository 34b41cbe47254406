// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineGrid/SplineModel.h>

namespace knotwork
{
/// Geometry and fields as one spline, so that all of them are refined in one go.
template <int Dim>
Spline<Dim> JoinFields(const Spline<Dim>& geometry, const std::vector<SplineField>& fields)
{
  Eigen::Index columns = 3;
  for (const SplineField& field : fields)
  {
    columns += field.Coefficients.cols();
  }
  Spline<Dim> all = geometry;
  all.ControlPoints.resize(geometry.ControlPoints.rows(), columns);
  all.ControlPoints.leftCols(3) = geometry.ControlPoints;
  columns = 3;
  for (const SplineField& field : fields)
  {
    all.ControlPoints.middleCols(columns, field.Coefficients.cols()) = field.Coefficients;
    columns += field.Coefficients.cols();
  }
  return all;
}

/// Geometry and fields of a patch from columns as JoinFields has put them together. The fields are
/// those that the patch has, with their numbers of components.
template <int Dim>
void SeparateFields(const Spline<Dim>& all, SplinePatch& patch)
{
  Eigen::Index columns = 3;
  for (SplineField& field : patch.Fields)
  {
    field.Coefficients = all.ControlPoints.middleCols(columns, field.Coefficients.cols()).eval();
    columns += field.Coefficients.cols();
  }
  Spline<Dim> geometry = all;
  geometry.ControlPoints = all.ControlPoints.leftCols(3).eval();
  patch.Geometry = std::move(geometry);
}
}
