// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineGrid/SplineModel.h>
#include <knotwork/SurfaceFeatures/ContourCurves.h>

#include <string>
#include <vector>

class vtkPolyData;
class vtkTable;
class vtkUnstructuredGrid;

namespace knotwork
{
/// Which function of a grid has contours, and which ones.
struct ContourChoice
{
  std::string Field;             ///< empty: the coordinates
  int Component = -1;            ///< -1: the last
  std::array<double, 2> Range{}; ///< of the levels when there are none; empty: of the values
  bool Curves = false;
  bool ProjectToLevel = false; ///< z is the level
  ContourParams Params;        ///< Levels, tolerances and limits
};

/// Contours of one patch.
struct PatchContours
{
  int PatchId = 0;
  int Component = 2;  ///< of Form: the function
  BezierForm<2> Form; ///< x, y, z and, last, the field when there is one
  ContourSet Contours;
  std::vector<ContourCurve> Curves; ///< empty unless wanted
};

/// Least and largest values at the corners of elements: of x, y, z and the function; without
/// patches infinite, the first above the second.
using ContourRanges = std::array<std::array<double, 2>, 4>;

/// Patches before they are contoured.
struct ContourPatches
{
  std::vector<PatchContours> Patches;
  ContourRanges Ranges;
};

/// @return DimensionMismatch for patches that are no surfaces; InvalidParameter for a field or
/// component that a patch does not have. With the patch.
Result<ContourPatches> PreparePatches(const SplineModel& model, const ContourChoice& choice);

/// Contours of all patches at the same levels with the same tolerance.
/// @param patches  of Ranges follow levels and tolerances that are left open.
/// @return failures of TraceContours, with the patch.
Status TracePatches(const ContourChoice& choice, ContourPatches& patches);

/// Polylines: point arrays `Value`, `ElementId` (of the piece that begins at the point), `UV` (the
/// parameters); cell arrays `Level`, `ComponentId`, `Closed`, `PatchId`, `MaxError`.
Status EncodePolylines(
  const std::vector<PatchContours>& patches, bool projectToLevel, int threads, vtkPolyData* output);

/// Spline curves, a patch a component (`PatchId` is `ComponentId`), with `Level`, `Closed`,
/// `SurfaceId` (the patch they lie on), `MaxError`, and the field `UV` where surfaces have a
/// domain.
Status EncodeCurves(
  const std::vector<PatchContours>& patches, bool projectToLevel, vtkUnstructuredGrid* output);

/// Makes what processes have traced, their polylines, curves and levels, parts of one result:
/// components are counted on, the levels are of all, and the curves stand in the first process.
/// @pre all processes call it.
/// @return failures of DecodeSplineModel and EncodeSplineGrid for the curves.
Status MergeContours(
  int threads, vtkPolyData* polylines, vtkUnstructuredGrid* curves, vtkTable* levels);

/// A row a level: Level, Components, Closed, Points, MaxError, Undecided, Tolerance.
void EncodeLevels(const std::vector<PatchContours>& patches, vtkTable* output);

/// Boxes that stayed undecided as quadrilaterals on the surface, with `Level`, `PatchId`,
/// `ElementId`, `ParametricBounds` (u0, u1, v0, v1).
Status EncodeUndecided(const std::vector<PatchContours>& patches, int threads, vtkPolyData* output);
}
