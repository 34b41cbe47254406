// SPDX-License-Identifier: BSD-3-Clause
// Sizes of a fit and its distances from the target, private to the kernel.
#pragma once
#include "FittedMesh.h"

namespace knotwork
{
/// Area, volume, distances and bounds of a fit, from its spline.
/// @return the errors of TraceOnFacets and the target; Aborted.
template <int Dim>
Status MeasureFit(const FittedMesh<Dim>& mesh, const CADFitParams& params, CADFit<Dim>& fit);

/// Distance of a spline's surface from the target, root mean square, at few points; 0 without one.
/// @param allowed  result, not without a target: AllowedDistance; null: not asked for.
/// @return as MeasureFit.
template <int Dim>
Result<double> DistanceFromTarget(const FittedMesh<Dim>& mesh, const Spline<Dim>& spline,
  const CADFitParams& params, double* allowed = nullptr);

/// Distance of the surface from the target that mending may end with: it may double, or reach a
/// share of what the mesh has itself. A valid spline far from its target is of no use.
double AllowedDistance(const FitDistances& before);
}
