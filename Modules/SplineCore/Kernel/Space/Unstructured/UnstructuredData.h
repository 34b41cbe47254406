// SPDX-License-Identifier: BSD-3-Clause
// What a space on an unstructured mesh is made from, private to the kernel.
#pragma once
#include "CellMesh.h"
#include "KnotWindows.h"

namespace knotwork
{
template <int Dim>
struct UnstructuredData
{
  CellMesh<Dim> Mesh;
  MeshTopology<Dim> Topology;
  typename MeshTopology<Dim>::EdgeSheets Sheets;
  int Degree = 1;
  /// Order of continuity across every side of every cell; -1 on the boundary.
  std::vector<signed char> Continuity;
  /// Knot interval of every sheet; empty: all 1.
  std::vector<double> Lengths;

  double Length(int cell, int direction) const
  {
    return this->Lengths.empty()
      ? 1.0
      : this->Lengths[static_cast<std::size_t>(
          this->Sheets.Of[static_cast<std::size_t>(cell * Dim + direction)])];
  }
  signed char& ContinuityOf(int cell, int side)
  {
    return this
      ->Continuity[static_cast<std::size_t>(cell) * 2 * Dim + static_cast<std::size_t>(side)];
  }
  signed char ContinuityOf(int cell, int side) const
  {
    return this
      ->Continuity[static_cast<std::size_t>(cell) * 2 * Dim + static_cast<std::size_t>(side)];
  }
  /// Of the knot at a side; that of an end on the boundary.
  int Multiplicity(int cell, int side) const
  {
    const int r = this->ContinuityOf(cell, side);
    return r < 0 ? this->Degree : this->Degree - r;
  }
  /// Lowers the continuity across an inner facet, seen from both cells. @return whether it was
  /// higher.
  bool Lower(int cell, int side, int continuity)
  {
    if (this->ContinuityOf(cell, side) <= continuity)
    {
      return false;
    }
    this->ContinuityOf(cell, side) = static_cast<signed char>(continuity);
    this->ContinuityOf(this->Topology.Neighbour(cell, side),
      this->Topology.Crossing(cell, side).Side) = static_cast<signed char>(continuity);
    return true;
  }
};

/// Adds the windows of all cells, and finishes them. @return their numbers, Dim a cell.
template <int Dim>
std::vector<int> FindWindows(const UnstructuredData<Dim>& data, KnotWindows& windows);
}
