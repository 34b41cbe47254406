// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/AnalyticSurface.h>
#include <knotwork/SplineCore/Spline.h>

#include <string>

/// Boundary representation: trimmed faces that share edges and vertices.
namespace knotwork
{
/// The use of an edge by a loop: the edge's curve in space and its image in the parameter plane
/// of the face (pcurve), which are one spline in x, y, z, u, v.
struct TrimmingCurve
{
  Spline<1> Curve; ///< n x 3 control points, a tensor space; the same in all uses of an edge
  PointMatrix UV;  ///< n x 2 control points in the space (and with the weights) of Curve
  int Edge = 0;    ///< uses of one edge have the same number, in [0, NumEdges)
  std::array<int, 2> Vertices{ 0, 0 }; ///< at the curve's begin and end, in [0, NumVertices)
  bool Reversed = false;               ///< the loop runs the curve from its end to its begin

  /// The pcurve as a spline of its own.
  Spline<1> ParameterCurve() const;
};

/// Curves end to end, closed. The face lies to the left in the parameter plane.
struct TrimmedLoop
{
  std::vector<TrimmingCurve> Curves;
};

struct TrimmedFace
{
  Spline<2> Surface; ///< n x 3 control points, a tensor space
  /// The outer loop first, counterclockwise in the parameter plane; holes clockwise. Empty: the
  /// whole surface.
  std::vector<TrimmedLoop> Loops;
  bool Reversed = false; ///< the face's normal is opposite to S_u x S_v
  /// What the surface is: CAD files hold it as such where it is no free form.
  SurfaceType Type = SurfaceType::FreeForm;
  int Body = 0; ///< faces of one body are sewn together along common edges
  std::string Name;
  bool HasColor = false;
  std::array<double, 3> Color{}; ///< red, green, blue in [0, 1]
};

struct TrimmedModel
{
  std::vector<TrimmedFace> Faces;
  int NumEdges = 0;
  int NumVertices = 0;

  /// SizeMismatch, NonFiniteInput, InvalidWeight (as Spline::Check), DimensionMismatch,
  /// InvalidTopology: numbers of edges and vertices out of range, a loop that does not close by its
  /// vertices. Details name face, loop and curve.
  Status Check() const;
};

/// Appends the faces of another model, as bodies, edges and vertices of their own.
void AppendFaces(TrimmedModel& model, TrimmedModel other);

/// Diagonal of the box of all control points; 0 without faces.
double SizeOf(const TrimmedModel& model);
}
