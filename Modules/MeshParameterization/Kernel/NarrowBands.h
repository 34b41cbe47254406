// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "FeatureEdges.h"

#include <map>

namespace knotwork
{
struct NarrowBandParams
{
  double Width = 0.0;      ///< of a band at most, unit of the points
  double SharpAngle = 0.0; ///< degrees between the two sides
  double BandAngle = 0.0;  ///< degrees from which on an edge may bound a row of triangles
};

struct NarrowBands
{
  std::vector<char> InBand; ///< one a triangle
  /// Angles between the two sides of the bands at their edges, degrees.
  std::map<MeshEdge, double> Turns;
};

/// Rows of triangles between two sides that meet at an angle: chamfers and fillets that are too
/// narrow to be faces. Edges from BandAngle on divide the triangles; parts of them that are no
/// wider than Width (twice the area over the circumference), joined over edges below SharpAngle as
/// long as they stay so narrow, are a band if wider parts beside half of their edges meet at an
/// angle between SharpAngle and 150 degrees. (Edges of plates, where the two sides look away from
/// each other, and steps, where they look the same way, are none.)
/// @param normals  one a triangle.
/// @param marks  edges that divide whatever their angle; bounds of bands are marked.
NarrowBands FindNarrowBands(const SurfaceParts& parts, const std::vector<Eigen::Vector3d>& normals,
  const EdgeAngle& angle, const NarrowBandParams& params, EdgeMarks& marks);
}
