// SPDX-License-Identifier: BSD-3-Clause
// Bezier projection onto a target, dimension by dimension; private to the kernel.
#pragma once
#include "FastPaths.h"
#include "MeshClassification.h"

#include <knotwork/SplineCore/UnstructuredSpace.h>

#include <string>

namespace knotwork
{
struct ProgressiveFitParams
{
  bool Surfaces = true;
  bool Curves = true;
  bool Points = true;
  /// Whether what comes before is fitted anew with the coefficients that a step has, instead of
  /// keeping all others.
  bool Constrain = false;
  /// Times that the surface is projected onto the target, from the second on from where it was
  /// fitted to before, >= 1.
  int Projections = 1;
  /// Gauss points a direction: p + 1 and so many more, in [0, 16].
  int ExtraPoints = 1;
  int Threads = 0;              ///< 0 = all cores; the result does not depend on it
  std::vector<int> LinearCells; ///< as InterpolateVertices
  ProgressCallback Progress;
};

template <int Dim>
struct ProgressiveFit
{
  Spline<Dim> Value;
  Spline<Dim> Before;                ///< through the points, nothing else
  std::vector<int> OnCurves;         ///< functions that were fitted to curves and corners
  std::vector<std::string> Warnings; ///< curves and corners that could not be fitted, and why
};

/// Facets inside of the mesh that must be C^0 for its surface to have an edge at every classified
/// edge, and a corner at every corner where classified edges or rims go straight on in the mesh.
template <int Dim>
std::vector<CellSide> FeatureFacets(const CellMesh<Dim>& mesh, const MeshTopology<Dim>& topology,
  const SurfaceMesh& surface, const MeshClassification& parts);

/// Facets with all that are opposite to them across regular ridges, as far as that goes: features
/// that end nowhere inside of the mesh.
template <int Dim>
std::vector<CellSide> Prolong(
  const MeshTopology<Dim>& topology, const std::vector<CellSide>& facets);

/// The polynomials through the points around every cell, projected onto the space; then, on its
/// surface, their closest points on the target's faces; on classified edges and rims those on
/// curves; corners. Each overwrites the coefficients that it has, or constrains what is around.
/// @param path  and the space. @param points  of the mesh, on the target. @param target  null: the
/// points alone. @param from  a spline of the space that takes the place of these polynomials;
/// null: none.
/// @return the target's errors; Aborted.
/// @source  Thomas, Scott, Evans, Tew, Evans, CMAME 284 (2015) 55-105.
template <int Dim>
Result<ProgressiveFit<Dim>> FitProgressively(const FastPath<Dim>& path, const SurfaceMesh& surface,
  const MeshClassification& parts, const PointMatrix& points, const FitTarget* target,
  const ProgressiveFitParams& params, const Spline<Dim>* from = nullptr);
}
