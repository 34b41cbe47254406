// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "vtkKnotworkSurfaceTrimmingModule.h" // for export macro
#include <knotwork/SurfaceTrimming/SurfaceRecognition.h>
#include <knotwork/SurfaceTrimming/TrimSurface.h>

#include "vtkType.h"

class vtkPointSet;
class vtkPolyData;
class vtkTable;

namespace knotwork
{
/// Charts and where their points and triangles come from.
struct DecodedCharts
{
  std::vector<ChartMesh> Charts;              ///< in ascending order of ChartId
  std::vector<std::vector<vtkIdType>> Points; ///< of the data set, one a point of the chart
  std::vector<std::vector<vtkIdType>> Cells;  ///< of the data set, one a triangle of the chart
  /// Charts that lie upside down in the plane: their triangles are read clockwise.
  std::vector<char> Turned;
};

/// Triangles of a data set with the point array `UV`, by the cell array `ChartId` if there is one.
/// Points of several charts are the same where they are one point, or have one `CutPointId` >= 0.
/// @return failures of DecodeMesh; EmptyInput without triangles; SizeMismatch for arrays of other
/// sizes; NonFiniteInput; InvalidTopology for triangles that are flipped in the plane. With ids of
/// the data set.
Result<DecodedCharts> DecodeCharts(vtkPointSet* data);

/// The faces of charts that were turned get the orientation of their meshes again.
void TurnFaces(const std::vector<char>& turned, TrimmedSurface& trimmed);

/// Triangles with shared points, unit `Normals`, the cell array `FaceId`, and parameters: the point
/// array `UV` where every point has one pair (also the texture coordinates), else the cell array
/// `CornerUV` (u, v of the three corners).
VTKKNOTWORKSURFACETRIMMING_EXPORT void EncodeTriangles(
  const TrimmedMesh& mesh, vtkPolyData* output);

/// Adds the point array `Deviation` and the cell array `DeviationBound`; 0 beside the charts.
void EncodeDeviation(
  const DecodedCharts& decoded, const TrimmedSurface& trimmed, vtkPointSet* output);

/// Adds SnappedSurfaces, CommonDirections, CommonPositions, CommonSizes and MaxTurn to a row.
void EncodeSnapped(const SnappedValues& snapped, vtkTable* output);

/// One row with all numbers.
void EncodeNumbers(const TrimmedSurface& trimmed, vtkTable* output);

/// Of the faces: invalid when one is, else undecided when one is.
Verdict WorstVerdict(const std::vector<FaceCertificate>& certificates);
/// Likewise of the loops; undecided when there are none.
LoopVerdict WorstLoops(const std::vector<LoopVerdict>& verdicts);
/// Sentences about verdicts that are not the best.
std::vector<std::string> ShortcomingsOfFaces(Verdict regular, LoopVerdict loops);
}
