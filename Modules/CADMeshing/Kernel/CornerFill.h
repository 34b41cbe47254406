// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "CADMesh.h"
#include "CornerSolid.h"
#include "QuadSides.h"

namespace knotwork
{
/// Hexahedra of a solid, a grid at each of its corners: between the parts of its faces beside the
/// corner, and surfaces from the middles of its sides to its own middle. Inner points are found by
/// transfinite interpolation.
class CornerFill
{
public:
  /// @param nodes  of the model's edges: all sides of the solid have as many segments.
  /// @param quads  of the solid's faces.
  /// @param mesh   its points get those inside of the solid.
  CornerFill(const CADTopology& model, const CornerSolid& solid, const EdgeNodes& nodes,
    const std::map<int, QuadSides>& quads, CADMesh& mesh);

  int HalfSegments() const { return this->Half; }
  /// Corners of right-handed hexahedra, tensor-product order (CellMesh).
  std::vector<std::array<int, 8>> Fill(int body);

private:
  using Grid = std::vector<std::vector<int>>;

  std::vector<int> HalfSide(int side, int vertex) const;
  Grid PartOfFace(int face, const std::vector<int>& along, const std::vector<int>& across) const;
  int AddPoint(const Eigen::Vector3d& point);
  const std::vector<int>& Spoke(int face, int foot);
  const Grid& InnerFace(
    int side, int face, const std::vector<int>& first, int other, const std::vector<int>& second);

  const CADTopology& Model;
  const CornerSolid& Solid;
  const EdgeNodes& Nodes;
  const std::map<int, QuadSides>& Quads;
  CADMesh& Mesh;
  int Body = 0;
  int Half = 0;                           ///< segments of half a side
  int Middle = -1;                        ///< node
  std::map<int, std::vector<int>> Spokes; ///< of faces, from their middle to that of the solid
  std::map<int, Grid> InnerFaces; ///< of sides, from their middle: along the first face, then
                                  ///< along the other one
};
}
