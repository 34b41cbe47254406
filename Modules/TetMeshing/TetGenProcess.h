// SPDX-License-Identifier: BSD-3-Clause
// TetGen in a process of its own, private to the module.
#pragma once
#include <knotwork/SplineGrid/WorkerProcess.h>
#include <knotwork/TetMeshing/SolidMesh.h>

namespace knotwork
{
/// Fills a surface by the program knotwork-tetgen.
/// @param goOn  false ends it.
/// @return the errors of RunMesher.
Result<Tetrahedra> RunTetGen(const TriangleMesh& surface, const TetrahedraParams& params,
  const WorkerLimits& limits, const std::function<bool()>& goOn);
}
