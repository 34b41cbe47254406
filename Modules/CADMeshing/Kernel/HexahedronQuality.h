// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/JacobianValidation/JacobianCertificate.h>
#include <knotwork/SplineCore/CellMesh.h>

namespace knotwork
{
struct HexahedronQuality
{
  JacobianCertificate Certificate;     ///< of trilinear cells
  std::vector<double> ScaledJacobians; ///< least sample of each cell, in [-1, 1]
  double LeastScaledJacobian = 0.0;
  double Volume = 0.0; ///< signed, exact but for rounding
};

/// The least scaled Jacobian at the corners of each cell.
/// @param points  NumPoints x 3. @return failures of MeasureCells.
Result<std::vector<double>> ScaledJacobians(
  const CellMesh<3>& mesh, const PointMatrixView& points, int threads = 0);

/// Certificates and measures of hexahedra with straight edges.
/// @param points  NumPoints x 3. @return failures of ValidateJacobian and MeasureCells.
Result<HexahedronQuality> MeasureHexahedra(
  const CellMesh<3>& mesh, const PointMatrixView& points, int threads = 0);

/// Share of cells whose verdict is not Valid, in [0, 1]; 0 without cells.
double ShareNotValid(const JacobianCertificate& certificate);
}
