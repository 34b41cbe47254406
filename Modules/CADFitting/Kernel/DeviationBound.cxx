// SPDX-License-Identifier: BSD-3-Clause
#include "DeviationBound.h"

#include <knotwork/SplineCore/Parallel.h>
#include <knotwork/SplineCore/Tessellation.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr std::size_t ChunkSize = 64;   ///< triangles
constexpr std::size_t AtOnce = 1 << 15; ///< triangles between two calls of the progress
constexpr double Rounding = 1e-13;      ///< of the coordinates
/// Halvings of an element a direction, and facets; where there would be more the tolerance grows.
constexpr int MostHalvings = 4;
constexpr int MostFacets = 2000000;
constexpr int MostTolerances = 4;
constexpr double ToleranceGrowth = 4.0;
/// Share of the polygon's size that must lie on both sides of a cut.
constexpr double LeastCut = 1e-9;

using Point = Eigen::RowVector3d;

/// A convex part of a triangle.
struct Polygon
{
  double Bound = 0.0; ///< of its distance from the mesh
  int Nearest = -1;   ///< the triangle that the bound is from
  std::vector<Point> Corners;
  std::vector<std::array<int, 2>> Cuts; ///< edges of the mesh that it was cut along

  bool operator<(const Polygon& other) const { return this->Bound < other.Bound; }
};

/// Bounds of the distance of triangles from a mesh. Keeps its buffers: one object a thread.
class OneSidedBound
{
public:
  OneSidedBound(const TriangleIndex<3>& mesh, const DeviationBoundParams& params)
    : Mesh(mesh), Params(params)
  {
  }

  double Bound(const Point& a, const Point& b, const Point& c)
  {
    this->Found = 0.0;
    this->Open.clear();
    double settled = 0.0;
    Polygon whole;
    whole.Corners = { a, b, c };
    const auto keep = [&](Polygon& polygon)
    {
      this->Measure(polygon);
      if (polygon.Bound <= this->Goal())
      {
        settled = std::max(settled, polygon.Bound);
        return;
      }
      this->Open.push_back(std::move(polygon));
      std::push_heap(this->Open.begin(), this->Open.end());
    };
    keep(whole);
    int pieces = 1;
    while (!this->Open.empty() && this->Open.front().Bound > this->Goal() &&
      pieces < this->Params.MaxPieces)
    {
      std::pop_heap(this->Open.begin(), this->Open.end());
      const Polygon polygon = std::move(this->Open.back());
      this->Open.pop_back();
      std::array<Polygon, 2> parts;
      std::vector<std::array<int, 2>> cuts = polygon.Cuts;
      if (!this->CutBetween(polygon, parts, cuts) && !CutAcross(polygon, parts))
      {
        settled = std::max(settled, polygon.Bound); // a point but for rounding
        continue;
      }
      for (Polygon& part : parts)
      {
        part.Bound = polygon.Bound;
        part.Nearest = polygon.Nearest;
        part.Cuts = cuts;
        keep(part);
        ++pieces;
      }
    }
    return this->Open.empty() ? settled : std::max(settled, this->Open.front().Bound);
  }

private:
  double Goal() const { return std::max(this->Params.Enough, this->Params.Ratio * this->Found); }

  double Farthest(const Polygon& polygon, int triangle) const
  {
    double largest = 0.0;
    for (const Point& corner : polygon.Corners)
    {
      largest = std::max(largest, this->Mesh.Foot(triangle, corner.data()).SquaredDistance);
    }
    return std::sqrt(largest);
  }

  /// Nearest triangle of a point; the last one's distance bounds the search.
  int NearestOf(const Point& point)
  {
    const double bound = this->Last < 0 ? std::numeric_limits<double>::infinity()
                                        : this->Mesh.Foot(this->Last, point.data()).SquaredDistance;
    const TriangleFoot foot = this->Mesh.Nearest(point.data(), bound);
    this->Last = foot.Triangle >= 0 ? foot.Triangle : this->Last;
    const double distance = std::min(bound, foot.SquaredDistance);
    this->Found = std::max(this->Found, std::sqrt(distance));
    return this->Last;
  }

  void Measure(Polygon& polygon)
  {
    if (polygon.Nearest < 0)
    {
      polygon.Bound = std::numeric_limits<double>::infinity();
    }
    Point middle = Point::Zero();
    for (const Point& corner : polygon.Corners)
    {
      middle += corner;
    }
    this->Take(polygon, this->NearestOf(middle / static_cast<double>(polygon.Corners.size())));
    for (std::size_t k = 0; k < polygon.Corners.size() && polygon.Bound > this->Goal(); ++k)
    {
      this->Take(polygon, this->NearestOf(polygon.Corners[k]));
    }
  }

  void Take(Polygon& polygon, int triangle) const
  {
    const double bound = this->Farthest(polygon, triangle);
    if (bound < polygon.Bound)
    {
      polygon.Bound = bound;
      polygon.Nearest = triangle;
    }
  }

  /// Along the plane between the triangle that is nearest as a whole and that of the corner which
  /// is farthest from it, where they have an edge in common.
  bool CutBetween(
    const Polygon& polygon, std::array<Polygon, 2>& parts, std::vector<std::array<int, 2>>& cuts)
  {
    const Point* farthest = nullptr;
    double largest = -1.0;
    for (const Point& corner : polygon.Corners)
    {
      const double distance = this->Mesh.Foot(polygon.Nearest, corner.data()).SquaredDistance;
      if (distance > largest)
      {
        largest = distance;
        farthest = &corner;
      }
    }
    const int other = this->NearestOf(*farthest);
    const MeshTriangle& a = this->Mesh.Triangles()[static_cast<std::size_t>(polygon.Nearest)];
    const MeshTriangle& b = this->Mesh.Triangles()[static_cast<std::size_t>(other)];
    std::vector<int> common;
    std::copy_if(a.begin(), a.end(), std::back_inserter(common),
      [&](int corner) { return std::find(b.begin(), b.end(), corner) != b.end(); });
    if (common.size() != 2)
    {
      return false;
    }
    const std::array<int, 2> ends{ std::min(common[0], common[1]), std::max(common[0], common[1]) };
    if (std::find(cuts.begin(), cuts.end(), ends) != cuts.end())
    {
      return false; // it lies on one side
    }
    cuts.push_back(ends);
    const Point origin = this->Mesh.Points().row(common[0]);
    const Point edge = this->Mesh.Points().row(common[1]) - origin;
    const Point normal = edge.cross(this->Normal(polygon.Nearest) + this->Normal(other));
    return Cut(polygon, origin, normal.normalized(), parts);
  }

  Point Normal(int triangle) const
  {
    const auto corner = [&](int k) -> Point
    { return Eigen::Map<const Point>(this->Mesh.Corner(triangle, k)); };
    return (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
  }

  static bool CutAcross(const Polygon& polygon, std::array<Polygon, 2>& parts)
  {
    std::array<Point, 2> ends{ polygon.Corners[0], polygon.Corners[0] };
    for (const Point& a : polygon.Corners)
    {
      for (const Point& b : polygon.Corners)
      {
        if ((b - a).squaredNorm() > (ends[1] - ends[0]).squaredNorm())
        {
          ends = { a, b };
        }
      }
    }
    return Cut(polygon, 0.5 * (ends[0] + ends[1]), Point(ends[1] - ends[0]).normalized(), parts);
  }

  /// @return false when the polygon lies on one side.
  static bool Cut(
    const Polygon& polygon, const Point& origin, const Point& normal, std::array<Polygon, 2>& parts)
  {
    const std::size_t count = polygon.Corners.size();
    std::vector<double> heights;
    double size = 0.0;
    for (const Point& corner : polygon.Corners)
    {
      heights.push_back((corner - origin).dot(normal));
      size = std::max(size, (corner - polygon.Corners[0]).norm());
    }
    const double least = LeastCut * size;
    if (!(*std::min_element(heights.begin(), heights.end()) < -least) ||
      !(*std::max_element(heights.begin(), heights.end()) > least))
    {
      return false;
    }
    for (std::size_t k = 0; k < count; ++k)
    {
      const double here = heights[k];
      const double next = heights[(k + 1) % count];
      if (here <= 0.0)
      {
        parts[0].Corners.push_back(polygon.Corners[k]);
      }
      if (here >= 0.0)
      {
        parts[1].Corners.push_back(polygon.Corners[k]);
      }
      if ((here < 0.0 && next > 0.0) || (here > 0.0 && next < 0.0))
      {
        const Point at = polygon.Corners[k] +
          here / (here - next) * (polygon.Corners[(k + 1) % count] - polygon.Corners[k]);
        parts[0].Corners.push_back(at);
        parts[1].Corners.push_back(at);
      }
    }
    return true;
  }

  const TriangleIndex<3>& Mesh;
  const DeviationBoundParams& Params;
  double Found = 0.0;
  int Last = -1;
  std::vector<Polygon> Open; ///< heap, the largest bound first
};

/// Bounds of the distances of triangles from a mesh, one each.
Status BoundTriangles(const TriangleIndex<3>& from, const TriangleIndex<3>& to,
  const DeviationBoundParams& params, double begin, std::vector<double>& bounds)
{
  const std::size_t count = from.Triangles().size();
  bounds.assign(count, 0.0);
  for (std::size_t first = 0; first < count; first += AtOnce)
  {
    if (params.Progress &&
      !params.Progress(begin + 0.5 * static_cast<double>(first) / static_cast<double>(count)))
    {
      return { ErrorCode::Aborted, "bounding distances stopped" };
    }
    ParallelFor(std::min(AtOnce, count - first), ChunkSize, params.Threads,
      [&](std::size_t lower, std::size_t upper)
      {
        OneSidedBound search(to, params);
        for (std::size_t t = first + lower; t < first + upper; ++t)
        {
          const auto corner = [&](int k) -> Point
          { return Eigen::Map<const Point>(from.Corner(static_cast<int>(t), k)); };
          bounds[t] = search.Bound(corner(0), corner(1), corner(2));
        }
      });
  }
  return {};
}

/// Facets of a surface, with the element of each.
Result<TessellationMesh> MakeFacets(
  const BezierForm<2>& surface, const DeviationBoundParams& params)
{
  TessellationParams tessellation;
  tessellation.Tolerance = params.Tolerance;
  tessellation.MaximumSubdivision = MostHalvings;
  tessellation.MaxCells = MostFacets;
  tessellation.Normals = false;
  tessellation.Threads = params.Threads;
  auto facets = Tessellate<2>({ surface }, tessellation);
  for (int k = 0; k < MostTolerances && facets.Status.Code == ErrorCode::TooLarge; ++k)
  {
    tessellation.Tolerance *= ToleranceGrowth;
    facets = Tessellate<2>({ surface }, tessellation);
  }
  return facets;
}
}

Result<DeviationBound> BoundSurfaceDeviation(
  const BezierForm<2>& surface, const TriangleIndex<3>& mesh, const DeviationBoundParams& params)
{
  if (mesh.Triangles().empty())
  {
    return { ErrorCode::EmptyInput, "no triangles to bound distances from" };
  }
  if (!(params.Tolerance > 0.0) || !(params.Enough >= 0.0) || !(params.Ratio > 1.0) ||
    params.MaxPieces < 1)
  {
    return { ErrorCode::InvalidParameter,
      "tolerance must be above 0, enough 0 or more, the ratio above 1, pieces 1 or more" };
  }
  auto made = MakeFacets(surface, params);
  if (!made)
  {
    return made.Status;
  }
  std::vector<MeshTriangle> triangles;
  std::vector<int> elementOf;
  for (std::size_t c = 0; c < made->Shapes.size(); ++c)
  {
    // triangles of a box's corners are as near to the map as its bilinear interpolation
    const std::int64_t begin = made->Offsets[c];
    const auto corner = [&](std::int64_t k)
    { return static_cast<int>(made->Connectivity[static_cast<std::size_t>(begin + k)]); };
    for (std::int64_t k = 2; k < made->Offsets[c + 1] - begin; ++k)
    {
      triangles.push_back({ corner(0), corner(k - 1), corner(k) });
      elementOf.push_back(made->CellElement[c]);
    }
  }
  Result<DeviationBound> result;
  result->Flatness = made->Bound;
  const double scale =
    std::max(made->Points.cwiseAbs().maxCoeff(), mesh.Points().cwiseAbs().maxCoeff());
  const double extra = made->Bound + Rounding * scale;
  const TriangleIndex<3> facets(std::move(made->Points), std::move(triangles));
  // nearer than the facets are to the surface is of no use
  DeviationBoundParams enough = params;
  enough.Enough = std::max(params.Enough, made->Bound);
  std::vector<double> ofFacets;
  Status status = BoundTriangles(facets, mesh, enough, 0.0, ofFacets);
  status = status ? BoundTriangles(mesh, facets, enough, 0.5, result->OfTriangles) : status;
  if (!status)
  {
    return status;
  }
  result->OfElements.assign(static_cast<std::size_t>(surface.Space->NumElements()), 0.0);
  for (std::size_t f = 0; f < ofFacets.size(); ++f)
  {
    double& own = result->OfElements[static_cast<std::size_t>(elementOf[f])];
    own = std::max(own, ofFacets[f] + extra);
  }
  for (double& bound : result->OfTriangles)
  {
    bound += extra;
  }
  result->OfSurface = *std::max_element(result->OfElements.begin(), result->OfElements.end());
  result->OfMesh = *std::max_element(result->OfTriangles.begin(), result->OfTriangles.end());
  return result;
}
}
