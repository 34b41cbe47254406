// SPDX-License-Identifier: BSD-3-Clause
#include "ValidationPieces.h"

#include <knotwork/SplineGrid/Bytes.h>
#include <knotwork/SplineGrid/Processes.h>

#include <algorithm>
#include <limits>
#include <map>
#include <string>
#include <utility>

namespace knotwork
{
namespace
{
/// Cells that decide NeedsEdges in place of all: a flat one, one at another height, one that is not
/// flat.
std::vector<SurfaceCell> Representatives(const std::vector<SurfaceCell>& cells)
{
  std::vector<SurfaceCell> chosen;
  for (const SurfaceCell& cell : cells)
  {
    const bool isNew = std::none_of(chosen.begin(), chosen.end(),
      [&cell](const SurfaceCell& other) {
        return cell.IsFlat == other.IsFlat && (!cell.IsFlat || !NeedsEdges({ cell, other }));
      });
    constexpr std::size_t enough = 3;
    if (isNew && chosen.size() < enough)
    {
      chosen.push_back(cell);
    }
  }
  return chosen;
}

template <typename T>
std::vector<T> Joined(const std::vector<std::vector<T>>& lists)
{
  std::vector<T> all;
  for (const std::vector<T>& list : lists)
  {
    all.insert(all.end(), list.begin(), list.end());
  }
  return all;
}

/// The arrays of a piece that are handed over, in their order.
template <typename Piece, typename Visit>
void EachArray(Piece& piece, const Visit& visit)
{
  visit(piece.Cells.Shapes);
  visit(piece.Cells.Degrees);
  visit(piece.Cells.Data);
  visit(piece.Cells.Errors);
  visit(piece.Cells.Remainders);
  visit(piece.Complex.Boxes);
  visit(piece.Complex.PointIds);
  visit(piece.Names);
  visit(piece.Certificates);
  visit(piece.Witnesses);
}

std::string Pack(const CertifiedPiece& piece)
{
  Bytes bytes;
  bytes.Add(std::vector<int>{
    piece.Cells.NumComponents, piece.Cells.Rational ? 1 : 0, piece.HasPatches ? 1 : 0 });
  EachArray(piece, [&bytes](const auto& values) { bytes.Add(values); });
  return bytes.Get();
}

CertifiedPiece Unpack(std::string text)
{
  CertifiedPiece piece;
  Bytes bytes(std::move(text));
  std::vector<int> flags;
  bytes.Take(flags);
  piece.Cells.NumComponents = flags[0];
  piece.Cells.Rational = flags[1] != 0;
  piece.HasPatches = flags[2] != 0;
  EachArray(piece, [&bytes](auto& values) { bytes.Take(values); });
  for (std::size_t i = 0; i < piece.Cells.Shapes.size(); ++i)
  {
    piece.Cells.Offsets.push_back(piece.Cells.Offsets.back() +
      static_cast<std::size_t>(NumCellCoefficients(piece.Cells.Shapes[i], piece.Cells.Degrees[i]) *
        piece.Cells.NumPlanes()));
  }
  return piece;
}

/// Appends cells; of polynomial ones among rational ones the weights are 1.
void Append(const BernsteinCells& from, bool hasErrors, bool hasRemainders, BernsteinCells& to)
{
  to.NumComponents = from.NumComponents;
  for (int cell = 0; cell < from.NumCells(); ++cell)
  {
    const auto at = static_cast<std::size_t>(cell);
    const std::size_t size = from.Offsets[at + 1] - from.Offsets[at];
    double* block = to.Block(to.Add(from.Shapes[at], from.Degrees[at]));
    std::copy_n(from.Block(cell), size, block);
    if (to.Rational && !from.Rational)
    {
      std::fill_n(block + size, size / static_cast<std::size_t>(from.NumComponents), 1.0);
    }
    if (hasErrors)
    {
      to.Errors.push_back(from.Errors.empty() ? 0.0 : from.Errors[at]);
    }
    if (hasRemainders)
    {
      const std::size_t first = to.Remainders.size();
      to.Remainders.resize(to.Data.size());
      if (!from.Remainders.empty())
      {
        std::copy_n(from.Remainders.begin() + static_cast<std::ptrdiff_t>(from.Offsets[at]), size,
          to.Remainders.begin() + static_cast<std::ptrdiff_t>(first));
      }
    }
  }
}
}

std::vector<bool> FindPlanesOfPieces(
  const BernsteinCells& cells, const std::vector<std::int64_t>& patches)
{
  const std::vector<SurfaceCell> own = SurfaceCellsOf(cells, patches);
  if (!NeedsEdges(Joined(Processes::Exchange(Representatives(own)))))
  {
    return FindPlanes(own, {}); // which needs none of its own either
  }
  const auto surfaces = Processes::Exchange(own);
  auto edges = Processes::Exchange(SurfaceEdgesOf(cells));
  std::size_t before = 0; // surface cells of other processes
  std::size_t first = 0;  // of this one
  for (std::size_t process = 0; process < surfaces.size(); ++process)
  {
    first = static_cast<int>(process) == Processes::Own() ? before : first;
    for (SurfaceEdge& edge : edges[process])
    {
      edge.Surface += static_cast<int>(before);
    }
    before += surfaces[process].size();
  }
  const std::vector<bool> found = FindPlanes(Joined(surfaces), Joined(edges));
  const auto begin = found.begin() + static_cast<std::ptrdiff_t>(first);
  return { begin, begin + static_cast<std::ptrdiff_t>(own.size()) };
}

Result<CertifiedPiece> CollectPieces(const CertifiedPiece& piece)
{
  std::vector<CertifiedPiece> pieces;
  std::size_t count = 0;
  for (std::string& bytes : Processes::Collect(Pack(piece)))
  {
    pieces.push_back(Unpack(std::move(bytes)));
    bytes.clear();
    count += pieces.back().Names.size();
  }
  if (count > static_cast<std::size_t>(std::numeric_limits<int>::max()))
  {
    return { ErrorCode::TooLarge,
      std::to_string(count) +
        " cells are too many for one process, which proves injectivity; turn Injectivity off" };
  }
  const auto any = [&pieces](auto has) { return std::any_of(pieces.begin(), pieces.end(), has); };
  const auto all = [&pieces](auto has)
  {
    return std::all_of(
      pieces.begin(), pieces.end(), [&](const auto& p) { return p.Names.empty() || has(p); });
  };
  using Piece = CertifiedPiece;
  const bool hasErrors = any([](const Piece& p) { return !p.Cells.Errors.empty(); });
  const bool hasRemainders = any([](const Piece& p) { return !p.Cells.Remainders.empty(); });
  const bool hasBoxes = all([](const Piece& p) { return !p.Complex.Boxes.empty(); });
  const bool hasIds = all([](const Piece& p) { return !p.Complex.PointIds.empty(); });
  CertifiedPiece joined;
  joined.HasPatches = all([](const Piece& p) { return p.HasPatches; });
  joined.Cells.Rational = any([](const Piece& p) { return p.Cells.Rational; });
  std::map<std::pair<int, int>, int> numbers; // blocks may use the same ids
  for (const CertifiedPiece& one : pieces)
  {
    const int firstCell = joined.Cells.NumCells();
    if (one.Names.empty())
    {
      continue;
    }
    Append(one.Cells, hasErrors, hasRemainders, joined.Cells);
    for (const CellName& name : one.Names)
    {
      joined.Names.push_back(name);
      if (joined.HasPatches)
      {
        joined.Complex.Patches.push_back(
          numbers.emplace(std::pair(name.Block, name.Patch), static_cast<int>(numbers.size()))
            .first->second);
      }
    }
    const auto append = [](const auto& from, auto& to)
    { to.insert(to.end(), from.begin(), from.end()); };
    append(hasBoxes ? one.Complex.Boxes : std::vector<ParametricBox<3>>(), joined.Complex.Boxes);
    append(hasIds ? one.Complex.PointIds : std::vector<std::int64_t>(), joined.Complex.PointIds);
    const auto firstWitness = static_cast<std::int32_t>(joined.Witnesses.size());
    for (CellCertificate certificate : one.Certificates)
    {
      certificate.Witness += certificate.Witness < 0 ? 0 : firstWitness;
      joined.Certificates.push_back(certificate);
    }
    for (JacobianWitness witness : one.Witnesses)
    {
      witness.Cell += firstCell;
      joined.Witnesses.push_back(witness);
    }
  }
  return joined;
}
}
