// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/TrimmedModel.h>

#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>

namespace knotwork
{
struct CADShapes
{
  TopoDS_Shape Shape;             ///< a shell, a solid, or a compound of them
  std::vector<TopoDS_Face> Faces; ///< of the model's faces, as they lie in Shape
  bool HasPoles = false;          ///< a loop runs through a pole
  bool HasPlanesOnly = true;      ///< whose edges need no pcurves
  bool HasCurvedTypes = false;    ///< cylinders, spheres, cones or tori as such
  double MaxGap = 0.0; ///< largest distance of a curve or vertex to the image of a pcurve
};

/// Where a loop with poles begins. STEP files have no edges at poles, and readers of OpenCASCADE
/// take the sides of a seam for each other, or a face for its complement, by what comes first.
enum class LoopBegin
{
  LowerPole, ///< that of the lesser parameter
  UpperPole
};

/// The model as OpenCASCADE's topology. May throw OpenCASCADE's exceptions.
/// @param sewTolerance  as CADWriteParams::SewTolerance.
/// @return failures as of WriteCAD.
Result<CADShapes> MakeShapes(
  const TrimmedModel& model, double sewTolerance, LoopBegin begin = LoopBegin::LowerPole);
}
