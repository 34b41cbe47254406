// SPDX-License-Identifier: BSD-3-Clause
// Cases for template mapping: the unit square with a circle, and with a lobed curve.
#pragma once
#include <knotwork/TemplateMapping/Skeleton.h>

#include <cmath>

namespace knotwork::cases
{
inline constexpr double Pi = 3.14159265358979323846;

/// The lobed curve r(a) = 0.25 (1 + Amplitude cos(Lobes a)) about (0.5, 0.5), passed through with
/// the speed of w(t) = t + Skew sin(2 pi t) / (2 pi) + Shift, a = 2 pi w.
struct LobedCurve
{
  double Amplitude = 0.2;
  int Lobes = 5;
  double Skew = 0.35;
  double Shift = 0.0;
};

inline PointMatrix Polyline(int n, double (*x)(double), double (*y)(double))
{
  PointMatrix points(n, 2);
  for (int i = 0; i < n; ++i)
  {
    const double t = double(i) / (n - 1);
    points.row(i) << x(t), y(t);
  }
  return points;
}

/// The four edges of the unit square, ids 0 to 3, counter-clockwise.
inline Skeleton<2> SquareEdges(int samples)
{
  const double corner[5][2] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 }, { 0, 0 } };
  Skeleton<2> edges(4);
  for (int e = 0; e < 4; ++e)
  {
    SkeletonPatch<2>& edge = edges[static_cast<std::size_t>(e)];
    edge.Id = e;
    edge.Points.resize(samples, 2);
    for (int i = 0; i < samples; ++i)
    {
      const double t = double(i) / (samples - 1);
      edge.Points.row(i) << corner[e][0] + t * (corner[e + 1][0] - corner[e][0]),
        corner[e][1] + t * (corner[e + 1][1] - corner[e][1]);
    }
  }
  return edges;
}

/// Square and circle of radius 0.25, ids 0 to 4.
inline Skeleton<2> CircleTemplate(int samples = 10001)
{
  Skeleton<2> skeleton = SquareEdges(samples);
  SkeletonPatch<2> circle;
  circle.Id = 4;
  circle.Points = Polyline(
    samples, [](double t) { return 0.5 + 0.25 * std::cos(2 * Pi * t); },
    [](double t) { return 0.5 + 0.25 * std::sin(2 * Pi * t); });
  skeleton.push_back(circle);
  return skeleton;
}

/// Square and lobed curve with exact normals, ids 0 to 4.
inline Skeleton<2> LobedTarget(const LobedCurve& shape = {}, int samples = 200)
{
  Skeleton<2> skeleton = SquareEdges(samples);
  SkeletonPatch<2> curve;
  curve.Id = 4;
  curve.Points.resize(samples, 2);
  curve.Normals.resize(samples, 2);
  for (int i = 0; i < samples; ++i)
  {
    const double t = double(i) / (samples - 1);
    const double w = t + shape.Skew * std::sin(2 * Pi * t) / (2 * Pi) + shape.Shift;
    const double a = 2 * Pi * w;
    const double r = 0.25 * (1 + shape.Amplitude * std::cos(shape.Lobes * a));
    const double slope = -0.25 * shape.Amplitude * shape.Lobes * std::sin(shape.Lobes * a);
    const Eigen::RowVector2d out(std::cos(a), std::sin(a));
    const Eigen::RowVector2d around(-std::sin(a), std::cos(a));
    const Eigen::RowVector2d tangent = slope * out + r * around;
    curve.Points.row(i) = Eigen::RowVector2d(0.5, 0.5) + r * out;
    curve.Normals.row(i) << tangent.y(), -tangent.x();
  }
  skeleton.push_back(curve);
  return skeleton;
}
}
