// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/CADFitting/RigidAlignment.h>
#include <knotwork/SurfaceTrimming/SurfaceRecognition.h>

namespace knotwork
{
/// Numbers of regions that a coordinate system is made of.
struct DatumParams
{
  int Plane = -1;         ///< a plane: z is its normal, and it lies at z = 0; -1: none
  int Axis = -1;          ///< a plane, cylinder, cone or torus: see AlignToDatums; -1: none
  std::vector<int> Point; ///< at most three regions: what fixes the origin first
  bool Inward = false;    ///< normals of planes count as they point into the part
};

struct DatumAlignment
{
  RigidMotion Motion;  ///< to the coordinate system
  int FreeMotions = 0; ///< of the six, that the datums say nothing about: they are as they were
};

/// The coordinate system of datums (3-2-1).
///
/// z is the outward normal of Plane, or without one the axis of Axis. x is across z: the outward
/// normal of Axis where that is a plane, its axis where it is turned; where that axis runs along z,
/// from the origin to it. The origin lies on what Point tells: the centre of a sphere or torus, the
/// axis of a cylinder or cone, planes; then, as far as it is free, on Plane, then on Axis; then it
/// is the nearest to the scan's middle. Axes point to where their largest coordinate is positive.
/// @return InvalidParameter naming the region: there is none of that number, it has another type,
/// or its direction is that of Plane, or it is of Point and fixes nothing that those before it
/// leave free; neither Plane nor Axis.
Result<DatumAlignment> AlignToDatums(const TriangleMesh& mesh,
  const std::vector<RecognizedRegion>& regions, const DatumParams& params);
}
