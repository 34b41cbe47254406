// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/JacobianValidation/JacobianCertificate.h>
#include <knotwork/SplineCore/TrimmedModel.h>
#include <knotwork/SurfaceTrimming/ChartMesh.h>

namespace knotwork
{
struct FaceCertificateParams
{
  /// Halvings of an element, in both directions, by which the region is told from what is trimmed
  /// away, [0, 20].
  int MaxDepth = 8;
  int Threads = 0; ///< 0: all cores; the result does not depend on it
  ProgressCallback Progress;
};

/// What is proved of a face: |S_u x S_v| > 0 on the trimmed region (and on parts of elements around
/// its boundary that the halving did not separate from it).
struct FaceCertificate
{
  knotwork::Verdict Verdict = knotwork::Verdict::Undecided; ///< never Reversed
  /// Lower bound of |S_u x S_v| by the surface's parameters, at least half of its least value on
  /// the region and the parts around it; <= 0 unless valid.
  double MinNormal = 0.0;
  bool HasWitness = false;
  std::array<double, 2> Witness{}; ///< parameters of a place that is not regular, or not decided
  int NumPieces = 0;               ///< elements and parts of elements looked at
};

/// Elements inside the loops and on them are proved by ValidateJacobian; those on them that are not
/// regular are quartered, and what is outside is dropped, until the rest is regular. Invalid is
/// proved: the witness lies inside, and the surface is singular there or, in a plane x, y or
/// z = const, folded around it. Other surfaces that fold along themselves are Undecided. The proof
/// includes the rounding of the Bezier form.
/// @return failures of Spline::Check; DimensionMismatch; InvalidParameter; EmptyInput for a loop
/// without curves, and when the loops enclose nothing of the surface; failures of ValidateJacobian;
/// Aborted.
/// @complexity linear in the elements inside, plus up to 2^MaxDepth pieces for an element on the
/// boundary that is not regular as a whole.
Result<FaceCertificate> CertifyFace(
  const TrimmedFace& face, const FaceCertificateParams& params = {});

struct DeviationParams
{
  /// Bounds are refined until upper <= (1 + RelativeGap) x what was found, (0, 1].
  double RelativeGap = 0.05;
  /// Bounds below are good enough as they are, >= 0.
  double Enough = 0.0;
  int Threads = 0; ///< 0: all cores; the result does not depend on it
  ProgressCallback Progress;
};

/// |S(u) - X(u)| over a chart, X its points interpolated linearly in each triangle: a bound of the
/// distance from mesh to surface and back. See also RefineDeviations.
struct ChartDeviation
{
  Eigen::VectorXd PointDeviation; ///< a chart point
  /// Proved, a triangle: within the gap of the largest value there, plus rounding (about 1e-13 of
  /// the coordinates; more for triangles that are thin in the plane). A triangle over very many
  /// elements may stop short of the gap.
  Eigen::VectorXd TriangleBound;
  /// The largest value that is met there, or proved to be reached.
  Eigen::VectorXd TriangleFound;
  double MaxBound = 0.0; ///< largest of TriangleBound
  double MaxFound = 0.0; ///< largest of TriangleFound
  double Rms = 0.0;      ///< root mean square by area in space (quadrature)
  double Area = 0.0;     ///< of S over the chart's triangles (quadrature)
  double MeshArea = 0.0;
};

/// Convex hulls of S - X in Bernstein form on boxes that are halved where the bound is largest.
/// @return failures of both Check; DimensionMismatch (a tensor surface in space is wanted);
/// InvalidParameter; OutsideDomain when UV leaves the surface; Aborted.
/// @complexity some boxes a triangle and element that it meets.
Result<ChartDeviation> BoundDeviation(
  const ChartMesh& chart, const Spline<2>& surface, const DeviationParams& params = {});
}
