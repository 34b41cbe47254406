// SPDX-License-Identifier: BSD-3-Clause
// Boundaries of splines from datasets, private to the module.
#pragma once
#include <knotwork/TetMeshing/BoundaryMesh.h>

class vtkDataObject;

namespace knotwork
{
struct SplineModel;

struct BoundaryOptions
{
  double Tolerance = 1e-3; ///< chordal, share of the size or length
  bool Relative = true;
  int Threads = 0;
  ProgressCallback Progress;
};

/// Whether a dataset has Bezier cells of two or three dimensions.
bool HasSplineCells(vtkDataObject* data);

/// Triangles on the boundary of volumes, or on surfaces, trimmed or not. Patches have the numbers
/// of PatchId; faces of trimmed surfaces are their numbers.
/// @param model  of the data.
/// @return DimensionMismatch for patches of several dimensions, and curves; the errors of the
/// tessellations.
Result<BoundaryMesh> TriangulateBoundary(
  vtkDataObject* data, const SplineModel& model, const BoundaryOptions& options);
}
