// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <vector>

namespace knotwork
{
struct GraphEdge
{
  int A = 0;
  int B = 0;
  double Weight = 0.0; ///< of a cut between the two, not negative
};

/// Divides nodes in two (0 and 1) so that the sum of the weights of cut edges and of the costs of
/// all nodes becomes least.
/// @param costs  of side 1 minus side 0, one a node; +-infinity holds a node.
/// @return the side of each node; of several least cuts the one with the fewest nodes on side 0.
///         Weights are rounded to 2^-30 of their sum: the result does not depend on the machine.
/// @complexity pseudo-polynomial at worst, near O(n) on meshes with costs at most nodes.
/// @source Y. Boykov, V. Kolmogorov, IEEE TPAMI 26 (2004) 1124-1137 (maximum flow).
std::vector<char> CutGraph(const std::vector<double>& costs, const std::vector<GraphEdge>& edges);
}
