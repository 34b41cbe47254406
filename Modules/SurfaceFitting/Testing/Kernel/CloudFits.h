// SPDX-License-Identifier: BSD-3-Clause
// What tests of fits share.
#pragma once
#include "CloudCases.h"
#include <knotwork/SplineCore/BezierForm.h>

#include <gtest/gtest.h>

namespace knotwork
{
/// Distances of a result's surface, evaluated by the code for all splines.
inline std::vector<double> Measure(const PointCloud& cloud, const Spline<2>& surface, int measured)
{
  EvaluationBatch batch;
  const Status status =
    EvaluateParameters<2>(MakeBezierForm<2>(surface), cloud.Parameters, {}, batch);
  EXPECT_TRUE(status) << status.Message();
  std::vector<double> distances;
  for (Eigen::Index i = 0; i < cloud.Values.rows(); ++i)
  {
    const auto difference =
      (cloud.Values.row(i).head(measured) - batch.Values.row(i).head(measured)).eval();
    distances.push_back(measured == 1 ? difference(0) : difference.norm());
  }
  return distances;
}

/// Reported and measured distances are the same and within the tolerances.
inline void ExpectWithin(const PointCloud& cloud, const SurfaceFit& fit, int measured = 1)
{
  EXPECT_TRUE(fit.WithinTolerance);
  EXPECT_EQ(fit.Final.NumOutside, 0U);
  ASSERT_TRUE(fit.Surface.Check());
  const std::vector<double> distances = Measure(cloud, fit.Surface, measured);
  const double rounding = 1e-13 * (1.0 + fit.Surface.ControlPoints.cwiseAbs().maxCoeff());
  double most = 0.0;
  for (std::size_t i = 0; i < distances.size(); ++i)
  {
    if (!fit.Outliers.empty() && fit.Outliers[i] != 0)
    {
      continue;
    }
    ASSERT_NEAR(distances[i], fit.Distances[i], rounding) << "point " << i;
    ASSERT_LE(std::fabs(distances[i]), fit.Tolerances[i] + rounding) << "point " << i;
    most = std::max(most, std::fabs(distances[i]));
  }
  EXPECT_NEAR(most, fit.Final.MaxError, rounding);
}

inline SurfaceFit Fit(const PointCloud& cloud, const FitParams& params)
{
  auto fit = FitSurface(cloud, params);
  EXPECT_TRUE(fit) << fit.Status.Message();
  return std::move(fit.Value);
}

inline FitParams WithTolerance(double tolerance)
{
  FitParams params;
  params.Tolerance = tolerance;
  return params;
}

inline double Wave(double x, double y)
{
  return 0.3 * std::sin(7.0 * x) * std::cos(5.0 * y) + 0.1 * x;
}
}
