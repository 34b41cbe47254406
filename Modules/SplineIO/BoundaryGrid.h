// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineGrid/SplineModel.h>
#include <knotwork/SplineIO/SplineFile.h>

/// The boundary curves of surfaces (g2 class 210) as a spline grid: a patch a spline, in the order
/// of the file, with the cell arrays `FaceId` (PatchId of the surface), `LoopId`, `CurveId` (place
/// in the loop), `InParameterPlane` (1: the curve is (u, v, 0); 0: in space), `PreferParameter` and
/// `LoopTolerance`. Nothing is computed: what is read is written again.
namespace knotwork
{
/// No cells when no surface is bounded.
Status EncodeBoundaries(const SplineFile& file, vtkUnstructuredGrid* output);

/// Sets file.Bounded. Curves of surfaces that are not there are left out (selection).
/// @return failures of DecodeSplineModel; InvalidTopology for cell arrays that are missing or of
/// which the loops and curves are not numbered without gaps; DimensionMismatch for other patches
/// than curves.
Status DecodeBoundaries(vtkDataObject* grid, SplineFile& file);
}
