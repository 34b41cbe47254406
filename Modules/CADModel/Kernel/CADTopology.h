// SPDX-License-Identifier: BSD-3-Clause
// Faces, edges and vertices of a CAD file as a mesher sees them: who borders whom, and places on
// them. What solids have in common is there once.
#pragma once
#include "CADExchange.h"

#include <knotwork/SplineCore/Types.h>

#include <Eigen/Core>

#include <array>
#include <functional>
#include <memory>

namespace knotwork
{
struct ModelBodies;

struct CADTopologyEdge
{
  std::array<int, 2> Vertices{}; ///< begin and end; equal ones: a closed edge
  double Length = 0.0;
  double Turning = 0.0; ///< sum of the tangent's turns along it, radians, found at 64 places
};

/// An edge in a loop.
struct CADTopologyUse
{
  int Edge = -1;         ///< -1: a side of the parameters that is a point, a pole
  bool Reversed = false; ///< the loop runs from the edge's end to its begin
  int Vertex = 0;        ///< that it begins at
};

/// A face. Loops have it on their left in the parameters; a seam stands in a loop twice. The first
/// loop is the outer one in the parameters.
struct CADTopologyFace
{
  std::vector<std::vector<CADTopologyUse>> Loops;
  std::vector<int> Ids;    ///< of ReadCAD; two where two solids share the face
  std::vector<int> Bodies; ///< one an id
  bool Reversed = false;   ///< its normal, outward of the first body, is that of -du x dv
  bool IsPlane = false;
  std::string Name;
  /// Of a composite (CADTopology::JoinComposites): ids of all its faces in the first body. Ids has
  /// the first of them. Empty: a face of the file.
  std::vector<int> Joined;
};

/// Lays triangles in space into the plane, without overlaps.
/// @return a row (x, y) for every point.
using CADFlattening = std::function<Result<PointMatrix>(
  const PointMatrix& points, const std::vector<std::array<int, 3>>& triangles)>;

/// A face of a body.
struct CADTopologySide
{
  int Face = 0;
  bool Reversed = false; ///< the body's outward normal is opposite to the face's
};

/// A solid, or a shell or face outside of solids, in ReadCAD's order.
struct CADTopologyBody
{
  std::vector<CADTopologySide> Sides;
  bool IsSolid = false;
};

/// Place on a face's surface.
struct CADPlace
{
  Eigen::Vector2d Parameters = Eigen::Vector2d::Zero();
  Eigen::Vector3d Point = Eigen::Vector3d::Zero();
};

/// The model of a file with OpenCASCADE behind it. Functions that take parameters extend surfaces
/// as OpenCASCADE does, periodic ones forever. Not for several threads at once.
class CADTopology
{
public:
  /// Vertices, edges and faces of different bodies are one when they agree within the tolerances
  /// of the file (at least 1e-7 of the diagonal).
  /// @param file  STEP, IGES or BREP.
  /// @return as of CheckCAD; EmptyInput: a file without faces; InvalidTopology: a loop that is not
  /// closed, naming the face.
  static Result<CADTopology> Read(
    const std::string& file, LengthUnit unit = LengthUnit::Millimetre);

  CADTopology() = default;
  CADTopology(CADTopology&&) noexcept = default;
  CADTopology& operator=(CADTopology&&) noexcept = default;

  /// Makes the faces of every composite (CADComposite.h) one face, as far as they have the same
  /// bodies and common edges that no other face has. Such edges, and vertices within, are no more;
  /// parameters of the face are places of its flattened triangles.
  /// @return a sentence for every composite that stays in faces, or in several parts, and why.
  std::vector<std::string> JoinComposites(const CADFlattening& flatten);

  /// Solids that touch in faces which they do not share, so that their meshes do not meet there:
  /// a place of one's face lies on the other's, with the opposite normal. Found at 8 x 8 places of
  /// the parameters of either face; smaller contacts may be missed.
  /// @return pairs of bodies, the lower first, each once, in order; InvalidFormat: OpenCASCADE
  /// fails. @complexity O(faces^2) boxes, and 128 projections a pair of faces whose boxes meet.
  Result<std::vector<std::array<int, 2>>> TouchingSolids() const;

  std::vector<Eigen::Vector3d> Vertices;
  std::vector<CADTopologyEdge> Edges;
  std::vector<CADTopologyFace> Faces;
  std::vector<CADTopologyBody> Bodies;
  double Diagonal = 0.0; ///< of the box of the faces

  /// @param share  of the length, in [0, 1].
  Eigen::Vector3d EdgePoint(int edge, double share) const;
  /// The same place in the parameters of a face, by one of its uses; the share is that of the use:
  /// 0 is where the loop enters it. Of a pole the share is that of the parameters.
  Eigen::Vector2d UseParameters(int face, int loop, int use, double share) const;
  Eigen::Vector3d FacePoint(int face, const Eigen::Vector2d& parameters) const;
  /// Unit length, outward of the first body; zero where the surface has none (the tip of a cone).
  Eigen::Vector3d FaceNormal(int face, const Eigen::Vector2d& parameters) const;
  /// Larger absolute principal curvature; 0 where there is none.
  double FaceCurvature(int face, const Eigen::Vector2d& parameters) const;
  /// Closest point of the (untrimmed) surface near a guess.
  CADPlace Project(int face, const Eigen::Vector3d& point, const Eigen::Vector2d& guess) const;

private:
  friend class CADPieces;
  struct Shapes;

  /// @param place  in messages.
  Status Build(const ModelBodies& bodies, const std::string& place);

  std::shared_ptr<Shapes> Impl; ///< knows how to destroy what others only declare
};
}
