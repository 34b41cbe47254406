// SPDX-License-Identifier: BSD-3-Clause
// Vertices of a mesh around a cell, private to the kernel.
#pragma once
#include "UnstructuredData.h"

namespace knotwork
{
/// A grid of vertices around a cell, as wide as a number of cells where there is room: it ends at
/// the boundary, at facets that are C^0, and where the mesh is no grid.
template <int Dim>
class VertexWindow
{
public:
  /// @param most  cells a direction, odd: the cell is in the middle where nothing ends the window.
  VertexWindow(const UnstructuredData<Dim>& data, int cell, int most);

  /// Values of the polynomial through the vertices, of as many degrees as there are cells.
  /// @param local  in the cell's own parameters. @param vertices  rows by number. @param values  a
  /// row a point, set.
  void Interpolate(
    const PointMatrixView& local, const PointMatrixView& vertices, PointMatrix& values) const;

private:
  /// A cell and how it lies: direction d of the window goes out of its side Ahead[d].
  struct Place
  {
    int Cell;
    IntArray<Dim> Ahead;
  };
  void Widen(int most);
  bool AddLayer(std::size_t direction, bool upper);
  bool Cross(const Place& from, std::size_t direction, bool upper, Place& to) const;
  void TakeNodes();
  void TakePoints();
  /// Number of places with the same index in all directions from `direction` on.
  int Stride(std::size_t direction) const;

  const UnstructuredData<Dim>& Data;
  IntArray<Dim> Size;                         ///< in cells
  IntArray<Dim> Root{};                       ///< index of the cell that it was made for
  std::vector<Place> Places;                  ///< first direction fastest
  std::array<std::vector<double>, Dim> Nodes; ///< parameters of the vertices
  std::vector<int> Points;                    ///< numbers of the vertices, first direction fastest
};

/// Interpolation in windows that grow by a vertex to both sides: to degree p in any case, on as
/// long as that changes less and less, which it does on smooth data.
/// @param local  in the cell's own parameters. @param values  a row a point, to set.
template <int Dim>
void InterpolateAround(const UnstructuredData<Dim>& data, int cell, const PointMatrix& local,
  const PointMatrixView& vertices, PointMatrix& values);
}
