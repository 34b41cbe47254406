// SPDX-License-Identifier: BSD-3-Clause
// Private to the kernel.
#pragma once
#include <knotwork/MeshParameterization/TriangleMesh.h>

namespace knotwork
{
/// @return EmptyInput: no points; NonFiniteInput with the point; InvalidTopology: a corner that is
/// no point.
Status CheckScan(const TriangleMesh& scan);
}
