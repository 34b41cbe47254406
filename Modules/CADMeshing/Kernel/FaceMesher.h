// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "CADQuads.h"
#include "EdgeDivisions.h"
#include "FaceQuads.h"

namespace knotwork
{
/// @return InvalidParameter.
Status CheckParams(const CADQuadsParams& params);

/// "face 3 ('name')", as files number and name it.
std::string FaceName(const CADTopology& model, int face);

enum class FaceMethod
{
  Paved,
  GridIfGood, ///< paved where the grid is bad
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
  /// Finds the faces that are logical rectangles.
  void FindRectangles();
  const std::vector<RectangleFace>& Rectangles() const { return this->AllRectangles; }
  /// First uses of its four sides; empty: it is no rectangle.
  const std::vector<int>& Corners(int face) const
  {
    return this->CornersOfFaces[static_cast<std::size_t>(face)];
  }
  /// The sides of a rectangle, in the order of its loop; empty ones: it is none.
  std::array<std::vector<CADTopologyUse>, 4> Sides(int face) const;
  const FaceChart& Chart(int face) const { return this->Charts[static_cast<std::size_t>(face)]; }
  /// Lines of a grid may be longer and turn more than the sides that they run along.
  void RaiseWishes(const RectangleFace& rectangle, std::vector<int>& wishes) const;

  /// Meshes a face anew where its edges' numbers of segments have changed.
  /// @return failures of PaveFace; the face has no quadrilaterals then.
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

  const CADTopology& Model;
  const CADQuadsParams& Params;
  double EdgeLength;
  std::vector<FaceChart> Charts;
  std::vector<RectangleFace> AllRectangles;
  std::vector<std::vector<int>> CornersOfFaces; ///< uses; empty: no rectangle
  std::vector<FaceMesh> Meshes;
};
}
