// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "CutMesh.h"
#include "PlaneLoops.h"

#include <limits>

namespace knotwork
{
/// What is known of a chart's map.
struct ChartMap
{
  bool Good = false;
  bool Exists = false;
  EdgeCrossing Crossing; ///< of a map without flips
  double Stretch =
    std::numeric_limits<double>::infinity(); ///< infinite without a map, or when it flips
  PointMatrix UV;
  FlattenMethod Used = FlattenMethod::Hlle;
  std::string Reason; ///< why the method asked for was not used
  int RejectedEigenvectors = 0;
};

/// Lays a chart out by the method asked for and, where that fails, flips, crosses or stretches too
/// much, by the injective one. A surface that is no disc gets no map.
ChartMap MapChart(const DiscMesh& mesh, const FlattenParams& params, double maxStretch);

/// Gives triangles of the cut mesh their places in a map, which is moved from: its UV is empty
/// then, its Crossing names points of the cut mesh.
void PlaceTriangles(const ChartPart& part, ChartMap& map, CutMesh& mesh);
}
