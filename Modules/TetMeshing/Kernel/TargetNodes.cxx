// SPDX-License-Identifier: BSD-3-Clause
#include "TargetNodes.h"

#include <knotwork/CADFitting/TargetDistances.h>
#include <knotwork/SplineCore/Parallel.h>

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
constexpr double NearCurve = 0.25;   ///< of an edge's length: how far its curve may be
constexpr double FarthestMove = 0.5; ///< of an edge's length
/// Barycentric coordinates at which distances are sampled: within, and at the middle and a quarter
/// of each edge (of its other triangle at three).
constexpr std::array<std::array<double, 3>, 10> SamplePlaces{ { { 1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0 },
  { 0.5, 0.25, 0.25 }, { 0.25, 0.5, 0.25 }, { 0.25, 0.25, 0.5 }, { 0.75, 0.25, 0.0 },
  { 0.0, 0.75, 0.25 }, { 0.25, 0.0, 0.75 }, { 0.5, 0.5, 0.0 }, { 0.0, 0.5, 0.5 },
  { 0.5, 0.0, 0.5 } } };

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// An edge of the boundary.
struct BoundaryEdge
{
  std::array<int, 2> Ends{};
  std::vector<int> Triangles;
  int Curve = -1; ///< of the target
};

class NodePlacement
{
public:
  NodePlacement(const FitTarget& target, const std::vector<std::array<int, 3>>& boundary,
    const NodeLattice& lattice, const PointMatrix& corners, int threads, CurvedNodes& nodes)
    : Target(target), Boundary(boundary), Lattice(lattice), Corners(corners), Threads(threads),
      Nodes(nodes)
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

private:
  struct Query
  {
    int Node;
    TargetPart Part;
    double Length; ///< of the edge, which bounds the way
    Eigen::RowVector3d From;
  };

  Eigen::RowVector3d Placed(int node) const { return this->Nodes.Positions().row(node); }

  void CollectEdges()
  {
    std::map<std::array<int, 2>, std::vector<int>> found;
    for (std::size_t t = 0; t < this->Boundary.size(); ++t)
    {
      for (std::size_t i = 0; i < 3; ++i)
      {
        const auto ends = std::minmax(this->Boundary[t][i], this->Boundary[t][(i + 1) % 3]);
        found[{ ends.first, ends.second }].push_back(static_cast<int>(t));
      }
    }
    for (auto& [ends, triangles] : found)
    {
      this->Edges.push_back({ ends, std::move(triangles), -1 });
    }
  }

  double Length(const BoundaryEdge& edge) const
  {
    return (this->Corners.row(edge.Ends[0]) - this->Corners.row(edge.Ends[1])).norm();
  }

  Eigen::Vector3d Normal(int triangle) const
  {
    const auto& t = this->Boundary[At(triangle)];
    const Eigen::Vector3d a = this->Corners.row(t[1]) - this->Corners.row(t[0]);
    const Eigen::Vector3d b = this->Corners.row(t[2]) - this->Corners.row(t[0]);
    return a.cross(b).normalized();
  }

  Status FindFaces()
  {
    PointMatrix middles(static_cast<Eigen::Index>(this->Boundary.size()), 3);
    for (std::size_t t = 0; t < this->Boundary.size(); ++t)
    {
      const auto& corners = this->Boundary[t];
      middles.row(static_cast<Eigen::Index>(t)) =
        (this->Corners.row(corners[0]) + this->Corners.row(corners[1]) +
          this->Corners.row(corners[2])) /
        3.0;
    }
    TargetDistanceParams params;
    params.Threads = this->Threads;
    TargetPoints feet;
    Status status = FindOnTarget(this->Target, middles, feet, params);
    this->Faces = std::move(feet.Faces);
    return status;
  }

  /// The face that all triangles of an edge lie on, -1: several.
  int FaceOf(const std::vector<int>& triangles) const
  {
    int face = this->Faces[At(triangles.front())];
    for (const int triangle : triangles)
    {
      face = this->Faces[At(triangle)] == face ? face : -1;
    }
    return face;
  }

  bool MayBeSharp(const BoundaryEdge& edge) const
  {
    return this->FaceOf(edge.Triangles) < 0 || edge.Triangles.size() != 2 ||
      this->Normal(edge.Triangles[0]).dot(this->Normal(edge.Triangles[1])) < SharpCosine;
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

  /// In chunks, in parallel.
  Status Find(const TargetPart& part, const PointMatrix& queries, PointMatrix& feet) const
  {
    constexpr std::size_t chunk = 64;
    feet.resize(queries.rows(), 3);
    const auto count = static_cast<std::size_t>(queries.rows());
    std::vector<Status> states((count + chunk - 1) / chunk);
    ParallelFor(count, chunk, this->Threads,
      [&](std::size_t begin, std::size_t end)
      {
        TargetPoints found;
        const auto first = static_cast<Eigen::Index>(begin);
        const auto rows = static_cast<Eigen::Index>(end - begin);
        states[begin / chunk] = this->Target.Find(part, queries.middleRows(first, rows), found);
        if (states[begin / chunk])
        {
          feet.middleRows(first, rows) = found.Points;
        }
      });
    const auto failed =
      std::find_if(states.begin(), states.end(), [](const Status& status) { return !status; });
    return failed == states.end() ? Status() : *failed;
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
        for (const int triangle : edge.Triangles)
        {
          corner.Faces.insert(this->Faces[At(triangle)]);
        }
      }
    }
    std::vector<Query> queries;
    for (const auto& [number, corner] : corners)
    {
      Query query{ number, {}, corner.Shortest, this->Placed(number) };
      const bool ends = !corner.Curves.empty() &&
        (corner.Curves.size() != 2 || corner.Curves[0] != corner.Curves[1]);
      const int vertex =
        ends ? this->NearestVertex(this->Corners.row(number), FarthestMove * corner.Shortest) : -1;
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

  /// Points of order 3 start from the parabola through the foot of the edge's middle: so they come
  /// to lie more evenly along the curve than from the straight edge.
  Status PlaceEdges()
  {
    std::vector<Query> middles;
    for (const BoundaryEdge& edge : this->Edges)
    {
      TargetPart part;
      if (edge.Curve >= 0)
      {
        part = { TargetEntity::Curve, edge.Curve };
      }
      else if (const int face = this->FaceOf(edge.Triangles); face >= 0)
      {
        part = { TargetEntity::Face, face };
      }
      const int number = this->Lattice.FindEdge(edge.Ends[0], edge.Ends[1]);
      const Eigen::RowVector3d middle =
        0.5 * (this->Placed(edge.Ends[0]) + this->Placed(edge.Ends[1]));
      middles.push_back({ this->Lattice.EdgeNode(number, 1), part, this->Length(edge), middle });
    }
    if (this->Lattice.Order == 2)
    {
      return this->PlaceQueries(middles);
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
      for (int k = 1; k < 3; ++k)
      {
        Query query = middles[e];
        const double t = k / 3.0;
        query.Node += k - 1;
        query.From = (1.0 - t) * this->Placed(this->Edges[e].Ends[0]) +
          t * this->Placed(this->Edges[e].Ends[1]);
        if (bulge.norm() <= 4.0 * FarthestMove * query.Length)
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
    for (std::size_t t = 0; t < this->Boundary.size() && this->Lattice.Order > 2; ++t)
    {
      const auto& corners = this->Boundary[t];
      const int face = this->Faces[t];
      const double length = (this->Corners.row(corners[0]) - this->Corners.row(corners[1])).norm();
      const int node = this->Lattice.FaceNode(this->Lattice.FindFace(corners));
      queries.push_back({ node, face < 0 ? TargetPart() : TargetPart{ TargetEntity::Face, face },
        length, this->Nodes.Base(node) });
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
      if ((feet[i] - queries[i].From).norm() <= FarthestMove * queries[i].Length)
      {
        this->Nodes.Place(queries[i].Node, feet[i]);
      }
    }
    return {};
  }

  const FitTarget& Target;
  const std::vector<std::array<int, 3>>& Boundary;
  const NodeLattice& Lattice;
  const PointMatrix& Corners;
  int Threads;
  CurvedNodes& Nodes;
  std::vector<BoundaryEdge> Edges;
  std::vector<int> Faces; ///< of the target, one a triangle
};

/// Point of a triangle with nodes at barycentric coordinates.
class CurvedTriangle
{
public:
  CurvedTriangle(
    const NodeLattice& lattice, const PointMatrix& points, const std::array<int, 3>& corners)
    : Lattice(lattice), Points(points), Corners(corners)
  {
  }

  Eigen::RowVector3d operator()(const std::array<double, 3>& at) const
  {
    const int order = this->Lattice.Order;
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    for (std::size_t i = 0; i < 3; ++i)
    {
      const std::size_t j = (i + 1) % 3;
      sum += Factor(order, order, at[i]) * this->Points.row(this->Corners[i]);
      const bool forward = this->Corners[i] < this->Corners[j];
      for (int k = 1; k < order; ++k)
      {
        const int node = this->Lattice.EdgeNode(
          this->Lattice.FindEdge(this->Corners[i], this->Corners[j]), forward ? k : order - k);
        sum += Factor(order, order - k, at[i]) * Factor(order, k, at[j]) * this->Points.row(node);
      }
    }
    if (order > 2)
    {
      sum += 27.0 * at[0] * at[1] * at[2] *
        this->Points.row(this->Lattice.FaceNode(this->Lattice.FindFace(this->Corners)));
    }
    return sum;
  }

private:
  /// Lagrange's polynomial of one coordinate that is 1 at count / order.
  static double Factor(int order, int count, double x)
  {
    double value = 1.0;
    for (int i = 0; i < count; ++i)
    {
      value *= (order * x - i) / (count - i);
    }
    return value;
  }

  const NodeLattice& Lattice;
  const PointMatrix& Points;
  std::array<int, 3> Corners;
};
}

Status PlaceOnTarget(const FitTarget& target, const std::vector<std::array<int, 3>>& boundary,
  const NodeLattice& lattice, const PointMatrix& corners, int threads, CurvedNodes& nodes)
{
  return NodePlacement(target, boundary, lattice, corners, threads, nodes).Place();
}

Result<double> FarthestFromTarget(const FitTarget& target,
  const std::vector<std::array<int, 3>>& boundary, const NodeLattice& lattice,
  const PointMatrix& points, int threads)
{
  constexpr auto count = static_cast<Eigen::Index>(SamplePlaces.size());
  PointMatrix samples(static_cast<Eigen::Index>(boundary.size()) * count, 3);
  Eigen::Index row = 0;
  for (const auto& corners : boundary)
  {
    const CurvedTriangle triangle(lattice, points, corners);
    for (const auto& place : SamplePlaces)
    {
      samples.row(row++) = triangle(place);
    }
  }
  TargetDistanceParams params;
  params.Threads = threads;
  TargetPoints feet;
  if (Status status = FindOnTarget(target, samples, feet, params); !status)
  {
    return status;
  }
  return (feet.Points - samples).rowwise().norm().maxCoeff();
}
}
