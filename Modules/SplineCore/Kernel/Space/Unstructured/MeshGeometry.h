// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/CellMesh.h>

namespace knotwork
{
/// Whether no point lies on an edge of a cell that it does not belong to, between other points that
/// are joined by edges along it: what local refinement without transition leaves.
/// @param points  NumPoints x 2 or 3.
/// @return InvalidTopology with the point and both cells; SizeMismatch, NonFiniteInput.
/// @complexity O(cells log cells).
template <int Dim>
Status CheckConforming(const CellMesh<Dim>& mesh, const PointMatrixView& points);

/// Mean length of the edges of every sheet, over the mean of all edges: lengths for
/// UnstructuredParams.
/// @return SizeMismatch, NonFiniteInput; InvalidParameter for a sheet whose edges are all points.
template <int Dim>
Result<std::vector<double>> MeanSheetLengths(
  const CellMesh<Dim>& mesh, const MeshTopology<Dim>& topology, const PointMatrixView& points);
}
