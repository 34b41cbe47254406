// SPDX-License-Identifier: BSD-3-Clause
// Layouts of several patches, made from formulas.
#pragma once
#include "DomainCases.h"
#include <knotwork/DomainParameterization/PatchLayout.h>

namespace knotwork::cases
{
inline PointMatrix Points(const std::vector<std::array<double, 2>>& points)
{
  PointMatrix matrix(static_cast<Eigen::Index>(points.size()), 2);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    matrix.row(static_cast<Eigen::Index>(i)) << points[i][0], points[i][1];
  }
  return matrix;
}

inline Spline<1> Segment(const PatchLayout<2>& layout, int a, int b)
{
  return Segment({ layout.Vertices(a, 0), layout.Vertices(a, 1) },
    { layout.Vertices(b, 0), layout.Vertices(b, 1) });
}

/// Three unit squares.
inline PatchLayout<2> LetterL()
{
  PatchLayout<2> layout;
  layout.Vertices =
    Points({ { 0, 0 }, { 1, 0 }, { 2, 0 }, { 0, 1 }, { 1, 1 }, { 2, 1 }, { 0, 2 }, { 1, 2 } });
  layout.Patches = { { 0, 1, 3, 4 }, { 1, 2, 4, 5 }, { 3, 4, 6, 7 } };
  for (const auto& [a, b] : std::vector<std::array<int, 2>>{
         { 0, 1 }, { 1, 2 }, { 5, 2 }, { 4, 5 }, { 4, 7 }, { 7, 6 }, { 6, 3 }, { 0, 3 } })
  {
    layout.Sides.push_back(Segment(layout, a, b));
  }
  return layout;
}

/// The disc of radius 1: a square with corners at `inner` times those of the rim, moved by `shift`
/// along x, and four patches around it.
inline PatchLayout<2> Disc(double inner, double shift = 0.0)
{
  PatchLayout<2> layout;
  std::vector<std::array<double, 2>> points;
  for (int ring = 0; ring < 2; ++ring)
  {
    for (int k = 0; k < 4; ++k)
    {
      const double angle = (0.25 + 0.5 * k) * Pi;
      const double r = ring == 0 ? 1.0 : inner;
      points.push_back({ r * std::cos(angle) + (ring ? shift : 0.0), r * std::sin(angle) });
    }
  }
  layout.Vertices = Points(points);
  layout.Patches.push_back({ 4, 5, 7, 6 });
  for (int k = 0; k < 4; ++k)
  {
    const int next = (k + 1) % 4;
    layout.Patches.push_back({ 4 + next, 4 + k, next, k });
    layout.Sides.push_back(Arc(1.0, (0.25 + 0.5 * k) * Pi, (0.75 + 0.5 * k) * Pi));
  }
  return layout;
}

/// Four patches between circles of the radii 1 and 2.
inline PatchLayout<2> Ring()
{
  PatchLayout<2> layout;
  std::vector<std::array<double, 2>> points;
  for (double r : { 1.0, 2.0 })
  {
    for (int k = 0; k < 4; ++k)
    {
      points.push_back({ r * std::cos(0.5 * k * Pi), r * std::sin(0.5 * k * Pi) });
      layout.Sides.push_back(Arc(r, 0.5 * k * Pi, 0.5 * (k + 1) * Pi));
    }
  }
  layout.Vertices = Points(points);
  for (int k = 0; k < 4; ++k)
  {
    const int next = (k + 1) % 4;
    layout.Patches.push_back({ k, 4 + k, next, 4 + next });
  }
  return layout;
}

/// Two patches whose south sides leave a narrow wedge above the vertex where they meet: the
/// straight interface from there lies outside.
inline PatchLayout<2> Wedge(int elements = 4)
{
  PatchLayout<2> layout;
  layout.Vertices = Points({ { 0, 0 }, { 1, 0 }, { 2, 0 }, { 0, 1 }, { 1, 1 }, { 2, 1 } });
  layout.Patches = { { 0, 1, 3, 4 }, { 1, 2, 4, 5 } };
  const KnotVector cubic = KnotVector::Uniform(3, 1);
  std::vector<double> knots;
  for (int i = 1; i < elements; ++i)
  {
    knots.push_back(double(i) / elements);
  }
  layout.Sides = { InsertKnots<1>(
                     Curve(cubic, { { 0, 0 }, { 0.4, 0.6 }, { 1.4, 0.5 }, { 1, 0 } }), 0, knots)
                     .Value,
    Segment(layout, 1, 2), Segment(layout, 2, 5), Segment(layout, 5, 4), Segment(layout, 4, 3),
    InsertKnots<1>(Curve(cubic, { { 0, 1 }, { 0, 2.0 / 3 }, { 0, 1.0 / 3 }, { 0, 0 } }), 0, knots)
      .Value };
  return layout;
}

/// A spline in the plane as one in space, moved by z.
template <int D>
Spline<D> Lifted(Spline<D> spline, double z)
{
  spline.ControlPoints.conservativeResize(Eigen::NoChange, 3);
  spline.ControlPoints.col(2).setConstant(z);
  return spline;
}

/// The surface that a curve in the plane sweeps from z = 0 to z = height.
inline Spline<2> Swept(const Spline<1>& curve, double height)
{
  Spline<2> face;
  face.Space = MakeTensorSpace<2>({ curve.Space->Knots[0], KnotVector::Uniform(1, 1) }).Value;
  const Eigen::Index n = curve.ControlPoints.rows();
  face.ControlPoints.resize(2 * n, 3);
  face.ControlPoints << Lifted<1>(curve, 0.0).ControlPoints, Lifted<1>(curve, height).ControlPoints;
  if (curve.IsRational())
  {
    face.Weights.resize(2 * n);
    face.Weights << curve.Weights, curve.Weights;
  }
  return face;
}

/// What patches in the plane sweep from z = 0 to z = height: bottom and top are these patches.
inline PatchLayout<3> Swept(
  const PatchLayout<2>& plane, const std::vector<Spline<2>>& patches, double height)
{
  PatchLayout<3> layout;
  const Eigen::Index n = plane.Vertices.rows();
  layout.Vertices = PointMatrix::Zero(2 * n, 3);
  const int up = static_cast<int>(n);
  for (const auto& corners : plane.Patches)
  {
    layout.Patches.push_back({ corners[0], corners[1], corners[2], corners[3], up + corners[0],
      up + corners[1], up + corners[2], up + corners[3] });
  }
  for (std::size_t p = 0; p < patches.size(); ++p)
  {
    const int nu = patches[p].Space->Knots[0].NumFunctions();
    const int nv = patches[p].Space->Knots[1].NumFunctions();
    for (int c = 0; c < 4; ++c)
    {
      const auto point =
        patches[p].ControlPoints.row((c & 1) * (nu - 1) + (c >> 1) * (nv - 1) * nu);
      const int vertex = plane.Patches[p][static_cast<std::size_t>(c)];
      layout.Vertices.row(vertex) << point, 0.0;
      layout.Vertices.row(up + vertex) << point, height;
    }
  }
  for (const Spline<2>& patch : patches)
  {
    layout.Sides.push_back(Lifted<2>(patch, 0.0));
    layout.Sides.push_back(Lifted<2>(patch, height));
  }
  for (const Spline<1>& curve : plane.Sides)
  {
    layout.Sides.push_back(Swept(curve, height));
  }
  return layout;
}
}
