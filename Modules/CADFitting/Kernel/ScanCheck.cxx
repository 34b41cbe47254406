// SPDX-License-Identifier: BSD-3-Clause
#include "ScanCheck.h"

#include <knotwork/SplineCore/Numbers.h>

#include <string>

namespace knotwork
{
Status CheckScan(const TriangleMesh& scan)
{
  const PointMatrix& points = scan.Points;
  if (points.rows() == 0)
  {
    return { ErrorCode::EmptyInput, "the scan has no points" };
  }
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    if (!AllWithinLimit(points.row(i)))
    {
      return { ErrorCode::NonFiniteInput,
        "point " + std::to_string(i) + " of the scan is not finite, or beyond " +
          Digits(LargestNumber) + ": leave it out" };
    }
  }
  for (std::size_t t = 0; t < scan.Triangles.size(); ++t)
  {
    for (const int corner : scan.Triangles[t])
    {
      if (corner < 0 || corner >= points.rows())
      {
        return { ErrorCode::InvalidTopology,
          "triangle " + std::to_string(t) + " of the scan has a corner that is no point" };
      }
    }
  }
  return {};
}
}
