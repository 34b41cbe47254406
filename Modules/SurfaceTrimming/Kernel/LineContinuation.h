// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "BackMap.h"
#include "ChartSamples.h"

namespace knotwork
{
/// The surface of BackMapMethod::ContinuedLines on a net.
///
/// Greville points of the net that lie in the chart get its points by linear interpolation in the
/// triangles. From there the known part grows, layer by layer: a grid point beside known ones takes
/// the polynomial through the last known ones of its row or column, the mean over the directions;
/// points with polynomials of full degree come first. The spline interpolates the grid. What is
/// continued from layer to layer grows without bound: it folds outside of the chart, and on fine
/// nets spoils the surface inside along the boundary. That is in the method.
/// @source  after Ruiz, Mejia, Cadavid, Triangular mesh parameterization with trimmed surfaces,
/// 2015, whose own way is SurfaceContinuation.h.
/// @return SingularSystem when no grid point lies in the chart, or when values overflow.
Result<Spline<2>> ContinueLines(const ChartMesh& chart, const NetKnots& knots);
}
