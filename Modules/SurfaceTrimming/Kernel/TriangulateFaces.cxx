// SPDX-License-Identifier: BSD-3-Clause
#include "FaceTriangulation.h"
#include "TrimmedMesh.h"
#include <knotwork/SplineCore/Parallel.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

constexpr double EdgeShare = 0.25; ///< of the tolerance, for the pieces of edges
constexpr double CellShare = 0.9;  ///< of the tolerance, for cells of the surface
constexpr int MaxTopologyPasses = 40;
constexpr int MaxRefinementPasses = 60;
constexpr int MaxCoarsenings = 30; ///< by factors of 4

class Triangulator
{
public:
  Triangulator(const TrimmedModel& model, const TrimmedMeshParams& params)
    : Model(model), Params(params)
  {
  }

  /// @param tolerance  of the first points, at least that of the parameters.
  Status Prepare(double tolerance);
  Status Refine();
  std::size_t NumTriangles() const;
  TrimmedMesh Assemble() const;

private:
  Status PrepareFace(std::size_t f, double tolerance);
  void AddRim(std::size_t f);
  Status SampleEdges(double tolerance);
  void EvaluateEdge(std::size_t e);
  Status Update();
  bool Apply(const std::vector<PointRequest>& requests, std::size_t face);
  Status CrossingStatus() const;
  bool Report(double share) const { return !this->Params.Progress || this->Params.Progress(share); }

  const TrimmedModel& Model;
  const TrimmedMeshParams& Params;
  std::vector<FaceTriangulation> Faces;
  std::vector<SampledEdge> Edges;
  std::vector<std::vector<std::size_t>> EdgeFaces; ///< faces along an edge
  PointMatrix Vertices;
  std::vector<bool> Dirty; ///< faces to triangulate anew
};

Status Triangulator::PrepareFace(std::size_t f, double tolerance)
{
  FaceTriangulation& face = this->Faces[f];
  face.Face = &this->Model.Faces[f];
  face.Form = MakeBezierForm(face.Face->Surface, this->Params.Threads);
  auto cells = SurfaceCells::Create(face.Form, CellShare * tolerance,
    static_cast<std::size_t>(this->Params.MaxTriangles) + 1000, this->Params.Threads);
  if (!cells)
  {
    return { cells.Status.Code, "face " + std::to_string(f) + ": " + cells.Status.Detail };
  }
  face.Cells = std::move(cells.Value);
  return {};
}

/// The rim of a whole surface: four edges of its own, sampled at the corners of cells.
void Triangulator::AddRim(std::size_t f)
{
  FaceTriangulation& face = this->Faces[f];
  const ParametricBox<2> domain = face.Form.Space->Domain();
  const int firstVertex = static_cast<int>(this->Vertices.rows());
  this->Vertices.conservativeResize(firstVertex + 4, 3);
  std::vector<EdgeSide> loop;
  std::array<int, 4> vertices{ firstVertex, firstVertex + 1, firstVertex + 2, firstVertex + 3 };
  std::array<SampledEdge, 4> edges;
  for (int k = 0; k < 4; ++k) // counterclockwise from the lower corner; k is even along u
  {
    const std::size_t along = At(k % 2);
    const std::size_t across = 1 - along;
    const double fixed = (k == 0 || k == 3 ? domain.Lower : domain.Upper)[across];
    SampledEdge& edge = edges[At(k)];
    for (const SurfaceCells::Cell& cell : face.Cells.Cells())
    {
      if (cell.Children < 0 && cell.Box.Lower[across] <= fixed && fixed <= cell.Box.Upper[across])
      {
        edge.Parameters.push_back(cell.Box.Lower[along]);
      }
    }
    edge.Parameters.push_back(domain.Upper[along]);
    std::sort(edge.Parameters.begin(), edge.Parameters.end());
    edge.Parameters.erase(
      std::unique(edge.Parameters.begin(), edge.Parameters.end()), edge.Parameters.end());
    const double begin = domain.Lower[along];
    const double end = domain.Upper[along];
    Spline<1> curve;
    curve.Space =
      MakeTensorSpace<1>({ KnotVector::Create(1, { begin, begin, end, end }).Value }).Value;
    curve.ControlPoints.resize(2, 2);
    curve.ControlPoints.col(static_cast<Eigen::Index>(along)) << begin, end;
    curve.ControlPoints.col(static_cast<Eigen::Index>(across)).setConstant(fixed);
    PlaneCurve plane(curve);
    const PointMatrix uv = EvaluateCurve(plane.Form, edge.Parameters);
    EvaluationBatch batch;
    EvaluateParameters<2>(face.Form, uv, { 0, 1 }, batch);
    edge.Points = batch.Values;
    const double extent = (edge.Points.rowwise() - edge.Points.row(0)).rowwise().norm().maxCoeff();
    const double size = face.Face->Surface.ControlPoints.cwiseAbs().maxCoeff();
    edge.Collapsed = extent <= 1e-14 * size;
    const bool backwards = k >= 2; // the loop runs it from its end
    const std::array<std::size_t, 2> ends{ At(backwards ? (k + 1) % 4 : k),
      At(backwards ? k : (k + 1) % 4) };
    this->Vertices.row(firstVertex + static_cast<int>(ends[0])) = edge.Points.row(0);
    this->Vertices.row(firstVertex + static_cast<int>(ends[1])) =
      edge.Points.row(edge.Points.rows() - 1);
    if (edge.Collapsed)
    {
      vertices[std::max(ends[0], ends[1])] = vertices[std::min(ends[0], ends[1])];
    }
    loop.push_back({ static_cast<int>(this->Edges.size()) + k,
      { static_cast<int>(ends[0]), static_cast<int>(ends[1]) }, backwards, std::move(plane) });
  }
  for (EdgeSide& side : loop)
  {
    side.Vertices = { vertices[At(side.Vertices[0])], vertices[At(side.Vertices[1])] };
  }
  for (SampledEdge& edge : edges)
  {
    this->Edges.push_back(std::move(edge));
    this->EdgeFaces.push_back({ f });
  }
  face.Loops.push_back(std::move(loop));
}

/// Parameters of all edges: for their own curves and for what the faces along them need.
Status Triangulator::SampleEdges(double tolerance)
{
  std::vector<CurveBounds> needs(this->Edges.size());
  std::vector<const Spline<1>*> curves(this->Edges.size(), nullptr);
  std::vector<bool> hasVertex(At(this->Model.NumVertices), false);
  std::vector<int> minPieces(this->Edges.size(), 1);
  for (std::size_t f = 0; f < this->Faces.size(); ++f)
  {
    FaceTriangulation& face = this->Faces[f];
    for (const TrimmedLoop& loop : face.Face->Loops)
    {
      face.Loops.emplace_back();
      for (const TrimmingCurve& use : loop.Curves)
      {
        EdgeSide side{ use.Edge, use.Vertices, use.Reversed, PlaneCurve(use.ParameterCurve()) };
        const std::size_t e = At(use.Edge);
        SampledEdge& edge = this->Edges[e];
        if (curves[e] == nullptr)
        {
          curves[e] = &use.Curve;
          edge.Curve = MakeBezierForm(use.Curve, 1);
          needs[e] = CurveBounds::Of(edge.Curve);
          const PointMatrix ends = EvaluateCurve(
            edge.Curve, { use.Curve.Space->Knots[0].Begin(), use.Curve.Space->Knots[0].End() });
          for (int end = 0; end < 2; ++end)
          {
            const int vertex = use.Vertices[At(end)];
            if (!hasVertex[At(vertex)])
            {
              hasVertex[At(vertex)] = true;
              this->Vertices.row(vertex) = ends.row(end);
            }
          }
          const PointMatrix& points = use.Curve.ControlPoints;
          edge.Collapsed = use.Vertices[0] == use.Vertices[1] &&
            (points.rowwise() - points.row(0)).cwiseAbs().maxCoeff() <=
              1e-12 * points.cwiseAbs().maxCoeff();
        }
        if (use.Curve.Space->Knots[0].Breaks() != needs[e].Breaks)
        {
          return { ErrorCode::InvalidTopology,
            "uses of edge " + std::to_string(use.Edge) + " have different curves" };
        }
        needs[e].Include(BoundInSpace(side.Curve, face.Cells));
        const int pieces = loop.Curves.size() == 1 ? 4 : (loop.Curves.size() == 2 ? 2 : 1);
        minPieces[e] = std::max(minPieces[e], pieces);
        if (this->EdgeFaces[e].empty() || this->EdgeFaces[e].back() != f)
        {
          this->EdgeFaces[e].push_back(f);
        }
        face.Loops.back().push_back(std::move(side));
      }
    }
  }
  std::size_t total = 0;
  for (std::size_t e = 0; e < this->Edges.size(); ++e)
  {
    if (curves[e] == nullptr)
    {
      continue;
    }
    auto parameters = SampleCurve(curves[e]->Space->Knots[0], needs[e], EdgeShare * tolerance,
      minPieces[e], static_cast<std::size_t>(this->Params.MaxTriangles) + 1000);
    if (!parameters)
    {
      return { parameters.Status.Code,
        "edge " + std::to_string(e) + ": " + parameters.Status.Detail };
    }
    this->Edges[e].Parameters = std::move(parameters.Value);
    this->EvaluateEdge(e);
    total += this->Edges[e].Parameters.size();
  }
  if (total > static_cast<std::size_t>(this->Params.MaxTriangles) + 1000)
  {
    return { ErrorCode::TooLarge, std::to_string(total) + " points of edges" };
  }
  return {};
}

void Triangulator::EvaluateEdge(std::size_t e)
{
  SampledEdge& edge = this->Edges[e];
  if (!edge.OnSurface())
  {
    edge.Points = EvaluateCurve(edge.Curve, edge.Parameters);
    return;
  }
  const FaceTriangulation& face = this->Faces[this->EdgeFaces[e].front()];
  for (const EdgeSide& side : face.Loops.front())
  {
    if (side.Edge == static_cast<int>(e))
    {
      EvaluationBatch batch;
      EvaluateParameters<2>(
        face.Form, EvaluateCurve(side.Curve.Form, edge.Parameters), { 0, 1 }, batch);
      edge.Points = std::move(batch.Values);
    }
  }
}

Status Triangulator::Prepare(double tolerance)
{
  this->Faces.assign(this->Model.Faces.size(), {});
  this->Edges.assign(At(this->Model.NumEdges), {});
  this->EdgeFaces.assign(At(this->Model.NumEdges), {});
  this->Vertices = PointMatrix::Zero(this->Model.NumVertices, 3);
  this->Dirty.assign(this->Faces.size(), true);
  for (std::size_t f = 0; f < this->Faces.size(); ++f)
  {
    if (Status status = this->PrepareFace(f, tolerance); !status)
    {
      return status;
    }
    if (!this->Report(0.2 * static_cast<double>(f + 1) / static_cast<double>(this->Faces.size())))
    {
      return { ErrorCode::Aborted, "triangulation of faces" };
    }
  }
  if (Status status = this->SampleEdges(tolerance); !status)
  {
    return status;
  }
  for (std::size_t f = 0; f < this->Faces.size(); ++f)
  {
    if (this->Faces[f].Loops.empty())
    {
      this->AddRim(f);
    }
    this->Faces[f].SetPlane(this->Edges);
  }
  return {};
}

Status Triangulator::Update()
{
  std::vector<std::size_t> dirty;
  for (std::size_t f = 0; f < this->Faces.size(); ++f)
  {
    if (this->Dirty[f])
    {
      dirty.push_back(f);
    }
  }
  std::vector<Status> status(this->Faces.size());
  ParallelFor(dirty.size(), 1, this->Params.Threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        status[dirty[i]] = this->Faces[dirty[i]].Update(
          this->Edges, this->Vertices, this->Params.Tolerance, this->Params.Threads);
      }
    });
  this->Dirty.assign(this->Faces.size(), false);
  for (std::size_t f : dirty)
  {
    if (!status[f])
    {
      return { status[f].Code, "face " + std::to_string(f) + ": " + status[f].Detail };
    }
  }
  return {};
}

/// Adds the points that a face asks for. @return whether there is a new one.
bool Triangulator::Apply(const std::vector<PointRequest>& requests, std::size_t face)
{
  bool changed = false;
  std::vector<std::size_t> changedEdges;
  for (const PointRequest& request : requests)
  {
    if (request.Edge < 0)
    {
      this->Faces[face].AddInterior(request.UV);
      this->Dirty[face] = true;
      changed = true;
      continue;
    }
    std::vector<double>& parameters = this->Edges[At(request.Edge)].Parameters;
    const auto above = std::lower_bound(parameters.begin(), parameters.end(), request.Parameter);
    if (above == parameters.begin() || above == parameters.end() || *above == request.Parameter)
    {
      changed = true; // another face asked for it
      continue;
    }
    const double least = 1e-13 * (parameters.back() - parameters.front());
    if (request.Parameter - *(above - 1) < least || *above - request.Parameter < least)
    {
      continue;
    }
    parameters.insert(above, request.Parameter);
    changedEdges.push_back(At(request.Edge));
    changed = true;
  }
  std::sort(changedEdges.begin(), changedEdges.end());
  changedEdges.erase(std::unique(changedEdges.begin(), changedEdges.end()), changedEdges.end());
  for (std::size_t e : changedEdges)
  {
    this->EvaluateEdge(e);
    for (std::size_t f : this->EdgeFaces[e])
    {
      this->Dirty[f] = true;
    }
  }
  return changed;
}

std::size_t Triangulator::NumTriangles() const
{
  std::size_t n = 0;
  for (const FaceTriangulation& face : this->Faces)
  {
    n += face.Triangles.size();
  }
  return n;
}

Status Triangulator::CrossingStatus() const
{
  for (std::size_t f = 0; f < this->Faces.size(); ++f)
  {
    if (!this->Faces[f].Simple)
    {
      return { ErrorCode::InvalidTopology,
        "face " + std::to_string(f) +
          ": its loops cross, are not nested or run the wrong way around" };
    }
  }
  return {};
}

Status Triangulator::Refine()
{
  const std::size_t limit = static_cast<std::size_t>(this->Params.MaxTriangles);
  std::size_t firstSamples = 0;
  for (const SampledEdge& edge : this->Edges)
  {
    firstSamples += edge.Parameters.size();
  }
  int topologyPasses = 0;
  for (int pass = 0; pass < MaxRefinementPasses + topologyPasses; ++pass)
  {
    if (Status status = this->Update(); !status)
    {
      return status;
    }
    if (!this->Report(0.2 + 0.7 * (1.0 - 1.0 / (1.0 + pass))))
    {
      return { ErrorCode::Aborted, "triangulation of faces" };
    }
    // Polygons first: without them there are no triangles.
    const bool simple = static_cast<bool>(this->CrossingStatus());
    bool changed = false;
    std::size_t samples = 0;
    for (const SampledEdge& edge : this->Edges)
    {
      samples += edge.Parameters.size();
    }
    if (!simple && ++topologyPasses <= MaxTopologyPasses && samples < 16 * firstSamples + 1000)
    {
      for (std::size_t f = 0; f < this->Faces.size(); ++f)
      {
        if (!this->Faces[f].Simple)
        {
          changed = this->Apply(this->Faces[f].Requests, f) || changed;
        }
      }
    }
    if (!simple && !changed)
    {
      return this->CrossingStatus();
    }
    if (!simple)
    {
      continue;
    }
    // The worst places, as far as the number of triangles allows.
    const std::size_t total = this->NumTriangles();
    if (total > limit)
    {
      return { ErrorCode::TooLarge, std::to_string(total) + " triangles" };
    }
    struct Ranked
    {
      std::size_t Face;
      std::size_t Request;
      double Excess;
      std::size_t Cost;
    };
    std::vector<Ranked> ranked;
    std::size_t cost = 0;
    for (std::size_t f = 0; f < this->Faces.size(); ++f)
    {
      const auto& requests = this->Faces[f].Requests;
      for (std::size_t r = 0; r < requests.size(); ++r)
      {
        ranked.push_back({ f, r, requests[r].Excess, 2 });
        if (requests[r].Edge >= 0)
        {
          ranked.back().Cost = this->EdgeFaces[At(requests[r].Edge)].size() * 2;
        }
        cost += ranked.back().Cost;
      }
    }
    if (total + cost > limit)
    {
      std::stable_sort(ranked.begin(), ranked.end(),
        [](const Ranked& a, const Ranked& b) { return a.Excess > b.Excess; });
      std::size_t sum = total;
      const auto end = std::find_if(
        ranked.begin(), ranked.end(), [&](const Ranked& r) { return (sum += r.Cost) > limit; });
      ranked.erase(end, ranked.end());
    }
    std::vector<std::vector<PointRequest>> chosen(this->Faces.size());
    for (const Ranked& r : ranked)
    {
      chosen[r.Face].push_back(this->Faces[r.Face].Requests[r.Request]);
    }
    for (std::size_t f = 0; f < this->Faces.size(); ++f)
    {
      changed = this->Apply(chosen[f], f) || changed;
    }
    if (!changed)
    {
      break;
    }
  }
  return this->CrossingStatus();
}

TrimmedMesh Triangulator::Assemble() const
{
  // Vertices, points of edges, points of faces; those in use keep this order.
  std::vector<std::size_t> edgeStart{ static_cast<std::size_t>(this->Vertices.rows()) };
  for (const SampledEdge& edge : this->Edges)
  {
    edgeStart.push_back(edgeStart.back() + edge.Parameters.size());
  }
  std::size_t count = edgeStart.back();
  std::vector<std::vector<std::size_t>> slots(this->Faces.size());
  for (std::size_t f = 0; f < this->Faces.size(); ++f)
  {
    for (const FacePoint& point : this->Faces[f].Points)
    {
      slots[f].push_back(point.Vertex >= 0 ? At(point.Vertex)
          : point.Edge >= 0                ? edgeStart[At(point.Edge)] + At(point.Sample)
                                           : count++);
    }
  }
  std::vector<int> number(count, -1);
  TrimmedMesh mesh;
  for (std::size_t f = 0; f < this->Faces.size(); ++f)
  {
    const FaceTriangulation& face = this->Faces[f];
    mesh.Bound = std::max(mesh.Bound, face.Bound);
    for (std::array<int, 3> corners : face.Triangles)
    {
      if (face.Face->Reversed)
      {
        std::swap(corners[1], corners[2]);
      }
      std::array<int, 3> ids;
      std::array<std::array<double, 2>, 3> uv;
      for (std::size_t i = 0; i < 3; ++i)
      {
        ids[i] = static_cast<int>(slots[f][At(corners[i])]);
        uv[i] = face.Points[At(corners[i])].UV;
      }
      if (ids[0] == ids[1] || ids[1] == ids[2] || ids[2] == ids[0])
      {
        continue; // at a side that is a point
      }
      for (int id : ids)
      {
        number[At(id)] = 0;
      }
      mesh.Triangles.push_back(ids);
      mesh.TriangleFace.push_back(static_cast<int>(f));
      mesh.TriangleUV.push_back(uv);
    }
  }
  int used = 0;
  for (int& n : number)
  {
    n = n < 0 ? -1 : used++;
  }
  for (std::array<int, 3>& corners : mesh.Triangles)
  {
    for (int& corner : corners)
    {
      corner = number[At(corner)];
    }
  }
  mesh.Points.resize(used, 3);
  mesh.Normals = PointMatrix::Zero(used, 3);
  std::vector<bool> hasNormal(At(used), false);
  for (std::size_t f = 0; f < this->Faces.size(); ++f)
  {
    const FaceTriangulation& face = this->Faces[f];
    PointMatrix uv(static_cast<Eigen::Index>(face.Points.size()), 2);
    for (Eigen::Index i = 0; i < uv.rows(); ++i)
    {
      const auto& p = face.Points[static_cast<std::size_t>(i)].UV;
      uv.row(i) << p[0], p[1];
    }
    EvaluationBatch batch;
    EvaluateParameters<2>(face.Form, uv, { 1, this->Params.Threads }, batch);
    for (std::size_t i = 0; i < face.Points.size(); ++i)
    {
      const int id = number[slots[f][i]];
      if (id < 0)
      {
        continue;
      }
      const FacePoint& point = face.Points[i];
      const Eigen::Index row = static_cast<Eigen::Index>(i);
      if (point.Vertex >= 0)
      {
        mesh.Points.row(id) = this->Vertices.row(point.Vertex);
      }
      else if (point.Edge >= 0)
      {
        mesh.Points.row(id) = this->Edges[At(point.Edge)].Points.row(point.Sample);
      }
      else
      {
        mesh.Points.row(id) = batch.Values.row(row);
      }
      if (hasNormal[At(id)])
      {
        continue;
      }
      const Eigen::Vector3d u = batch.First.row(row).head<3>();
      const Eigen::Vector3d v = batch.First.row(row).tail<3>();
      const Eigen::Vector3d normal = u.cross(v);
      const double length = normal.norm();
      if (length > 1e-9 * face.MeanSize())
      {
        mesh.Normals.row(id) = (face.Face->Reversed ? -normal : normal).transpose() / length;
        hasNormal[At(id)] = true;
      }
    }
  }
  // Where the surface has no normal, that of the triangles around.
  for (const std::array<int, 3>& corners : mesh.Triangles)
  {
    for (int corner : corners)
    {
      if (!hasNormal[At(corner)])
      {
        const Eigen::Vector3d a = mesh.Points.row(corners[0]);
        const Eigen::Vector3d b = mesh.Points.row(corners[1]);
        const Eigen::Vector3d c = mesh.Points.row(corners[2]);
        mesh.Normals.row(corner) += (b - a).cross(c - a).transpose();
      }
    }
  }
  for (int id = 0; id < used; ++id)
  {
    const double length = mesh.Normals.row(id).norm();
    if (!hasNormal[At(id)])
    {
      mesh.Normals.row(id) = length > 0.0 ? Eigen::RowVector3d(mesh.Normals.row(id) / length)
                                          : Eigen::RowVector3d(0.0, 0.0, 1.0);
    }
  }
  return mesh;
}
}

Result<TrimmedMesh> TriangulateFaces(const TrimmedModel& model, const TrimmedMeshParams& params)
{
  if (Status status = model.Check(); !status)
  {
    return status;
  }
  if (!(params.Tolerance > 0.0) || !std::isfinite(params.Tolerance))
  {
    return { ErrorCode::InvalidParameter, "Tolerance must be positive" };
  }
  if (params.MaxTriangles < 1)
  {
    return { ErrorCode::InvalidParameter, "MaxTriangles must be at least 1" };
  }
  // The first points are made for the tolerance; where they are too many, for a larger one.
  double tolerance = params.Tolerance;
  for (int i = 0;; ++i)
  {
    Triangulator triangulator(model, params);
    Status status = triangulator.Prepare(tolerance);
    if (status)
    {
      status = triangulator.Refine();
    }
    if (status)
    {
      return triangulator.Assemble();
    }
    if (status.Code != ErrorCode::TooLarge || i == MaxCoarsenings)
    {
      return status;
    }
    tolerance *= 4.0;
  }
}

Result<TrimmedMesh> TriangulateFacesFiner(const TrimmedModel& model, TrimmedMeshParams params)
{
  constexpr int Attempts = 4;
  constexpr double Finer = 0.8;
  const ProgressCallback whole = params.Progress;
  double done = 0.0; // an attempt tells again what the one before it did
  if (whole)
  {
    params.Progress = [&](double share)
    {
      done = std::max(done, share);
      return whole(done);
    };
  }
  Result<TrimmedMesh> triangles;
  for (int attempt = 0; attempt < Attempts; ++attempt)
  {
    triangles = TriangulateFaces(model, params);
    if (triangles || triangles.Status.Code != ErrorCode::InvalidTopology)
    {
      break;
    }
    params.Tolerance *= Finer;
  }
  return triangles;
}
}
