// SPDX-License-Identifier: BSD-3-Clause
#include "MeshClassification.h"

#include "TargetDistances.h"

#include <knotwork/SplineCore/DisjointSets.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <queue>
#include <set>
#include <unordered_map>

namespace knotwork
{
namespace
{
/// How much an edge counts more that is away from its curve by its own length.
constexpr double DistancePenalty = 25.0;
/// Share of a quadrilateral's component that must agree on a face.
constexpr double AgreeingShare = 0.8;
/// Boxes of a part of the mesh and of a body differ by at most this share of its diagonal, and an
/// edge, where they are the same.
constexpr double BoxShare = 0.1;
constexpr int BoxSamples = 2000; ///< of the target
/// Pieces of a curve without a corner.
constexpr int ClosedPieces = 3;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

class Classifier
{
public:
  Classifier(const SurfaceMesh& surface, const PointMatrix& points, const FitTarget& target,
    const ClassificationParams& params)
    : Surface(surface), Points(points), Target(target), Params(params),
      Lengths(EdgeLengthsAt(surface, points)), IsTaken(static_cast<std::size_t>(points.rows()), 0)
  {
    this->Result.PointParts.resize(static_cast<std::size_t>(points.rows()));
    this->Result.CurveOf.assign(surface.Edges.size(), -1);
    this->Result.FaceOf.assign(surface.Quads.size(), -1);
  }

  knotwork::Result<MeshClassification> Run()
  {
    if (Status status = this->FindBodies(); !status)
    {
      return status;
    }
    this->MatchCorners();
    // short curves first: they leave the others their ways
    std::vector<std::pair<double, int>> order;
    for (std::size_t c = 0; c < this->Target.Curves().size(); ++c)
    {
      const TargetCurve& curve = this->Target.Curves()[c];
      order.emplace_back(LineOf(curve).Length(), static_cast<int>(c));
    }
    std::sort(order.begin(), order.end());
    for (const auto& [length, curve] : order)
    {
      this->MatchCurve(curve);
    }
    Status status = this->Params.Faces && this->Target.HasSurface() ? this->MatchFaces() : Status();
    return status ? knotwork::Result<MeshClassification>(std::move(this->Result)) : status;
  }

private:
  Status FindFeet()
  {
    if (!this->Feet.Faces.empty())
    {
      return {};
    }
    this->Middles.resize(static_cast<Eigen::Index>(this->Surface.Quads.size()), 3);
    this->Areas.resize(this->Middles.rows());
    for (Eigen::Index q = 0; q < this->Middles.rows(); ++q)
    {
      const auto& quad = this->Surface.Quads[static_cast<std::size_t>(q)];
      const auto point = [&](std::size_t k) -> Eigen::RowVector3d
      { return this->Points.row(quad[k]); };
      this->Middles.row(q) = 0.25 * (point(0) + point(1) + point(2) + point(3));
      this->Areas[q] = (point(2) - point(0)).norm() * (point(3) - point(1)).norm();
    }
    TargetDistanceParams search;
    search.Threads = this->Params.Threads;
    return FindOnTarget(this->Target, this->Middles, this->Feet, search);
  }

  /// Which body of the target each part of the mesh that hangs together is, where there are
  /// several: coinciding edges of others are not its own.
  Status FindBodies()
  {
    this->BodyOf.assign(this->IsTaken.size(), 0);
    const std::vector<int>& bodies = this->Target.BodiesOfFaces();
    if (std::adjacent_find(bodies.begin(), bodies.end(), std::not_equal_to<>()) == bodies.end())
    {
      return {};
    }
    if (Status status = this->FindFeet(); !status)
    {
      return status;
    }
    DisjointSets sets(static_cast<int>(this->Surface.Quads.size()));
    for (const auto& [a, b] : this->Surface.QuadsOf)
    {
      if (b >= 0)
      {
        sets.Unite(a, b);
      }
    }
    struct Part
    {
      std::map<int, double> Areas; // by body
      Eigen::AlignedBox3d Box;
    };
    std::map<int, Part> parts;
    for (std::size_t q = 0; q < this->Surface.Quads.size(); ++q)
    {
      Part& part = parts[sets.Find(static_cast<int>(q))];
      part.Areas[bodies[At(this->Feet.Faces[q])]] += this->Areas[static_cast<Eigen::Index>(q)];
      for (const int point : this->Surface.Quads[q])
      {
        part.Box.extend(this->Points.row(point).transpose());
      }
    }
    std::map<int, Eigen::AlignedBox3d> boxes; // of bodies
    const TargetSamples samples = this->Target.Samples(BoxSamples);
    for (Eigen::Index i = 0; i < samples.Points.rows(); ++i)
    {
      boxes[bodies[At(samples.Faces[static_cast<std::size_t>(i)])]].extend(
        samples.Points.row(i).transpose());
    }
    for (std::size_t q = 0; q < this->Surface.Quads.size(); ++q)
    {
      const Part& part = parts.at(sets.Find(static_cast<int>(q)));
      const auto most = std::max_element(part.Areas.begin(), part.Areas.end(),
        [](const auto& a, const auto& b) { return a.second < b.second; });
      // a part may be several bodies together
      const Eigen::AlignedBox3d& box = boxes[most->first];
      const double off = std::max((part.Box.min() - box.min()).cwiseAbs().maxCoeff(),
        (part.Box.max() - box.max()).cwiseAbs().maxCoeff());
      for (const int point : this->Surface.Quads[q])
      {
        this->BodyOf[At(point)] =
          off <= BoxShare * box.diagonal().norm() + this->Lengths[At(point)] ? most->first : 0;
      }
    }
    return {};
  }

  /// Whether a point of the mesh may lie on a curve or corner of a body.
  bool IsOf(int point, int body) const
  {
    return body == 0 || this->BodyOf[At(point)] == 0 || this->BodyOf[At(point)] == body;
  }

  void MatchCorners()
  {
    const PointMatrix& corners = this->Target.Vertices();
    this->PointOfCorner.assign(static_cast<std::size_t>(corners.rows()), -1);
    std::vector<std::pair<double, std::pair<int, int>>> pairs; // distance, corner, point
    for (int c = 0; c < corners.rows(); ++c)
    {
      if (this->Params.LeftOutCorners.count(c) != 0)
      {
        continue;
      }
      for (const int point : this->Surface.Points)
      {
        const double distance = (this->Points.row(point) - corners.row(c)).norm();
        if (distance <= this->Params.MaxMove * this->Lengths[At(point)] &&
          this->IsOf(point, this->Target.BodyOfVertex(c)))
        {
          pairs.push_back({ distance, { c, point } });
        }
      }
    }
    std::sort(pairs.begin(), pairs.end());
    for (const auto& [distance, pair] : pairs)
    {
      const auto [corner, point] = pair;
      if (this->PointOfCorner[At(corner)] < 0 && this->IsTaken[At(point)] == 0)
      {
        this->PointOfCorner[At(corner)] = point;
        this->IsTaken[At(point)] = 1;
        this->Result.PointParts[At(point)] = { TargetEntity::Vertex, corner };
      }
    }
    for (int c = 0; c < corners.rows(); ++c)
    {
      if (this->PointOfCorner[At(c)] < 0)
      {
        this->Result.Unmatched.push_back(
          { { TargetEntity::Vertex, c }, { corners(c, 0), corners(c, 1), corners(c, 2) } });
      }
    }
  }

  /// Points of the surface near a line, with their distances.
  std::unordered_map<int, PolylineFoot::Foot> Near(const PolylineFoot& line, int body) const
  {
    std::unordered_map<int, PolylineFoot::Foot> near;
    for (const int point : this->Surface.Points)
    {
      const PolylineFoot::Foot foot = line.Nearest(this->Points.row(point));
      if (foot.Distance <= 2.0 * this->Lengths[At(point)] && this->IsOf(point, body))
      {
        near.emplace(point, foot);
      }
    }
    return near;
  }

  void MatchCurve(int number)
  {
    const TargetCurve& curve = this->Target.Curves()[At(number)];
    const PolylineFoot line = LineOf(curve);
    const auto near = this->Near(line, curve.Body);
    std::vector<int> stops;
    std::vector<double> lengths;
    if (line.IsClosed())
    {
      // from the corner on, or from the point that is the nearest
      const auto first = std::min_element(near.begin(), near.end(),
        [](const auto& a, const auto& b)
        {
          return std::make_pair(a.second.Distance, a.first) <
            std::make_pair(b.second.Distance, b.first);
        });
      const double begin = curve.IsLoop() || first == near.end() ? 0.0 : first->second.Length;
      for (int k = 0; k <= ClosedPieces; ++k)
      {
        lengths.push_back(begin + k * line.Length() / ClosedPieces);
        stops.push_back(k == ClosedPieces ? stops.front()
            : k == 0 && curve.IsLoop()    ? this->PointOfCorner[At(curve.Ends[0])]
                                          : this->Closest(near, line.At(lengths.back())));
      }
    }
    else
    {
      lengths = { 0.0, line.Length() };
      stops = { this->PointOfCorner[At(curve.Ends[0])], this->PointOfCorner[At(curve.Ends[1])] };
    }
    std::vector<int> path;
    bool isFound = this->Params.LeftOut.count(number) == 0 &&
      std::find(stops.begin(), stops.end(), -1) == stops.end();
    for (std::size_t k = 0; isFound && k + 1 < stops.size(); ++k)
    {
      const std::vector<int> piece =
        this->FindPath(near, line, stops[k], stops[k + 1], { lengths[k], lengths[k + 1] });
      isFound = !piece.empty();
      path.insert(path.end(), piece.begin(), piece.end());
    }
    if (!isFound || !this->Follows(path, near, line))
    {
      const Eigen::RowVector3d place = line.At(0.5 * line.Length());
      this->Result.Unmatched.push_back(
        { { TargetEntity::Curve, number }, { place[0], place[1], place[2] } });
      return;
    }
    for (const int edge : path)
    {
      this->Result.CurveOf[At(edge)] = number;
      for (const int end : this->Surface.Edges[At(edge)])
      {
        this->IsTaken[At(end)] = 1;
        TargetPart& part = this->Result.PointParts[At(end)];
        if (part.Entity != TargetEntity::Vertex)
        {
          part = { TargetEntity::Curve, number };
        }
      }
    }
  }

  /// The point beside a place of the curve; what lies off the curve counts more than what lies
  /// along it.
  int Closest(
    const std::unordered_map<int, PolylineFoot::Foot>& near, const Eigen::RowVector3d& place) const
  {
    constexpr double Off = 2.0;
    std::pair<double, int> best{ std::numeric_limits<double>::infinity(), -1 };
    for (const auto& [point, foot] : near)
    {
      if (this->IsTaken[At(point)] == 0)
      {
        best =
          std::min(best, { (this->Points.row(point) - place).norm() + Off * foot.Distance, point });
      }
    }
    return best.second;
  }

  /// Edges of the cheapest path within a part of the curve, empty when there is none.
  std::vector<int> FindPath(const std::unordered_map<int, PolylineFoot::Foot>& near,
    const PolylineFoot& line, int from, int to, const std::array<double, 2>& part) const
  {
    const double whole = line.Length();
    const double margin = 0.5 * (part[1] - part[0]);
    const auto isInPart = [&](double length)
    {
      if (!line.IsClosed())
      {
        return true;
      }
      const double middle = 0.5 * (part[0] + part[1]);
      const double off = std::abs(std::remainder(length - middle, whole));
      return off <= 0.5 * (part[1] - part[0]) + margin;
    };
    struct Entry
    {
      double Cost;
      int Point;
      int Edge;
      bool operator>(const Entry& other) const
      {
        return std::make_pair(this->Cost, this->Edge) > std::make_pair(other.Cost, other.Edge);
      }
    };
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    std::unordered_map<int, int> cameBy;
    queue.push({ 0.0, from, -1 });
    while (!queue.empty())
    {
      const Entry entry = queue.top();
      queue.pop();
      if (!cameBy.emplace(entry.Point, entry.Edge).second)
      {
        continue;
      }
      if (entry.Point == to && entry.Edge >= 0)
      {
        break;
      }
      this->Surface.ForEdges(entry.Point,
        [&](int edge)
        {
          const int next = this->Surface.Across(edge, entry.Point);
          const auto foot = near.find(next);
          if (foot == near.end() || cameBy.count(next) != 0 ||
            (next != to && this->IsTaken[At(next)] != 0) || !isInPart(foot->second.Length) ||
            this->Result.CurveOf[At(edge)] >= 0)
          {
            return;
          }
          const Eigen::RowVector3d a = this->Points.row(entry.Point);
          const Eigen::RowVector3d b = this->Points.row(next);
          const double length = (b - a).norm();
          const double away = (line.Nearest(0.5 * (a + b)).Distance + foot->second.Distance) /
            std::max(length, 1e-300);
          queue.push({ entry.Cost + length * (1.0 + DistancePenalty * away * away), next, edge });
        });
    }
    std::vector<int> path;
    if (cameBy.count(to) == 0 || from == to)
    {
      return path;
    }
    for (int point = to; point != from;)
    {
      path.push_back(cameBy.at(point));
      point = this->Surface.Across(path.back(), point);
    }
    std::reverse(path.begin(), path.end());
    return path;
  }

  /// Whether the path stays near the curve, and passes all of it.
  bool Follows(const std::vector<int>& path,
    const std::unordered_map<int, PolylineFoot::Foot>& near, const PolylineFoot& line) const
  {
    double length = 0.0;
    double longest = 0.0;
    double farthest = 0.0;
    std::set<int> points;
    for (const int edge : path)
    {
      const auto [a, b] = this->Surface.Edges[At(edge)];
      const double own = (this->Points.row(a) - this->Points.row(b)).norm();
      length += own;
      longest = std::max(longest, own);
      points.insert({ a, b });
      for (const int end : { a, b })
      {
        const auto foot = near.find(end);
        const double distance =
          foot == near.end() ? line.Nearest(this->Points.row(end)).Distance : foot->second.Distance;
        farthest = std::max(farthest, distance / this->Lengths[At(end)]);
      }
    }
    // no point twice, but for both ends of one that closes
    const bool isSimple = points.size() == path.size() + (line.IsClosed() ? 0 : 1);
    const bool isWhole =
      length >= 0.6 * line.Length() - longest && length <= 1.8 * line.Length() + longest;
    return isSimple && isWhole && farthest <= this->Params.MaxMove;
  }

  /// Quadrilaterals that lie beside the face of their component, and turned away from it, are on
  /// any: behind a curve that has no edges of the mesh.
  /// @param quads  that are the nearest to others.
  Status FreeFromFace(int face, const std::vector<int>& quads)
  {
    constexpr double Beside = 0.1; ///< mean edges farther from the face than from the surface
    constexpr double Turned = 0.2; ///< cosine of the angle between normals that is lost there
    PointMatrix places(static_cast<Eigen::Index>(quads.size()), 3);
    for (std::size_t i = 0; i < quads.size(); ++i)
    {
      places.row(static_cast<Eigen::Index>(i)) = this->Middles.row(quads[i]);
    }
    TargetPoints onFace;
    TargetDistanceParams search;
    search.Threads = this->Params.Threads;
    search.Part = { TargetEntity::Face, face };
    if (Status status = FindOnTarget(this->Target, places, onFace, search); !status)
    {
      return status;
    }
    for (std::size_t i = 0; i < quads.size(); ++i)
    {
      const int q = quads[i];
      const auto& quad = this->Surface.Quads[At(q)];
      const auto point = [&](std::size_t k) -> Eigen::Vector3d
      { return this->Points.row(quad[k]); };
      const Eigen::Vector3d normal =
        (point(2) - point(0)).cross(point(3) - point(1)).stableNormalized();
      const auto row = static_cast<Eigen::Index>(i);
      const double far = (onFace.Points.row(row) - places.row(row)).norm() -
        (this->Feet.Points.row(q) - places.row(row)).norm();
      const double turned = std::abs(this->Feet.Normals.row(q).dot(normal)) -
        std::abs(onFace.Normals.row(row).dot(normal));
      double length = 0.0;
      for (const int corner : quad)
      {
        length += 0.25 * this->Lengths[At(corner)];
      }
      if (far > Beside * length && turned > Turned)
      {
        this->Result.FaceOf[At(q)] = -1;
      }
    }
    return {};
  }

  /// Components of quadrilaterals between classified edges.
  Status MatchFaces()
  {
    if (Status status = this->FindFeet(); !status)
    {
      return status;
    }
    DisjointSets sets(static_cast<int>(this->Surface.Quads.size()));
    for (std::size_t e = 0; e < this->Surface.Edges.size(); ++e)
    {
      const auto [a, b] = this->Surface.QuadsOf[e];
      if (b >= 0 && this->Result.CurveOf[e] < 0)
      {
        sets.Unite(a, b);
      }
    }
    std::map<int, std::map<int, double>> votes;
    for (Eigen::Index q = 0; q < this->Middles.rows(); ++q)
    {
      votes[sets.Find(static_cast<int>(q))][this->Feet.Faces[static_cast<std::size_t>(q)]] +=
        this->Areas[q];
    }
    std::map<int, int> faceOf;
    std::map<int, std::vector<int>> others; // of a face: quadrilaterals that voted for another
    for (const auto& [component, shares] : votes)
    {
      double sum = 0.0;
      std::pair<double, int> best{ 0.0, -1 };
      for (const auto& [face, share] : shares)
      {
        sum += share;
        best = std::max(best, { share, face });
      }
      faceOf[component] = best.first >= AgreeingShare * sum ? best.second : -1;
    }
    for (std::size_t q = 0; q < this->Surface.Quads.size(); ++q)
    {
      const int face = faceOf[sets.Find(static_cast<int>(q))];
      this->Result.FaceOf[q] = face;
      if (face >= 0 && face != this->Feet.Faces[q])
      {
        others[face].push_back(static_cast<int>(q));
      }
    }
    for (const auto& [face, quads] : others)
    {
      if (Status status = this->FreeFromFace(face, quads); !status)
      {
        return status;
      }
    }
    for (std::size_t q = 0; q < this->Surface.Quads.size(); ++q)
    {
      const int face = this->Result.FaceOf[q];
      for (const int point : this->Surface.Quads[q])
      {
        TargetPart& part = this->Result.PointParts[At(point)];
        if (part.Entity == TargetEntity::Surface && face >= 0)
        {
          part = { TargetEntity::Face, face };
        }
      }
    }
    return {};
  }

  const SurfaceMesh& Surface;
  const PointMatrix& Points;
  const FitTarget& Target;
  const ClassificationParams& Params;
  const std::vector<double> Lengths;
  std::vector<char> IsTaken; ///< points of corners and curves
  std::vector<int> BodyOf;   ///< of every point: the target's; 0: any
  PointMatrix Middles;       ///< of quadrilaterals
  Eigen::VectorXd Areas;
  TargetPoints Feet; ///< of the middles
  std::vector<int> PointOfCorner;
  MeshClassification Result;
};
}

Result<MeshClassification> ClassifyMesh(const SurfaceMesh& surface, const PointMatrix& points,
  const FitTarget& target, const ClassificationParams& params)
{
  return Classifier(surface, points, target, params).Run();
}
}
