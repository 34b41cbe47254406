// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineGrid/SplineModel.h>

namespace knotwork
{
/// Patches of kind Unstructured become the tensor-product patches that they consist of
/// (SplitIntoPatches.h), with their fields: the first one has the patch's id, the others ids that
/// are free. What is stated of the sides of others stays, what is known of theirs is added. One
/// line a patch goes to the warnings.
/// @param threads  0 = all cores. @return failures of SplitIntoPatches with the patch.
VTKKNOTWORKSPLINEGRID_EXPORT Status SplitUnstructuredPatches(SplineModel& model, int threads);
}
