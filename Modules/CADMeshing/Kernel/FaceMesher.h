// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "CADQuads.h"
#include "EdgeDivisions.h"
#include "FaceQuads.h"
#include "LogicalShape.h"

namespace knotwork
{
/// @return InvalidParameter.
Status CheckParams(const CADQuadsParams& params);

/// "face 3 ('name')", as files number and name it.
std::string FaceName(const CADTopology& model, int face);

enum class FaceMethod
{
  Paved,
  GridIfGood, ///< paved where grids are bad
  Grid
};

/// Quadrilaterals of a face for numbers of segments along its edges.
struct FaceMesh
{
  std::vector<int> Counts; ///< of its uses; empty: nothing is there yet
  bool Mapped = false;
  double Least = 0.0; ///< scaled Jacobian
  FaceQuads Quads;
  std::vector<int> LoopNodes; ///< that Quads.Nodes are of
  std::vector<Eigen::Vector2d> LoopPlaces;
  Status Failure;
};

/// Meshes one face after the other as often as the numbers of segments change, and joins them.
class FaceMesher
{
public:
  FaceMesher(const CADTopology& model, const CADQuadsParams& params);

  /// Segments of edges by their own length and turning.
  /// @return TooLarge, with the option that says so.
  Result<std::vector<int>> Wishes(const char* option) const;
  /// Finds the faces in which grids can lie.
  void FindShapes();
  const std::vector<RectangleFace>& Rectangles() const { return this->AllRectangles; }
  /// Their loops are opposite sides; the other two have no edges.
  const std::vector<RectangleFace>& Rings() const { return this->AllRings; }
  LogicalShapeKind Kind(int face) const
  {
    return this->Shapes[static_cast<std::size_t>(face)].Kind;
  }
  bool IsRectangle(int face) const { return this->Kind(face) == LogicalShapeKind::Rectangle; }
  /// What lies between the corners of a face's outer loop, from the first one on, without poles.
  std::vector<std::vector<CADTopologyUse>> Sides(int face) const;
  const FaceChart& Chart(int face) const { return this->Charts[static_cast<std::size_t>(face)]; }
  /// Lines of a grid may be longer and turn more than the sides that they run along.
  void RaiseWishes(const RectangleFace& rectangle, std::vector<int>& wishes) const;

  /// Meshes a face anew where its edges' numbers of segments have changed.
  /// @return failures of PaveFace, InvalidTopology where these numbers allow no grids that must be;
  /// the face has no quadrilaterals then.
  const Status& Mesh(int face, const EdgeNodes& nodes, FaceMethod method);
  /// Gives a face quadrilaterals that were made elsewhere, and smooths them.
  void Take(int face, FaceQuads quads);
  /// Wishes twice as many segments of the edges at a face's bad quadrilaterals, of all when it has
  /// none.
  void Halve(int face, const EdgeNodes& nodes, std::vector<int>& wishes) const;
  const FaceMesh& Of(int face) const { return this->Meshes[static_cast<std::size_t>(face)]; }
  /// The points of vertices and edges.
  CADQuads Begin(const EdgeNodes& nodes) const;
  /// Adds the quadrilaterals of a face, with their numbers. @return the mesh's points for those of
  /// the face.
  std::vector<int> Append(int face, CADQuads& made) const;

private:
  FaceQuads CoarseGrid(int face) const;
  Status MapFace(int face, const std::vector<ChartLoop>& loops, FaceMesh& state) const;

  const CADTopology& Model;
  const CADQuadsParams& Params;
  double EdgeLength;
  std::vector<FaceChart> Charts;
  std::vector<RectangleFace> AllRectangles;
  std::vector<RectangleFace> AllRings;
  std::vector<LogicalShape> Shapes;
  std::vector<FaceMesh> Meshes;
};
}
