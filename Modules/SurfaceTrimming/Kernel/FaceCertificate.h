// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "ChartMesh.h"
#include "JacobianCertificate.h"
#include "TrimmedModel.h"

namespace knotwork
{
struct FaceCertificateParams
{
  int MaxDepth =
    8; ///< halvings of an element by which the region is told from what is trimmed away, [0, 20]
  int Threads = 0;
  ProgressCallback Progress;
};

/// What is proved of a face: |S_u x S_v| > 0 on the trimmed region (and on parts of elements around
/// its boundary that the halving did not separate from it).
struct FaceCertificate
{
  knotwork::Verdict Verdict = knotwork::Verdict::Undecided;
  double MinNormal =
    0.0; ///< lower bound of |S_u x S_v| by the surface's parameters; <= 0 unless valid
  bool HasWitness = false;
  std::array<double, 2> Witness{}; ///< parameters of a place that is not regular, or not decided
  int NumPieces = 0;               ///< elements and parts of elements looked at
};

/// @return failures of Spline::Check; DimensionMismatch; Aborted.
Result<FaceCertificate> CertifyFace(
  const TrimmedFace& face, const FaceCertificateParams& params = {});

struct DeviationParams
{
  /// Bounds are refined until upper <= (1 + RelativeGap) x what was found, (0, 1].
  double RelativeGap = 0.05;
  /// Bounds below are good enough as they are, >= 0.
  double Enough = 0.0;
  int Threads = 0;
  ProgressCallback Progress;
};

/// |S(u) - X(u)| over a chart, X its points interpolated linearly in each triangle: a bound of the
/// distance from mesh to surface and back.
struct ChartDeviation
{
  Eigen::VectorXd PointDeviation; ///< a chart point
  Eigen::VectorXd TriangleBound;  ///< proved, a triangle
  double MaxBound = 0.0;          ///< largest of TriangleBound
  double MaxFound = 0.0;          ///< largest value met
  double Rms = 0.0;               ///< root mean square by area in space (quadrature)
  double Area = 0.0;              ///< of S over the chart's triangles (quadrature)
  double MeshArea = 0.0;
};

/// @return failures of both Check; OutsideDomain when UV leaves the surface; Aborted.
Result<ChartDeviation> BoundDeviation(
  const ChartMesh& chart, const Spline<2>& surface, const DeviationParams& params = {});
}
