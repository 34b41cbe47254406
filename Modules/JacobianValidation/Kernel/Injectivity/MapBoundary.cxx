// SPDX-License-Identifier: BSD-3-Clause
#include "MapBoundary.h"

#include "StarShape.h"
#include <knotwork/SplineCore/Parallel.h>

#include <algorithm>

namespace knotwork
{
MapBoundary::MapBoundary(
  const BernsteinCells& cells, CellGluing& gluing, const std::vector<int>& signs, int threads)
  : Cells(cells), Gluing(gluing), Shift(MoveToMiddle(cells, gluing.Boundary))
{
  for (std::size_t c = 0; c < this->Cells.Shapes.size(); ++c)
  {
    this->Lattices.try_emplace({ static_cast<int>(this->Cells.Shapes[c]), this->Cells.Degrees[c] },
      this->Cells.Shapes[c], this->Cells.Degrees[c]);
  }
  this->SideCells.NumComponents = this->Cells.NumComponents;
  this->SideCells.Rational = this->Cells.Rational;
  for (const BoundarySide& b : this->Gluing.Boundary)
  {
    this->SideLattices.try_emplace(
      { static_cast<int>(b.Frame.Shape), b.Degree }, b.Frame.Shape, b.Degree);
    const int i = this->SideCells.Add(b.Frame.Shape, b.Degree);
    std::copy(b.Data.begin(), b.Data.end(), this->SideCells.Block(i));
    this->SideCells.Errors.push_back(b.Error);
  }
  this->StarShaped =
    FindStarShaped(gluing.Boundary, gluing.NumComponents, this->SideCells, signs, threads);
  if (!gluing.Boundary.empty())
  {
    MakeBoxes(this->SideCells, this->SideLattices, this->Lower, this->Upper, threads);
    this->ModelSize =
      (this->Upper.colwise().maxCoeff() - this->Lower.colwise().minCoeff()).cwiseAbs().maxCoeff();
  }
}

void MakeBoxes(const BernsteinCells& cells, const CellLatticeTable& lattices, PointMatrix& lower,
  PointMatrix& upper, int threads)
{
  const Eigen::Index n = cells.NumCells();
  lower.resize(n, cells.NumComponents);
  upper.resize(n, cells.NumComponents);
  ParallelFor(static_cast<std::size_t>(n), 256, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t c = begin; c < end; ++c)
      {
        const auto& lattice = lattices.at({ static_cast<int>(cells.Shapes[c]), cells.Degrees[c] });
        const int cell = static_cast<int>(c);
        const PieceHull hull = MakeHull(lattice, cells.NumComponents, cells.Rational,
          MakePiece(lattice, cells.NumPlanes(), cells.Block(cell),
            cells.Errors.empty() ? 0.0 : cells.Errors[c]));
        for (int d = 0; d < cells.NumComponents; ++d)
        {
          const std::size_t at = static_cast<std::size_t>(d);
          lower(cell, d) = hull.Lower[at];
          upper(cell, d) = hull.Upper[at];
        }
      }
    });
}

InjectivityWitness::Place PlaceInCell(
  const BernsteinCells& cells, int cell, int side, const std::array<double, 3>& u)
{
  return { cell, side, u, EvaluateCell(cells, cell, u.data()).Position };
}

InjectivityWitness::Place PlaceOnSide(
  const BernsteinCells& cells, const BoundarySide& side, const std::array<double, 3>& s)
{
  const CellShape shape = cells.Shapes[static_cast<std::size_t>(side.Cell)];
  return PlaceInCell(cells, side.Cell, side.Number, SideToCell(shape, side.Frame, s.data()));
}

InjectivityWitness::Place MiddleOfSide(const BernsteinCells& cells, int cell, int number)
{
  if (cell < 0)
  {
    return {};
  }
  const CellShape shape = cells.Shapes[static_cast<std::size_t>(cell)];
  const SideFrame& frame = GetSideFrame(shape, number);
  const double middle = frame.Shape == CellShape::Triangle ? 0.25 : 0.5;
  const double s[2] = { middle, middle };
  return PlaceInCell(cells, cell, number, SideToCell(shape, frame, s));
}
}
