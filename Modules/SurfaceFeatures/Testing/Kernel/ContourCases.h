// SPDX-License-Identifier: BSD-3-Clause
// Surfaces (x, y, f) whose contours are known, the same functions over meshes of every kind, and
// checks of contours by evaluation alone.
#pragma once
#include "LRCases.h"
#include <knotwork/SplineCore/Bernstein.h>
#include <knotwork/SplineCore/BezierSpace.h>
#include <knotwork/SplineCore/Refinement.h>
#include <knotwork/SurfaceFeatures/Contours.h>

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

namespace knotwork::testing
{
/// A polynomial in Bernstein form on the square [-1, 1]^2.
struct SquarePolynomial
{
  IntArray<2> Degree{};
  std::vector<double> Coefficients;
};

/// a x^2 + b x y + c y^2 + d x + e y + f.
inline SquarePolynomial Conic(double a, double b, double c, double d, double e, double f)
{
  SquarePolynomial p{ { 2, 2 }, {} };
  const double line[3] = { -1.0, 0.0, 1.0 };   // x
  const double square[3] = { 1.0, -1.0, 1.0 }; // x^2
  for (int j = 0; j < 3; ++j)
  {
    for (int i = 0; i < 3; ++i)
    {
      p.Coefficients.push_back(
        a * square[i] + b * line[i] * line[j] + c * square[j] + d * line[i] + e * line[j] + f);
    }
  }
  return p;
}
/// (x - a)^2 + (y - b)^2 - r^2.
inline SquarePolynomial Circle(double a, double b, double r)
{
  return Conic(1.0, 0.0, 1.0, -2.0 * a, -2.0 * b, a * a + b * b - r * r);
}
inline SquarePolynomial operator*(const SquarePolynomial& a, const SquarePolynomial& b)
{
  return { { a.Degree[0] + b.Degree[0], a.Degree[1] + b.Degree[1] },
    BernsteinProduct<2>(a.Degree, a.Coefficients, b.Degree, b.Coefficients) };
}

/// The surface (x, y, f) with one element.
inline Spline<2> SquareSurface(const SquarePolynomial& f)
{
  std::array<KnotVector, 2> knots;
  for (std::size_t d = 0; d < 2; ++d)
  {
    std::vector<double> t(static_cast<std::size_t>(f.Degree[d] + 1), -1.0);
    t.insert(t.end(), static_cast<std::size_t>(f.Degree[d] + 1), 1.0);
    knots[d] = KnotVector::Create(f.Degree[d], t).Value;
  }
  Spline<2> surface;
  surface.Space = MakeTensorSpace<2>(knots).Value;
  surface.ControlPoints.resize(static_cast<Eigen::Index>(f.Coefficients.size()), 3);
  for (int j = 0, k = 0; j <= f.Degree[1]; ++j)
  {
    for (int i = 0; i <= f.Degree[0]; ++i, ++k)
    {
      surface.ControlPoints.row(k) << -1.0 + 2.0 * i / f.Degree[0], -1.0 + 2.0 * j / f.Degree[1],
        f.Coefficients[static_cast<std::size_t>(k)];
    }
  }
  return surface;
}

enum class MeshKind
{
  One,    ///< the element it comes with
  Even,   ///< 4 x 4
  Uneven, ///< tensor-product with random knots
  Hierarchical,
  LocallyRefined,
  Bezier ///< 4 x 4 without a domain
};
inline const std::vector<MeshKind> MeshKinds{ MeshKind::One, MeshKind::Even, MeshKind::Uneven,
  MeshKind::Hierarchical, MeshKind::LocallyRefined, MeshKind::Bezier };

/// The same map over another mesh.
inline Spline<2> OverMesh(const Spline<2>& surface, MeshKind kind, unsigned seed = 1)
{
  Random random(seed);
  Spline<2> result = surface;
  const auto refineAll = [&] { result = RefineAllElements<2>(result).Value.Value; };
  if (kind == MeshKind::Even || kind == MeshKind::Bezier || kind == MeshKind::Hierarchical)
  {
    refineAll();
    refineAll();
  }
  const ParametricBox<2> box = surface.Space->Domain();
  if (kind == MeshKind::Uneven)
  {
    for (int d = 0; d < 2; ++d)
    {
      const std::size_t k = static_cast<std::size_t>(d);
      std::vector<double> knots;
      for (int i = 0; i < 4; ++i)
      {
        knots.push_back(random.In(box.Lower[k], box.Upper[k]));
      }
      std::sort(knots.begin(), knots.end());
      result = InsertKnots<2>(result, d, knots).Value;
    }
  }
  if (kind == MeshKind::Hierarchical)
  {
    for (int step = 0; step < 3; ++step)
    {
      std::vector<int> marked;
      for (int i = 0; i < 3; ++i)
      {
        marked.push_back(random.Int(0, result.Space->NumElements() - 1));
      }
      RefinementParams params;
      params.Extension = 1;
      result = RefineMarkedElements<2>(result, marked, params).Value.Value;
    }
  }
  if (kind == MeshKind::LocallyRefined)
  {
    const Spline<2> even = OverMesh(surface, MeshKind::Even);
    result = InsertSegments(even, RandomSegments(random, even.Space, 12), 0).Value;
  }
  if (kind == MeshKind::Bezier)
  {
    // every element on its own, then glued where control points agree
    const BezierForm<2> form = MakeBezierForm(result);
    std::map<std::vector<double>, int> numbers;
    std::vector<IntArray<2>> degrees;
    std::vector<int> ids;
    std::vector<std::vector<double>> points;
    for (int e = 0; e < result.Space->NumElements(); ++e)
    {
      const IntArray<2> degree = result.Space->Elements[static_cast<std::size_t>(e)].Degree;
      const int size = NumTensorFunctions<2>(degree);
      degrees.push_back(degree);
      for (int k = 0; k < size; ++k)
      {
        std::vector<double> point;
        std::vector<double> key;
        for (int c = 0; c < form.NumPlanes(); ++c)
        {
          point.push_back(form.Block(e)[c * size + k]);
          key.push_back(std::round(1e9 * point.back()));
        }
        const auto found = numbers.emplace(key, static_cast<int>(points.size())).first;
        if (found->second == static_cast<int>(points.size()))
        {
          points.push_back(point);
        }
        ids.push_back(found->second);
      }
    }
    Spline<2> glued;
    glued.Space = MakeBezierSpace<2>(degrees, ids, static_cast<int>(points.size())).Value;
    PointMatrix rows(static_cast<Eigen::Index>(points.size()), form.NumPlanes());
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      for (int c = 0; c < form.NumPlanes(); ++c)
      {
        rows(static_cast<Eigen::Index>(i), c) = points[i][static_cast<std::size_t>(c)];
      }
    }
    glued.SetHomogeneousPoints(rows, result.IsRational());
    result = glued;
  }
  return result;
}

/// Largest |value - level| at samples of all straight pieces, evaluated on the element each piece
/// names.
inline double SampledError(
  const BezierForm<2>& form, const ContourSet& contours, int component = -1)
{
  const int c = component < 0 ? form.NumComponents - 1 : component;
  constexpr int Samples = 16;
  std::vector<int> elements;
  std::vector<double> local;
  std::vector<double> levels;
  for (const ContourComponent& component1 : contours.Components)
  {
    const std::size_t n = component1.NumPoints;
    for (std::size_t i = 0; i + (component1.Closed ? 0 : 1) < n; ++i)
    {
      const std::size_t a = component1.First + i;
      const int e = contours.Elements[a];
      const Eigen::RowVector2d from = contours.Local.row(static_cast<Eigen::Index>(a));
      const Eigen::RowVector2d to = contours.PieceEnds.row(static_cast<Eigen::Index>(a));
      for (int k = 0; k <= Samples; ++k)
      {
        const Eigen::RowVector2d p = from + (to - from) * k / Samples;
        elements.push_back(e);
        local.push_back(std::clamp(p[0], 0.0, 1.0));
        local.push_back(std::clamp(p[1], 0.0, 1.0));
        levels.push_back(contours.Levels[static_cast<std::size_t>(component1.Level)]);
      }
    }
  }
  EvaluationBatch batch;
  const Eigen::Map<const PointMatrix> at(
    local.data(), static_cast<Eigen::Index>(elements.size()), 2);
  EXPECT_TRUE(EvaluateElements<2>(form, elements, at, {}, batch));
  double error = 0.0;
  for (std::size_t i = 0; i < elements.size(); ++i)
  {
    error = std::max(error, std::abs(batch.Values(static_cast<Eigen::Index>(i), c) - levels[i]));
  }
  return error;
}

/// Largest distance in space between the end of a straight piece and the next point.
inline double LargestBreak(const BezierForm<2>& form, const ContourSet& contours)
{
  EvaluationBatch points;
  EvaluationBatch ends;
  EXPECT_TRUE(EvaluateElements<2>(form, contours.Elements, contours.Local, {}, points));
  EXPECT_TRUE(EvaluateElements<2>(form, contours.Elements, contours.PieceEnds, {}, ends));
  double largest = 0.0;
  for (const ContourComponent& component : contours.Components)
  {
    for (std::size_t i = 0; i + (component.Closed ? 0 : 1) < component.NumPoints; ++i)
    {
      const auto a = static_cast<Eigen::Index>(component.First + i);
      const auto b = static_cast<Eigen::Index>(component.First + (i + 1) % component.NumPoints);
      largest = std::max(largest, (ends.Values.row(a) - points.Values.row(b)).norm());
    }
  }
  return largest;
}

/// Open components end on the border of the domain.
inline bool EndsOnBorder(const SplineSpace<2>& space, const ContourSet& contours)
{
  const ParametricBox<2> box = space.Domain();
  for (const ContourComponent& component : contours.Components)
  {
    for (const std::size_t i : { component.First, component.First + component.NumPoints - 1 })
    {
      const auto p = contours.Parameters.row(static_cast<Eigen::Index>(i));
      if (!component.Closed && p[0] != box.Lower[0] && p[0] != box.Upper[0] &&
        p[1] != box.Lower[1] && p[1] != box.Upper[1])
      {
        return false;
      }
    }
  }
  return true;
}

/// Components of {f = level} of values on a grid, by marching squares; saddles by the mean of four.
inline int CountGridContours(const Eigen::MatrixXd& values, double level)
{
  const int n = static_cast<int>(values.rows());
  std::map<std::array<int, 3>, std::array<int, 3>> parent; // edges: direction, i, j
  const std::function<std::array<int, 3>(std::array<int, 3>)> root =
    [&](std::array<int, 3> e) -> std::array<int, 3>
  {
    const auto found = parent.emplace(e, e).first;
    return found->second == e ? e : found->second = root(found->second);
  };
  const auto up = [&](int i, int j) { return values(i, j) >= level; };
  for (int j = 0; j + 1 < n; ++j)
  {
    for (int i = 0; i + 1 < n; ++i)
    {
      const std::array<std::array<int, 3>, 4> edges{ { { 0, i, j }, { 1, i + 1, j },
        { 0, i, j + 1 }, { 1, i, j } } };
      const bool corner[4] = { up(i, j), up(i + 1, j), up(i + 1, j + 1), up(i, j + 1) };
      std::vector<int> crossed;
      for (int k = 0; k < 4; ++k)
      {
        if (corner[k] != corner[(k + 1) % 4])
        {
          crossed.push_back(k);
        }
      }
      if (crossed.size() == 2)
      {
        parent[root(edges[crossed[0]])] = root(edges[crossed[1]]);
      }
      else if (crossed.size() == 4)
      {
        const double mean =
          0.25 * (values(i, j) + values(i + 1, j) + values(i + 1, j + 1) + values(i, j + 1));
        const int shift = (mean >= level) == corner[0] ? 0 : 3; // around the other corners
        parent[root(edges[shift % 4])] = root(edges[(1 + shift) % 4]);
        parent[root(edges[(2 + shift) % 4])] = root(edges[(3 + shift) % 4]);
      }
    }
  }
  std::set<std::array<int, 3>> roots;
  std::vector<std::array<int, 3>> all;
  for (const auto& [edge, p] : parent)
  {
    all.push_back(edge);
  }
  for (const auto& edge : all)
  {
    roots.insert(root(edge));
  }
  return static_cast<int>(roots.size());
}

/// Values of a component at a grid of n x n points of the domain.
inline Eigen::MatrixXd GridValues(const BezierForm<2>& form, int n)
{
  const ParametricBox<2> box = form.Space->Domain();
  PointMatrix at(n * n, 2);
  for (int j = 0, k = 0; j < n; ++j)
  {
    for (int i = 0; i < n; ++i, ++k)
    {
      at.row(k) << box.Lower[0] + (box.Upper[0] - box.Lower[0]) * i / (n - 1),
        box.Lower[1] + (box.Upper[1] - box.Lower[1]) * j / (n - 1);
    }
  }
  EvaluationBatch batch;
  EXPECT_TRUE(EvaluateParameters<2>(form, at, {}, batch));
  Eigen::MatrixXd values(n, n);
  for (int j = 0, k = 0; j < n; ++j)
  {
    for (int i = 0; i < n; ++i, ++k)
    {
      values(i, j) = batch.Values(k, form.NumComponents - 1);
    }
  }
  return values;
}
}
