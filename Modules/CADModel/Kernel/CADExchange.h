// SPDX-License-Identifier: BSD-3-Clause
// STEP and IGES files through OpenCASCADE, and its own BREP files for reading. The format follows
// from the ending of the file name: .step, .stp, .iges, .igs, .brep, in any case. OpenCASCADE keeps
// global settings: calls wait for each other, and what they set is restored. Nothing is printed.
// OpenCASCADE's reader of IGES may crash on damaged files (its reader of STEP is told of damage
// first).
#pragma once
#include <knotwork/SplineCore/TrimmedModel.h>

namespace knotwork
{
/// What one unit of length in a file is; the numbers in it are those of the model.
enum class LengthUnit
{
  Micrometre,
  Millimetre,
  Centimetre,
  Metre,
  Inch,
  Foot
};
inline constexpr int NumLengthUnits = 6;

/// Application protocol of a STEP file.
enum class STEPSchema
{
  AP214,
  AP242
};

struct CADWriteParams
{
  LengthUnit Unit = LengthUnit::Millimetre;
  STEPSchema Schema = STEPSchema::AP214;
  /// Sides of faces without loops are one edge when they are nowhere farther apart at equal (or
  /// opposite) parameters than this share of the model's size, in (0, 0.1].
  double SewTolerance = 1e-6;
  std::string Name = "Knotwork"; ///< of the product
};

/// Whether a file name has one of the endings.
bool HasCADEnding(const std::string& file);

/// Writes trimmed faces: B-spline surfaces, curves in space and pcurves of the same
/// parametrization, common edges and vertices. Faces of a body that hang together are a shell, a
/// closed one is a solid with its normals outward; faces are turned where neighbours of a body
/// disagree. A face without loops gets the sides of its surface; a side of one point is a
/// degenerate edge. Names and colours of faces are kept (IGES: names of up to 8 characters).
///
/// Tolerances of edges and vertices are the largest distance found between curve and image of the
/// pcurve (16 samples a knot span) times 1.02, at least 1e-7. A file that exists is replaced only
/// when everything could be written.
///
/// Faces of a Type other than free form are written as that plane, cylinder, sphere, cone or torus,
/// with lines and circles as edges where all faces along them are such, if the spline is that
/// surface within a billionth of its size; tori on both sides of where their turning angle begins,
/// and surfaces that are wound around more than once, stay splines.
///
/// OpenCASCADE reads a surface with seam and poles rightly or not by where its loops begin in a
/// STEP file: files with those or with curved types are read again and compared (CompareCAD) before
/// they are there; where they differ, spheres, cones and tori stay splines.
/// @return failures of TrimmedModel::Check; InvalidParameter: ending, SewTolerance;
/// InvalidKnots: a curve or surface that jumps; OutsideDomain: a pcurve that leaves its surface;
/// InvalidTopology: uses of an edge that do not fit each other; InvalidFormat: OpenCASCADE refuses
/// or reads something else; FileError: the file cannot be written, with the system's reason.
Status WriteCAD(
  const TrimmedModel& model, const std::string& file, const CADWriteParams& params = {});

/// What OpenCASCADE finds in a file that it reads with its default settings.
struct CADSummary
{
  bool Valid = false;               ///< BRepCheck_Analyzer has no complaint
  std::vector<std::string> Defects; ///< the first ten complaints in words
  int NumSolids = 0;
  int NumShells = 0;
  int NumFaces = 0;
  int NumWires = 0;
  int NumEdges = 0; ///< without degenerate ones
  int NumVertices = 0;
  int NumFreeLoops = 0; ///< connected pieces of what edges of a single face make
  double MaxEdgeTolerance = 0.0;
  double MaxVertexTolerance = 0.0;
  double Area = 0.0;
  std::vector<double> FaceAreas;    ///< in the file's order
  bool Closed = false;              ///< no free edge
  double Volume = 0.0;              ///< of the solids; 0 when it was not asked for
  std::array<double, 3> BoxLower{}; ///< of the faces, found on their poles and curves:
  std::array<double, 3> BoxUpper{}; ///< it holds the shape
};

/// Reads a file again and checks it.
/// @param unit  of lengths in the summary.
/// @param volume  whether it is wanted: of faces with many spans it costs more than all checks.
/// @return FileError: no such file; EmptyInput: nothing in it; InvalidFormat: damaged.
Result<CADSummary> CheckCAD(
  const std::string& file, LengthUnit unit = LengthUnit::Millimetre, bool volume = true);

/// Whether a file has the geometry of the model that was written: as many faces have the areas of
/// the model's faces, one to one (more faces the same area together), and all lie in the box.
/// The model's areas are bounded on the cells of surfaces inside of and across the loops; those
/// that OpenCASCADE found may lie 0.5 % outside of the bounds, the faces a thousandth of the box's
/// size outside of the box.
/// @param summary  as CheckCAD gives it, in the model's unit.
/// @param others  when not null: those of the FaceAreas that no face of the model has.
/// @return failures of TrimmedRegion; InvalidFormat: they differ, naming the face and the areas, or
/// faces are missing.
Status CompareCAD(
  const TrimmedModel& model, const CADSummary& summary, std::vector<std::size_t>* others = nullptr);

/// CheckCAD without volumes of a file that a model was written to in millimetres, and CompareCAD.
/// Areas that no face of the model has are measured again on a fine raster of the face's
/// parameters: OpenCASCADE's quadrature is some hundredths off where a face is small in a surface
/// of many spans, whatever its tolerance.
Result<CADSummary> CheckWrittenCAD(const TrimmedModel& model, const std::string& file);

struct CADReadParams
{
  LengthUnit Unit = LengthUnit::Millimetre; ///< of lengths in the model
  /// Edges whose curve and pcurves have no exact common form (their parametrizations differ) become
  /// cubic within this distance, unit of the model; 0: a millionth of the model's size.
  double Tolerance = 0.0;
};

struct CADContents
{
  TrimmedModel Model;
  double MaxGap = 0.0; ///< largest distance found between a curve and the image of its pcurve
  int NumRefitted = 0; ///< edges that became cubic
  std::vector<std::string> Warnings; ///< what is not as it should be, one line each
  std::vector<std::string> LeftOut;  ///< faces of the file that are not here and why, one line each
};

/// Faces of a STEP, IGES or BREP file (of a BREP file lengths are millimetres, and it has neither
/// names nor colours). B-spline surfaces come as they are, others (planes, cylinders,
/// spheres, ...) as the rational spline that is the same surface over the face's part of it;
/// periodic ones are cut open. Loops of a face come with pcurves, also along seams, and with
/// degenerate edges (a curve of equal points). Assemblies are resolved; a solid, a shell and a face
/// that is in neither is a body each. Names of faces are theirs, else their product's unless that
/// is "Knotwork"; colours are those of face, shell or solid, the nearest one.
///
/// What WriteCAD wrote comes back bit for bit, as far as a STEP file says it: surfaces, curves and
/// pcurves of splines with clamped knots whose surfaces are not closed.
/// @return as of CheckCAD; InvalidParameter; EmptyInput: a file without faces.
Result<CADContents> ReadCAD(const std::string& file, const CADReadParams& params = {});
}
