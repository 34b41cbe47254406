// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "SplineModel.h"
#include <knotwork/SplineCore/LRRefinement.h>

#include <map>

class vtkDataObject;

namespace knotwork
{
/// Mesh line segments by patch id, in the order of the input.
using SegmentsByPatch = std::map<int, std::vector<LRSegment>>;

/// Reads them from a table with the columns Direction (0: the first parameter is constant along the
/// segment, 1: the second), Value (that parameter), Start and End (the other one), and if wanted
/// Multiplicity (else 1) and PatchId; or from the lines of polydata whose points (u, v, any) are
/// parameters, with cell arrays Multiplicity and PatchId. Names of columns in any case. Without
/// PatchId they are of the model's only patch.
/// @return InvalidParameter for a column that is missing or no number, a line that runs along no
/// parameter, a patch that is not there or is to be said; EmptyInput without a segment.
Result<SegmentsByPatch> ReadSegments(vtkDataObject* segments, const SplineModel& model);
}
