// SPDX-License-Identifier: BSD-3-Clause
#include "ClosestParameters.h"

#include <knotwork/SplineCore/ClosestPoint.h>

namespace knotwork
{
Result<PointMatrix> ClosestParameters(
  const Spline<2>& surface, const PointMatrixView& points, int threads, ProgressCallback progress)
{
  if (!surface.Space || !surface.Space->HasDomain() || surface.ControlPoints.cols() < points.cols())
  {
    return { ErrorCode::DimensionMismatch,
      "parameters are those of closest points of a surface with a parameter domain and as many "
      "components as the points" };
  }
  Spline<2> measured = surface;
  measured.ControlPoints = surface.ControlPoints.leftCols(points.cols());
  ClosestPointParams params;
  params.Threads = threads;
  params.Progress = std::move(progress);
  auto search = ClosestPointSearch<2>::Create({ MakeBezierForm<2>(measured, threads) }, params);
  if (!search)
  {
    return search.Status;
  }
  ClosestPoints found;
  if (const Status status = search->Find(points, found); !status)
  {
    return status;
  }
  PointMatrix parameters(points.rows(), 2);
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    const ParametricBox<2>& box =
      surface.Space->Elements[static_cast<std::size_t>(found.Elements[static_cast<std::size_t>(i)])]
        .Box;
    for (std::size_t d = 0; d < 2; ++d)
    {
      const auto column = static_cast<Eigen::Index>(d);
      const double local = found.Local(i, column);
      parameters(i, column) = (1.0 - local) * box.Lower[d] + local * box.Upper[d];
    }
  }
  return parameters;
}
}
