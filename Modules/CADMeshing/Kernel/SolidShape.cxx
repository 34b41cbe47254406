// SPDX-License-Identifier: BSD-3-Clause
#include "SolidShape.h"

#include "RimMap.h"
#include <knotwork/SplineCore/DisjointSets.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
using Eigen::Vector3d;
constexpr int Samples = 8; ///< segments of an edge between places that are followed

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}
}

SolidShape::SolidShape(const CADTopology& model, const FaceMesher& mesher, int body)
  : Model(model), Mesher(mesher), Body(body)
{
  constexpr double MostTurn = 0.7071; // cosine of 45 degrees
  for (const CADTopologySide& side : model.Bodies[At(body)].Sides)
  {
    this->Faces.insert(side.Face);
    this->IsReversed[side.Face] = side.Reversed;
    const auto& loops = model.Faces[At(side.Face)].Loops;
    for (std::size_t l = 0; l < loops.size(); ++l)
    {
      for (std::size_t u = 0; u < loops[l].size(); ++u)
      {
        if (loops[l][u].Edge >= 0)
        {
          this->Edges[loops[l][u].Edge].Uses.push_back(
            { side.Face, static_cast<int>(l), static_cast<int>(u) });
        }
      }
    }
  }
  for (auto& [id, edge] : this->Edges)
  {
    if (edge.Uses.size() != 2)
    {
      continue;
    }
    std::array<Vector3d, 2> normals;
    for (std::size_t i = 0; i < 2; ++i)
    {
      const SolidEdge::Use& use = edge.Uses[i];
      normals[i] =
        model.FaceNormal(use.Face, model.UseParameters(use.Face, use.Loop, use.Index, 0.5));
      normals[i] *= this->IsReversed.at(use.Face) ? -1.0 : 1.0;
    }
    edge.IsFlat = normals[0].dot(normals[1]) > MostTurn;
  }
}

/// Faces around a plane one that look its way, joined by flat edges: what rounded edges are around.
std::vector<int> SolidShape::CapOf(int face) const
{
  constexpr double Least = 0.3; ///< cosine
  const Vector3d way = this->AreaVector(face).normalized();
  DisjointSets sets(static_cast<int>(this->Model.Faces.size()));
  std::set<int> looking;
  for (const int other : this->Faces)
  {
    const Vector3d area = this->AreaVector(other);
    if (area.dot(way) > Least * area.norm())
    {
      looking.insert(other);
    }
  }
  for (const auto& [id, edge] : this->Edges)
  {
    if (edge.IsFlat && looking.count(edge.Uses[0].Face) > 0 && looking.count(edge.Uses[1].Face) > 0)
    {
      sets.Unite(edge.Uses[0].Face, edge.Uses[1].Face);
    }
  }
  std::vector<int> cap;
  for (const int other : looking)
  {
    if (sets.Find(other) == sets.Find(face))
    {
      cap.push_back(other);
    }
  }
  return cap;
}

/// Every face, what is joined to it by flat edges, and of that what looks the way of a plane one.
std::vector<std::vector<int>> SolidShape::Sources() const
{
  std::vector<std::vector<int>> sources;
  DisjointSets sets(static_cast<int>(this->Model.Faces.size()));
  for (const auto& [id, edge] : this->Edges)
  {
    if (edge.IsFlat)
    {
      sets.Unite(edge.Uses[0].Face, edge.Uses[1].Face);
    }
  }
  std::map<int, std::vector<int>> groups;
  for (const int face : this->Faces)
  {
    sources.push_back({ face });
    groups[sets.Find(face)].push_back(face);
  }
  for (auto& [root, group] : groups)
  {
    if (group.size() > 1 && group.size() < this->Faces.size())
    {
      sources.push_back(std::move(group));
    }
  }
  for (const int face : this->Faces)
  {
    if (this->Model.Faces[At(face)].IsPlane)
    {
      std::vector<int> cap = this->CapOf(face);
      if (cap.size() < this->Faces.size() &&
        std::find(sources.begin(), sources.end(), cap) == sources.end())
      {
        sources.push_back(std::move(cap));
      }
    }
  }
  return sources;
}

/// How often faces use their edges.
std::map<int, int> SolidShape::UsesWithin(const std::set<int>& faces) const
{
  std::map<int, int> uses;
  for (const int face : faces)
  {
    for (const auto& loop : this->Model.Faces[At(face)].Loops)
    {
      for (const CADTopologyUse& use : loop)
      {
        if (use.Edge >= 0)
        {
          ++uses[use.Edge];
        }
      }
    }
  }
  return uses;
}

/// Moves the front over a rectangle that has all of one side in it, and none of the other ones.
bool SolidShape::Advance(int face, std::size_t side, Progress& progress) const
{
  const auto sides = this->Mesher.Sides(face);
  for (std::size_t s = 0; s < 4; ++s)
  {
    for (const CADTopologyUse& use : sides[s])
    {
      if ((progress.Front.count(use.Edge) > 0) != (s == side))
      {
        return false;
      }
    }
  }
  const auto lengthOf = [&](const std::vector<CADTopologyUse>& uses)
  {
    double length = 0.0;
    for (const CADTopologyUse& use : uses)
    {
      length += this->Model.Edges[At(use.Edge)].Length;
    }
    return length;
  };
  // where a share of the side comes from
  const auto& near = sides[side];
  const double nearLength = lengthOf(near);
  const auto originAt = [&](double share) -> Vector3d
  {
    double left = share * nearLength;
    std::size_t at = 0;
    const auto length = [&] { return this->Model.Edges[At(near[at].Edge)].Length; };
    while (at + 1 < near.size() && left > length())
    {
      left -= length();
      ++at;
    }
    const double along = std::clamp(left / length(), 0.0, 1.0);
    const double place = Samples * (near[at].Reversed ? 1.0 - along : along);
    const Followed& origins = progress.Front.at(near[at].Edge);
    const int begin = std::min(static_cast<int>(place), Samples - 1);
    return origins[At(begin)] + (place - begin) * (origins[At(begin + 1)] - origins[At(begin)]);
  };
  const auto& far = sides[(side + 2) % 4];
  const double farLength = lengthOf(far);
  std::map<int, Followed> next;
  double before = 0.0;
  for (const CADTopologyUse& use : far) // runs the other way than the near side
  {
    const double length = this->Model.Edges[At(use.Edge)].Length;
    Followed& origins = next[use.Edge];
    for (int i = 0; i <= Samples; ++i)
    {
      const double along = static_cast<double>(use.Reversed ? Samples - i : i) / Samples;
      origins.push_back(originAt(1.0 - (before + along * length) / farLength));
    }
    before += length;
  }
  const auto climb = [&](const std::vector<CADTopologyUse>& uses, int from, int to)
  {
    std::vector<int>& up = progress.Up[from];
    up.clear();
    for (const CADTopologyUse& use : uses)
    {
      up.push_back(use.Edge);
    }
    progress.Above[from] = to;
  };
  const auto beginOf = [&](std::size_t s) { return sides[s % 4].front().Vertex; };
  climb(sides[(side + 1) % 4], beginOf(side + 1), beginOf(side + 2));
  climb(sides[(side + 3) % 4], beginOf(side), beginOf(side + 3));
  for (const CADTopologyUse& use : near)
  {
    progress.Front.erase(use.Edge);
  }
  for (auto& [edge, origins] : next)
  {
    progress.Front[edge] = std::move(origins);
  }
  progress.Linking.insert(face);
  return true;
}

/// Faces beside the source link, and, if asked for, those that go on flatly behind linking ones.
void SolidShape::Link(const std::set<int>& source, bool goesOn, Progress& progress) const
{
  std::set<int> rim;
  for (const auto& [edge, origins] : progress.Front)
  {
    rim.insert(edge);
  }
  bool changed = true;
  while (changed)
  {
    changed = false;
    for (const int face : this->Faces)
    {
      if (source.count(face) > 0 || progress.Linking.count(face) > 0 ||
        !this->Mesher.IsRectangle(face))
      {
        continue;
      }
      const auto sides = this->Mesher.Sides(face);
      for (std::size_t side = 0; side < sides.size(); ++side)
      {
        const bool leadsOn = std::all_of(sides[side].begin(), sides[side].end(),
          [&](const CADTopologyUse& use)
          { return rim.count(use.Edge) > 0 || (goesOn && this->Edges.at(use.Edge).IsFlat); });
        if (leadsOn && this->Advance(face, side, progress))
        {
          changed = true;
          break;
        }
      }
    }
  }
}

std::vector<int> SolidShape::ChainUp(int vertex, const Progress& progress, int& end) const
{
  std::vector<int> chain;
  std::set<int> seen;
  end = vertex;
  for (auto up = progress.Up.find(end); up != progress.Up.end() && seen.insert(end).second;
       up = progress.Up.find(end))
  {
    chain.insert(chain.end(), up->second.begin(), up->second.end());
    end = progress.Above.at(end);
  }
  return chain;
}

/// As many layers everywhere: chains of edges from the rim of the source to that of the target.
bool SolidShape::AddLayers(
  const std::set<int>& source, const Progress& progress, SolidSweep& sweep) const
{
  const std::map<int, int> uses = this->UsesWithin(source);
  std::vector<int> first;
  for (const int face : source)
  {
    for (const auto& loop : this->Model.Faces[At(face)].Loops)
    {
      for (const CADTopologyUse& use : loop)
      {
        int end = 0;
        const std::vector<int> chain = use.Edge >= 0 && uses.at(use.Edge) == 1
          ? this->ChainUp(use.Vertex, progress, end)
          : std::vector<int>();
        if (!chain.empty() && first.empty())
        {
          first = chain;
        }
        else if (!chain.empty() && chain != first)
        {
          sweep.Equal.push_back({ first, chain });
        }
      }
    }
  }
  return !first.empty();
}

/// Edges inside of the target are images of edges inside of the source; a seam is none.
bool SolidShape::MatchImprints(SolidSweep& sweep) const
{
  constexpr double Near = 0.25; ///< of an edge's length, or of its radius
  const RimMap back(sweep.Arrival, sweep.Origin, sweep.Mirrored);
  sweep.Imprints.clear();
  const auto inner = [&](const std::vector<int>& faces)
  {
    std::vector<int> edges;
    for (const auto& [edge, count] : this->UsesWithin({ faces.begin(), faces.end() }))
    {
      const auto& uses = this->Edges.at(edge).Uses;
      if (count == 2 && uses[0].Face != uses[1].Face)
      {
        edges.push_back(edge);
      }
    }
    return edges;
  };
  const auto isClosed = [&](int edge)
  {
    const auto& vertices = this->Model.Edges[At(edge)].Vertices;
    return vertices[0] == vertices[1];
  };
  /// How far apart two edges are; closed ones may begin anywhere.
  const auto gapOf = [&](int target, int source)
  {
    std::array<std::vector<Vector3d>, 2> places;
    for (int i = 0; i <= Samples; ++i)
    {
      const double share = static_cast<double>(i) / Samples;
      places[0].push_back(back(this->Model.EdgePoint(target, share).transpose()).transpose());
      places[1].push_back(this->Model.EdgePoint(source, share));
    }
    if (isClosed(target))
    {
      std::array<Vector3d, 2> middles;
      std::array<double, 2> radii{};
      for (std::size_t k = 0; k < 2; ++k)
      {
        middles[k] = Vector3d::Zero();
        for (int i = 0; i < Samples; ++i)
        {
          middles[k] += places[k][At(i)] / Samples;
        }
        for (int i = 0; i < Samples; ++i)
        {
          radii[k] += (places[k][At(i)] - middles[k]).norm() / Samples;
        }
      }
      return ((middles[0] - middles[1]).norm() + std::abs(radii[0] - radii[1])) /
        std::max(radii[0], radii[1]);
    }
    std::array<double, 2> gaps{};
    for (int i = 0; i <= Samples; ++i)
    {
      gaps[0] = std::max(gaps[0], (places[0][At(i)] - places[1][At(i)]).norm());
      gaps[1] = std::max(gaps[1], (places[0][At(i)] - places[1][At(Samples - i)]).norm());
    }
    return std::min(gaps[0], gaps[1]) / this->Model.Edges[At(source)].Length;
  };
  std::vector<int> ofSource = inner(sweep.Source);
  for (const int target : inner(sweep.Target))
  {
    int best = -1;
    double least = Near;
    for (const int source : ofSource)
    {
      const double gap = isClosed(source) == isClosed(target) ? gapOf(target, source) : Near;
      if (gap < least)
      {
        least = gap;
        best = source;
      }
    }
    if (best < 0)
    {
      return false;
    }
    ofSource.erase(std::find(ofSource.begin(), ofSource.end(), best));
    sweep.Imprints.push_back({ best, target });
  }
  for (const EdgePair& pair : sweep.Imprints)
  {
    sweep.Equal.push_back({ { pair.Source }, { pair.Target } });
  }
  sweep.BothWays = ofSource.empty();
  return true;
}

bool SolidShape::HasSameCorners(const SolidSweep& sweep, const Progress& progress) const
{
  if (sweep.Source.size() != 1 || sweep.Target.size() != 1 ||
    !this->Mesher.IsRectangle(sweep.Source[0]) || !this->Mesher.IsRectangle(sweep.Target[0]))
  {
    return false;
  }
  std::set<int> images;
  for (const auto& side : this->Mesher.Sides(sweep.Source[0]))
  {
    int end = 0;
    if (this->ChainUp(side.front().Vertex, progress, end).empty())
    {
      return false;
    }
    images.insert(end);
  }
  std::set<int> corners;
  for (const auto& side : this->Mesher.Sides(sweep.Target[0]))
  {
    corners.insert(side.front().Vertex);
  }
  return images == corners;
}

/// How far the rims are from an affine map, in shares of their size; and a little for faces that
/// are not flat.
double SolidShape::Score(const SolidSweep& sweep) const
{
  const RimMap map(sweep.Origin, sweep.Arrival);
  if (map.IsFlat())
  {
    return 1e9;
  }
  double sum = 0.0;
  double size = 0.0;
  const Eigen::RowVector3d middle = sweep.Arrival.colwise().mean();
  for (Eigen::Index i = 0; i < sweep.Origin.rows(); ++i)
  {
    sum += (map(sweep.Origin.row(i)) - sweep.Arrival.row(i)).squaredNorm();
    size += (sweep.Arrival.row(i) - middle).squaredNorm();
  }
  double score = std::sqrt(sum / size);
  for (const auto* faces : { &sweep.Source, &sweep.Target })
  {
    for (const int face : *faces)
    {
      score += this->Model.Faces[At(face)].IsPlane ? 0.0 : 0.1;
    }
  }
  return score + 0.01 * static_cast<double>(sweep.Source.size() + sweep.Target.size());
}

/// The integral of a face's normal, outward of the solid, by chords of its boundary; of one that
/// goes all the way around zero.
Vector3d SolidShape::AreaVector(int face) const
{
  const CADTopologyFace& loops = this->Model.Faces[At(face)];
  Vector3d sum = Vector3d::Zero();
  double all = 0.0;
  for (const auto& loop : loops.Loops)
  {
    std::vector<Vector3d> points;
    for (const CADTopologyUse& use : loop)
    {
      for (int i = 0; use.Edge >= 0 && i < Samples; ++i)
      {
        const double share = static_cast<double>(i) / Samples;
        points.push_back(this->Model.EdgePoint(use.Edge, use.Reversed ? 1.0 - share : share));
      }
    }
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      const Vector3d piece =
        0.5 * (points[i] - points[0]).cross(points[(i + 1) % points.size()] - points[0]);
      sum += piece;
      all += piece.norm();
    }
  }
  if (sum.norm() <= 1e-9 * all)
  {
    return Vector3d::Zero();
  }
  return loops.Reversed != this->IsReversed.at(face) ? Vector3d(-sum) : sum;
}

/// Faces of an end that look another way than all of it together: what is swept from there folds.
std::set<int> SolidShape::BentFaces(const std::vector<int>& end) const
{
  constexpr double Least = 0.1; ///< cosine
  Vector3d sum = Vector3d::Zero();
  for (const int face : end)
  {
    sum += this->AreaVector(face);
  }
  std::set<int> bent;
  for (const int face : end)
  {
    const Vector3d area = this->AreaVector(face);
    if (!(area.dot(sum) > Least * area.norm() * sum.norm()))
    {
      bent.insert(face);
    }
  }
  return bent;
}

bool SolidShape::IsConnected(const std::set<int>& faces) const
{
  DisjointSets sets(static_cast<int>(this->Model.Faces.size()));
  for (const auto& [id, edge] : this->Edges)
  {
    if (edge.Uses.size() == 2 && faces.count(edge.Uses[0].Face) > 0 &&
      faces.count(edge.Uses[1].Face) > 0)
    {
      sets.Unite(edge.Uses[0].Face, edge.Uses[1].Face);
    }
  }
  return std::all_of(faces.begin(), faces.end(),
    [&](int face) { return sets.Find(face) == sets.Find(*faces.begin()); });
}

bool SolidShape::Sweep(
  const std::vector<int>& given, bool goesOn, SolidSweep& sweep, std::set<int>& blockers) const
{
  const std::set<int> source(given.begin(), given.end());
  Progress progress;
  std::set<int> beside;
  for (const auto& [edge, count] : this->UsesWithin(source))
  {
    const auto& uses = this->Edges.at(edge).Uses;
    if (uses.size() != 2)
    {
      return false; // the solid meets itself there
    }
    if (count == 1)
    {
      Followed& origins = progress.Front[edge];
      for (int i = 0; i <= Samples; ++i)
      {
        origins.push_back(this->Model.EdgePoint(edge, static_cast<double>(i) / Samples));
      }
      beside.insert(source.count(uses[0].Face) > 0 ? uses[1].Face : uses[0].Face);
    }
  }
  if (progress.Front.empty())
  {
    return false;
  }
  this->Link(source, goesOn, progress);
  for (const int face : beside)
  {
    if (progress.Linking.count(face) == 0)
    {
      blockers.insert(face);
    }
  }
  if (!blockers.empty())
  {
    return false;
  }
  std::set<int> target;
  for (const int face : this->Faces)
  {
    if (source.count(face) == 0 && progress.Linking.count(face) == 0)
    {
      target.insert(face);
    }
  }
  std::size_t numRim = 0;
  for (const auto& [edge, count] : this->UsesWithin(target))
  {
    if (count == 1)
    {
      ++numRim;
      if (progress.Front.count(edge) == 0)
      {
        const auto& uses = this->Edges.at(edge).Uses;
        blockers.insert(target.count(uses[0].Face) > 0 ? uses[0].Face : uses[1].Face);
      }
    }
  }
  if (target.empty() || !blockers.empty() || numRim != progress.Front.size() ||
    !this->IsConnected(target))
  {
    return false;
  }
  sweep.Body = this->Body;
  sweep.Source = given;
  sweep.Target.assign(target.begin(), target.end());
  for (const auto& end : { sweep.Source, sweep.Target })
  {
    const std::set<int> bent = this->BentFaces(end);
    blockers.insert(bent.begin(), bent.end());
  }
  if (!blockers.empty())
  {
    return false;
  }
  sweep.Linking.assign(progress.Linking.begin(), progress.Linking.end());
  const auto rows = static_cast<Eigen::Index>(progress.Front.size() * (Samples + 1));
  sweep.Origin.resize(rows, 3);
  sweep.Arrival.resize(rows, 3);
  Eigen::Index row = 0;
  for (const auto& [edge, origins] : progress.Front)
  {
    for (int i = 0; i <= Samples; ++i)
    {
      sweep.Origin.row(row) = origins[At(i)].transpose();
      sweep.Arrival.row(row++) =
        this->Model.EdgePoint(edge, static_cast<double>(i) / Samples).transpose();
    }
  }
  for (const int face : sweep.Linking)
  {
    const auto sides = this->Mesher.Sides(face);
    for (std::size_t s = 0; s < 2; ++s)
    {
      EqualChains chains;
      for (const CADTopologyUse& use : sides[s])
      {
        chains.One.push_back(use.Edge);
      }
      for (const CADTopologyUse& use : sides[s + 2])
      {
        chains.Other.push_back(use.Edge);
      }
      sweep.Equal.push_back(std::move(chains));
    }
  }
  sweep.Score = this->Score(sweep);
  if (!this->AddLayers(source, progress, sweep))
  {
    return false;
  }
  if (!this->MatchImprints(sweep))
  {
    sweep.Mirrored = true;
    if (!this->MatchImprints(sweep))
    {
      return false;
    }
  }
  sweep.IsBlock = this->HasSameCorners(sweep, progress);
  return true;
}
}
