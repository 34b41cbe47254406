// SPDX-License-Identifier: BSD-3-Clause
#include "PointFile.h"

#include <cmath>

namespace knotwork
{
Status CheckCoordinates(const PointMatrix& points)
{
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    for (Eigen::Index c = 0; c < 3; ++c)
    {
      if (!std::isfinite(points(i, c)))
      {
        return { ErrorCode::NonFiniteInput,
          "point " + std::to_string(i) + " has a coordinate " + "xyz"[c] +
            " that is not finite; remove the point" };
      }
    }
  }
  return {};
}
}
