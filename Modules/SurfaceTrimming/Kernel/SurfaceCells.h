// SPDX-License-Identifier: BSD-3-Clause
// Private to the triangulation of faces.
#pragma once
#include <knotwork/SplineCore/BezierForm.h>

#include <vector>

namespace knotwork
{
/// Upper bounds of norms of a surface's derivatives by the parameters of its domain.
struct CellBounds
{
  std::array<double, 2> First{};  ///< |S_u|, |S_v|
  std::array<double, 3> Second{}; ///< |S_uu|, |S_uv|, |S_vv|

  void Include(const CellBounds& other);
};

/// Chordal bound of linear interpolation between points of a box with these sides (ChordalBound.h).
double ChordalDeviation(const CellBounds& bounds, const std::array<double, 2>& sides);

/// A tensor surface's domain, halved again and again into cells within which linear interpolation
/// keeps a tolerance: between elements while they are many, then within elements. What any box of
/// the domain needs to know of derivatives is in the tree of cells.
class SurfaceCells
{
public:
  /// @param maxCells  @return TooLarge when more are needed.
  /// @complexity O(elements + cells), times their logarithm.
  static Result<SurfaceCells> Create(
    const BezierForm<2>& form, double tolerance, std::size_t maxCells, int threads);

  struct Cell
  {
    ParametricBox<2> Box;
    CellBounds Bounds; ///< of the cell; with children of all of them
    int Children = -1; ///< first of two
  };
  const std::vector<Cell>& Cells() const { return this->Tree; } ///< the whole domain first

  /// Largest bounds of the cells whose inner points a box has; of the nearest cell when there are
  /// none.
  CellBounds Bound(const ParametricBox<2>& box) const;

  /// Inner parameters where the surface may have a crease: cells end there.
  const std::array<std::vector<double>, 2>& Creases() const { return this->Breaks; }

  /// Mean |S_u|, |S_v| over the domain; positive.
  const std::array<double, 2>& MeanSpeeds() const { return this->Speeds; }

private:
  class Builder;

  std::vector<Cell> Tree;
  std::array<std::vector<double>, 2> Breaks;
  std::array<double, 2> Speeds{};
};
}
