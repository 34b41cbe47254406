// SPDX-License-Identifier: BSD-3-Clause
#include "SideSeparation.h"

#include "HullsApart.h"
#include "PieceCharts.h"
#include "PieceContacts.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace knotwork
{
namespace
{
/// Halvings of a piece a direction at most.
constexpr int DepthPerDirection = 34;

/// Lattices of sides a and b.
std::array<const CellLattice*, 2> LatticesOf(const SeparationInput& input, int a, int b)
{
  std::array<const CellLattice*, 2> lattices{};
  for (std::size_t k = 0; k < 2; ++k)
  {
    const BoundarySide& side = (*input.Sides)[static_cast<std::size_t>(k == 0 ? a : b)];
    lattices[k] = &input.Lattices->at({ static_cast<int>(side.Frame.Shape), side.Degree });
  }
  return lattices;
}

/// The two sides of one proof and the pieces made of them.
class Prover
{
public:
  Prover(const SeparationInput& input, int a, int b)
    : Measures(input), SideA(a), SideB(b), Lattice(LatticesOf(input, a, b)),
      Contacts(input, a, b, this->Lattice)
  {
    for (int k = 0; k < (a == b ? 1 : 2); ++k)
    {
      const BoundarySide& side = (*input.Sides)[static_cast<std::size_t>(k == 0 ? a : b)];
      this->Pool[k].push_back(this->MakeNode(k,
        MakePiece(this->LatticeOf(k), this->Measures.NumPlanes(), side.Data.data(), side.Error)));
    }
    this->Which[1] = a == b ? 0 : 1;
  }

  SeparationResult Run(std::int64_t maxBoxes)
  {
    SeparationResult result;
    std::vector<std::array<int, 2>> open{ { 0, 0 } };
    const int largestDepth = DepthPerDirection * NumParameters(this->Lattice[0]->Shape);
    while (!open.empty())
    {
      const std::array<int, 2> pair = open.back();
      open.pop_back();
      if (++result.Boxes > maxBoxes)
      {
        result.State = SeparationState::Boxes;
        this->SetPlace(result, pair);
        return result;
      }
      const bool same = this->SideA == this->SideB && pair[0] == pair[1];
      const BoundaryPiece& a = this->NodeOf(0, pair[0]);
      const BoundaryPiece& b = this->NodeOf(1, pair[1]);
      PieceRelation relation;
      if (same)
      {
        relation = this->Contacts.RelateToItself(a.Piece);
      }
      else
      {
        if (!this->BoxesMeet(a, b))
        {
          continue;
        }
        relation = this->Contacts.Relate(a.Piece, b.Piece);
      }
      if (this->IsSeparate(relation, a, b))
      {
        continue;
      }
      const bool tooSmall = std::max(a.Size, b.Size) <=
        64.0 * (a.Hull.Error + b.Hull.Error) + 64.0 * UnitRoundoff * std::max(a.Largest, b.Largest);
      const bool splitA =
        same || relation.Longer == 0 || (relation.Longer < 0 && this->IsFirstToCut(relation, a, b));
      const BoundaryPiece& larger = splitA ? a : b;
      if (tooSmall || larger.Piece.Depth >= largestDepth)
      {
        result.State = SeparationState::Stuck;
        this->SetPlace(result, pair);
        return result;
      }
      if (same)
      {
        const auto halves = this->Split(0, pair[0], -1, true);
        open.push_back({ halves[0], halves[1] });
        open.push_back({ halves[1], halves[1] });
        open.push_back({ halves[0], halves[0] });
      }
      else
      {
        const int k = splitA ? 0 : 1;
        const auto halves = this->Split(k, pair[static_cast<std::size_t>(k)], relation.LongerEdge,
          relation.What == PieceRelation::Edge);
        for (const int half : { halves[1], halves[0] })
        {
          auto next = pair;
          next[static_cast<std::size_t>(k)] = half;
          open.push_back(next);
        }
      }
    }
    return result;
  }

private:
  const BoundaryPiece& NodeOf(int k, int index) const
  {
    return *this->Pool[this->Which[k]][static_cast<std::size_t>(index)];
  }
  const CellLattice& LatticeOf(int k) const { return *this->Lattice[static_cast<std::size_t>(k)]; }

  std::unique_ptr<BoundaryPiece> MakeNode(int k, CellPiece piece) const
  {
    auto node = std::make_unique<BoundaryPiece>();
    node->Piece = std::move(piece);
    this->Measures.Complete(this->LatticeOf(k), *node);
    return node;
  }

  /// Of two pieces the one whose normals turn more, if that is what is in the way, else the larger.
  bool IsFirstToCut(
    const PieceRelation& relation, const BoundaryPiece& a, const BoundaryPiece& b) const
  {
    if (relation.What == PieceRelation::Edge)
    {
      constexpr double muchLarger = 16.0;
      const double turnA = this->Measures.FindTurn(*this->Lattice[0], a).Size;
      const double turnB = this->Measures.FindTurn(*this->Lattice[1], b).Size;
      if (turnA > 2.0 * turnB && b.Size < muchLarger * a.Size)
      {
        return true;
      }
      if (turnB > 2.0 * turnA && a.Size < muchLarger * b.Size)
      {
        return false;
      }
    }
    return a.Size > b.Size || (a.Size == b.Size && a.Piece.Depth <= b.Piece.Depth);
  }

  /// Halves that are there already stay.
  /// @param edge  of the piece that is cut through, or -1.
  /// @param turns  it is the piece's normals that are in the way.
  std::array<int, 2> Split(int k, int index, int edge, bool turns)
  {
    auto& pool = this->Pool[this->Which[k]];
    BoundaryPiece& node = *pool[static_cast<std::size_t>(index)];
    if (node.Children[0] < 0)
    {
      const CellLattice& lattice = this->LatticeOf(k);
      int direction = edge >= 0 ? DirectionOf(lattice, edge)
        : turns                 ? this->Measures.FindTurn(lattice, node).Direction
                                : -1;
      if (direction < 0)
      {
        direction = LongestDirection(lattice, node.Hull);
      }
      auto halves = Bisect(lattice, this->Measures.NumPlanes(), node.Piece, direction);
      for (int h = 0; h < 2; ++h)
      {
        node.Children[h] = static_cast<int>(pool.size());
        pool.push_back(this->MakeNode(k, std::move(halves[static_cast<std::size_t>(h)])));
      }
    }
    return { node.Children[0], node.Children[1] };
  }

  static int DirectionOf(const CellLattice& lattice, int edge)
  {
    const auto ends = SideEdge(lattice.Shape, edge);
    for (std::size_t d = 0; d < lattice.Directions.size(); ++d)
    {
      for (const auto& pair : lattice.Directions[d].CornerPairs)
      {
        if ((pair[0] == ends[0] && pair[1] == ends[1]) ||
          (pair[0] == ends[1] && pair[1] == ends[0]))
        {
          return static_cast<int>(d);
        }
      }
    }
    return 0;
  }

  void SetPlace(SeparationResult& result, const std::array<int, 2>& pair) const
  {
    for (int k = 0; k < 2; ++k)
    {
      const std::size_t at = static_cast<std::size_t>(k);
      const BoundaryPiece& node = this->NodeOf(k, pair[at]);
      const int corners = NumCorners(this->LatticeOf(k).Shape);
      for (std::size_t d = 0; d < 2; ++d)
      {
        double sum = 0.0;
        for (int c = 0; c < corners; ++c)
        {
          sum += node.Piece.Corners[static_cast<std::size_t>(c)][d];
        }
        result.At[at][d] = sum / corners;
      }
    }
  }

  bool BoxesMeet(const BoundaryPiece& a, const BoundaryPiece& b) const
  {
    for (std::size_t d = 0; d < static_cast<std::size_t>(this->Measures.Input.NumComponents); ++d)
    {
      if (a.Hull.Upper[d] < b.Hull.Lower[d] || b.Hull.Upper[d] < a.Hull.Lower[d])
      {
        return false;
      }
    }
    return true;
  }

  bool IsSeparate(
    const PieceRelation& relation, const BoundaryPiece& a, const BoundaryPiece& b) const
  {
    if (!std::isfinite(a.Hull.Error) || !std::isfinite(b.Hull.Error))
    {
      return false;
    }
    switch (relation.What)
    {
      case PieceRelation::None:
        return HullsApart(this->Measures, { this->Lattice[0], &a, 0 }, { this->Lattice[1], &b, 0 });
      case PieceRelation::Corner:
        return ConesApart(this->Measures,
          { { { this->Lattice[0], &a, relation.A }, { this->Lattice[1], &b, relation.B } } });
      case PieceRelation::Same:
        return HasChart(this->Measures, *this->Lattice[0], a);
      case PieceRelation::Edge:
        return HaveChart(this->Measures, this->Lattice, relation, a, b);
      case PieceRelation::Mixed:
        break;
    }
    return false;
  }

  PieceMeasures Measures;
  int SideA;
  int SideB;
  int Which[2] = { 0, 1 };
  std::array<const CellLattice*, 2> Lattice;
  PieceContacts Contacts;
  std::vector<std::unique_ptr<BoundaryPiece>> Pool[2];
};
}

SeparationResult SeparateSides(const SeparationInput& input, int a, int b, std::int64_t maxBoxes)
{
  return Prover(input, a, b).Run(maxBoxes);
}
}
