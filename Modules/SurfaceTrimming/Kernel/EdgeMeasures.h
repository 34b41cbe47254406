// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/TrimmedModel.h>

#include <vector>

/// Private to ModelRegions: how faces meet at their edges.
namespace knotwork
{
/// At five samples a span.
struct EdgeMeasure
{
  std::vector<int> Faces;   ///< that use the edge; of a seam the same one twice
  double Gap = 0.0;         ///< largest distance of the curve from the images of its pcurves
  double MaxAngle = 0.0;    ///< degrees, between the normals of two faces
  double MedianAngle = 0.0; ///< the same
};

/// One an edge. Normals are those of faces, not of surfaces; where a face has none, as at a pole,
/// there is no angle.
/// @pre TrimmedModel::Check is Ok; the uses of an edge have one space.
/// @complexity O(n) for n spans of all uses.
std::vector<EdgeMeasure> MeasureEdges(const TrimmedModel& model, int threads);
}
