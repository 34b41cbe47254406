// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>

#include <string>

class vtkDataObject;

namespace knotwork
{
/// Polygons of polydata, or of a collection of them, in the format of the ending: .obj with all
/// digits and the normals of points, .ply (binary) in double precision, .stl (binary) as triangles
/// in single precision, which is all the format has.
/// @return EmptyInput without polygons; InvalidParameter for another ending; TooLarge above 2^31 -
/// 1 polygons or points.
Result<std::string> PolygonText(vtkDataObject* data, const std::string& ending);
}
