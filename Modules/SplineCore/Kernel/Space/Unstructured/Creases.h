// SPDX-License-Identifier: BSD-3-Clause
// Continuities by policy, and what repairs them, private to the kernel.
#pragma once
#include "UnstructuredBuild.h"
#include "UnstructuredSpace.h"

namespace knotwork
{
/// @return InvalidParameter for a feature that is no inner facet.
template <int Dim>
Status CheckFeatures(const MeshTopology<Dim>& topology, const std::vector<CellSide>& features);

/// Sets the continuities of a space by a policy, and lowers them where they have no basis.
template <int Dim>
class Creases
{
public:
  /// @param data  with everything but continuities, which are set.
  Creases(UnstructuredData<Dim>& data, const std::vector<CellSide>& features, CreasePolicy policy);

  CreasePolicy Policy() const { return this->Taken; }
  /// Lowers continuities near the places. @return false when there is nothing left to lower.
  bool Repair(const std::vector<Inadmissible>& places);
  std::int64_t NumCreased() const;
  /// C^0 across facets and all their opposites. @return how many were smoother.
  std::int64_t CreaseFully(const std::vector<CellSide>& facets);

private:
  using Topology = MeshTopology<Dim>;
  static constexpr int NumSides = 2 * Dim;
  std::size_t Slot(int cell, int side) const
  {
    return static_cast<std::size_t>(cell) * NumSides + static_cast<std::size_t>(side);
  }
  bool Mark(std::vector<char>& marks, int cell, int side) const;
  template <class Visit>
  void ForOpposites(int cell, int side, Visit&& visit) const;
  std::vector<CellSide> Saturate(std::vector<char>& marks, std::vector<CellSide> facets) const;
  void FindSeeds(const std::vector<CellSide>& features);
  void AddVertexSeeds();
  void LayTracks();
  void Grade();
  void GradeFrom(const CellSide& facet, int continuity);
  bool AreCrosswise(const CellSide& one, const CellSide& other) const;
  bool AgreeOnBoundary();
  std::int64_t CreaseStrip(int cell);
  CellSide LowestOfStrip(int cell) const;
  template <class Accept>
  bool HasOpposite(int cell, int side, Accept&& accept) const;
  std::int64_t Prolong(CellSide end);
  template <class Accept>
  std::vector<CellSide> Nearest(int cell, Accept&& accept) const;

  UnstructuredData<Dim>& Data;
  CreasePolicy Taken;
  std::vector<CellSide> Seeds; ///< of distance 0
  std::vector<char> IsSeed;    ///< a side of a cell, seen from both
  std::vector<char> InComplex; ///< the seeds and all their opposites
  std::vector<CellSide> Complex;
};
}
