// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "DyadicKnots.h"
#include "RefinementTree.h"

namespace knotwork
{
/// The functions of one level's tensor-product basis that meet Omega^level.
template <int Dim>
struct HierarchyLevel
{
  FunctionMap<Dim> Functions;
  /// Of every function: its id in the space when active, else Partial or Covered.
  std::vector<int> Ids;

  /// The support is not inside Omega^level: the function is not chosen, what the spline does there
  /// follows from the coarser level.
  static constexpr int Partial = -1;
  /// The support is inside Omega^(level + 1): finer functions replace it.
  static constexpr int Covered = -2;
};

template <int Dim>
struct Hierarchy
{
  std::vector<HierarchyLevel<Dim>> Levels;
  int NumFunctions = 0;
};

/// A cell of a hierarchical mesh and its element, or -1 when it is refined.
template <int Dim>
struct HierarchyCell
{
  LevelIndex<Dim> Index{};
  int Element = -1;
};
/// All cells by level.
template <int Dim>
using HierarchyCells = std::vector<std::vector<HierarchyCell<Dim>>>;

/// One DyadicKnots a direction.
template <int Dim>
std::vector<DyadicKnots> MakeDyadicKnots(const std::array<KnotVector, Dim>& knots);

/// Kraft's selection by counting the cells and the refined cells on every function.
/// @source  Kraft 1997; Giannelli, Juettler, Speleers, CAGD 29 (2012) 485-498.
template <int Dim>
Hierarchy<Dim> SelectFunctions(
  const std::vector<DyadicKnots>& knots, const HierarchyCells<Dim>& cells);

/// The space of a tree. @return TooLarge.
template <int Dim>
Result<SplineSpacePtr<Dim>> MakeSpaceOfTree(
  const std::array<KnotVector, Dim>& knots, const RefinementTree<Dim>& tree);

/// Values that depend on a one-dimensional index, kept as long as no other index takes their place.
template <class Value>
class IndexMemo
{
public:
  template <class Make>
  const Value& Get(std::int64_t index, Make&& make)
  {
    Entry& entry = this->Entries[static_cast<std::size_t>(index) % Size];
    if (entry.Index != index)
    {
      entry.Data = make(index);
      entry.Index = index;
    }
    return entry.Data;
  }

private:
  static constexpr std::size_t Size = 512;
  struct Entry
  {
    std::int64_t Index = -1;
    Value Data{};
  };
  std::vector<Entry> Entries = std::vector<Entry>(Size);
};

/// Parents and two-scale coefficients of the functions of one level.
template <int Dim>
class ParentStencil
{
public:
  /// @param level  of the children, >= 1.
  ParentStencil(const std::vector<DyadicKnots>& knots, int level) : Knots(knots), Level(level) {}

  /// Parents of a function that meets Omega^level.
  /// @param parents  functions of the level before. Numbers and Weights are set.
  void Find(const FunctionMap<Dim>& parents, const LevelIndex<Dim>& child);

  std::vector<int> Numbers;
  std::vector<double> Weights;

private:
  const std::vector<DyadicKnots>& Knots;
  int Level;
  std::array<IndexMemo<DyadicKnots::TwoScaleRow>, Dim> Memo;
};
}
