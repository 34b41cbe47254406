// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "CellGluing.h"

#include <knotwork/SplineCore/DisjointSets.h>

/// Private to the injectivity proof: what the steps of the gluing work on.
namespace knotwork
{
/// Merges items with equal keys, in order.
template <typename Key>
class Merger
{
public:
  explicit Merger(DisjointSets& sets) : Sets(sets) {}
  void Add(const Key& key, int item)
  {
    const auto [at, isNew] = this->First.try_emplace(key, item);
    if (!isNew)
    {
      this->Sets.Unite(at->second, item);
    }
  }

private:
  DisjointSets& Sets;
  std::map<Key, int> First;
};

/// A way to look at a side: an origin corner and the neighbours that i and j run to.
struct Reframe
{
  std::vector<int> Coefficients;
  std::array<int, 4> Corners{};
  std::array<int, 2> Degree{};
  int Parity = 1;
};

struct SideOfCell
{
  int Cell;
  int Number;
};

/// Everything about one run of the gluing.
class GluingState
{
public:
  GluingState(const BernsteinCells& cells, const CellComplex& complex,
    const std::vector<int>& signs, const InjectivityParams& params);

  CellShape Shape(int c) const { return this->Cells.Shapes[static_cast<std::size_t>(c)]; }
  const CellDegree& Degree(int c) const { return this->Cells.Degrees[static_cast<std::size_t>(c)]; }
  int Patch(int c) const
  {
    return this->Complex.Patches.empty() ? c : this->Complex.Patches[static_cast<std::size_t>(c)];
  }
  int CornerId(int c, int corner) const { return c * 8 + corner; }
  int EdgeId(int c, int a, int b) const;
  /// Whether a cell is an element with a box of its patch's parameters.
  bool HasBox(int c) const;
  std::array<double, 3> BoxCorner(int c, int corner) const;
  std::int64_t PointId(int c, int coefficient) const
  {
    return this->Complex.PointIds[this->Cells.Offsets[static_cast<std::size_t>(c)] /
        static_cast<std::size_t>(this->Cells.NumPlanes()) +
      static_cast<std::size_t>(coefficient)];
  }
  /// Euclidean.
  std::array<double, 3> Position(int c, int coefficient) const;
  double LargestCoordinate(int c) const;
  const CellLattice& Lattice(CellShape shape, const CellDegree& degree);
  const std::vector<Reframe>& Reframes(CellShape shape, const CellDegree& degree);
  /// Takes out of Open what is glued.
  void KeepUnglued(const std::vector<bool>& glued);
  int Sign(int c) const { return this->Signs[static_cast<std::size_t>(c)]; }
  /// Keeps the first pair of sides with both cells on one side of them.
  void SetFolded(SideOfCell a, SideOfCell b);
  /// Whether control points of a cell are one point.
  bool IsPoint(int c, const std::vector<int>& coefficients, double tolerance) const;
  void JoinCorners(int a, int cornerA, int b, int cornerB);

  const BernsteinCells& Cells;
  const CellComplex& Complex;
  const std::vector<int>& Signs;
  const InjectivityParams& Params;
  DisjointSets Corners;
  DisjointSets Edges;
  std::vector<std::array<int, 2>> EdgeCorners[NumCellShapes];
  std::vector<SideOfCell> Open; ///< that are not glued
  std::vector<SideOfCell>
    Uneven; ///< sides that dropped out, and those that cover each other in parts
  int Dim = 2;
  CellGluing Out;

private:
  std::map<std::pair<int, CellDegree>, std::vector<Reframe>> ReframeCache;
  CellLatticeTable Lattices;
};
}
