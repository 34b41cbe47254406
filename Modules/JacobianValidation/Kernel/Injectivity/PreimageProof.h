// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "CellPieces.h"
#include <knotwork/SplineCore/BoxTree.h>

#include <optional>

/// Private to the injectivity proof: where a cell takes a value, and that no other place does.
namespace knotwork
{
/// A value known up to an error in every coordinate.
struct ImagePoint
{
  std::array<double, 3> Position{};
  double Error = 0.0;
};
/// f(u), with a bound of the evaluation's rounding.
ImagePoint EvaluateImage(const BernsteinCells& cells, int cell, const double* u);

struct Preimage
{
  std::array<double, 3> Parameters{};
  double Radius = 0.0; ///< the exact preimage is within, in every parameter
};

/// Newton's method from a start, then the proof: for every value within the image's error the map
/// x -> x - Y F(x), F = N - y W, Y near the inverse of F', is a contraction of a box that lies
/// inside the cell's parameter domain, so the box holds just one preimage.
std::optional<Preimage> ProvePreimage(const BernsteinCells& cells, const CellLattice& lattice,
  int cell, const std::array<double, 3>& start, const ImagePoint& image);

enum class Multiplicity : std::uint8_t
{
  Once,    ///< f takes the value at the known point only, and is one-to-one around it
  Several, ///< another preimage is proved: Cell, Other
  Unknown
};
struct MultiplicityResult
{
  Multiplicity State = Multiplicity::Unknown;
  int Cell = -1;
  Preimage Other;
  std::int64_t Boxes = 0;
};

/// How often f takes the value f(u) of a point of a cell that no other cell shares.
/// @param tree  of the boxes of all cells.
MultiplicityResult CountPreimages(const BernsteinCells& cells, const CellLatticeTable& lattices,
  const BoxTree& tree, int cell, const std::array<double, 3>& u, std::int64_t maxBoxes);
}
