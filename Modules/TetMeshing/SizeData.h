// SPDX-License-Identifier: BSD-3-Clause
// Lengths of edges of tetrahedra in data sets, private to the module.
#pragma once
#include <knotwork/TetMeshing/SolidMesh.h>

#include <string>

class vtkDataSet;

namespace knotwork
{
/// Adds sizes to what a mesher is asked for: of the regions in which points lie if the data set has
/// no cells but vertices, else a field in its volumes, which are divided into tetrahedra.
/// @param name  of the array, of points or of cells; empty: the only one of one component.
/// @return InvalidParameter: no such array, values that are not above 0 (naming the first);
/// InvalidTopology: lines or polygons without volumes.
Status DecodeSizes(vtkDataSet* data, const std::string& name, TetrahedraParams& params);
}
