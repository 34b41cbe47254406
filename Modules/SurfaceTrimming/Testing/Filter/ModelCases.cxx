// SPDX-License-Identifier: BSD-3-Clause
#include "ModelCases.h"

#include <knotwork/SplineCore/TensorSpace.h>

#include <algorithm>
#include <random>

namespace knotwork
{
namespace
{
PointMatrix Random(int rows, int columns, std::mt19937& random)
{
  std::uniform_real_distribution<double> value(-1.0, 1.0);
  PointMatrix points(rows, columns);
  for (Eigen::Index i = 0; i < points.size(); ++i)
  {
    points.data()[i] = value(random);
  }
  return points;
}

Spline<2> Surface(int degree, int spans, std::mt19937& random)
{
  const KnotVector u = KnotVector::Uniform(degree, spans);
  const KnotVector v = KnotVector::Uniform(degree, 2);
  Spline<2> surface;
  surface.Space = MakeTensorSpace<2>({ u, v }).Value;
  surface.ControlPoints = Random(surface.Space->NumFunctions, 3, random);
  return surface;
}

TrimmingCurve Curve(
  int degree, int spans, int edge, std::array<int, 2> vertices, std::mt19937& random)
{
  TrimmingCurve use;
  use.Curve.Space = MakeTensorSpace<1>({ KnotVector::Uniform(degree, spans) }).Value;
  use.Curve.ControlPoints = Random(use.Curve.Space->NumFunctions, 3, random);
  use.UV = Random(use.Curve.Space->NumFunctions, 2, random);
  use.Edge = edge;
  use.Vertices = vertices;
  return use;
}

::testing::AssertionResult Differ(const std::string& what)
{
  return ::testing::AssertionFailure() << what;
}

template <int Dim>
bool Same(const Spline<Dim>& a, const Spline<Dim>& b)
{
  return a.Space->Knots == b.Space->Knots && a.ControlPoints == b.ControlPoints &&
    a.Weights == b.Weights;
}
}

TrimmedModel TwoFaces(unsigned seed, int spans)
{
  std::mt19937 random(seed);
  TrimmedModel model;
  model.NumEdges = 4;
  model.NumVertices = 3;
  model.Faces.resize(2);
  TrimmedFace& first = model.Faces[0];
  first.Surface = Surface(3, spans, random);
  first.Name = "roof";
  first.HasColor = true;
  first.Color = { 1.0, 0.2, 0.0 };
  const TrimmingCurve shared = Curve(3, 4, 0, { 0, 1 }, random);
  TrimmingCurve hole = Curve(2, 2, 3, { 2, 2 }, random);
  hole.Curve.Weights = Eigen::VectorXd::LinSpaced(hole.Curve.Space->NumFunctions, 1.0, 2.0);
  hole.Reversed = true;
  first.Loops.resize(2);
  first.Loops[0].Curves = { shared, Curve(2, 3, 1, { 1, 0 }, random) };
  first.Loops[1].Curves = { hole };
  TrimmedFace& second = model.Faces[1];
  second.Surface = Surface(2, 2, random);
  second.Surface.Weights = Eigen::VectorXd::LinSpaced(second.Surface.Space->NumFunctions, 0.5, 1.5);
  second.Reversed = true;
  second.Loops.resize(1);
  second.Loops[0].Curves = { shared, Curve(1, 5, 2, { 1, 0 }, random) };
  std::reverse(second.Loops[0].Curves.begin(), second.Loops[0].Curves.end());
  for (TrimmingCurve& use : second.Loops[0].Curves)
  {
    use.Reversed = true;
  }
  second.Loops[0].Curves.back().UV = Random(static_cast<int>(shared.UV.rows()), 2, random);
  return model;
}

::testing::AssertionResult Identical(const TrimmedModel& a, const TrimmedModel& b)
{
  if (a.Faces.size() != b.Faces.size() || a.NumEdges != b.NumEdges ||
    a.NumVertices != b.NumVertices)
  {
    return Differ("numbers of faces, edges or vertices");
  }
  for (std::size_t f = 0; f < a.Faces.size(); ++f)
  {
    const TrimmedFace& x = a.Faces[f];
    const TrimmedFace& y = b.Faces[f];
    const std::string face = "face " + std::to_string(f);
    double color = 0.0;
    for (std::size_t c = 0; c < 3; ++c)
    {
      color = std::max(color, std::abs(x.Color[c] - y.Color[c]));
    }
    if (!Same(x.Surface, y.Surface) || x.Reversed != y.Reversed || x.Type != y.Type ||
      x.Body != y.Body || x.Name != y.Name || x.HasColor != y.HasColor || color > 0.5 / 255.0 ||
      x.Loops.size() != y.Loops.size())
    {
      return Differ(face);
    }
    for (std::size_t l = 0; l < x.Loops.size(); ++l)
    {
      if (x.Loops[l].Curves.size() != y.Loops[l].Curves.size())
      {
        return Differ(face + ", loop " + std::to_string(l));
      }
      for (std::size_t c = 0; c < x.Loops[l].Curves.size(); ++c)
      {
        const TrimmingCurve& p = x.Loops[l].Curves[c];
        const TrimmingCurve& q = y.Loops[l].Curves[c];
        if (!Same(p.Curve, q.Curve) || p.UV != q.UV || p.Edge != q.Edge ||
          p.Vertices != q.Vertices || p.Reversed != q.Reversed)
        {
          return Differ(face + ", loop " + std::to_string(l) + ", curve " + std::to_string(c));
        }
      }
    }
  }
  return ::testing::AssertionSuccess();
}
}
