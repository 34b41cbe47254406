// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "ChartMesh.h"
#include <knotwork/SplineCore/KnotVector.h>

namespace knotwork
{
/// Points of a chart's triangles, as dense as a net of knot spans asks for. Rows: Weighted inside
/// triangles (a quadrature rule of the chart's area in the plane), more of them on boundary edges
/// (lengths times the size of the spans there), then points that are looked at only: all corners
/// and points of edges.
struct ChartSamples
{
  PointMatrix Parameters;  ///< n x 2
  PointMatrix Points;      ///< n x 3
  Eigen::VectorXd Weights; ///< n; 0 from NumWeighted on
  Eigen::Index NumInside = 0;
  Eigen::Index NumWeighted = 0;
};

/// Net of clamped knot vectors over a chart.
using NetKnots = std::array<KnotVector, 2>;

/// Smallest element of a net, over both directions.
double SmallestSpan(const NetKnots& knots);

/// Triangles are halved at their longest edges until they are small against the spans they lie in;
/// each piece gives its centre.
/// @param boundary  pairs of points.
ChartSamples SampleChart(const ChartMesh& chart, const std::vector<std::array<int, 2>>& boundary,
  const NetKnots& knots, int threads);

/// Edges that one triangle uses, along the triangle.
std::vector<std::array<int, 2>> BoundaryEdges(const std::vector<std::array<int, 3>>& triangles);
}
