// SPDX-License-Identifier: BSD-3-Clause
#include "HexahedronQuality.h"

#include <knotwork/JacobianValidation/CellMeasures.h>

namespace knotwork
{
Result<HexahedronQuality> MeasureHexahedra(
  const CellMesh<3>& mesh, const PointMatrixView& points, int threads)
{
  BernsteinCells cells;
  cells.NumComponents = 3;
  for (int c = 0; c < mesh.NumCells(); ++c)
  {
    // corners are the coefficients of degree 1, in the same order
    double* block = cells.Block(cells.Add(CellShape::Hexahedron, { 1, 1, 1 }));
    for (int corner = 0; corner < 8; ++corner)
    {
      for (int d = 0; d < 3; ++d)
      {
        block[8 * d + corner] = points(mesh.Cell(c)[corner], d);
      }
    }
  }
  JacobianParams params;
  params.Threads = threads;
  auto certificate = ValidateJacobian(cells, params);
  if (!certificate)
  {
    return certificate.Status;
  }
  CellMeasuresParams measured;
  measured.BoundBoxes = 0;
  measured.SamplesPerEdge = 2;
  measured.Threads = threads;
  const auto measures = MeasureCells(cells, measured);
  if (!measures)
  {
    return measures.Status;
  }
  HexahedronQuality quality;
  quality.Certificate = std::move(certificate.Value);
  for (const CellMeasure& cell : measures->Cells)
  {
    quality.ScaledJacobians.push_back(cell.ScaledMin);
  }
  quality.LeastScaledJacobian = measures->Total.ScaledMin;
  quality.Volume = measures->Total.Measure;
  return quality;
}
}
