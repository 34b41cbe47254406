// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>

class vtkDataObject;

namespace knotwork
{
/// What every job asks of a dataset that was read, of all parts of a collection: coordinates of
/// points are finite, polygons and strips of polydata have three corners or more, lines two (VTK
/// crashes on others).
/// @return NonFiniteInput naming point and coordinate; InvalidTopology naming the cell.
Status CheckData(vtkDataObject* data);
}
