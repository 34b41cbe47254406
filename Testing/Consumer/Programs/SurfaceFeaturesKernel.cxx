// SPDX-License-Identifier: BSD-3-Clause
// A bowl has one minimum, and its contour is closed.
#include <knotwork/SplineCore/TensorSpace.h>
#include <knotwork/SurfaceFeatures/Contours.h>
#include <knotwork/SurfaceFeatures/CriticalPoints.h>

int main()
{
  const auto knots = knotwork::KnotVector::Uniform(2, 1, -1.0, 1.0);
  knotwork::Spline<2> bowl;
  bowl.Space = knotwork::MakeTensorSpace<2>({ knots, knots }).Value;
  bowl.ControlPoints.resize(9, 3);
  for (int i = 0; i < 9; ++i) // z = x^2 + y^2
  {
    const int x = i % 3 - 1;
    const int y = i / 3 - 1;
    bowl.ControlPoints.row(i) << x, y, (x == 0 ? -1 : 1) + (y == 0 ? -1 : 1);
  }
  knotwork::ContourParams params;
  params.Levels = { 0.5 };
  const auto contours = knotwork::TraceContours(knotwork::MakeBezierForm(bowl), params);
  knotwork::CriticalPointParams critical;
  critical.Component = 2;
  const auto points = knotwork::FindCriticalPoints(bowl, critical);
  int minima = 0;
  for (std::size_t i = 0; points && i < points->Points.size(); ++i)
  {
    minima += points->Points[i].Kind == knotwork::CriticalKind::Minimum;
  }
  return minima == 1 && contours && contours->Components.size() == 1 &&
      contours->Components[0].Closed
    ? 0
    : 1;
}
