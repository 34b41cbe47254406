// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "vtkKnotworkSplineIOModule.h" // for export macro
#include <knotwork/SplineCore/Spline.h>

#include <vector>

class vtkDataObject;

namespace knotwork
{
/// Curves of a dataset: the lines of a vtkPolyData (of degree 1), or the curves of a spline grid.
/// @param threads  of the decoding; 0: all cores.
/// @return EmptyInput: neither is there; failures of DecodeSplineModel.
VTKKNOTWORKSPLINEIO_EXPORT Result<std::vector<Spline<1>>> CurvesInSpace(
  vtkDataObject* data, int threads = 0);
}
