// SPDX-License-Identifier: BSD-3-Clause
// The points of a fit of values in space by the elements that hold them, and its two methods.
#pragma once
#include "ElementFunctions.h"
#include "VolumeFit.h"

namespace knotwork
{
/// Points in the order of their elements, with local parameters.
struct VolumePoints
{
  std::vector<std::size_t> Start; ///< elements + 1
  std::vector<int> Order;         ///< row in the cloud
  std::vector<double> Local;      ///< three a point
  PointMatrix Values;

  std::size_t Count(std::size_t e) const { return this->Start[e + 1] - this->Start[e]; }
};

/// @pre the points are in the domain.
VolumePoints GroupVolumePoints(const SplineSpace<3>& space, const VolumeCloud& cloud);

/// (p + 1)^3 Bernstein polynomials at local parameters, first direction fastest.
void EvaluateVolumeBernstein(int degree, const double* local, double* values);

/// Coefficients that minimize the sum of squared differences plus Smoothing times the energy, by
/// conjugate gradients from the given ones on, scaled by the diagonal. All sums have a fixed order.
void SolveVolumeLeastSquares(const ElementFunctions& functions, const VolumePoints& points,
  int degree, double smoothing, double accuracy, int threads, PointMatrix& coefficients);

/// One step of multilevel B-spline approximation, as MultilevelStep.
/// @source  Lee, Wolberg, Shin, IEEE TVCG 3 (1997) 228-244, equations (3) and (5).
void VolumeMultilevelStep(const ElementFunctions& functions, const VolumePoints& points, int degree,
  int threads, PointMatrix& coefficients);
}
