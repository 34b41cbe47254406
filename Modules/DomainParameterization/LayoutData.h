// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/DomainParameterization/PatchLayout.h>

class vtkDataSet;

/// Between datasets and the kernel of domain parameterization. Internal to the module.
namespace knotwork
{
/// A patch a quadrilateral or pixel (hexahedron or voxel), a vertex a point, in their order; cells
/// of fewer dimensions are not looked at, nor is z in the plane. Sides are left empty.
/// @return EmptyInput without such cells; InvalidTopology naming a cell of another kind.
template <int Dim>
Result<PatchLayout<Dim>> DecodeLayout(vtkDataSet* data);
}
