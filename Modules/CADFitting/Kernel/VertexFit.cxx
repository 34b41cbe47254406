// SPDX-License-Identifier: BSD-3-Clause
#include "VertexFit.h"

#include "TargetDistances.h"

#include <Eigen/Geometry>
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Edges of the cells, each once.
template <int Dim>
std::vector<std::array<int, 2>> EdgesOf(const CellMesh<Dim>& mesh)
{
  std::vector<std::array<int, 2>> edges;
  for (int c = 0; c < mesh.NumCells(); ++c)
  {
    for (int corner = 0; corner < (1 << Dim); ++corner)
    {
      for (int d = 0; d < Dim; ++d)
      {
        const int a = mesh.Cell(c)[corner];
        const int b = mesh.Cell(c)[corner | 1 << d];
        if ((corner >> d & 1) == 0)
        {
          edges.push_back({ std::min(a, b), std::max(a, b) });
        }
      }
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

/// Moves of the free points as the mean of those of their neighbours.
template <int Dim>
void ExtendMoves(const CellMesh<Dim>& mesh, const std::vector<char>& isFree, PointMatrix& moves)
{
  std::vector<int> number(At(mesh.NumPoints), -1);
  int count = 0;
  for (int i = 0; i < mesh.NumPoints; ++i)
  {
    if (isFree[At(i)] != 0)
    {
      number[At(i)] = count++;
    }
  }
  if (count == 0)
  {
    return;
  }
  std::vector<Eigen::Triplet<double>> entries;
  PointMatrix right = PointMatrix::Zero(count, 3);
  for (const auto& edge : EdgesOf(mesh))
  {
    for (const int k : { 0, 1 })
    {
      const int own = number[At(edge[At(k)])];
      const int other = edge[At(1 - k)];
      if (own >= 0)
      {
        entries.emplace_back(own, own, 1.0);
        if (number[At(other)] >= 0)
        {
          entries.emplace_back(own, number[At(other)], -1.0);
        }
        else
        {
          right.row(own) += moves.row(other);
        }
      }
    }
  }
  Eigen::SparseMatrix<double> matrix(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper> solver(matrix);
  solver.setTolerance(1e-10);
  const Eigen::MatrixXd solution = solver.solve(Eigen::MatrixXd(right));
  for (int i = 0; i < mesh.NumPoints; ++i)
  {
    if (number[At(i)] >= 0 && solution.row(number[At(i)]).allFinite())
    {
      moves.row(i) = solution.row(number[At(i)]);
    }
  }
}

/// Points of a mesh slide on what they are classified as.
class TargetSlide final : public PointSlide
{
public:
  TargetSlide(const FitTarget& target, const std::vector<TargetPart>& parts,
    const std::vector<char>& isInside, const std::vector<char>& isHeld, bool isPlane, bool surfaces)
    : Target(target), Parts(parts), IsInside(isInside), IsHeld(isHeld), IsPlane(isPlane),
      Surfaces(surfaces)
  {
    for (const TargetCurve& curve : target.Curves())
    {
      this->Lines.push_back(LineOf(curve));
    }
  }

  bool IsFixed(int point) const override
  {
    const TargetEntity entity = this->Parts[At(point)].Entity;
    const bool isHeld = !this->IsHeld.empty() && this->IsHeld[At(point)] != 0;
    return isHeld ||
      (this->IsInside[At(point)] == 0 &&
        (entity == TargetEntity::Vertex ||
          (entity != TargetEntity::Curve && (!this->Target.HasSurface() || !this->Surfaces))));
  }
  Eigen::RowVector3d Nearest(int point, const Eigen::RowVector3d& at) const override
  {
    if (this->IsInside[At(point)] != 0)
    {
      return at;
    }
    TargetPoints feet;
    return this->Target.Find(this->Parts[At(point)], PointMatrix(at), feet)
      ? Eigen::RowVector3d(feet.Points.row(0))
      : at;
  }
  Eigen::Matrix<double, 3, Eigen::Dynamic> Directions(
    int point, const Eigen::RowVector3d& at) const override
  {
    const TargetPart& part = this->Parts[At(point)];
    if (this->IsInside[At(point)] != 0)
    {
      return Eigen::Matrix3d::Identity().leftCols(this->IsPlane ? 2 : 3);
    }
    if (part.Entity == TargetEntity::Curve)
    {
      const PolylineFoot& line = this->Lines[At(part.Id)];
      const double length = line.Nearest(at).Length;
      const double step = 1e-3 * line.Length();
      return (line.At(length + step) - line.At(length - step)).normalized().transpose();
    }
    TargetPoints feet;
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
    if (this->Target.Find(part, PointMatrix(at), feet) && !feet.Normals.row(0).isZero())
    {
      normal = feet.Normals.row(0);
    }
    Eigen::Matrix<double, 3, 2> plane;
    plane.col(0) = normal.unitOrthogonal();
    plane.col(1) = normal.cross(plane.col(0));
    return plane;
  }

private:
  const FitTarget& Target;
  const std::vector<TargetPart>& Parts;
  const std::vector<char>& IsInside;
  const std::vector<char>& IsHeld;
  bool IsPlane;
  bool Surfaces;
  std::vector<PolylineFoot> Lines;
};

/// Points along the edges of a curve, in order, from a corner on where there is one; a closed one
/// has the first at the end too.
std::vector<int> PointsAlong(
  const SurfaceMesh& surface, const std::vector<TargetPart>& parts, const std::vector<int>& edges)
{
  std::map<int, std::vector<int>> edgesAt;
  for (const int edge : edges)
  {
    for (const int end : surface.Edges[At(edge)])
    {
      edgesAt[end].push_back(edge);
    }
  }
  int begin = surface.Edges[At(edges.front())][0];
  for (const auto& [point, at] : edgesAt)
  {
    if (at.size() == 1 || parts[At(point)].Entity == TargetEntity::Vertex)
    {
      begin = point;
      break;
    }
  }
  std::vector<int> along{ begin };
  std::set<int> done;
  for (bool goesOn = true; goesOn;)
  {
    goesOn = false;
    for (const int edge : edgesAt[along.back()])
    {
      if (done.insert(edge).second)
      {
        along.push_back(surface.Across(edge, along.back()));
        goesOn = true;
        break;
      }
    }
  }
  return along;
}

/// Whether lengths along a line ascend or descend, with no step below a tenth of the mean one.
bool IsInOrder(const std::vector<double>& lengths, const PolylineFoot& line)
{
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  for (std::size_t i = 0; i + 1 < lengths.size(); ++i)
  {
    double step = lengths[i + 1] - lengths[i];
    step = line.IsClosed() ? std::remainder(step, line.Length()) : step;
    least = std::min(least, step);
    most = std::max(most, step);
  }
  const double limit = 0.1 * line.Length() / static_cast<double>(lengths.size());
  return least > limit || most < -limit;
}

/// Places of a curve's points: their closest ones, or, where these are out of order, such that
/// divide the curve as the edges divide their path.
Status PlaceOnCurve(const FitTarget& target, int number, const std::vector<int>& along,
  const PointMatrix& points, PointMatrix& moved)
{
  const TargetCurve& curve = target.Curves()[At(number)];
  const PolylineFoot line = LineOf(curve);
  std::vector<double> lengths;
  PointMatrix places(static_cast<Eigen::Index>(along.size()), 3);
  for (std::size_t i = 0; i < along.size(); ++i)
  {
    places.row(static_cast<Eigen::Index>(i)) = points.row(along[i]);
    lengths.push_back(line.Nearest(points.row(along[i])).Length);
  }
  if (!line.IsClosed())
  {
    // the ends are corners
    const bool isForward = lengths.front() <= lengths.back();
    lengths.front() = isForward ? 0.0 : line.Length();
    lengths.back() = isForward ? line.Length() : 0.0;
  }
  if (!IsInOrder(lengths, line))
  {
    std::vector<double> path{ 0.0 };
    for (std::size_t i = 1; i < along.size(); ++i)
    {
      path.push_back(path.back() + (points.row(along[i]) - points.row(along[i - 1])).norm());
    }
    double whole = lengths.back() - lengths.front();
    if (line.IsClosed())
    {
      double turn = 0.0;
      for (std::size_t i = 1; i < lengths.size(); ++i)
      {
        turn += std::remainder(lengths[i] - lengths[i - 1], line.Length());
      }
      whole = turn >= 0.0 ? line.Length() : -line.Length();
    }
    for (std::size_t i = 0; i < along.size(); ++i)
    {
      places.row(static_cast<Eigen::Index>(i)) =
        line.At(lengths.front() + path[i] / path.back() * whole);
    }
  }
  TargetPoints feet;
  Status status = target.Find({ TargetEntity::Curve, number }, places, feet);
  for (std::size_t i = 0; status && i < along.size(); ++i)
  {
    moved.row(along[i]) = feet.Points.row(static_cast<Eigen::Index>(i));
  }
  return status;
}

/// Points of the surface to where they belong. @param isSet  points that were placed.
Status PlaceSurface(const SurfaceMesh& surface, const MeshClassification& parts,
  const PointMatrix& points, const FitTarget& target, const VertexFitParams& params,
  PointMatrix& moved, std::vector<char>& isSet)
{
  std::map<int, std::vector<int>> edgesOf; // curves
  for (std::size_t e = 0; e < surface.Edges.size(); ++e)
  {
    if (parts.CurveOf[e] >= 0)
    {
      edgesOf[parts.CurveOf[e]].push_back(static_cast<int>(e));
    }
  }
  for (const auto& [curve, edges] : edgesOf)
  {
    const std::vector<int> along = PointsAlong(surface, parts.PointParts, edges);
    if (Status status = PlaceOnCurve(target, curve, along, points, moved); !status)
    {
      return status;
    }
    for (const int point : along)
    {
      isSet[At(point)] = 1;
    }
  }
  std::vector<char> isRim(isSet.size(), 0);
  for (std::size_t e = 0; e < surface.Edges.size(); ++e)
  {
    if (surface.QuadsOf[e][1] == Rim)
    {
      isRim[At(surface.Edges[e][0])] = 1;
      isRim[At(surface.Edges[e][1])] = 1;
    }
  }
  std::map<int, std::vector<int>> pointsOf; // faces, -1: any
  for (const int point : surface.Points)
  {
    const TargetPart& part = parts.PointParts[At(point)];
    if (part.Entity == TargetEntity::Vertex)
    {
      moved.row(point) = target.Vertices().row(part.Id);
      isSet[At(point)] = 1;
    }
    else if (part.Entity != TargetEntity::Curve && target.HasSurface() &&
      (params.Surfaces || isRim[At(point)] != 0))
    {
      pointsOf[part.Id].push_back(point);
    }
  }
  for (const auto& [face, own] : pointsOf)
  {
    PointMatrix queries(static_cast<Eigen::Index>(own.size()), 3);
    for (std::size_t i = 0; i < own.size(); ++i)
    {
      queries.row(static_cast<Eigen::Index>(i)) = points.row(own[i]);
    }
    TargetPoints feet;
    TargetDistanceParams search;
    search.Threads = params.Threads;
    search.Part = { face < 0 ? TargetEntity::Surface : TargetEntity::Face, face };
    if (Status status = FindOnTarget(target, queries, feet, search); !status)
    {
      return status;
    }
    for (std::size_t i = 0; i < own.size(); ++i)
    {
      moved.row(own[i]) = feet.Points.row(static_cast<Eigen::Index>(i));
      isSet[At(own[i])] = 1;
    }
  }
  return {};
}
}

template <int Dim>
Result<VertexFit> MoveOntoTarget(const CellMesh<Dim>& mesh, const MeshTopology<Dim>& topology,
  const SurfaceMesh& surface, const MeshClassification& parts, const PointMatrix& points,
  const FitTarget& target, const VertexFitParams& params)
{
  Result<VertexFit> result;
  auto folded = FoldedCells<Dim>(mesh, points);
  if (!folded)
  {
    return folded.Status;
  }
  result->FoldedBefore = std::move(folded.Value);
  result->Points = points;
  std::vector<char> isSet(At(mesh.NumPoints), 0);
  if (Status status = PlaceSurface(surface, parts, points, target, params, result->Points, isSet);
      !status)
  {
    return status;
  }
  const bool isPlane = Dim == 2 && (points.col(2).array() == points(0, 2)).all();
  // what is inside: of hexahedra all but the surface, of quadrilaterals of a plane all but the rim
  std::vector<char> isInside(At(mesh.NumPoints), 1);
  for (const int point : surface.Points)
  {
    isInside[At(point)] = Dim == 2 && isSet[At(point)] == 0 ? 1 : 0;
  }
  for (std::size_t i = 0; i < params.IsHeld.size(); ++i)
  {
    isInside[i] = params.IsHeld[i] != 0 ? 0 : isInside[i];
  }
  PointMatrix moves = result->Points - points;
  const double size = (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
  if (moves.rowwise().norm().maxCoeff() > 1e-14 * size)
  {
    ExtendMoves(mesh, isInside, moves);
    for (int i = 0; i < mesh.NumPoints; ++i)
    {
      if (isInside[At(i)] != 0)
      {
        result->Points.row(i) = points.row(i) + moves.row(i);
      }
    }
  }
  auto now = FoldedCells<Dim>(mesh, result->Points);
  result->Folded = std::move(now.Value);
  if (params.Untangle && (!result->Folded.empty() || !params.Poor.empty()))
  {
    const TargetSlide slide(
      target, parts.PointParts, isInside, params.IsHeld, isPlane, params.Surfaces);
    UntanglingParams untangling;
    untangling.Slide = &slide;
    untangling.Poor = params.Poor;
    untangling.Rings = params.Rings;
    untangling.MaxSweeps = params.MaxSweeps;
    untangling.Progress = params.Progress;
    auto untangled = UntangleMesh<Dim>(mesh, topology, result->Points, untangling);
    if (!untangled)
    {
      return untangled.Status;
    }
    result->Points = std::move(untangled->Points);
    result->Folded = std::move(untangled->Folded);
  }
  return result;
}

template Result<VertexFit> MoveOntoTarget(const CellMesh<2>&, const MeshTopology<2>&,
  const SurfaceMesh&, const MeshClassification&, const PointMatrix&, const FitTarget&,
  const VertexFitParams&);
template Result<VertexFit> MoveOntoTarget(const CellMesh<3>&, const MeshTopology<3>&,
  const SurfaceMesh&, const MeshClassification&, const PointMatrix&, const FitTarget&,
  const VertexFitParams&);
}
