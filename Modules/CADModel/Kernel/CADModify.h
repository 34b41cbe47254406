// SPDX-License-Identifier: BSD-3-Clause
// Modification of a STEP file: solids share faces, become pieces, faces become parts.
#pragma once
#include "CADExchange.h"
#include <knotwork/SplineCore/Spline.h>

#include <Eigen/Core>

#include <map>

namespace knotwork
{
enum class CADOperationKind
{
  Imprint,          ///< solids that touch share faces, edges and vertices (general fuse)
  CutByPlane,       ///< solids become pieces along the plane of Point and Direction
  CutByFace,        ///< along the extended surface of the face Tool
  CutByCylinder,    ///< along the cylinder around the axis of Point and Direction, with Radius
  SplitByPlane,     ///< Faces become parts along the plane of Point and Direction
  SplitByParameter, ///< Faces become parts along an iso-line of their surface
  Composite,        ///< Faces count as one: joined where they lie on one surface, else a group
  SplitByCurve,     ///< Faces become parts along Curves, which are projected to them
  Heal              ///< all bodies, also those outside of solids, are mended within Tolerance
};

/// What is to be done. Face ids are those of ReadCAD, at the time of the operation.
struct CADOperation
{
  CADOperationKind Kind = CADOperationKind::Imprint;
  std::vector<int> Faces; ///< of a split, not empty; of a composite, neighbours of one body
  int Tool = -1;          ///< face of CutByFace: a plane, cylinder, sphere or torus
  Eigen::Vector3d Point = Eigen::Vector3d::Zero();
  Eigen::Vector3d Direction = Eigen::Vector3d::UnitZ(); ///< any length but 0
  double Radius = 0.0;                                  ///< of CutByCylinder, > 0
  int IsoDirection = 0;          ///< of SplitByParameter: 0 u is constant, 1 v is
  double Share = 0.5;            ///< where, of the face's range of that parameter, in (0, 1)
  std::vector<Spline<1>> Curves; ///< of SplitByCurve, in space, not empty
  double Tolerance = 0.0;        ///< of Heal: what lies nearer is one place; finite, > 0
};

/// What an operation Heal did.
struct CADHealing
{
  int TurnedFaces = 0;  ///< their orientation is another one in their body
  int TurnedSolids = 0; ///< all faces of a solid
  int SewnEdges = 0;    ///< fewer edges border one face only
  int NewSolids = 0;    ///< closed shells that were no solids
  int RemovedEdges = 0; ///< fewer edges are shorter than the tolerance
  int RemovedFaces = 0; ///< narrower than the tolerance
  int ClosedGaps = 0;   ///< fewer joints of loops where the edges' curves do not meet
  std::map<std::string, int> Messages; ///< of OpenCASCADE's ShapeFix, each with its number
  std::vector<std::string> Unmended;   ///< what is left, one sentence each; bodies as after it
};

struct CADCounts
{
  int Solids = 0;
  int Faces = 0; ///< shared ones once, as edges and vertices
  int Edges = 0; ///< without degenerate ones
  int Vertices = 0;
  int FaceIds = 0; ///< faces of all bodies: shared ones twice
  double Volume = 0.0;
};

/// What an operation Composite made.
struct CADComposite
{
  std::string Name;       ///< of the group; empty: there is one face, which needs none
  std::vector<int> Faces; ///< ids after the operation
};

/// What one operation did.
struct CADStep
{
  CADOperationKind Kind = CADOperationKind::Imprint;
  CADCounts Before;
  CADCounts After;
  double VolumeChange = 0.0; ///< share of the volume that was lost or won
  double Overlap = 0.0;      ///< volume that lay in two solids; it belongs to the first of them now
  std::vector<std::vector<int>> NewFaces; ///< ids after it of each face id before it
  CADHealing Healing;
  CADComposite Composite;
};

struct CADModifyParams
{
  LengthUnit Unit = LengthUnit::Millimetre; ///< of lengths in operations and results
  /// Largest change of the solids' volume by an operation, as a share of it, in [0, 1]. What lay in
  /// two solids is counted once.
  double VolumeTolerance = 1e-9;
};

/// What became of a file.
struct ModifiedCAD
{
  std::vector<CADStep> Steps; ///< one an operation
  std::string Text;           ///< of the new file
};

/// Reads a STEP file, runs the operations in their order and checks the shapes after each
/// (BRepCheck_Analyzer). The text is a STEP file in the unit of the first one, read again and
/// compared, or a BREP file. Names and colours of products, instances, solids and faces and the
/// tree of assemblies are kept; an instance that was changed becomes a product of its own.
/// OpenCASCADE writes each solid of a STEP file by itself: what solids share is there once for
/// each, equal and at the same place. A BREP file keeps it shared, without names, colours and
/// assembly. Shells and faces outside of solids stay as they are but for Heal. Composites travel in
/// the names of their faces (CADComposite.h).
/// @param output  says the format by its ending, and is named in messages; it is not written.
/// @return EmptyInput: no operations, no solid; InvalidParameter: options outside of their ranges,
/// ids that are not there; NonFiniteInput; OutsideDomain: what meets nothing; InvalidTopology:
/// shapes that are not valid before or after an operation, or volume that is not kept;
/// DimensionMismatch, SizeMismatch, InvalidWeight, InvalidKnots: curves; InvalidFormat, FileError:
/// as ReadCAD.
Result<ModifiedCAD> ModifyCADText(const std::string& file, const std::string& output,
  const std::vector<CADOperation>& operations, const CADModifyParams& params = {});

/// ModifyCADText, and writes the file, all or nothing.
/// @return further FileError: it cannot be written.
Result<std::vector<CADStep>> ModifyCAD(const std::string& file, const std::string& output,
  const std::vector<CADOperation>& operations, const CADModifyParams& params = {});
}
