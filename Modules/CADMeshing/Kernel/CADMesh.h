// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>

#include <array>
#include <vector>

namespace knotwork
{
/// Quadrilaterals on the faces of a CAD model (CADTopology of CADModel).
struct CADMesh
{
  std::vector<Eigen::Vector3d> Points;
  std::vector<std::array<int, 4>> Quads; ///< counterclockwise about the face's normal
  std::vector<int> QuadFace;             ///< CADTopology::Faces
  std::vector<int> PointDimension;       ///< 0 on a vertex, 1 on an edge, 2 on a face
  std::vector<int> PointEntity;          ///< which, of CADTopology's Vertices, Edges or Faces
};
}
