// SPDX-License-Identifier: BSD-3-Clause
// Between what a file of splines holds and the model of a spline grid.
#pragma once
#include <knotwork/SplineGrid/SplineModel.h>
#include <knotwork/SplineIO/SplineFile.h>

namespace knotwork
{
/// Patches with the file's ids; coordinates that a geometry does not have are 0.
/// @return DimensionMismatch for a geometry of more than three coordinates.
Result<SplineModel> ModelFromFile(const SplineFile& file);

/// Splines and ids of a model; ids that are not distinct give way to 0, 1, 2, ... Fields are left
/// out with a warning.
/// @param coordinates  1, 2 or 3; 0: two when every z is 0 and no patch is a volume, else three.
/// @return InvalidParameter when a coordinate that would be left out is not 0.
Result<SplineFile> FileFromModel(const SplineModel& model, int coordinates);
}
