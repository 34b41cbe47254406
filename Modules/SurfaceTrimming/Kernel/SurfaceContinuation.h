// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "BackMap.h"
#include "ChartGrid.h"

namespace knotwork
{
/// Rows and columns of a grid, the last ones included.
struct GridRectangle
{
  std::array<int, 2> First{ 0, 0 };
  std::array<int, 2> Last{ -1, -1 };

  int Size(std::size_t direction) const
  {
    return this->Last[direction] - this->First[direction] + 1;
  }
};

/// Of the rectangles of known points only, at least `smallest` in both directions, one with the
/// most points; empty when there is none.
/// @complexity O(points).
GridRectangle LargestKnownRectangle(const KnownGrid& grid, int smallest);

/// The surface of BackMapMethod::Nurbs as it is published.
///
/// A grid of equally spaced points on the rectangle W. W_0 is its largest rectangle of points that
/// all lie in the chart; S_0 interpolates them. From W_i to W_(i+1) a ring of grid points is added
/// around: those in the chart take its points, the others the surface S_i continued beyond its
/// domain; S_(i+1) interpolates W_(i+1). The last one, over W, is the result. What is continued
/// grows without bound; it folds beside concavities and in holes. That is in the method.
/// @param counts  points of the grid in each direction, at least degree + 1.
/// @source  Ruiz, Mejia, Cadavid, Triangular mesh parameterization with trimmed surfaces, 2015;
/// interpolation: The NURBS Book, 9.2.1, knots by averaging, (9.8).
/// @return SingularSystem when no rectangle of degree + 1 points in both directions lies in the
/// chart, or when values overflow.
/// @complexity O(n^3) with n points in a direction.
Result<Spline<2>> ContinueSurface(const ChartMesh& chart, const ParametricBox<2>& rectangle,
  int degree, const std::array<int, 2>& counts);
}
