// SPDX-License-Identifier: BSD-3-Clause
// QuadriFlow in a process of blender, private to the module.
#pragma once
#include <knotwork/SplineGrid/WorkerProcess.h>
#include <knotwork/SurfaceRemeshing/QuadRemesh.h>

namespace knotwork
{
/// Quadrilaterals of triangles by QuadriFlow in the program blender of PATH. What it makes is not
/// checked.
/// @param threads  of blender; 0: all cores.
/// @param goOn  false ends it.
/// @return LibraryError: blender or our script for it is missing, or cannot be run; TooLarge:
/// it was late, or took too much memory; NotConverged with the reason: it crashed, or wrote nothing
/// that can be read; Aborted.
Result<PolygonMesh> RunQuadriFlow(const TriangleMesh& mesh, const QuadRequest& request, int threads,
  const WorkerLimits& limits, const std::function<bool()>& goOn);
}
