// SPDX-License-Identifier: BSD-3-Clause
#include "TargetNodes.h"

#include "TargetDistances.h"

#include <knotwork/SplineCore/Numbers.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace knotwork
{
namespace
{
constexpr double SharpCosine = 0.94; ///< 20 degrees between normals: an edge that may be sharp
constexpr double NearCurve =
  0.3; ///< of an edge's length: how far its curve may be (arcs to 120 degrees)
constexpr double FarthestMove = 0.5; ///< of an edge's length
/// Along edges, between points of the orders 2 to 4, and the middle: where distances are sampled.
constexpr std::array<double, 5> SampleShares{ 0.1, 0.37, 0.5, 0.63, 0.9 };
/// Within triangles, barycentric, and all that turning these gives.
constexpr std::array<std::array<double, 3>, 5> TrianglePlaces{ { { 0.8, 0.1, 0.1 },
  { 0.45, 0.45, 0.1 }, { 0.63, 0.27, 0.1 }, { 0.27, 0.63, 0.1 }, { 0.37, 0.37, 0.26 } } };

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// An edge of the boundary.
struct BoundaryEdge
{
  std::array<int, 2> Ends{};
  std::vector<int> Facets;
  int Curve = -1; ///< of the target
};

int NumFacetCorners(const FaceCorners& corners)
{
  return corners[3] < 0 ? 3 : 4;
}

class NodePlacement
{
public:
  NodePlacement(const FitTarget& target, const std::vector<int>& facets, const NodeLattice& lattice,
    const PointMatrix& corners, const CurvedElementsParams& params, CurvedNodes& nodes,
    PlacedPoints& placed)
    : Target(target), Facets(facets), Lattice(lattice), Corners(corners), Params(params),
      Nodes(nodes), Count(placed)
  {
  }

  Status Place()
  {
    this->CollectEdges();
    for (const auto& step : { &NodePlacement::FindFaces, &NodePlacement::FindCurves,
           &NodePlacement::PlaceCorners, &NodePlacement::PlaceEdges, &NodePlacement::PlaceFaces })
    {
      if (Status status = (this->*step)(); !status)
      {
        return status;
      }
    }
    return {};
  }

  /// Curves of the target that no edge lies on.
  int NumUnmatched() const
  {
    std::set<int> found;
    for (const BoundaryEdge& edge : this->Edges)
    {
      found.insert(edge.Curve);
    }
    found.erase(-1);
    return static_cast<int>(this->Target.Curves().size() - found.size());
  }

private:
  struct Query
  {
    int Node;
    TargetPart Part;
    double Length; ///< of the edge, which bounds the way
    Eigen::RowVector3d From;
    Eigen::RowVector3d Base; ///< where it is without a target
  };

  Eigen::RowVector3d Placed(int node) const { return this->Nodes.Positions().row(node); }

  const FaceCorners& FacetCorners(std::size_t facet) const
  {
    return this->Lattice.Faces[At(this->Facets[facet])];
  }

  void CollectEdges()
  {
    std::map<std::array<int, 2>, std::vector<int>> found;
    for (std::size_t f = 0; f < this->Facets.size(); ++f)
    {
      const FaceCorners& corners = this->FacetCorners(f);
      const int count = NumFacetCorners(corners);
      for (int i = 0; i < count; ++i)
      {
        const auto ends = std::minmax(corners[At(i)], corners[At((i + 1) % count)]);
        found[{ ends.first, ends.second }].push_back(static_cast<int>(f));
      }
    }
    for (auto& [ends, facets] : found)
    {
      this->Edges.push_back({ ends, std::move(facets), -1 });
    }
  }

  double Length(const BoundaryEdge& edge) const
  {
    return (this->Corners.row(edge.Ends[0]) - this->Corners.row(edge.Ends[1])).norm();
  }

  /// Up to its sign.
  Eigen::Vector3d Normal(int facet) const
  {
    const FaceCorners& c = this->FacetCorners(At(facet));
    const int last = c[3] < 0 ? c[0] : c[3];
    const Eigen::Vector3d a = this->Corners.row(c[2]) - this->Corners.row(c[0]);
    const Eigen::Vector3d b = this->Corners.row(last) - this->Corners.row(c[1]);
    return a.cross(b).normalized();
  }

  Status FindFaces()
  {
    PointMatrix middles(static_cast<Eigen::Index>(this->Facets.size()), 3);
    for (std::size_t f = 0; f < this->Facets.size(); ++f)
    {
      const FaceCorners& corners = this->FacetCorners(f);
      const int count = NumFacetCorners(corners);
      Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
      for (int i = 0; i < count; ++i)
      {
        sum += this->Corners.row(corners[At(i)]);
      }
      middles.row(static_cast<Eigen::Index>(f)) = sum / count;
    }
    TargetDistanceParams params;
    params.Threads = this->Params.Threads;
    TargetPoints feet;
    if (Status status = FindOnTarget(this->Target, middles, feet, params); !status)
    {
      return status;
    }
    this->Faces = std::move(feet.Faces);
    const double mean = (feet.Points - middles).rowwise().norm().mean();
    const double size =
      (feet.Points.colwise().maxCoeff() - feet.Points.colwise().minCoeff()).norm();
    if (this->Facets.size() > 1 && !(mean <= this->Params.FarShare * size))
    {
      return { ErrorCode::InvalidParameter,
        "the mesh is " + Digits(mean) +
          " from its target in the mean, whose closest points extend "
          "over " +
          Digits(size) + ": give both in the same unit and place" };
    }
    return {};
  }

  /// The face that all facets of an edge lie on, -1: several.
  int FaceOf(const std::vector<int>& facets) const
  {
    int face = this->Faces[At(facets.front())];
    for (const int facet : facets)
    {
      face = this->Faces[At(facet)] == face ? face : -1;
    }
    return face;
  }

  /// Faces are ordered by their corners and not turned alike: of the two angles between planes the
  /// one is taken that the facets' middles tell, seen from their edge.
  double CosineBetween(const BoundaryEdge& edge) const
  {
    const Eigen::Vector3d begin = this->Corners.row(edge.Ends[0]);
    const Eigen::Vector3d along =
      (Eigen::Vector3d(this->Corners.row(edge.Ends[1])) - begin).normalized();
    std::array<Eigen::Vector3d, 2> across;
    for (std::size_t i = 0; i < 2; ++i)
    {
      const Eigen::Vector3d normal = this->Normal(edge.Facets[i]);
      const FaceCorners& corners = this->FacetCorners(At(edge.Facets[i]));
      Eigen::Vector3d middle = Eigen::Vector3d::Zero();
      for (int k = 0; k < NumFacetCorners(corners); ++k)
      {
        middle += Eigen::Vector3d(this->Corners.row(corners[At(k)])) - begin;
      }
      across[i] = normal.cross(along);
      across[i] *= across[i].dot(middle) < 0.0 ? -1.0 : 1.0;
    }
    return -across[0].dot(across[1]);
  }

  bool MayBeSharp(const BoundaryEdge& edge) const
  {
    return this->FaceOf(edge.Facets) < 0 || edge.Facets.size() != 2 ||
      this->CosineBetween(edge) < SharpCosine;
  }

  Status FindCurves()
  {
    const auto& curves = this->Target.Curves();
    std::vector<double> nearest(this->Edges.size(), NearCurve);
    for (std::size_t c = 0; c < curves.size(); ++c)
    {
      const Eigen::RowVector3d lower = curves[c].Points.colwise().minCoeff();
      const Eigen::RowVector3d upper = curves[c].Points.colwise().maxCoeff();
      std::vector<std::size_t> candidates;
      for (std::size_t e = 0; e < this->Edges.size(); ++e)
      {
        const BoundaryEdge& edge = this->Edges[e];
        const Eigen::RowVector3d a = this->Corners.row(edge.Ends[0]);
        const Eigen::RowVector3d b = this->Corners.row(edge.Ends[1]);
        const double reach = this->Length(edge);
        if (this->MayBeSharp(edge) && ((a.cwiseMax(b) - lower).array() >= -reach).all() &&
          ((upper - a.cwiseMin(b)).array() >= -reach).all())
        {
          candidates.push_back(e);
        }
      }
      PointMatrix queries(static_cast<Eigen::Index>(3 * candidates.size()), 3);
      for (std::size_t i = 0; i < candidates.size(); ++i)
      {
        const BoundaryEdge& edge = this->Edges[candidates[i]];
        const auto row = static_cast<Eigen::Index>(3 * i);
        queries.row(row) = this->Corners.row(edge.Ends[0]);
        queries.row(row + 1) = this->Corners.row(edge.Ends[1]);
        queries.row(row + 2) = 0.5 * (queries.row(row) + queries.row(row + 1));
      }
      PointMatrix feet;
      if (Status status = this->Find({ TargetEntity::Curve, static_cast<int>(c) }, queries, feet);
          !status)
      {
        return status;
      }
      for (std::size_t i = 0; i < candidates.size(); ++i)
      {
        BoundaryEdge& edge = this->Edges[candidates[i]];
        const auto row = static_cast<Eigen::Index>(3 * i);
        // the ends' feet lie apart: an edge across a curve is near to it, too
        const double length = this->Length(edge);
        if ((feet.row(row) - feet.row(row + 1)).norm() < 0.5 * length)
        {
          continue;
        }
        const double distance =
          (feet.middleRows(row, 3) - queries.middleRows(row, 3)).rowwise().norm().maxCoeff() /
          length;
        if (distance < nearest[candidates[i]])
        {
          nearest[candidates[i]] = distance;
          edge.Curve = static_cast<int>(c);
        }
      }
    }
    return {};
  }

  Status Find(const TargetPart& part, const PointMatrix& queries, PointMatrix& feet) const
  {
    TargetDistanceParams params;
    params.Threads = this->Params.Threads;
    params.Part = part;
    TargetPoints found;
    Status status = FindOnTarget(this->Target, queries, found, params);
    feet = std::move(found.Points);
    return status;
  }

  /// Nearest corner of the target, -1: none is nearer than the distance.
  int NearestVertex(const Eigen::RowVector3d& point, double within) const
  {
    int nearest = -1;
    for (Eigen::Index v = 0; v < this->Target.Vertices().rows(); ++v)
    {
      const double distance = (this->Target.Vertices().row(v) - point).norm();
      if (distance < within)
      {
        within = distance;
        nearest = static_cast<int>(v);
      }
    }
    return nearest;
  }

  Status PlaceCorners()
  {
    struct Corner
    {
      double Shortest = std::numeric_limits<double>::infinity();
      std::vector<int> Curves; ///< one an edge
      std::set<int> Faces;
    };
    std::map<int, Corner> corners;
    for (const BoundaryEdge& edge : this->Edges)
    {
      for (const int end : edge.Ends)
      {
        Corner& corner = corners[end];
        corner.Shortest = std::min(corner.Shortest, this->Length(edge));
        if (edge.Curve >= 0)
        {
          corner.Curves.push_back(edge.Curve);
        }
        for (const int facet : edge.Facets)
        {
          corner.Faces.insert(this->Faces[At(facet)]);
        }
      }
    }
    std::vector<Query> queries;
    for (const auto& [number, corner] : corners)
    {
      const Eigen::RowVector3d at = this->Corners.row(number);
      Query query{ number, {}, corner.Shortest, at, at };
      const bool ends = !corner.Curves.empty() &&
        (corner.Curves.size() != 2 || corner.Curves[0] != corner.Curves[1]);
      const int vertex = ends ? this->NearestVertex(at, FarthestMove * corner.Shortest) : -1;
      if (vertex >= 0)
      {
        query.Part = { TargetEntity::Vertex, vertex };
      }
      else if (!corner.Curves.empty())
      {
        query.Part = { TargetEntity::Curve, corner.Curves.front() };
      }
      else if (corner.Faces.size() == 1)
      {
        query.Part = { TargetEntity::Face, *corner.Faces.begin() };
      }
      queries.push_back(query);
    }
    return this->PlaceQueries(queries);
  }

  /// Points of orders 3 and 4 start from the parabola through the foot of the edge's middle: so
  /// they come to lie more evenly along the curve than from the straight edge.
  Status PlaceEdges()
  {
    std::vector<Query> middles;
    std::vector<int> numbers;
    for (const BoundaryEdge& edge : this->Edges)
    {
      TargetPart part;
      if (edge.Curve >= 0)
      {
        part = { TargetEntity::Curve, edge.Curve };
      }
      else if (const int face = this->FaceOf(edge.Facets); face >= 0)
      {
        part = { TargetEntity::Face, face };
      }
      numbers.push_back(this->Lattice.FindEdge(edge.Ends[0], edge.Ends[1]));
      const Eigen::RowVector3d middle =
        0.5 * (this->Placed(edge.Ends[0]) + this->Placed(edge.Ends[1]));
      middles.push_back({ -1, part, this->Length(edge), middle, middle });
    }
    std::vector<Eigen::RowVector3d> feet;
    if (Status status = this->FindFeet(middles, feet); !status)
    {
      return status;
    }
    std::vector<Query> queries;
    for (std::size_t e = 0; e < this->Edges.size(); ++e)
    {
      const Eigen::RowVector3d bulge = 4.0 * (feet[e] - middles[e].From);
      for (int k = 1; k < this->Lattice.Order; ++k)
      {
        Query query = middles[e];
        const double t = static_cast<double>(k) / this->Lattice.Order;
        query.Node = this->Lattice.EdgeNode(numbers[e], k);
        query.Base = this->Nodes.EdgeBase(numbers[e], k);
        query.From = query.Base;
        if (this->Lattice.Order > 2 && bulge.norm() <= 4.0 * FarthestMove * query.Length)
        {
          query.From += t * (1.0 - t) * bulge;
        }
        queries.push_back(query);
      }
    }
    return this->PlaceQueries(queries);
  }

  Status PlaceFaces()
  {
    std::vector<Query> queries;
    for (std::size_t f = 0; f < this->Facets.size(); ++f)
    {
      const FaceCorners& corners = this->FacetCorners(f);
      const int face = this->Faces[f];
      const double length = (this->Corners.row(corners[0]) - this->Corners.row(corners[1])).norm();
      const std::vector<int> inside = this->Nodes.InsideFace(this->Facets[f]);
      if (inside.empty())
      {
        continue;
      }
      const PointMatrix base = this->Nodes.FaceBase(this->Facets[f]);
      for (std::size_t i = 0; i < inside.size(); ++i)
      {
        const Eigen::RowVector3d at = base.row(static_cast<Eigen::Index>(i));
        queries.push_back({ inside[i],
          face < 0 ? TargetPart() : TargetPart{ TargetEntity::Face, face }, length, at, at });
      }
    }
    return this->PlaceQueries(queries);
  }

  /// Closest points, part by part.
  Status FindFeet(const std::vector<Query>& queries, std::vector<Eigen::RowVector3d>& feet) const
  {
    std::map<std::pair<TargetEntity, int>, std::vector<std::size_t>> parts;
    for (std::size_t i = 0; i < queries.size(); ++i)
    {
      parts[{ queries[i].Part.Entity, queries[i].Part.Id }].push_back(i);
    }
    feet.resize(queries.size());
    for (const auto& [part, members] : parts)
    {
      PointMatrix from(static_cast<Eigen::Index>(members.size()), 3);
      for (std::size_t i = 0; i < members.size(); ++i)
      {
        from.row(static_cast<Eigen::Index>(i)) = queries[members[i]].From;
      }
      PointMatrix found;
      if (Status status = this->Find({ part.first, part.second }, from, found); !status)
      {
        return status;
      }
      for (std::size_t i = 0; i < members.size(); ++i)
      {
        feet[members[i]] = found.row(static_cast<Eigen::Index>(i));
      }
    }
    return {};
  }

  Status PlaceQueries(const std::vector<Query>& queries)
  {
    std::vector<Eigen::RowVector3d> feet;
    if (Status status = this->FindFeet(queries, feet); !status)
    {
      return status;
    }
    for (std::size_t i = 0; i < queries.size(); ++i)
    {
      const Query& query = queries[i];
      if ((feet[i] - query.From).norm() > FarthestMove * query.Length)
      {
        ++this->Count.Left;
        this->Nodes.Hold(query.Node);
        continue;
      }
      this->Nodes.Place(query.Node, query.Base, feet[i]);
      int& count = query.Part.Entity == TargetEntity::Vertex ? this->Count.OnVertices
        : query.Part.Entity == TargetEntity::Curve           ? this->Count.OnCurves
                                                             : this->Count.OnFaces;
      ++count;
    }
    return {};
  }

  const FitTarget& Target;
  const std::vector<int>& Facets;
  const NodeLattice& Lattice;
  const PointMatrix& Corners;
  const CurvedElementsParams& Params;
  CurvedNodes& Nodes;
  PlacedPoints& Count;
  std::vector<BoundaryEdge> Edges;
  std::vector<int> Faces; ///< of the target, one a facet
};

/// Places in a facet where distances are sampled.
std::vector<std::array<double, 3>> SamplePlaces(CellShape shape)
{
  std::vector<std::array<double, 3>> places;
  if (shape == CellShape::Triangle)
  {
    places.push_back({ 1.0 / 3.0, 1.0 / 3.0, 0.0 });
    for (const auto& place : TrianglePlaces)
    {
      for (std::size_t turn = 0; turn < 3; ++turn)
      {
        places.push_back({ place[turn], place[(turn + 1) % 3], 0.0 });
      }
    }
    for (const double share : SampleShares)
    {
      places.insert(
        places.end(), { { share, 0.0, 0.0 }, { 0.0, share, 0.0 }, { share, 1.0 - share, 0.0 } });
    }
    return places;
  }
  for (const double u : SampleShares)
  {
    for (const double v : { 0.0, 0.1, 0.37, 0.5, 0.63, 0.9, 1.0 })
    {
      places.push_back({ u, v, 0.0 });
    }
    places.insert(places.end(), { { 0.0, u, 0.0 }, { 1.0, u, 0.0 } });
  }
  return places;
}

/// Values of the polynomials of the facet's points at the places: one row a place.
Eigen::MatrixXd ValuesAt(const NodeTable& table, CellShape shape, int order,
  const std::vector<std::array<double, 3>>& places)
{
  BernsteinCells cells;
  cells.NumComponents = 1;
  const CellDegree degree = DegreeOf(shape, order);
  const auto count = static_cast<Eigen::Index>(NumCellCoefficients(shape, degree));
  Eigen::MatrixXd values(static_cast<Eigen::Index>(places.size()), count);
  for (Eigen::Index i = 0; i < count; ++i)
  {
    const int cell = cells.Add(shape, degree);
    std::copy_n(table.ToBezier.col(i).data(), count, cells.Block(cell));
    for (std::size_t k = 0; k < places.size(); ++k)
    {
      EvaluateCell(cells, cell, places[k], &values(static_cast<Eigen::Index>(k), i));
    }
  }
  return values;
}

double AreaOf(const PointMatrix& points, const FaceCorners& corners)
{
  const int last = corners[3] < 0 ? corners[0] : corners[3];
  const Eigen::Vector3d a = points.row(corners[2]) - points.row(corners[0]);
  const Eigen::Vector3d b = points.row(last) - points.row(corners[1]);
  return 0.5 * a.cross(b).norm();
}
}

Status PlaceOnTarget(const FitTarget& target, const std::vector<int>& facets,
  const NodeLattice& lattice, const PointMatrix& corners, const CurvedElementsParams& params,
  CurvedNodes& nodes, PlacedPoints& placed, int& unmatched)
{
  NodePlacement placement(target, facets, lattice, corners, params, nodes, placed);
  Status status = placement.Place();
  unmatched = placement.NumUnmatched();
  return status;
}

Result<DistanceSummary> MeasureFacets(const FitTarget& target, const std::vector<int>& facets,
  const NodeLattice& lattice, const PointMatrix& points, int threads, std::vector<double>& farthest)
{
  std::array<Eigen::MatrixXd, 2> values; // of triangles and quadrilaterals
  for (const CellShape shape : { CellShape::Triangle, CellShape::Quadrilateral })
  {
    values[shape == CellShape::Triangle ? 0 : 1] =
      ValuesAt(lattice.Table(shape), shape, lattice.Order, SamplePlaces(shape));
  }
  const auto valuesOf = [&](int facet) -> const Eigen::MatrixXd&
  { return values[lattice.FaceShape(facet) == CellShape::Triangle ? 0 : 1]; };
  Eigen::Index count = 0;
  for (const int facet : facets)
  {
    count += valuesOf(facet).rows();
  }
  PointMatrix samples(count, 3);
  Eigen::Index row = 0;
  for (const int facet : facets)
  {
    const std::size_t begin = lattice.FaceBegin[At(facet)];
    const std::size_t end = lattice.FaceBegin[At(facet) + 1];
    PointMatrix own(static_cast<Eigen::Index>(end - begin), 3);
    for (std::size_t i = begin; i < end; ++i)
    {
      own.row(static_cast<Eigen::Index>(i - begin)) = points.row(lattice.FaceNodes[i]);
    }
    samples.middleRows(row, valuesOf(facet).rows()) = valuesOf(facet) * own;
    row += valuesOf(facet).rows();
  }
  TargetDistanceParams params;
  params.Threads = threads;
  TargetPoints feet;
  if (Status status = FindOnTarget(target, samples, feet, params); !status)
  {
    return status;
  }
  const Eigen::VectorXd distances = (feet.Points - samples).rowwise().norm();
  DistanceSummary summary;
  summary.Largest = 0.0;
  double squares = 0.0;
  double areas = 0.0;
  farthest.clear();
  row = 0;
  for (const int facet : facets)
  {
    const Eigen::Index own = valuesOf(facet).rows();
    Eigen::Index at = 0;
    farthest.push_back(distances.segment(row, own).maxCoeff(&at));
    if (farthest.back() > summary.Largest)
    {
      summary.Largest = farthest.back();
      const Eigen::Index place = row + at;
      summary.Place = { samples(place, 0), samples(place, 1), samples(place, 2) };
    }
    const double area = AreaOf(points, lattice.Faces[At(facet)]);
    squares += area * distances.segment(row, own).squaredNorm() / static_cast<double>(own);
    areas += area;
    row += own;
  }
  summary.RootMeanSquare = areas > 0.0 ? std::sqrt(squares / areas) : 0.0;
  return summary;
}
}
