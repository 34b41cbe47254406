// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "CADQuads.h"
#include "HexahedronQuality.h"

namespace knotwork
{
struct CADHexesParams
{
  /// Of faces; Method does not count.
  CADQuadsParams Faces;
  int MaxHexahedra = 1000000;
  int Threads = 0;
};

/// How a solid was swept.
struct CADSolidHexes
{
  int Body = 0;
  std::vector<int> Source; ///< faces
  std::vector<int> Target;
  std::vector<int> Linking;
  int Layers = 0;
  int Hexahedra = 0;
  double LeastScaledJacobian = 1.0;
};

/// A side of a hexahedron on a face of the model.
struct CADHexFacet
{
  int Cell = 0;
  int Side = 0;     ///< 2 direction + end
  int Face = -1;    ///< CADTopology::Faces
  int NumCells = 0; ///< that have it; 2: it lies between two solids
};

/// Corners of a hexahedron's side, CellMesh's numbers (bit d is the end in direction d), in
/// tensor-product order as seen from outside.
std::array<int, 4> CornersOfHexSide(int side);

struct CADHexes
{
  CellMesh<3> Mesh; ///< right-handed
  PointMatrix Points;
  std::vector<int> HexBody;         ///< CADTopology::Bodies
  std::vector<int> HexLayer;        ///< from the source of its body, 0 first
  std::vector<int> PointDimension;  ///< 0 on a vertex, 1 on an edge, 2 on a face, 3 inside
  std::vector<int> PointEntity;     ///< which, of CADTopology's Vertices, Edges, Faces or Bodies
  std::vector<CADHexFacet> OnFaces; ///< by cell and side; what two solids share is there once
  std::vector<CADSolidHexes> Solids;
  int PaddedHexes = 0; ///< of all, those in layers under smooth surfaces
  HexahedronQuality Quality;
};

/// Conforming hexahedra in all solids of a model, each swept from faces to others. Faces that
/// solids share have one mesh; solids that touch along edges or at vertices alone are apart.
/// @return InvalidParameter; EmptyInput: no solids; TooLarge; InvalidTopology: a solid that cannot
/// be swept, with the faces that prevent it, or whose mesh does not suit that of its neighbours;
/// failures of MeasureHexahedra; Aborted. Hexahedra may be folded: Quality says so.
/// @complexity of sweeps: SweepBetween's; of faces: MeshQuads'.
Result<CADHexes> MeshHexes(const CADTopology& model, const CADHexesParams& params = {});
}
