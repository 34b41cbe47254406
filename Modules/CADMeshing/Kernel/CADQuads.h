// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "CADMesh.h"
#include <knotwork/CADModel/CADTopology.h>
#include <knotwork/SplineCore/Types.h>

namespace knotwork
{
enum class CADQuadMethod
{
  Automatic = 0, ///< mapped where a face has a shape for grids, else unstructured
  Mapped,        ///< all faces must be
  Unstructured
};

struct CADQuadsParams
{
  CADQuadMethod Method = CADQuadMethod::Automatic;
  double EdgeLength = 0.0; ///< of quadrilaterals; 0: a twentieth of the diagonal
  double Curvature = 30.0; ///< degrees that an edge or surface turns along a segment, (0, 90]
  int MinDivisions = 2;    ///< segments of every edge, [1, 100000]
  int MaxQuads = 1000000;
  /// Every solid has points and quadrilaterals of its own, of the faces that it shares, too: closed
  /// surfaces. Else shared faces are meshed once, and three faces may meet at an edge.
  bool SolidsApart = false;
  ProgressCallback Progress;
};

struct CADFaceQuads
{
  int Face = 0;
  bool Mapped = false;
  int Quads = 0;
  int ExtraordinaryPoints = 0; ///< inside of the face, where other than four quadrilaterals meet
  double LeastScaledJacobian = 1.0;
  double Distance = 0.0; ///< farthest that middles of quadrilaterals and their sides are from it
};

struct CADQuads
{
  CADMesh Mesh;
  std::vector<double> ScaledJacobians; ///< of quadrilaterals: smallest sine of their angles
  /// Of quadrilaterals: which of the bodies at their face they lead out of, 0 or 1.
  std::vector<int> BodyOfFace;
  std::vector<int> Divisions;      ///< of edges
  std::vector<CADFaceQuads> Faces; ///< one a face of the model
  int EulerNumber = 0;
  bool Closed = false; ///< no edge of the mesh has one quadrilateral only
  int ExtraordinaryPoints =
    0; ///< of edges with two quadrilaterals, where other than four of these meet
  double LeastScaledJacobian = 1.0;
  double Distance = 0.0;
};

/// Makes every composite of a model one face, whose parameters are an injective map of its
/// triangles to the plane.
/// @return a sentence for every composite that stays in faces, or in several parts, and why.
std::vector<std::string> JoinComposites(CADTopology& model);

/// Conforming quadrilaterals on all faces of a model. Every edge is divided once, by equal lengths,
/// into an even number of segments; rectangles, rings, discs and polygons become grids, other faces
/// are triangulated, joined and divided to quadrilaterals. Inner points are moved on the surface
/// until the corners are good. Edges of faces where that fails are divided into twice as many, at
/// most three times.
/// @return InvalidParameter; EmptyInput: no faces; TooLarge; InvalidTopology: a face that is not
/// mapped where all must be, or that cannot be meshed, naming it; Aborted.
Result<CADQuads> MeshQuads(const CADTopology& model, const CADQuadsParams& params = {});
}
