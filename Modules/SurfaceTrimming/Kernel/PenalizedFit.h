// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "BackMap.h"
#include "ChartSamples.h"
#include <knotwork/SplineCore/BezierForm.h>

namespace knotwork
{
/// Rectangle of a back-map: the box of UV and a margin around it.
ParametricBox<2> BackMapRectangle(const ChartMesh& chart, double margin);

/// Equal spans, nearly square: so many in the longer direction.
NetKnots UniformNet(const ParametricBox<2>& rectangle, int degree, int elements);

/// @return TooLarge for a net of more control points than MaxFunctions.
Status CheckNet(const NetKnots& knots, const BackMapParams& params);

/// Residuals of a surface at the samples.
struct BackMapResiduals
{
  Eigen::VectorXd Distances; ///< one a sample
  double Max = 0.0;
  double Rms = 0.0; ///< of the samples inside triangles, by weight
};
BackMapResiduals MeasureBackMap(
  const BezierForm<2>& surface, const ChartSamples& samples, int threads);

/// BackMapMethod::Penalized. @pre the chart and the parameters are checked.
///
/// Least squares to the triangles' plane pieces with the thin-plate energy, whose weight falls with
/// the fourth power of the smallest span: so it stays as small against the data on every net, and
/// rules alone where there is none. A net by need begins with few spans; spans that hold points
/// farther than the tolerance are halved, in the direction in which the surface bends there, until
/// a limit of the parameters or a contradiction of the chart ends it; the best surface is the
/// result.
Result<BackMap> FitPenalized(const ChartMesh& chart, const BackMapParams& params);
}
