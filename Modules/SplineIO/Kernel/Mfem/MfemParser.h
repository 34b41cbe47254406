// SPDX-License-Identifier: BSD-3-Clause
// Parts of the reader of MFEM meshes.
#pragma once
#include "MfemElements.h"
#include "MfemLattice.h"
#include "MfemWords.h"

namespace knotwork
{
/// What stands at the head of nodes.
struct MfemNodesHead
{
  MfemCollection Collection;
  int Components = 0;
  bool ByNodes = false; ///< all x, then all y, ...
};

/// Reads from "FiniteElementSpace" on.
MfemNodesHead ReadNodesHead(MfemWords& words, int dimension);

/// Reads so many points of three coordinates, those that the file does not have are 0.
PointMatrix ReadNodes(MfemWords& words, const MfemNodesHead& head, std::int64_t count);

/// Reads what stands behind the vertices of a NURBS mesh, into mesh.Splines.
/// @param edges  by vertices, in the order of the file.
/// @param knots  which knot vector each edge has, from its first to its second vertex.
void ReadNurbs(MfemWords& words, const std::vector<std::array<int, 2>>& edges,
  const std::vector<int>& knots, MfemMesh& mesh);
}
