// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "TriangleMesh.h"

#include <Eigen/Core>

namespace knotwork
{
/// Implicit steps of heat flow, (M + time L) u = M u0 each; without a flow across the boundary.
/// @param held    one a point: keeps its value. One at least when time is infinite.
/// @param time    square of a length; infinity: the harmonic function of the held values.
/// @param steps   one where time is infinite.
/// @param values  u0, then u.
/// @return SingularSystem.
Status FlowHeat(const DiscMesh& mesh, const std::vector<char>& held, double time, int steps,
  Eigen::VectorXd& values);
}
