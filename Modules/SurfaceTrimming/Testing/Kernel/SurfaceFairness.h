// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SurfaceTrimming/ChartMesh.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace knotwork
{
/// A surface outside of its chart, at the points of a dense grid over the rectangle.
struct SurfaceFairness
{
  /// Of neighbouring grid points outside of the chart, those whose normals are more than a right
  /// angle apart.
  double FoldedShare = 0.0;
  double MinDot = 1.0; ///< least product of neighbouring unit normals outside of the chart
  /// Mean |S_u x S_v| outside of the chart over that inside: how much area the surface makes up.
  double AreaFactor = 0.0;
};

/// @param n  grid points a direction.
inline SurfaceFairness MeasureFairness(
  const ChartMesh& chart, const Spline<2>& surface, int n = 300)
{
  const auto box = surface.Space->Domain();
  const auto at = [&](int d, int k)
  {
    const auto i = static_cast<std::size_t>(d);
    return box.Lower[i] + (box.Upper[i] - box.Lower[i]) * (k + 0.5) / n;
  };
  PointMatrix grid(n * n, 2);
  for (int j = 0; j < n; ++j)
  {
    for (int i = 0; i < n; ++i)
    {
      grid.row(j * n + i) << at(0, i), at(1, j);
    }
  }
  std::vector<char> inside(static_cast<std::size_t>(n) * static_cast<std::size_t>(n), 0);
  for (const auto& corners : chart.Triangles)
  {
    std::array<Eigen::RowVector2d, 3> p;
    for (std::size_t k = 0; k < 3; ++k)
    {
      p[k] = chart.UV.row(corners[k]);
    }
    const auto first = [&](int d, double u)
    {
      const auto i = static_cast<std::size_t>(d);
      const double place = (u - box.Lower[i]) / (box.Upper[i] - box.Lower[i]) * n - 0.5;
      return std::clamp(static_cast<int>(std::ceil(place)), 0, n);
    };
    const auto cross = [](const Eigen::RowVector2d& a, const Eigen::RowVector2d& b)
    { return a[0] * b[1] - a[1] * b[0]; };
    const int i1 = first(0, std::max({ p[0][0], p[1][0], p[2][0] }));
    const int j1 = first(1, std::max({ p[0][1], p[1][1], p[2][1] }));
    for (int j = first(1, std::min({ p[0][1], p[1][1], p[2][1] })); j < j1; ++j)
    {
      for (int i = first(0, std::min({ p[0][0], p[1][0], p[2][0] })); i < i1; ++i)
      {
        const Eigen::RowVector2d u(at(0, i), at(1, j));
        if (cross(p[1] - p[0], u - p[0]) >= 0.0 && cross(p[2] - p[1], u - p[1]) >= 0.0 &&
          cross(p[0] - p[2], u - p[2]) >= 0.0)
        {
          inside[static_cast<std::size_t>(j * n + i)] = 1;
        }
      }
    }
  }
  EvaluationParams params;
  params.Derivatives = 1;
  EvaluationBatch batch;
  EvaluateParameters<2>(MakeBezierForm(surface), grid, params, batch);
  SurfaceFairness fairness;
  const auto normal = [&](int k)
  {
    const Eigen::Vector3d u = batch.First.row(k).head<3>();
    const Eigen::Vector3d v = batch.First.row(k).tail<3>();
    return Eigen::Vector3d(u.cross(v));
  };
  double pairs = 0.0;
  double folded = 0.0;
  std::array<double, 2> area{};
  std::array<double, 2> count{};
  for (int k = 0; k < n * n; ++k)
  {
    const auto side = static_cast<std::size_t>(inside[static_cast<std::size_t>(k)]);
    area[side] += normal(k).norm();
    count[side] += 1.0;
    for (int next : { k % n + 1 < n ? k + 1 : -1, k + n < n * n ? k + n : -1 })
    {
      if (side == 1 || next < 0 || inside[static_cast<std::size_t>(next)] == 1)
      {
        continue;
      }
      const double dot = normal(k).normalized().dot(normal(next).normalized());
      fairness.MinDot = std::min(fairness.MinDot, dot);
      pairs += 1.0;
      folded += dot < 0.0 ? 1.0 : 0.0;
    }
  }
  fairness.FoldedShare = pairs > 0.0 ? folded / pairs : 0.0;
  fairness.AreaFactor =
    count[0] > 0.0 && count[1] > 0.0 ? area[0] / count[0] / (area[1] / count[1]) : 1.0;
  return fairness;
}
}
