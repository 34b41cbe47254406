// SPDX-License-Identifier: BSD-3-Clause
// What processes that validate pieces of a dataset tell each other.
#pragma once
#include <knotwork/JacobianValidation/CellMaps.h>

#include <cstdint>
#include <functional>
#include <vector>

namespace knotwork
{
/// By what a cell is called in outputs.
struct CellName
{
  std::int64_t Number = 0; ///< in its grid, counted through the pieces of its block
  int Block = 0;
  int Patch = 0;
  std::int64_t Element = -1; ///< in the file that it was read from, -1: not known
};
using CellNames = std::function<CellName(int)>;

/// The cells of a piece and what is proved of each.
struct CertifiedPiece
{
  BernsteinCells Cells;
  /// Its patches are not looked at: those of the names count.
  CellComplex Complex;
  bool HasPatches = false;
  std::vector<CellName> Names;
  std::vector<CellCertificate> Certificates;
  std::vector<JacobianWitness> Witnesses;
};

/// FindPlanes of the surface cells of all processes: those of this one.
/// @pre all processes call it.
std::vector<bool> FindPlanesOfPieces(
  const BernsteinCells& cells, const std::vector<std::int64_t>& patches);

/// The pieces of all processes as one, in the first of them; empty elsewhere. Its boxes and ids of
/// points are there where all pieces with cells have them.
/// @pre all processes call it.
/// @return TooLarge: more cells than an int counts.
Result<CertifiedPiece> CollectPieces(const CertifiedPiece& piece);
}
