// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>
#include <knotwork/SplineCore/TriangleIndex.h>
#include <knotwork/SplineCore/Types.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

/// Shapes that splines are fitted to.
namespace knotwork
{
/// What a point belongs on.
enum class TargetEntity : std::uint8_t
{
  Surface, ///< all faces
  Face,    ///< a part of the surface that sharp edges and rims enclose
  Curve,   ///< sharp edges and rims from corner to corner
  Vertex   ///< a corner, where curves end, cross or turn
};

struct TargetPart
{
  TargetEntity Entity = TargetEntity::Surface;
  int Id = -1; ///< number of the face, curve or vertex

  bool operator==(const TargetPart& other) const
  {
    return this->Entity == other.Entity && this->Id == other.Id;
  }
};

/// Closest points of n queries.
struct TargetPoints
{
  PointMatrix Points;     ///< n x 3
  PointMatrix Normals;    ///< n x 3, unit vectors; zero on curves and vertices
  std::vector<int> Faces; ///< that the points lie on; -1 on curves and vertices
};

/// Sharp edges or a rim in a row.
struct TargetCurve
{
  std::array<int, 2> Ends{ -1, -1 }; ///< corners; -1: it closes without a corner
  /// Along it, from end to end; of a closed curve the first one stands once.
  PointMatrix Points;
  int Body = 0; ///< FitTarget::BodiesOfFaces

  bool IsClosed() const { return this->Ends[0] < 0; }
  /// Whether it ends at the corner where it begins, as the outline of a drop.
  bool IsLoop() const { return this->Ends[0] >= 0 && this->Ends[0] == this->Ends[1]; }
};

/// Points of a surface and the areas that they stand for.
struct TargetSamples
{
  PointMatrix Points; ///< n x 3
  Eigen::VectorXd Areas;
  std::vector<int> Faces;
};

/// A shape by its closest points. Read-only, so that queries may run in parallel.
class FitTarget
{
public:
  virtual ~FitTarget();

  int NumFaces() const { return this->FaceCount; }
  const std::vector<TargetCurve>& Curves() const { return this->CurveList; }
  const PointMatrix& Vertices() const { return this->VertexList; }
  /// Whether the surface has no rim. A target of curves alone has no surface.
  bool IsClosed() const { return this->Closed; }
  bool HasSurface() const { return this->FaceCount > 0; }
  /// Closed bodies of the surface that share no edge, of every face, from 1 on; 0: others. Empty:
  /// all is one. Curves and corners have theirs.
  const std::vector<int>& BodiesOfFaces() const { return this->FaceBodies; }
  int BodyOfVertex(int vertex) const
  {
    return this->VertexBodies.empty() ? 0 : this->VertexBodies[static_cast<std::size_t>(vertex)];
  }

  /// Closest points on one part, for queries in any order; such that come near each other one after
  /// the other are the quickest.
  /// @param queries  n x 3, finite.
  /// @return NotConverged with the query that has no closest point (implicit surfaces).
  virtual Status Find(
    const TargetPart& part, const PointMatrixView& queries, TargetPoints& result) const = 0;

  /// At least so many points, spread by area. @return none where there is no surface.
  virtual TargetSamples Samples(int atLeast) const = 0;

  /// The triangles that the surface consists of; null where it is no such mesh.
  virtual const TriangleIndex<3>* Triangles() const;

protected:
  int FaceCount = 0;
  std::vector<TargetCurve> CurveList;
  PointMatrix VertexList;
  std::vector<int> FaceBodies;
  std::vector<int> VertexBodies;
  bool Closed = false;
};

using FitTargetPtr = std::shared_ptr<const FitTarget>;

/// Closest points of a line of straight pieces.
class PolylineFoot
{
public:
  /// @param points  n x 3, n >= 1. @param closed  the last one is joined with the first.
  PolylineFoot(PointMatrix points, bool closed);

  struct Foot
  {
    Eigen::RowVector3d Point;
    double Length = 0.0; ///< along the line
    double Distance = 0.0;
  };
  Foot Nearest(const Eigen::RowVector3d& query) const;
  Eigen::RowVector3d At(double length) const;
  double Length() const { return this->Lengths.back(); }
  bool IsClosed() const { return this->Closed; }

private:
  PointMatrix Points; ///< a closed line ends with its first point
  std::vector<double> Lengths;
  bool Closed;
};

/// The line of a curve, closed where the curve is, or is a loop.
PolylineFoot LineOf(const TargetCurve& curve);
}
