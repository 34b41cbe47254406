// SPDX-License-Identifier: BSD-3-Clause
// Private to the triangulation of faces.
#pragma once
#include "EdgeSampling.h"
#include "PlanarRegion.h"
#include <knotwork/SplineCore/TrimmedModel.h>

namespace knotwork
{
/// An edge as all faces along it have it.
struct SampledEdge
{
  BezierForm<1> Curve;            ///< without a space: on the surface of its only face
  std::vector<double> Parameters; ///< ascending, with both ends of the curve
  PointMatrix Points;             ///< a row a parameter
  bool Collapsed = false;         ///< to one vertex
  bool OnSurface() const { return this->Curve.Space == nullptr; }
};

/// The side of an edge in a face.
struct EdgeSide
{
  int Edge = 0;
  std::array<int, 2> Vertices{};
  bool Reversed = false;
  PlaneCurve Curve;
};

/// Where a triangulation needs another point.
struct PointRequest
{
  double Excess = 0.0; ///< what the deviation is above what is allowed
  int Edge = -1;       ///< at Parameter of this edge, -1: at UV of the face
  double Parameter = 0.0;
  std::array<double, 2> UV{};
};

/// A point of a face's triangulation.
struct FacePoint
{
  std::array<double, 2> UV{};
  int Vertex = -1;  ///< of the model, or
  int Edge = -1;    ///< of the model, and
  int Sample = -1;  ///< row of SampledEdge::Points
  double Gap = 0.0; ///< distance from the surface's value there
};

/// Triangles of one face over the samples of its edges and points of its own.
class FaceTriangulation
{
public:
  const TrimmedFace* Face = nullptr;
  BezierForm<2> Form;
  SurfaceCells Cells;
  std::vector<std::vector<EdgeSide>> Loops;

  // What Update found.
  std::vector<FacePoint> Points;
  std::vector<std::array<int, 3>> Triangles; ///< counterclockwise in the parameter plane
  std::vector<PointRequest> Requests;        ///< largest excess first
  bool Simple =
    false;            ///< false: polygons cross or are not nested, requests are those that may help
  double Bound = 0.0; ///< of the distance of triangles and surface

  /// Fixes the plane in which triangles are made: parameters scaled to about lengths.
  void SetPlane(const std::vector<SampledEdge>& edges);
  /// About |S_u x S_v|.
  double MeanSize() const { return this->Scale[0] * this->Scale[1]; }
  /// A point of the face's own, inside its loops.
  void AddInterior(std::array<double, 2> uv) { this->Interior.push_back(uv); }
  /// Triangulates anew.
  /// @param vertices  n x 3.
  Status Update(const std::vector<SampledEdge>& edges, const PointMatrix& vertices,
    double tolerance, int threads);

private:
  struct Side // a segment of a polygon
  {
    int Edge;
    std::array<double, 2> Parameters; ///< of the edge, in the loop's direction
    const PlaneCurve* Curve;
    std::array<double, 2> Outside; ///< how far the ends were outside the domain
  };
  struct Verdict // on a triangle
  {
    double Bound = 0.0;
    double Excess = 0.0; ///< above what is allowed
    int Edge = 0;        ///< the edge to divide begins at this corner
    double Share = 0.5;  ///< there
  };
  PlanarPoint Planar(const std::array<double, 2>& uv) const;
  void CollectBoundary(const std::vector<SampledEdge>& edges);
  void MeasureGaps(const std::vector<SampledEdge>& edges, const PointMatrix& vertices);
  void ChooseInterior();
  Verdict CheckTriangle(std::size_t t, const std::vector<double>& off, double tolerance) const;
  void CheckTriangles(double tolerance, int threads);
  void RequestPoints(const std::vector<Verdict>& verdicts);
  int FindSide(int a, int b) const;
  void RequestSide(std::size_t side, double excess, double share = 0.5);
  double OffSide(std::size_t side) const;

  std::array<double, 2> Scale{ 1.0, 1.0 };
  std::array<double, 2> Middle{ 0.0, 0.0 };
  double Grid = 1.0;
  bool HasInterior = false;
  std::vector<std::array<double, 2>> Interior;
  std::vector<PlanarPoint> Plane;
  std::vector<PlanarSegment> Segments;
  std::vector<Side> Sides; ///< of Segments
  std::vector<std::pair<PlanarSegment, int>> SidesByEnds;
};
}
