// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "vtkKnotworkSurfaceTrimmingModule.h" // for export macro
#include <knotwork/SplineCore/TrimmedModel.h>

#include <vector>

class vtkDataObject;
class vtkUnstructuredGrid;

/// Trimmed models as two spline grids: filters that move points, append or select whole faces work
/// on them, and any spline grid of surfaces is a model whose faces are not trimmed.
namespace knotwork
{
/// Surfaces: a patch a face, `PatchId` = `FaceId` its number; cell arrays `FaceReversed`, `Body`,
/// `TrimmingCurves` (their number), `ModelId`, and where a face has one `Color` (red, green, blue
/// as bytes, the fourth is 0 for faces without one) and `Name`; where one is analytic `SurfaceType`
/// (the numbers of SurfaceType).
/// Curves: a patch a use of an edge, its geometry the edge's curve in space, its image in the
/// parameter plane the point array `UV` (coefficients in the same space); cell arrays `FaceId`,
/// `LoopId` (0 is the outer one), `CurveId` (place in the loop), `EdgeId`, `BeginVertex`,
/// `EndVertex`, `Reversed`, `ModelId`. No cells when no face is trimmed. The surfaces carry the
/// curves as field data too, so that they alone are the model.
/// @return failures of TrimmedModel::Check.
VTKKNOTWORKSURFACETRIMMING_EXPORT Status EncodeTrimmedModel(
  const TrimmedModel& model, vtkUnstructuredGrid* surfaces, vtkUnstructuredGrid* curves);

/// The model of two spline grids, or collections of them. Faces stand in the order of the cells;
/// edges and vertices are numbered anew in the order of their first use. Curves of faces that are
/// not there (selection) are left out; curves that are missing are an error. Copies of a model, and
/// several models in one grid, are told apart by `ModelId` and the order they occur in; appended
/// ones that lost their knots keep their map, with knots of multiplicity degree.
/// @param curves    null: those that the surfaces carry, moved with them by any affine map; without
/// them faces are the whole surfaces, with a warning if they were trimmed.
/// @param warnings  takes what a user should know; may be null.
/// @return failures of DecodeSplineModel and TrimmedModel::Check; EmptyInput without surfaces;
/// DimensionMismatch for patches of other dimensions or kinds; InvalidTopology for cell arrays that
/// are missing, differ within a patch or contradict each other (with patch and array), and for
/// surfaces that were bent or refined since they got the curves that they carry.
VTKKNOTWORKSURFACETRIMMING_EXPORT Result<TrimmedModel> DecodeTrimmedModel(
  vtkDataObject* surfaces, vtkDataObject* curves, std::vector<std::string>* warnings = nullptr);
}
