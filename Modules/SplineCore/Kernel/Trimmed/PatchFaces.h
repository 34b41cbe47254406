// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/TrimmedModel.h>

namespace knotwork
{
/// A surface on an unstructured mesh as faces, one a patch of FindSpacePatches, that share edges:
/// edges end where patches have corners, so that a side with T-joints has several. All
/// are one body, so that closed parts that are turned inward are cavities of those around them. Of
/// rational surfaces the faces have no loops.
/// @return as SplitIntoPatches; SizeMismatch unless the surface has 3 coordinates.
Result<TrimmedModel> FacesOfPatches(const Spline<2>& surface, int threads = 0);

/// The boundary of a volume on a mesh of hexahedra in the same way, turned outward; cells that hang
/// together by faces are a body.
/// @return also failures of TraceOnFacets: InvalidTopology for a boundary that is no surface.
Result<TrimmedModel> FacesOfPatches(const Spline<3>& volume, int threads = 0);
}
