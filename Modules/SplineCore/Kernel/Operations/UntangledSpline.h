// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/MeshUntangling.h>
#include <knotwork/SplineCore/UnstructuredSpace.h>

namespace knotwork
{
/// Where the points of a mesh may move before a spline is made of them.
enum class UntanglingScope : std::int8_t
{
  None,
  Cells,   ///< around folded cells
  Elements ///< and around elements of the spline that turn over
};

struct UntangledSplineParams
{
  UntanglingScope Scope = UntanglingScope::Cells;
  UntanglingParams Mesh; ///< Poor and Progress are set here
  /// SplineOfCage, not SplineThroughVertices.
  bool IsCage = false;
  int Threads = 0; ///< 0 = all cores; the result does not depend on it
  ProgressCallback Progress;
};

template <int Dim>
struct UntangledSpline
{
  Spline<Dim> Value;
  PointMatrix Vertices;         ///< that it was made of, columns as given
  std::vector<int> FoldedCells; ///< of the mesh as it was; not looked for by None
  std::vector<int> StillFolded; ///< cells of the mesh as it is now
  int FoldedElements = -1;      ///< of the spline, as FoldedElements says; Elements alone looks
  int NumMoved = 0;             ///< points
  double LargestMove = 0.0;
};

/// A spline of the vertices of a mesh after folded cells were untangled, and, if asked for, the
/// cells of elements that turn over have got better shapes: up to six rounds, of which the one with
/// the fewest folded cells, then elements, is kept, so that nothing moves in vain.
/// @param vertices  coordinates in the first columns, as many as `coordinates`: 2 or 3; what is
/// behind them goes with the points.
/// @return as UntangleMesh, SplineThroughVertices.
template <int Dim>
Result<UntangledSpline<Dim>> MakeUntangledSpline(const SplineSpacePtr<Dim>& space,
  const PointMatrixView& vertices, int coordinates, const UntangledSplineParams& params);
}
