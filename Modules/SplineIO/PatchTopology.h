// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "vtkKnotworkSplineIOModule.h" // for export macro
#include <knotwork/SplineIO/SplineFile.h>

class vtkDataObject;

/// The multi-patch topology that a file states, as field data of its spline grid:
///   PatchInterfaces  10 integers a row: PatchId and side, PatchId and side (from 1 on), three
///                    directions, three senses, as in PatchDirections;
///   PatchBoundaries  2 integers a row: PatchId and side.
namespace knotwork
{
/// Adds the arrays to a dataset; nothing when the file states no topology.
VTKKNOTWORKSPLINEIO_EXPORT void SetPatchTopology(const SplineFile& file, vtkDataObject* data);

/// Fills the multi-patches of a file whose splines and ids are set: one of every parametric
/// dimension that has several patches or topology.
/// @return a warning when rows refer to patches or sides that are not there (they are left out),
/// else nothing.
VTKKNOTWORKSPLINEIO_EXPORT std::string GetPatchTopology(vtkDataObject* data, SplineFile& file);

/// Copies the arrays, for a grid that is decoded and encoded again.
VTKKNOTWORKSPLINEIO_EXPORT void PassPatchTopology(vtkDataObject* from, vtkDataObject* to);
}
