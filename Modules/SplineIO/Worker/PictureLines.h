// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <vtkSmartPointer.h>

class vtkPolyData;

namespace knotwork
{
/// Edges of polygons, on their points.
struct PictureLines
{
  vtkSmartPointer<vtkPolyData> Patches;  ///< where patches and surfaces end, and sharp edges
  vtkSmartPointer<vtkPolyData> Elements; ///< between elements of one patch
  long long NumElements = 0;             ///< that the polygons belong to
};

/// @param polygons  with the cell arrays PatchId, FaceId or RegionId where they belong to patches.
/// @param elements  cell array that numbers the elements of a patch; null: each polygon is one.
/// @param findSharp  whether edges of more than 45 degrees end a patch, too.
/// @complexity n, with a hash map of edges
PictureLines FindPictureLines(vtkPolyData* polygons, const char* elements, bool findSharp);
}
