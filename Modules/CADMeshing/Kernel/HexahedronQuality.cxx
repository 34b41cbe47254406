// SPDX-License-Identifier: BSD-3-Clause
#include "HexahedronQuality.h"

#include <knotwork/JacobianValidation/CellMeasures.h>

#include <algorithm>

namespace knotwork
{
namespace
{
BernsteinCells CellsOf(const CellMesh<3>& mesh, const PointMatrixView& points)
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
  return cells;
}

CellMeasuresParams AtCorners(int threads)
{
  CellMeasuresParams params;
  params.BoundBoxes = 0;
  params.SamplesPerEdge = 2;
  params.Threads = threads;
  return params;
}

std::vector<double> LeastOf(const std::vector<CellMeasure>& cells)
{
  std::vector<double> least;
  for (const CellMeasure& cell : cells)
  {
    least.push_back(cell.ScaledMin);
  }
  return least;
}
}

Result<std::vector<double>> ScaledJacobians(
  const CellMesh<3>& mesh, const PointMatrixView& points, int threads)
{
  const auto measures = MeasureCells(CellsOf(mesh, points), AtCorners(threads));
  return measures ? Result<std::vector<double>>(LeastOf(measures->Cells))
                  : Result<std::vector<double>>(measures.Status);
}

Result<HexahedronQuality> MeasureHexahedra(
  const CellMesh<3>& mesh, const PointMatrixView& points, int threads)
{
  const BernsteinCells cells = CellsOf(mesh, points);
  JacobianParams params;
  params.Threads = threads;
  auto certificate = ValidateJacobian(cells, params);
  if (!certificate)
  {
    return certificate.Status;
  }
  const auto measures = MeasureCells(cells, AtCorners(threads));
  if (!measures)
  {
    return measures.Status;
  }
  HexahedronQuality quality;
  quality.Certificate = std::move(certificate.Value);
  quality.ScaledJacobians = LeastOf(measures->Cells);
  quality.LeastScaledJacobian = measures->Total.ScaledMin;
  quality.Volume = measures->Total.Measure;
  return quality;
}

double ShareNotValid(const JacobianCertificate& certificate)
{
  const auto bad = std::count_if(certificate.Cells.begin(), certificate.Cells.end(),
    [](const CellCertificate& cell) { return cell.Verdict != Verdict::Valid; });
  return certificate.Cells.empty()
    ? 0.0
    : static_cast<double>(bad) / static_cast<double>(certificate.Cells.size());
}
}
