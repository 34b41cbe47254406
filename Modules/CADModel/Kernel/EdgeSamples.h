// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/BezierForm.h>

namespace knotwork
{
/// A curve in space and the image of a pcurve at equal parameters: 16 places in every knot span of
/// either, and both ends (the first and last rows).
struct EdgeSamples
{
  PointMatrix Curve;
  PointMatrix Image;

  double MaxGap() const { return (this->Curve - this->Image).rowwise().norm().maxCoeff(); }
};

/// @param parameters  a spline of two components on the domain of the curve.
/// @return OutsideDomain with the parameter where the pcurve leaves the surface's domain by more
/// than 1e-9 of its size.
Result<EdgeSamples> SampleEdge(
  const Spline<1>& curve, const Spline<1>& parameters, const BezierForm<2>& surface);
}
