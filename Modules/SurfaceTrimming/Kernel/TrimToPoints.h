// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/SizeLimit.h>
#include <knotwork/SurfaceTrimming/CloudOutline.h>
#include <knotwork/SurfaceTrimming/FaceCertificate.h>
#include <knotwork/SurfaceTrimming/TrimLoops.h>

namespace knotwork
{
struct TrimToPointsParams
{
  CloudOutlineParams Outline;
  /// Largest distance, measured on the surface, between outline and trimming curves; 0: a third of
  /// a cell.
  double Tolerance = 0.0;
  double CornerAngle = 70.0;              ///< see LoopParams
  int MaxFunctions = DefaultMaxFunctions; ///< of the surface as a tensor product, >= 1
  int Threads = 0;
  ProgressCallback Progress;
};

struct TrimmedToPoints
{
  TrimmedModel Model; ///< a face a part of the outline, on the tensor-product surface around it
  std::vector<LoopVerdict> Loops;            ///< of the faces
  std::vector<FaceCertificate> Certificates; ///< of the faces
  double CellSize = 0.0;
  double MaxGap = 0.0;
  double Tolerance = 0.0;
  double MaxTrimDistance = 0.0; ///< bound, between outline and trimming curves
  int NumLoops = 0;
  std::size_t NumPointsOutside = 0; ///< points that are in no face
};

/// Trims a fitted surface to where its points are: the outline of their parameters
/// (CloudOutline.h), fitted by trimming curves (TrimLoops.h), with the proofs of trimmed faces.
/// @param surface  polynomial, 3 components or more, of which 3 count; LR and hierarchical ones are
/// expanded to tensor products, of which every face gets what is around its part, up to the next
/// knots.
/// @param parameters  n x 2. @return failures of FindCloudOutline, ExpandToTensor, FitLoops and
/// CertifyFace; InvalidWeight; SizeMismatch; OutsideDomain naming the point; InvalidParameter.
/// @complexity that of the outline, of the expansion, and of fits and proofs a boundary cell.
Result<TrimmedToPoints> TrimToPoints(const Spline<2>& surface, const PointMatrixView& parameters,
  const TrimToPointsParams& params = {});
}
