// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/JacobianValidation/CellPieces.h>
#include <knotwork/SplineCore/BernsteinCells.h>
#include <knotwork/SplineCore/Shapes.h>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

/// Cells that the tests of this module make.
namespace knotwork::testing
{
inline constexpr CellShape AllCellShapes[] = { CellShape::Curve, CellShape::Quadrilateral,
  CellShape::Hexahedron, CellShape::Triangle, CellShape::Tetrahedron, CellShape::Wedge };

/// p in every direction of the shape.
inline CellDegree UniformDegree(CellShape shape, int p)
{
  CellDegree degree{};
  for (int d = 0; d < NumParameters(shape); ++d)
  {
    degree[static_cast<std::size_t>(d)] = p;
  }
  return degree;
}

/// Length, area or volume of the shape's parameter domain.
inline double ReferenceMeasure(CellShape shape)
{
  return shape == CellShape::Tetrahedron                        ? 1.0 / 6.0
    : shape == CellShape::Triangle || shape == CellShape::Wedge ? 0.5
                                                                : 1.0;
}

using CellFunction = std::function<std::array<double, 3>(const std::array<double, 3>&)>;

/// Adds a polynomial cell that interpolates a function at the lattice points i / p: the function
/// itself, up to rounding, when it is a polynomial of the degree.
inline int AddInterpolant(
  BernsteinCells& cells, CellShape shape, const CellDegree& degree, const CellFunction& function)
{
  const int n = NumCellCoefficients(shape, degree);
  Eigen::MatrixXd matrix(n, n);
  Eigen::MatrixXd values(n, cells.NumComponents);
  std::vector<double> row(static_cast<std::size_t>(n));
  int at = 0;
  const bool tetrahedron = shape == CellShape::Tetrahedron;
  const bool triangle = shape == CellShape::Triangle || shape == CellShape::Wedge;
  for (int k = 0; k <= degree[2]; ++k)
  {
    for (int j = 0; j <= degree[1]; ++j)
    {
      for (int i = 0; i <= degree[0]; ++i)
      {
        if ((triangle && i + j > degree[0]) || (tetrahedron && i + j + k > degree[0]))
        {
          continue;
        }
        const std::array<double, 3> u{ static_cast<double>(i) / degree[0],
          degree[1] > 0 ? static_cast<double>(j) / degree[1] : 0.0,
          degree[2] > 0 ? static_cast<double>(k) / degree[2] : 0.0 };
        EvaluateCellBasis(shape, degree, u.data(), row.data(), nullptr);
        const auto x = function(u);
        for (int c = 0; c < n; ++c)
        {
          matrix(at, c) = row[static_cast<std::size_t>(c)];
        }
        for (int c = 0; c < cells.NumComponents; ++c)
        {
          values(at, c) = x[static_cast<std::size_t>(c)];
        }
        ++at;
      }
    }
  }
  const Eigen::MatrixXd coefficients = matrix.fullPivLu().solve(values);
  const int cell = cells.Add(shape, degree);
  for (int c = 0; c < cells.NumComponents; ++c)
  {
    for (int i = 0; i < n; ++i)
    {
      cells.Block(cell)[c * n + i] = coefficients(i, c);
    }
  }
  return cell;
}

/// A cell whose control points are the shape's lattice, each coordinate moved by up to `noise`, at
/// an offset; rational with weights from 10^-decades to 10^decades where that is not 0.
inline int AddRandomCell(BernsteinCells& cells, CellShape shape, int degree, double noise,
  double decades, double offset, std::mt19937& random)
{
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const CellDegree p = UniformDegree(shape, degree);
  const int cell = cells.Add(shape, p);
  const int n = NumCellCoefficients(shape, p);
  double* block = cells.Block(cell);
  const bool tetrahedron = shape == CellShape::Tetrahedron;
  const bool triangle = shape == CellShape::Triangle || shape == CellShape::Wedge;
  for (int k = 0; k <= p[2]; ++k)
  {
    for (int j = 0; j <= p[1]; ++j)
    {
      for (int i = 0; i <= p[0]; ++i)
      {
        if ((triangle && i + j > p[0]) || (tetrahedron && i + j + k > p[0]))
        {
          continue;
        }
        const int index[3] = { i, j, k };
        const int at = CellCoefficient(shape, p, i, j, k);
        const double w = cells.Rational ? std::pow(10.0, decades * uniform(random)) : 1.0;
        for (int c = 0; c < cells.NumComponents; ++c)
        {
          block[c * n + at] =
            w * (static_cast<double>(index[c]) / degree + noise * uniform(random) + offset);
        }
        if (cells.Rational)
        {
          block[cells.NumComponents * n + at] = w;
        }
      }
    }
  }
  return cell;
}

/// Appends cells with the same number of components; polynomial cells get unit weights beside
/// rational ones. The first `components` components are kept.
inline void Append(BernsteinCells& cells, const BernsteinCells& more)
{
  for (int c = 0; c < more.NumCells(); ++c)
  {
    const std::size_t from = static_cast<std::size_t>(c);
    const int n = NumCellCoefficients(more.Shapes[from], more.Degrees[from]);
    const int to = cells.Add(more.Shapes[from], more.Degrees[from]);
    for (int k = 0; k < cells.NumComponents; ++k)
    {
      std::copy_n(more.Block(c) + k * n, n, cells.Block(to) + k * n);
    }
    if (cells.Rational)
    {
      double* w = cells.Block(to) + cells.NumComponents * n;
      if (more.Rational)
      {
        std::copy_n(more.Block(c) + more.NumComponents * n, n, w);
      }
      else
      {
        std::fill_n(w, n, 1.0);
      }
    }
  }
}

/// The elements of all patches of a shape with their patch and parameter box; of plane shapes x and
/// y alone when `planar`.
struct ShapeCells
{
  BernsteinCells Cells;
  std::vector<int> Patches;
  std::vector<ParametricBox<3>> Boxes;
};

template <int Dim>
void AddSpline(ShapeCells& shape, const Spline<Dim>& spline, int patch)
{
  const auto form = MakeBezierForm(spline);
  Append(shape.Cells, MakeBernsteinCells(form));
  for (const auto& element : form.Space->Elements)
  {
    ParametricBox<3> box;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      box.Lower[d] = element.Box.Lower[d];
      box.Upper[d] = element.Box.Upper[d];
    }
    shape.Boxes.push_back(box);
    shape.Patches.push_back(patch);
  }
}

inline ShapeCells MakeShapeCells(const ShapeParams& params, bool planar = false)
{
  const auto made = MakeShape(params);
  EXPECT_TRUE(made) << made.Status.Message();
  ShapeCells shape;
  shape.Cells.NumComponents = planar ? 2 : 3;
  for (const auto& patch : made.Value)
  {
    std::visit([&](const auto& s) { shape.Cells.Rational |= s.IsRational(); }, patch);
  }
  int number = 0;
  for (const auto& patch : made.Value)
  {
    std::visit([&](const auto& s) { AddSpline(shape, s, number); }, patch);
    ++number;
  }
  return shape;
}
}
