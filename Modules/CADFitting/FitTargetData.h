// SPDX-License-Identifier: BSD-3-Clause
// Targets from datasets.
#pragma once
#include "vtkKnotworkCADFittingModule.h" // for export macro
#include <knotwork/CADFitting/FitTarget.h>
#include <knotwork/MeshParameterization/TriangleMesh.h>

#include <string>
#include <vector>

class vtkDataObject;
class vtkImplicitFunction;

namespace knotwork
{
struct FitTargetOptions
{
  double SharpAngle = 40.0;
  double WeakAngle = 20.0;
  double CornerAngle = 60.0;
  /// Faces of a model that count as one: numbers joined by commas, groups by semicolons.
  std::string FaceGroups;
  /// When not null: gets triangles of the target, those of CAD faces within a thousandth of its
  /// size; none of curves.
  TriangleMesh* Triangles = nullptr;
  ProgressCallback Progress; ///< of the triangulation
};

/// Whole numbers from 0 on, joined by commas.
/// @param below  the largest is less. @param remedy  follows a word that is none, in the message.
/// @return InvalidParameter.
Result<std::vector<int>> ParseNumbers(
  const std::string& text, int below, const std::string& remedy);

/// Triangles (polygons are divided), or a spline grid of one dimension: curves, surfaces, trimmed
/// faces with the curves that they carry, volumes, whose boundary is the target.
/// @return EmptyInput for a dataset without faces; InvalidParameter for groups that are no numbers
/// of faces; Aborted; the errors of the decoders and of the targets.
VTKKNOTWORKCADFITTING_EXPORT Result<FitTargetPtr> DecodeFitTarget(
  vtkDataObject* data, const FitTargetOptions& options, int threads);

/// @param box  bounds as VTK orders them, in which the surface is sampled.
Result<FitTargetPtr> AdaptImplicitFunction(vtkImplicitFunction* function, const double* box);
}
