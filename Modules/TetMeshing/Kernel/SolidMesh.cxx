// SPDX-License-Identifier: BSD-3-Clause
#include "SolidMesh.h"

#include "FlatCorners.h"
#include "SurfaceParts.h"
#include "TetrahedronShapes.h"

#include <knotwork/CADFitting/CurvedElements.h>
#include <knotwork/SplineCore/DisjointSets.h>
#include <knotwork/SplineCore/Numbers.h>
#include <knotwork/SurfaceRemeshing/FarthestDistance.h>
#include <knotwork/SurfaceRemeshing/SolidCheck.h>
#include <knotwork/SurfaceRemeshing/SoupTopology.h>
#include <knotwork/SurfaceRemeshing/SurfaceRepair.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace knotwork
{
namespace
{
constexpr double DistanceTolerance = 1e-4; ///< of the diagonal
/// Corners of the face opposite of a corner, outward.
constexpr std::array<std::array<int, 3>, 4> FaceCorners{ { { 1, 2, 3 }, { 0, 3, 2 }, { 0, 1, 3 },
  { 0, 2, 1 } } };

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

std::array<int, 3> Sorted(std::array<int, 3> corners)
{
  std::sort(corners.begin(), corners.end());
  return corners;
}

/// A part of the surface between a cell and another one, or the outside (-1).
struct Wall
{
  std::array<int, 2> Cells{ -1, -1 };
  std::array<int, 3> Corners{}; ///< outward seen from the first cell
  int Source = -1;
};

Status CheckParams(const SolidMeshParams& params)
{
  const TetrahedraParams& asked = params.Tetrahedra;
  const auto isBetween = [](double x, double low, double high) { return x >= low && x <= high; };
  if (asked.RadiusEdgeRatio != 0.0 && !isBetween(asked.RadiusEdgeRatio, 1.0, 10.0))
  {
    return { ErrorCode::InvalidParameter,
      "the radius-edge ratio is between 1 and 10, or 0 for no bound; " +
        Digits(asked.RadiusEdgeRatio) + " was given" };
  }
  if (!isBetween(asked.MinDihedralAngle, 0.0, 30.0))
  {
    return { ErrorCode::InvalidParameter,
      "the smallest dihedral angle is between 0 and 30 degrees; " + Digits(asked.MinDihedralAngle) +
        " was given" };
  }
  if (!isBetween(asked.MaxVolume, 0.0, LargestNumber))
  {
    return { ErrorCode::InvalidParameter, "the largest volume is a finite number, 0 for none" };
  }
  const auto isLength = [&](double length) { return length > 0.0 && length <= LargestNumber; };
  for (const RegionSize& size : asked.RegionSizes)
  {
    if (!isLength(size.Length) || !size.Point.allFinite())
    {
      return { ErrorCode::InvalidParameter,
        "lengths of edges in regions are above 0, at points that are numbers" };
    }
  }
  if (asked.Sizes.Cells.size() != asked.Sizes.Lengths.size() || !asked.Sizes.Points.allFinite())
  {
    return { ErrorCode::SizeMismatch,
      "the field of sizes has points that are no numbers, or not four lengths of edges a cell" };
  }
  for (std::size_t c = 0; c < asked.Sizes.Cells.size(); ++c)
  {
    const auto& corners = asked.Sizes.Cells[c];
    const auto& lengths = asked.Sizes.Lengths[c];
    if (!std::all_of(corners.begin(), corners.end(),
          [&](int corner) { return corner >= 0 && corner < asked.Sizes.Points.rows(); }) ||
      !std::all_of(lengths.begin(), lengths.end(), isLength))
    {
      return { ErrorCode::InvalidParameter,
        "cell " + std::to_string(c) +
          " of the field of sizes has a corner that is no point, or a length that is not above 0" };
    }
  }
  if (asked.MaxSteinerPoints < 0 || params.Order < 1 || params.Order > 3)
  {
    return { ErrorCode::InvalidParameter,
      "the order is 1, 2 or 3, and the number of added points is not negative" };
  }
  return {};
}

/// Whether a point lies in a tetrahedron, its sides included but for rounding.
bool IsIn(const Eigen::Vector3d& point, const PointMatrix& points, const std::array<int, 4>& cell)
{
  constexpr double Rounding = 1e-12;
  const auto corner = [&](std::size_t k) -> Eigen::Vector3d
  { return points.row(cell[k]).transpose(); };
  Eigen::Matrix3d edges;
  edges << corner(1) - corner(0), corner(2) - corner(0), corner(3) - corner(0);
  const Eigen::Vector3d shares = edges.partialPivLu().solve(point - corner(0));
  return std::min(shares.minCoeff(), 1.0 - shares.sum()) >= -Rounding;
}

class SolidMesher
{
public:
  SolidMesher(const SolidSurface& surface, const FitTarget* target, const SolidMeshParams& params)
    : Surface(surface), Target(target), Params(params)
  {
  }

  Result<SolidMesh> Make(Tetrahedra tetrahedra)
  {
    this->Found = std::move(tetrahedra);
    for (const auto& step :
      { &SolidMesher::CheckAnswer, &SolidMesher::FindWalls, &SolidMesher::FindRegions,
        &SolidMesher::CheckRegionSizes, &SolidMesher::MeasureStraight, &SolidMesher::Curve })
    {
      if (Status status = (this->*step)(); !status)
      {
        return status;
      }
      this->Done += 0.1;
      if (this->Params.Progress && !this->Params.Progress(this->Done))
      {
        return { ErrorCode::Aborted, "" };
      }
    }
    return std::move(this->Mesh);
  }

private:
  static Status NotFilled()
  {
    return { ErrorCode::LibraryError,
      "the tetrahedra do not fill the surface; repair it, or give it better triangles" };
  }

  /// Numbers in range; all cells turned alike.
  Status CheckAnswer()
  {
    const auto n = static_cast<int>(this->Found.Points.rows());
    const auto isPoint = [n](int i) { return i >= 0 && i < n; };
    const auto arePoints = [&](const auto& corners)
    { return std::all_of(corners.begin(), corners.end(), isPoint); };
    if (this->Found.Cells.empty() || this->Found.Triangles.size() != this->Found.Sources.size() ||
      (!this->Found.Labels.empty() && this->Found.Labels.size() != this->Found.Cells.size()) ||
      !std::all_of(this->Found.Cells.begin(), this->Found.Cells.end(), arePoints) ||
      !std::all_of(this->Found.Triangles.begin(), this->Found.Triangles.end(), arePoints) ||
      !std::all_of(this->Found.Sources.begin(), this->Found.Sources.end(),
        [&](int source) { return source >= 0 && At(source) < this->Surface.Triangles.size(); }) ||
      !this->Found.Points.allFinite())
    {
      return NotFilled();
    }
    if (MeasureTetrahedra(this->Found.Points, this->Found.Cells).Volume < 0.0)
    {
      for (auto& cell : this->Found.Cells)
      {
        std::swap(cell[0], cell[1]);
      }
    }
    if (this->Target && this->Params.Order > 1)
    {
      const auto added = n - static_cast<int>(this->Surface.Points.rows());
      DivideFlatCorners(
        this->Found, std::max(0, this->Params.Tetrahedra.MaxSteinerPoints - std::max(0, added)));
    }
    return {};
  }

  /// Where the surface is between cells; the others hang together.
  Status FindWalls()
  {
    struct Side
    {
      std::array<int, 3> Corners;
      int Cell;
      int Opposite;
    };
    std::vector<Side> sides;
    for (std::size_t c = 0; c < this->Found.Cells.size(); ++c)
    {
      for (int opposite = 0; opposite < 4; ++opposite)
      {
        sides.push_back({ Sorted(this->CornersOf(static_cast<int>(c), opposite)),
          static_cast<int>(c), opposite });
      }
    }
    std::sort(sides.begin(), sides.end(),
      [](const Side& a, const Side& b)
      { return std::tie(a.Corners, a.Cell) < std::tie(b.Corners, b.Cell); });
    std::vector<std::pair<std::array<int, 3>, int>> parts;
    for (std::size_t t = 0; t < this->Found.Triangles.size(); ++t)
    {
      parts.emplace_back(Sorted(this->Found.Triangles[t]), this->Found.Sources[t]);
    }
    std::sort(parts.begin(), parts.end());
    this->Pieces = DisjointSets(static_cast<int>(this->Found.Cells.size()));
    for (std::size_t i = 0; i < sides.size();)
    {
      const bool inner = i + 1 < sides.size() && sides[i + 1].Corners == sides[i].Corners;
      const auto part =
        std::lower_bound(parts.begin(), parts.end(), std::make_pair(sides[i].Corners, 0));
      const bool isWall = part != parts.end() && part->first == sides[i].Corners;
      if (isWall)
      {
        this->Walls.push_back({ { sides[i].Cell, inner ? sides[i + 1].Cell : -1 },
          this->CornersOf(sides[i].Cell, sides[i].Opposite), part->second });
      }
      else if (inner)
      {
        this->Pieces.Unite(sides[i].Cell, sides[i + 1].Cell);
      }
      else
      {
        return NotFilled();
      }
      i += inner ? 2 : 1;
    }
    return {};
  }

  std::array<int, 3> CornersOf(int cell, int opposite) const
  {
    const auto& corners = FaceCorners[At(opposite)];
    const auto& of = this->Found.Cells[At(cell)];
    return { of[At(corners[0])], of[At(corners[1])], of[At(corners[2])] };
  }

  /// Walls to be crossed from outside; voids go.
  Status FindRegions()
  {
    const std::size_t n = this->Found.Cells.size();
    std::vector<int> depths(n, -1); // of the pieces' first cells
    std::vector<std::vector<int>> neighbours(n);
    std::vector<int> front;
    const auto reach = [&](int piece, int depth, std::vector<int>& next)
    {
      if (depths[At(piece)] < 0)
      {
        depths[At(piece)] = depth;
        next.push_back(piece);
      }
    };
    for (const Wall& wall : this->Walls)
    {
      const int first = this->Pieces.Find(wall.Cells[0]);
      if (wall.Cells[1] < 0)
      {
        reach(first, 1, front);
        continue;
      }
      const int second = this->Pieces.Find(wall.Cells[1]);
      neighbours[At(first)].push_back(second);
      neighbours[At(second)].push_back(first);
    }
    for (int depth = 2; !front.empty(); ++depth)
    {
      std::vector<int> next;
      for (const int piece : front)
      {
        for (const int neighbour : neighbours[At(piece)])
        {
          reach(neighbour, depth, next);
        }
      }
      front = std::move(next);
    }
    this->RegionOf.assign(n, -1);
    std::vector<int> numbers(n, -1);
    std::vector<int> points(At(static_cast<int>(this->Found.Points.rows())), -1);
    for (std::size_t c = 0; c < n; ++c)
    {
      const int piece = this->Pieces.Find(static_cast<int>(c));
      if (this->Params.Inner == InnerParts::Voids && depths[At(piece)] % 2 == 0)
      {
        continue;
      }
      int& number = numbers[At(piece)];
      number = number < 0 ? this->Mesh.NumRegions++ : number;
      this->RegionOf[c] = number;
      this->Mesh.Regions.push_back(number);
      this->Cells.push_back(this->Found.Cells[c]);
      if (!this->Found.Labels.empty())
      {
        this->Mesh.Labels.push_back(this->Found.Labels[c]);
      }
      for (const int corner : this->Found.Cells[c])
      {
        points[At(corner)] = 0;
      }
    }
    this->Compact(points);
    return {};
  }

  /// Sizes are of regions that there are.
  Status CheckRegionSizes()
  {
    for (const RegionSize& size : this->Params.Tetrahedra.RegionSizes)
    {
      const Eigen::Vector3d& at = size.Point;
      if (std::none_of(this->Cells.begin(), this->Cells.end(),
            [&](const auto& cell) { return IsIn(at, this->Corners, cell); }))
      {
        return { ErrorCode::InvalidParameter,
          "the point (" + Digits(at.x()) + ", " + Digits(at.y()) + ", " + Digits(at.z()) +
            ") of a size lies in no region; give a point inside of the region" };
      }
    }
    return {};
  }

  /// Points of cells alone, in the order that they were in.
  void Compact(std::vector<int>& points)
  {
    int count = 0;
    for (int& point : points)
    {
      point = point < 0 ? -1 : count++;
    }
    this->Corners.resize(count, 3);
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      if (points[i] >= 0)
      {
        this->Corners.row(points[i]) = this->Found.Points.row(static_cast<Eigen::Index>(i));
      }
    }
    for (auto& cell : this->Cells)
    {
      for (int& corner : cell)
      {
        corner = points[At(corner)];
      }
    }
    for (const Wall& wall : this->Walls)
    {
      const int first = this->RegionOf[At(wall.Cells[0])];
      const int second = wall.Cells[1] < 0 ? -1 : this->RegionOf[At(wall.Cells[1])];
      if (first < 0 && second < 0)
      {
        continue;
      }
      std::array<int, 3> corners{ points[At(wall.Corners[0])], points[At(wall.Corners[1])],
        points[At(wall.Corners[2])] };
      if (first < 0 || (second >= 0 && second < first))
      {
        std::swap(corners[1], corners[2]);
      }
      this->Mesh.Boundary.push_back(corners);
      this->Mesh.BoundarySources.push_back(wall.Source);
    }
  }

  Status MeasureStraight()
  {
    SolidMeshNumbers& numbers = this->Mesh.Numbers;
    const TetrahedronShapes shapes = MeasureTetrahedra(this->Corners, this->Cells);
    numbers.MinDihedral = shapes.MinDihedral;
    numbers.MaxDihedral = shapes.MaxDihedral;
    numbers.WorstRadiusEdgeRatio = shapes.WorstRadiusEdgeRatio;
    numbers.SurfaceVolume = this->EnclosedVolume();
    numbers.Diagonal = this->Surface.Diagonal;
    if (this->IsKept())
    {
      return {};
    }
    const double tolerance = DistanceTolerance * this->Surface.Diagonal;
    const PartsDistance parts = MeasureParts(this->Surface.Points, this->Surface.Triangles,
      this->Corners, this->Mesh.Boundary, this->Mesh.BoundarySources, tolerance);
    numbers.DistanceToSurface = parts.OfParts;
    numbers.DistanceFromSurface = parts.OfSurface;
    if (!parts.Open.empty())
    {
      const LargestDistance open =
        FarthestFrom(TriangleIndex<3>(this->Corners, this->Mesh.Boundary), this->Surface.Points,
          parts.Open, DistanceTolerance * this->Surface.Diagonal);
      numbers.DistanceFromSurface = std::max(numbers.DistanceFromSurface, open.Value);
    }
    return {};
  }

  /// Whether the boundary is the surface's triangles, whatever their order.
  bool IsKept() const
  {
    using Places = std::array<std::array<double, 3>, 3>;
    const auto places = [](const PointMatrix& points, const std::vector<std::array<int, 3>>& of)
    {
      std::vector<Places> all;
      for (const auto& corners : of)
      {
        Places triangle;
        for (std::size_t i = 0; i < 3; ++i)
        {
          triangle[i] = { points(corners[i], 0), points(corners[i], 1), points(corners[i], 2) };
        }
        std::sort(triangle.begin(), triangle.end());
        all.push_back(triangle);
      }
      std::sort(all.begin(), all.end());
      return all;
    };
    return this->Mesh.Boundary.size() == this->Surface.Triangles.size() &&
      places(this->Corners, this->Mesh.Boundary) ==
      places(this->Surface.Points, this->Surface.Triangles);
  }

  /// Of the given triangles: a patch counts as often as it has the solid on its inner side alone,
  /// negative where it is on the other one alone.
  double EnclosedVolume() const
  {
    int count = 0;
    const std::vector<int> parts = NumberParts(this->Surface.Triangles, false, count);
    std::vector<int> sides(At(count), 0);
    for (const Wall& wall : this->Walls)
    {
      const bool first = this->RegionOf[At(wall.Cells[0])] >= 0;
      const bool second = wall.Cells[1] >= 0 && this->RegionOf[At(wall.Cells[1])] >= 0;
      if (first == second)
      {
        continue;
      }
      const auto& source = this->Surface.Triangles[At(wall.Source)];
      const bool alike =
        NormalOf(this->Surface.Points, source).dot(NormalOf(this->Found.Points, wall.Corners)) >
        0.0;
      sides[At(parts[At(wall.Source)])] = alike == first ? 1 : -1;
    }
    std::vector<std::vector<std::array<int, 3>>> triangles(2);
    for (std::size_t t = 0; t < parts.size(); ++t)
    {
      if (const int side = sides[At(parts[t])]; side != 0)
      {
        triangles[side > 0 ? 0 : 1].push_back(this->Surface.Triangles[t]);
      }
    }
    const PointMatrix centred =
      this->Surface.Points.rowwise() - this->Surface.Points.colwise().mean();
    return SignedVolume(centred, triangles[0]) - SignedVolume(centred, triangles[1]);
  }

  static Eigen::Vector3d NormalOf(const PointMatrix& points, const std::array<int, 3>& corners)
  {
    const Eigen::Vector3d a = points.row(corners[1]) - points.row(corners[0]);
    const Eigen::Vector3d b = points.row(corners[2]) - points.row(corners[0]);
    return a.cross(b);
  }

  Status Curve()
  {
    StraightElements elements;
    elements.Points = this->Corners;
    for (const auto& cell : this->Cells)
    {
      elements.Add(CellShape::Tetrahedron, { cell.begin(), cell.end() });
    }
    CurvedElementsParams params;
    params.Order = this->Params.Order;
    params.IsConforming = true;
    params.FarShare = LargestNumber; // the surface was made from the target, or is compared with it
    params.Threads = this->Params.Threads;
    for (const auto& corners : this->Mesh.Boundary)
    {
      params.Facets.push_back({ corners[0], corners[1], corners[2], -1 });
    }
    auto curved = CurveElements(elements, this->Target, params);
    if (!curved)
    {
      return curved.Status;
    }
    SolidMeshNumbers& numbers = this->Mesh.Numbers;
    numbers.RelaxedElements =
      static_cast<int>(std::count(curved->Relaxed.begin(), curved->Relaxed.end(), 1));
    numbers.BoundaryElements = curved->BoundaryElements;
    numbers.Volume = curved->Volume;
    numbers.StraightToTarget = std::max(0.0, curved->StraightToTarget.Largest);
    numbers.CurvedToTarget = std::max(0.0, curved->CurvedToTarget.Largest);
    this->Mesh.Points = std::move(curved->Points);
    this->Mesh.NumCorners = static_cast<int>(this->Corners.rows());
    this->Mesh.Certificate = std::move(curved->Certificate);
    for (std::size_t c = 0; c < this->Cells.size(); ++c)
    {
      const auto nodes = curved->Nodes.begin();
      this->Mesh.Cells.emplace_back(nodes + static_cast<std::ptrdiff_t>(curved->Begin[c]),
        nodes + static_cast<std::ptrdiff_t>(curved->Begin[c + 1]));
    }
    return {};
  }

  const SolidSurface& Surface;
  const FitTarget* Target;
  const SolidMeshParams& Params;
  Tetrahedra Found;
  DisjointSets Pieces;
  std::vector<Wall> Walls;
  std::vector<int> RegionOf; ///< of the found cells, -1: in a void
  PointMatrix Corners;
  std::vector<std::array<int, 4>> Cells;
  SolidMesh Mesh;
  double Done = 0.5;
};
}

int NumTetrahedronPoints(int order)
{
  return NumCellCoefficients(CellShape::Tetrahedron, { order, order, order });
}

std::vector<SolidMeshFacet> BoundaryFacets(const SolidMesh& mesh, int order)
{
  const CellDegree degree{ order, order, order };
  std::array<std::size_t, 4> atCorner{};
  for (int c = 0; c < 4; ++c)
  {
    atCorner[At(c)] = At(CellCoefficient(
      CellShape::Tetrahedron, degree, c == 1 ? order : 0, c == 2 ? order : 0, c == 3 ? order : 0));
  }
  std::vector<std::pair<std::array<int, 3>, int>> numbers;
  for (const auto& corners : mesh.Boundary)
  {
    numbers.emplace_back(Sorted(corners), static_cast<int>(numbers.size()));
  }
  std::sort(numbers.begin(), numbers.end());
  std::vector<SolidMeshFacet> facets(mesh.Boundary.size());
  for (std::size_t cell = 0; cell < mesh.Cells.size(); ++cell)
  {
    const std::vector<int>& nodes = mesh.Cells[cell];
    for (const auto& face : FaceCorners)
    {
      const std::array<int, 3> corners = Sorted({ nodes[atCorner[At(face[0])]],
        nodes[atCorner[At(face[1])]], nodes[atCorner[At(face[2])]] });
      const auto found =
        std::lower_bound(numbers.begin(), numbers.end(), std::make_pair(corners, 0));
      if (found == numbers.end() || found->first != corners || facets[At(found->second)].Cell >= 0)
      {
        continue;
      }
      SolidMeshFacet& facet = facets[At(found->second)];
      facet.Cell = static_cast<int>(cell);
      std::array<int, 3> local{}; // corners of the triangle, of the cell
      for (std::size_t k = 0; k < 3; ++k)
      {
        local[k] = *std::find_if(face.begin(), face.end(),
          [&](int corner)
          { return nodes[atCorner[At(corner)]] == mesh.Boundary[At(found->second)][k]; });
      }
      for (int j = 0; j <= order; ++j)
      {
        for (int i = 0; i + j <= order; ++i)
        {
          std::array<int, 4> weights{};
          weights[At(local[0])] = order - i - j;
          weights[At(local[1])] = i;
          weights[At(local[2])] = j;
          facet.Nodes.push_back(nodes[At(
            CellCoefficient(CellShape::Tetrahedron, degree, weights[1], weights[2], weights[3]))]);
        }
      }
    }
  }
  return facets;
}

Result<SolidMesh> MeshSolid(const TriangleMesh& surface, const FitTarget* target,
  const TetrahedraMaker& maker, const SolidMeshParams& params)
{
  if (Status status = CheckParams(params); !status)
  {
    return status;
  }
  SurfaceRepair repaired;
  auto solid = CheckSolid(surface, params.Threads);
  const bool repair = params.Repair && solid.Status.Code == ErrorCode::InvalidTopology;
  if (repair)
  {
    SurfaceRepairParams asked;
    asked.LargestHole = 1.0;
    asked.Threads = params.Threads;
    auto found = RepairSurface(surface, asked);
    if (!found)
    {
      return found.Status;
    }
    repaired = std::move(found.Value);
    solid = CheckSolid(repaired.Mesh, params.Threads);
  }
  if (!solid)
  {
    return solid.Status;
  }
  if (params.Progress && !params.Progress(0.1))
  {
    return { ErrorCode::Aborted, "" };
  }
  auto tetrahedra = maker({ solid->Points, solid->Triangles }, params.Tetrahedra);
  if (!tetrahedra)
  {
    return tetrahedra.Status;
  }
  const int oversized = tetrahedra->Oversized;
  auto mesh = SolidMesher(solid.Value, target, params).Make(std::move(tetrahedra.Value));
  if (mesh)
  {
    mesh->Numbers.Oversized = oversized;
  }
  if (mesh && repair)
  {
    mesh->Numbers.Repaired = true;
    mesh->Numbers.DistanceToSurface += repaired.DistanceFromInput;
    mesh->Numbers.DistanceFromSurface += repaired.DistanceToInput;
    for (int& source : mesh->BoundarySources)
    {
      source = repaired.TriangleIds[At(source)];
    }
  }
  return mesh;
}
}
