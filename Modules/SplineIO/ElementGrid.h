// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineIO/ElementMesh.h>

class vtkUnstructuredGrid;

namespace knotwork
{
/// Linear, quadratic and Lagrange cells with the cell arrays ElementNumber, PhysicalGroup (a
/// component for each of the most groups that an element has, 0 behind the last) and
/// GeometricEntity, the point arrays NodeNumber and PhysicalGroup (of point elements), an array of
/// 0 and 1 by the name of every set, and the names of groups as field data PhysicalGroupNames with
/// PhysicalGroupIds (dimension, group).
Status EncodeElements(const ElementMesh& mesh, vtkUnstructuredGrid* grid);

/// The mesh of a grid of such cells, and of polynomial Bezier cells, which become Lagrange cells of
/// the same polynomials. Numbers that are missing, not positive or there twice are
/// counted from 1 instead; without PhysicalGroup the cell array Attribute takes its place.
/// @return EmptyInput; InvalidTopology for other cells, rational ones among them; NonFiniteInput.
Result<ElementMesh> DecodeElements(vtkUnstructuredGrid* grid);
}
