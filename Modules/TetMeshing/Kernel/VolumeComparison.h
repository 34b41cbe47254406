// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/CADFitting/DeviationMap.h>
#include <knotwork/JacobianValidation/CellMeasures.h>
#include <knotwork/JacobianValidation/JacobianCertificate.h>
#include <knotwork/TetMeshing/BoundaryMesh.h>

namespace knotwork
{
/// Triangles on the facets of volume cells that belong to one cell alone, with points on the
/// curved facets; every facet is divided alike, 4 to 32 times along an edge.
/// @param cells  tetrahedra, wedges and hexahedra in space.
/// @param corners  points of the cells in the order of CornerParameters, cell by cell: cells hang
/// together where they share them.
/// @param tolerance  chordal, > 0: an estimate by second differences ends below it, or at 32.
/// @return EmptyInput; InvalidTopology for a facet of three cells, and as FinishBoundary;
/// SizeMismatch; DimensionMismatch for other cells; TooLarge for more than 20,000,000 triangles.
/// Bound is the estimate.
/// @complexity O(cells log cells + points).
Result<BoundaryMesh> TriangulateFacets(
  const BernsteinCells& cells, const std::vector<int>& corners, double tolerance);

struct VolumeComparisonParams
{
  int Samples = 20000; ///< points of the reference at least, [100, 10000000]
  int BoundBoxes = 64; ///< sub-cells a cell for the bound of the scaled Jacobian, [1, 65536]
  int Threads = 0;     ///< 0: all cores
  ProgressCallback Progress;
};

/// Cells of a solid against its reference.
struct ComparedVolume
{
  JacobianCertificate Certificate;
  /// Cells[i].ScaledLower <= least scaled Jacobian of cell i <= Cells[i].ScaledMin, a value that
  /// it takes.
  CellMeasures Measures;
  DeviationMap Deviation;     ///< the boundary is the scan
  double ToReference = 0.0;   ///< largest distance of the boundary's points from the reference
  double FromReference = 0.0; ///< of the reference's points from the boundary's triangles
  double CertificateSeconds = 0.0;
  double MeasureSeconds = 0.0;
  double DistanceSeconds = 0.0;
};

/// Certifies and measures cells, and maps distances both ways between their boundary and a
/// reference.
/// @param cells  of volumes. @param boundary  on them. @param triangles  of the reference.
/// @return the errors of ValidateMaps, MeasureCells and MapDeviation; Aborted.
Result<ComparedVolume> CompareVolume(const BernsteinCells& cells, const BoundaryMesh& boundary,
  const FitTarget& reference, const TriangleMesh& triangles,
  const VolumeComparisonParams& params = {});

/// Cells by their least scaled Jacobian.
struct QualityHistogram
{
  std::vector<double> Edges;   ///< bins + 1, from -1 to 1
  std::vector<int> Guaranteed; ///< cells by the proven lower bound
  std::vector<int> Attained;   ///< cells by the least value that was met, an upper bound
};

/// @param bins  >= 1; the last one has its upper end.
QualityHistogram MakeHistogram(const CellMeasures& measures, int bins);
}
