// SPDX-License-Identifier: BSD-3-Clause
// Splines of unstructured spaces on facets of their meshes, as splines of their own.
#pragma once
#include <knotwork/SplineCore/UnstructuredSpace.h>

namespace knotwork
{
/// Where an element of a trace lies in the whole: on a side of a cell; its direction k is direction
/// Direction[k] of the cell, run backwards where Reversed[k].
template <int Dim>
struct TraceElement
{
  CellSide Facet;
  IntArray<Dim> Direction{};
  std::array<bool, Dim> Reversed{};
};

/// A space of traces: which function of the whole each of its functions is (closed curves without
/// an end have p functions at both ends), and where its elements lie. The trace of a spline has its
/// control points and weights in the rows of Functions.
template <int Dim>
struct MeshTrace
{
  SplineSpacePtr<Dim> Space;
  std::vector<int> Functions;
  std::vector<TraceElement<Dim>> Elements;
};

/// All facets on the boundary, by cell and side.
template <int Dim>
std::vector<CellSide> BoundaryFacets(const MeshTopology<Dim>& topology);

/// The space on faces of hexahedra as one space on a mesh of quadrilaterals: element i on facet i.
/// @param facets  each once, on the boundary or C^0.
/// @return EmptyInput; DimensionMismatch for a space without a mesh; InvalidParameter for a facet
/// that is not there or that the spline crosses smoothly (mark it as a feature); InvalidTopology
/// for facets that are no surface, by their places in the list; NotInSpace with the facet where the
/// traces are no independent functions: the facets end where the spline goes on smoothly, or on a
/// facet that it crosses smoothly (a T-joint of tracks).
Result<MeshTrace<2>> TraceOnFacets(
  const SplineSpace<3>& space, const std::vector<CellSide>& facets);

/// The space on edges of quadrilaterals as curves: edges follow each other over points of two of
/// them, and past ends of others where the spline goes on smoothly on the other side; a curve that
/// closes without a C^0 point has knots without full multiplicity at its ends. Curves in the order
/// of their first edges, which they run along in the direction of the cell.
/// @return as for volumes. Edges of volumes: those of the trace on faces.
Result<std::vector<MeshTrace<1>>> TraceOnFacets(
  const SplineSpace<2>& space, const std::vector<CellSide>& facets);

/// A spline's trace.
template <int Dim>
Spline<Dim> TraceOf(const Spline<Dim + 1>& spline, const MeshTrace<Dim>& trace);
}
