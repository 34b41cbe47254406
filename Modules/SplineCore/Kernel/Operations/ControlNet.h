// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/SplineSpace.h>

namespace knotwork
{
/// A line of the control net, first function before the second along the direction.
struct NetEdge
{
  int Begin = 0; ///< function id
  int End = 0;
  int Direction = 0;
};

/// Lines of the control net of a space. Tensor: neighbours in the grid of control points.
/// Hierarchical: functions of the same level with neighbouring indices, both active, so every level
/// has a net of its own. LocallyRefined: functions whose knots differ by one step along one
/// direction and are equal along the other. Bezier: the nets of the elements, every line once.
/// Ordered by the first function, then the direction (Bezier: by element).
/// @complexity O(functions log functions).
template <int Dim>
std::vector<NetEdge> ControlNetEdges(const SplineSpace<Dim>& space);
}
