// SPDX-License-Identifier: BSD-3-Clause
// Patches of a grid of Bezier cells; private to DecodeSplineModel.
#pragma once
#include "BezierCells.h"
#include "SplineSchema.h"
#include "TopologyTable.h"

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "vtkPoints.h"
#include "vtkUnstructuredGrid.h"

class vtkDataArray;

namespace knotwork
{
/// A patch in messages.
inline std::string PatchName(int id)
{
  return "patch " + std::to_string(id);
}

/// Cells that belong together, in the order of the grid.
struct CellGroup
{
  int Id = 0;
  int Basis = 0; ///< PatchBasis
  std::vector<vtkIdType> Cells;
};

/// The cells of one patch in element order with what they consist of.
template <int Dim>
struct PatchCells
{
  std::vector<vtkIdType> Cells;
  std::vector<IntArray<Dim>> Degrees;
  std::vector<vtkIdType> Points; ///< ids, first direction fastest within an element
  Checksum Sum;                  ///< of their geometry
  bool Weighted = false;         ///< whether a point has a weight that is not 1
};

/// Numbers of the patches of a block.
struct PatchNumbers
{
  std::set<int> Used;
  int Next = 0; ///< all before it are used
};

/// Reads the patches of one grid into a model.
class GridReader
{
public:
  GridReader(vtkUnstructuredGrid* grid, int block, vtkIdType firstCell, PatchNumbers& numbers,
    int threads, SplineModel& model)
    : Grid(grid), Bezier(grid), Block(block), FirstCell(firstCell), Numbers(numbers),
      Threads(threads), Model(model)
  {
  }
  Status Read();

private:
  using AnySpace = std::variant<SplineSpacePtr<1>, SplineSpacePtr<2>, SplineSpacePtr<3>>;
  Status CheckCells();
  Status FindArrays();
  Status GroupCells(std::vector<CellGroup>& groups);
  Status ReadGroup(const CellGroup& group);
  Status SplitCopies(
    const CellGroup& group, int numElements, std::vector<std::vector<vtkIdType>>& copies);
  template <int Dim>
  Status ReadStructured(const CellGroup& group, const PatchRecord& record);
  template <int Dim>
  Status ReadBezier(const CellGroup& group);
  template <int Dim>
  Status Gather(
    const std::string& where, const SplineSpace<Dim>* space, PatchCells<Dim>& cells) const;
  template <int Dim>
  Status CheckBounds(const std::string& where, const SplineSpace<Dim>& space,
    const std::vector<vtkIdType>& cells) const;
  template <int Dim>
  Status ReadFields(const std::string& where, const PatchRecord& record,
    const PatchCells<Dim>& cells, const Spline<Dim>& spline, SplinePatch& patch);
  template <int Dim>
  Result<SplineSpacePtr<Dim>> Space(const PatchRecord& record);
  template <int Dim>
  PointMatrix RowsOf(const PatchCells<Dim>& cells) const;
  Status CheckField(const std::string& where, vtkDataArray* array,
    const std::vector<vtkIdType>& points, Checksum& sum, bool& isZero) const;
  void IndexRecords();
  const PatchRecord* FindRecord(const CellGroup& group) const;
  const PatchRecord* FindCache(
    const Checksum& sum, const SpaceDefinition& basis, int numFunctions, int id) const;
  void ReadSides(const std::map<int, PatchPlace>& places);
  int TakeId(int wanted);
  /// May be said again: DecodeSplineModel keeps what is new.
  void Warn(const std::string& text) { this->Model.Warnings.push_back(text); }
  double Epsilon() const
  {
    return this->Grid->GetPoints()->GetDataType() == VTK_FLOAT
      ? static_cast<double>(std::numeric_limits<float>::epsilon())
      : std::numeric_limits<double>::epsilon();
  }

  vtkUnstructuredGrid* Grid;
  BezierCells Bezier;
  int Block;
  vtkIdType FirstCell;
  PatchNumbers& Numbers;
  int Threads;
  SplineModel& Model;
  SplineSchema Schema;
  // Of the records, by index: the first of each number, of each PatchBasis, and of both together;
  // those with control points by the sum of a grid that they belong to.
  std::map<int, std::size_t> RecordsById, RecordsByBasis;
  std::map<std::array<int, 2>, std::size_t> RecordsByBoth;
  std::multimap<std::uint64_t, std::size_t> Caches;
  std::set<int> GridIds; ///< numbers of patches of the grid, once one of them is changed
  std::vector<int> PatchIds, ElementIds, Bases;
  std::vector<vtkDataArray*> Fields;
  std::map<int, std::pair<SpaceDefinition, AnySpace>> Spaces;
};
}
