// SPDX-License-Identifier: BSD-3-Clause
// The mesh on the faces of solids, as far as it is made, and what their ends get from each other.
#pragma once
#include "QuadSides.h"
#include "SolidSweeps.h"
#include <knotwork/SplineCore/CellMesh.h>

#include <map>

namespace knotwork
{
/// Quadrilaterals of faces, one after the other; those of a target are copies of its source's.
class SolidFaceMesh
{
public:
  using Quad = QuadSides::Quad;
  using Side = QuadSides::Side;

  SolidFaceMesh(const CADTopology& model, FaceMesher& faces) : Model(model), Faces(faces) {}

  /// Nothing but the points of edges.
  void Begin(const EdgeNodes& nodes);
  /// @return failures of FaceMesher::Mesh with the face and the remedy.
  Status MeshFace(int face, FaceMethod method);

  bool IsMeshed(int face) const
  {
    return !this->QuadsOfFaces[static_cast<std::size_t>(face)].empty();
  }
  bool IsMeshed(const std::vector<int>& faces) const;
  /// Counterclockwise about the normal that leads out of a body of theirs.
  QuadSides QuadsOf(int body, const std::vector<int>& faces) const;
  /// The nodes from the rim of the source along the linking faces.
  /// @return InvalidTopology: other numbers of layers at other places.
  Status FindColumns(const SolidSweep& sweep, const QuadSides& source,
    std::map<int, std::vector<int>>& columns) const;
  /// Both ends have a mesh: from the rim on, quadrilateral by quadrilateral, they must be one.
  /// @return InvalidTopology: they are not.
  Status Match(const SolidSweep& sweep, const QuadSides& source,
    const std::map<int, std::vector<int>>& columns, std::map<int, int>& images) const;
  /// Gives the target the mesh of the source.
  /// @param images  result: nodes of the target for those of the source.
  /// @return InvalidTopology: imprints or faces that do not match; failures of SweepBetween.
  Status Copy(const SolidSweep& sweep, const QuadSides& source,
    const std::map<int, std::vector<int>>& columns, std::map<int, int>& images);

  CADMesh& Mesh() { return this->Surface.Mesh; }
  const CADMesh& Mesh() const { return this->Surface.Mesh; }
  /// Faces whose quadrilaterals are none or bad.
  const std::vector<int>& Poor() const { return this->PoorFaces; }

private:
  std::vector<int> AppendFace(int face);
  Status MatchImprints(const SolidSweep& sweep, std::map<int, int>& images) const;
  Status FacesOfCopies(const SolidSweep& sweep, const QuadSides& source,
    const std::map<int, int>& images, std::vector<int>& faceOfQuads) const;
  std::map<int, int> TakeCopy(int face, const QuadSides& source, const std::vector<int>& quads,
    const std::map<int, int>& images, const std::map<int, Eigen::Vector3d>& places);

  const CADTopology& Model;
  FaceMesher& Faces;
  const EdgeNodes* Nodes = nullptr;
  CADQuads Surface;
  std::vector<std::vector<int>> QuadsOfFaces;
  std::vector<int> PoorFaces;
};

/// "solid 3", for messages.
std::string SolidName(int body);

/// The quadrilaterals of a source, with points of their own.
struct SourceMesh
{
  SourceMesh(const QuadSides& quads, const std::vector<Eigen::Vector3d>& points);

  std::map<int, int> Numbers; ///< of nodes
  CellMesh<2> Mesh;
  PointMatrix Points;
};
}
