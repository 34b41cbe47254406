// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>

#include "vtkType.h"

#include <string>
#include <vector>

class vtkDataSet;

namespace knotwork
{
/// What a cell of a skeleton can be.
enum class SkeletonCellKind
{
  Polyline,
  Polygon,       ///< triangles, quadrilaterals, pixels
  TriangleStrip, ///< in VTK's order
  BezierCurve,
  BezierQuadrilateral,
  BezierTriangle
};

/// The cells of a skeleton's dataset, polygonal data and unstructured grids alike, with ids
/// of points that exist. All are of one dimension, and all are Bezier cells or none
/// is.
class SkeletonCells
{
public:
  /// @param data  vtkPolyData or vtkUnstructuredGrid. @param name  "template" or "target".
  /// @return InvalidTopology: other or mixed cells, points that do not exist; the detail names the
  /// cell.
  static Result<SkeletonCells> Read(vtkDataSet* data, const std::string& name);
  /// Reads the cell array PatchId, which PatchId() needs.
  /// @return InvalidTopology: no array, or not whole numbers.
  Status ReadPatchIds(vtkDataSet* data, const std::string& name);

  vtkIdType Count() const { return static_cast<vtkIdType>(this->Kinds.size()); }
  SkeletonCellKind Kind(vtkIdType cell) const
  {
    return this->Kinds[static_cast<std::size_t>(cell)];
  }
  int PatchId(vtkIdType cell) const { return this->PatchIds[static_cast<std::size_t>(cell)]; }
  vtkIdType NumPoints(vtkIdType cell) const
  {
    const auto c = static_cast<std::size_t>(cell);
    return static_cast<vtkIdType>(this->Offsets[c + 1] - this->Offsets[c]);
  }
  const vtkIdType* Points(vtkIdType cell) const
  {
    return this->Ids.data() + this->Offsets[static_cast<std::size_t>(cell)];
  }
  /// Of the space that the skeleton lies in: 2 for curves, 3 for surfaces, 0 without cells.
  int Dimension() const;
  bool IsBezier() const;
  bool HasBezierTriangles() const;

private:
  Status ReadCells(vtkDataSet* data, const std::string& name);
  Status CheckKinds(const std::string& name) const;
  void Add(SkeletonCellKind kind, vtkIdType count, const vtkIdType* points);

  std::vector<SkeletonCellKind> Kinds;
  std::vector<int> PatchIds;
  std::vector<std::size_t> Offsets{ 0 };
  std::vector<vtkIdType> Ids;
};
}
