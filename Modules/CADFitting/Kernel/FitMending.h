// SPDX-License-Identifier: BSD-3-Clause
// Elements of a fit that are mended step by step, private to the kernel.
#pragma once
#include "FittedSpline.h"

namespace knotwork
{
/// Mends elements without a certificate, or with inverted nets: by the mesh map of their corners
/// alone, better places of the mesh's points, and moves of control points. A step is kept where it
/// leaves fewer elements without a certificate, and the surface at the target.
/// @param fit  result: InvalidBefore and Smoothed.
/// @return the errors of projections, of moves and of the target; Aborted. What could not be mended
/// is in the spline's verdicts.
template <int Dim>
Status MendFit(
  FittedMesh<Dim>& mesh, FittedSpline<Dim>& spline, const CADFitParams& params, CADFit<Dim>& fit);
}
