// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineIO/PointFile.h>

class vtkPointSet;
class vtkPolyData;

namespace knotwork
{
/// Points with a vertex each (unless there are polygons or lines), channels as point arrays;
/// channels `a:0`, `a:1`, ... that follow each other are components of one array `a`. Several
/// groups are told apart by the point array `CloudId`, colours are the point array `Color`, the
/// reference system is the field data string `CoordinateReferenceSystem`.
void EncodePoints(const PointFile& file, vtkPolyData* output);

/// Points of a data set with all point arrays of numbers; `CloudId` and `Color` become groups where
/// ids do not fall and the colour of a group is one.
PointFile DecodePoints(vtkPointSet* data);
}
