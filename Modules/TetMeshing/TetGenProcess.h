// SPDX-License-Identifier: BSD-3-Clause
// TetGen in a process of its own, private to the module.
#pragma once
#include <knotwork/SplineGrid/WorkerProcess.h>
#include <knotwork/TetMeshing/SolidMesh.h>

namespace knotwork
{
/// Fills a surface by the program knotwork-tetgen. Where it crashes, hangs or refuses, up to three
/// times more with points that are moved by 1e-11 of the diagonal; what it makes has the surface's.
/// @param limits  seconds of all attempts together.
/// @param goOn  false ends it.
/// @return the errors of RunMesher.
Result<Tetrahedra> RunTetGen(const TriangleMesh& surface, const TetrahedraParams& params,
  const WorkerLimits& limits, const std::function<bool()>& goOn);
}
