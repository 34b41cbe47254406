// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceGrowth.h"

#include "TriangleSag.h"
#include <knotwork/SplineCore/FitProfileSurface.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <set>

namespace knotwork
{
namespace
{
using Eigen::Vector3d;

constexpr double LargestLean = 0.5235987755982988; // 30 degrees between facet and surface at points
constexpr double LargestTurn = 1.0471975511965976; // 60 degrees between facets of a surface
constexpr double HeightOfSliver = 4.0;             // noises: normals of flatter facets say nothing
constexpr std::size_t MostNeighbours = 8;
constexpr std::size_t ClustersOfRow = 6;
constexpr std::size_t PointsOfFlat = 5; ///< of facets in one plane from which on they are a face
constexpr int MostFits = 12;            ///< while a surface grows
/// A surface of more parameters must cover more points than one of fewer, by so many and this
/// share.
constexpr int MorePoints = 2;
constexpr double MoreShare = 0.1;
/// One through as many points is taken when edges lie nearer to it by that factor at least.
constexpr double LessSag = 1.2;
constexpr int StepsOfJoin = 300;
constexpr double Hopeless = 4.0; ///< noises: fits that are farther after some steps come to nothing

/// The simplest region that has about as many points as any.
GrownRegion Choose(std::vector<GrownRegion> found, int seed, double noise)
{
  // by parameters, and by how far the edges' middles lie from them where there are as many points
  std::stable_sort(found.begin(), found.end(),
    [](const GrownRegion& a, const GrownRegion& b)
    { return NumSurfaceParameters(a.Surface.Type) < NumSurfaceParameters(b.Surface.Type); });
  GrownRegion best;
  best.Clusters = { seed };
  best.Surface.Type = SurfaceType::FreeForm;
  for (GrownRegion& region : found)
  {
    const int more =
      NumSurfaceParameters(region.Surface.Type) - NumSurfaceParameters(best.Surface.Type) > 0
      ? std::max(MorePoints, static_cast<int>(MoreShare * best.NumPoints))
      : 0;
    const bool covers = region.NumPoints > best.NumPoints + more;
    const bool closer = region.NumPoints >= best.NumPoints &&
      best.Surface.Type != SurfaceType::Plane && LessSag * region.MeanSag + noise < best.MeanSag;
    if (best.NumPoints == 0 || covers || closer)
    {
      best = std::move(region);
    }
  }
  return best;
}

std::vector<int> Unique(std::vector<int> values)
{
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}
}

SurfaceGrowth::SurfaceGrowth(
  const DiscMesh& surface, const FacetClusters& facets, double noise, double sag)
  : Surface(surface), Facets(facets), Noise(noise), Sag(sag)
{
}

std::vector<int> SurfaceGrowth::PointIdsOf(const std::vector<int>& clusters) const
{
  std::vector<int> ids;
  for (int c : clusters)
  {
    const auto& more = this->Facets.Clusters[static_cast<std::size_t>(c)].Points;
    ids.insert(ids.end(), more.begin(), more.end());
  }
  return Unique(std::move(ids));
}

std::vector<Vector3d> SurfaceGrowth::PointsOf(const std::vector<int>& clusters) const
{
  std::vector<Vector3d> points;
  for (int id : this->PointIdsOf(clusters))
  {
    points.push_back(this->Surface.Point(id));
  }
  return points;
}

std::vector<FlatPiece> SurfaceGrowth::PiecesOf(const std::vector<int>& clusters) const
{
  std::vector<FlatPiece> pieces;
  for (int c : clusters)
  {
    pieces.push_back(this->Facets.Clusters[static_cast<std::size_t>(c)].Piece);
  }
  return pieces;
}

bool SurfaceGrowth::IsWithin(int cluster, const AnalyticSurface& surface, double distance) const
{
  const auto& points = this->Facets.Clusters[static_cast<std::size_t>(cluster)].Points;
  return std::all_of(points.begin(), points.end(),
    [&](int p) { return std::abs(surface.Distance(this->Surface.Point(p))) <= distance; });
}

bool SurfaceGrowth::IsSliver(int cluster) const
{
  const auto& triangles = this->Facets.Clusters[static_cast<std::size_t>(cluster)].Triangles;
  return std::all_of(triangles.begin(), triangles.end(),
    [&](int t)
    { return this->Facets.Heights[static_cast<std::size_t>(t)] < HeightOfSliver * this->Noise; });
}

bool SurfaceGrowth::Fits(int number, const AnalyticSurface& surface, bool reversed) const
{
  const FacetCluster& cluster = this->Facets.Clusters[static_cast<std::size_t>(number)];
  if (!this->IsWithin(number, surface, this->Noise))
  {
    return false;
  }
  const double lean = std::cos(LargestLean);
  for (int t : cluster.Triangles)
  {
    const auto at = static_cast<std::size_t>(t);
    const auto& corners = this->Surface.Triangles[at];
    const bool sliver = this->Facets.Heights[at] < HeightOfSliver * this->Noise;
    for (std::size_t k = 0; k < 3; ++k)
    {
      const Vector3d a = this->Surface.Point(corners[k]);
      const Vector3d b = this->Surface.Point(corners[(k + 1) % 3]);
      const Vector3d normal = surface.Normal(a);
      const double cosine = (reversed ? -1.0 : 1.0) * normal.dot(this->Facets.Normals[at]);
      const bool isApex = surface.Type == SurfaceType::Cone &&
        (a - surface.Point).cross(surface.Axis).norm() < HeightOfSliver * this->Noise;
      if ((!sliver && !isApex && cosine < lean) ||
        !(std::abs(surface.Distance((a + b) / 2.0)) <= this->Sag + this->Noise))
      {
        return false;
      }
    }
  }
  if (surface.Type == SurfaceType::Plane || cluster.Points.size() < PointsOfFlat)
  {
    return true;
  }
  const Vector3d offset = cluster.Piece.Centre - surface.Point;
  const double ofCentre = offset.cross(surface.Axis).norm();
  if (surface.Type == SurfaceType::Cone)
  {
    for (int p : cluster.Points) // a disc about the axis is no strip
    {
      const Vector3d other = this->Surface.Point(p) - surface.Point;
      if (ofCentre < 0.4 * other.cross(surface.Axis).norm())
      {
        return false;
      }
    }
  }
  // a plane meets cylinders and cones in rulings, but a sphere or torus in a circle around it
  const bool rulings = surface.Type == SurfaceType::Cylinder || surface.Type == SurfaceType::Cone ||
    HasProfile(surface.Type); // a profile may be straight
  return std::abs(surface.Distance(cluster.Piece.Centre)) <= (rulings ? this->Sag : this->Noise);
}

double SurfaceGrowth::Cost(int number, const AnalyticSurface& surface) const
{
  const FacetCluster& cluster = this->Facets.Clusters[static_cast<std::size_t>(number)];
  double sum = 0.0;
  for (int p : cluster.Points)
  {
    const double distance = surface.Distance(this->Surface.Point(p));
    sum += distance * distance;
  }
  double height = 0.0;
  for (int t : cluster.Triangles)
  {
    height = std::max(height, this->Facets.Heights[static_cast<std::size_t>(t)]);
  }
  const double lean =
    height * surface.Normal(cluster.Piece.Centre).cross(cluster.Piece.Normal).norm() / 2.0;
  return sum / static_cast<double>(cluster.Points.size()) + lean * lean;
}

void SurfaceGrowth::Refit(GrownRegion& region) const
{
  const std::vector<Vector3d> points = this->PointsOf(region.Clusters);
  AnalyticSurface better = region.Surface;
  region.NumPoints = static_cast<int>(points.size());
  // least squares may leave a point farther away than it may be
  if (FitSurface(points, better) &&
    (MaxDistance(points, better) <= this->Noise ||
      MaxDistance(points, better) <= MaxDistance(points, region.Surface)))
  {
    region.Surface = better;
  }
}

void SurfaceGrowth::Flatten(GrownRegion& region) const
{
  const std::vector<Vector3d> points = this->PointsOf(region.Clusters);
  GrownRegion flat = region;
  flat.NumPoints = static_cast<int>(points.size());
  if (GuessSurface(SurfaceType::Plane, points, this->PiecesOf(region.Clusters), flat.Surface) &&
    FitSurface(points, flat.Surface))
  {
    const FlatPiece& first =
      this->Facets.Clusters[static_cast<std::size_t>(region.Clusters.front())].Piece;
    flat.Reversed = flat.Surface.Normal(first.Centre).dot(first.Normal) < 0.0;
    if (std::all_of(region.Clusters.begin(), region.Clusters.end(),
          [&](int cluster) { return this->Fits(cluster, flat.Surface, flat.Reversed); }))
    {
      region = std::move(flat);
    }
  }
}

void SurfaceGrowth::Reconsider(bool isSingleRow, GrownRegion& region) const
{
  constexpr double MuchNearer = 0.5;
  if (region.Surface.Type == SurfaceType::Plane || region.Surface.Type == SurfaceType::FreeForm ||
    region.Clusters.size() < 2)
  {
    return;
  }
  const std::vector<Vector3d> points = this->PointsOf(region.Clusters);
  const std::vector<FlatPiece> pieces = this->PiecesOf(region.Clusters);
  region.MeanSag = this->MeanSag(region);
  for (const SurfaceType type : { SurfaceType::Cylinder, SurfaceType::Sphere, SurfaceType::Cone })
  {
    GrownRegion other = region;
    if (type == region.Surface.Type || !GuessSurface(type, points, pieces, other.Surface) ||
      !FitSurface(points, other.Surface))
    {
      continue;
    }
    const FlatPiece& first = pieces.front();
    other.Reversed = other.Surface.Normal(first.Centre).dot(first.Normal) < 0.0;
    if (!std::all_of(region.Clusters.begin(), region.Clusters.end(),
          [&](int cluster) { return this->Fits(cluster, other.Surface, other.Reversed); }))
    {
      continue;
    }
    other.MeanSag = this->MeanSag(other);
    const bool isLikelier = type < region.Surface.Type ||
      (isSingleRow && type == SurfaceType::Cone && region.Surface.Type == SurfaceType::Sphere);
    const double share = isLikelier ? 1.0 : MuchNearer;
    if (other.MeanSag <= share * region.MeanSag)
    {
      region = std::move(other);
    }
  }
}

bool SurfaceGrowth::Settle(GrownRegion& made, GrownRegion& region) const
{
  const FlatPiece& first =
    this->Facets.Clusters[static_cast<std::size_t>(made.Clusters.front())].Piece;
  made.Reversed = made.Surface.Normal(first.Centre).dot(first.Normal) < 0.0;
  if (!std::all_of(made.Clusters.begin(), made.Clusters.end(),
        [&](int cluster) { return this->Fits(cluster, made.Surface, made.Reversed); }))
  {
    return false;
  }
  made.MeanSag = this->MeanSag(made);
  region = std::move(made);
  return true;
}

bool SurfaceGrowth::FitProfile(
  SurfaceType type, const std::vector<char>& flat, GrownRegion& region) const
{
  constexpr double NearShare = 0.125; // of the noise: no more spans are worth while
  const std::vector<int> ids = this->PointIdsOf(region.Clusters);
  std::vector<std::array<int, 2>> edges = this->EdgesOf(region.Clusters);
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::vector<char> straight(edges.size(), 0);
  for (const int c : region.Clusters)
  {
    if (flat[static_cast<std::size_t>(c)])
    {
      for (const auto& edge : this->EdgesOf({ c }))
      {
        straight[static_cast<std::size_t>(
          std::lower_bound(edges.begin(), edges.end(), edge) - edges.begin())] = 1;
      }
    }
  }
  for (auto& edge : edges)
  {
    for (int& end : edge)
    {
      end = static_cast<int>(std::lower_bound(ids.begin(), ids.end(), end) - ids.begin());
    }
  }
  GrownRegion made = region;
  made.NumPoints = static_cast<int>(ids.size());
  if (!FitProfileSurface(type, this->PointsOf(region.Clusters), edges, straight,
        this->PiecesOf(region.Clusters), NearShare * this->Noise, made.Surface))
  {
    return false;
  }
  return this->Settle(made, region);
}

bool SurfaceGrowth::FitType(
  SurfaceType type, const std::vector<const GrownRegion*>& parts, GrownRegion& region) const
{
  const std::vector<Vector3d> points = this->PointsOf(region.Clusters);
  std::vector<AnalyticSurface> starts(1);
  if (!GuessSurface(type, points, this->PiecesOf(region.Clusters), starts.front()))
  {
    starts.clear();
  }
  const auto addTorus = [&](AnalyticSurface start)
  {
    if (type == SurfaceType::Torus && GuessTorusAbout(points, start))
    {
      starts.push_back(start);
    }
  };
  for (const GrownRegion* part : parts)
  {
    const AnalyticSurface& own = part->Surface;
    if (own.Type == type)
    {
      starts.push_back(own);
    }
    else if (own.Type == SurfaceType::Cylinder || own.Type == SurfaceType::Cone)
    {
      addTorus(own);
    }
    if (AnalyticSurface circle; GuessCircleAxis(this->PointsOf(part->Clusters), circle))
    {
      addTorus(circle);
    }
  }
  if (AnalyticSurface circle; GuessCircleAxis(points, circle))
  {
    addTorus(circle);
  }
  GrownRegion made = region;
  made.NumPoints = static_cast<int>(points.size());
  double least = HUGE_VAL;
  for (AnalyticSurface& start : starts)
  {
    const double squares = FitSurface(points, start, Hopeless * this->Noise, StepsOfJoin)
      ? SumOfSquaredDistances(points, start)
      : HUGE_VAL;
    if (squares < least)
    {
      least = squares;
      made.Surface = start;
    }
  }
  return least < HUGE_VAL && this->Settle(made, region);
}

double SurfaceGrowth::Squares(
  const std::vector<int>& clusters, const AnalyticSurface& surface) const
{
  return SumOfSquaredDistances(this->PointsOf(clusters), surface);
}

std::array<double, 2> SurfaceGrowth::Residuals(const GrownRegion& region) const
{
  double largest = 0.0;
  double sum = 0.0;
  const std::vector<Vector3d> points = this->PointsOf(region.Clusters);
  for (const Vector3d& point : points)
  {
    const double distance = std::abs(region.Surface.Distance(point));
    largest = std::max(largest, distance);
    sum += distance * distance;
  }
  return { largest, std::sqrt(sum / static_cast<double>(points.size())) };
}

bool SurfaceGrowth::Grow(const AnalyticSurface& guess, const Guess& from,
  const std::vector<int>& regions, GrownRegion& region) const
{
  region.Surface = guess;
  const FlatPiece& first = this->Facets.Clusters[static_cast<std::size_t>(from.front())].Piece;
  region.Reversed = guess.Normal(first.Centre).dot(first.Normal) < 0.0;
  std::size_t fitted = this->PointsOf(from).size();
  std::vector<char> reached(this->Facets.Clusters.size(), 0);
  for (int round = 0; round < MostFits; ++round)
  {
    for (int c : from)
    {
      if (!this->Fits(c, region.Surface, region.Reversed))
      {
        return false;
      }
    }
    std::fill(reached.begin(), reached.end(), 0);
    region.Clusters = { from.front() };
    reached[static_cast<std::size_t>(from.front())] = 1;
    for (std::size_t i = 0; i < region.Clusters.size(); ++i)
    {
      for (const ClusterSide& side :
        this->Facets.Sides[static_cast<std::size_t>(region.Clusters[i])])
      {
        const auto other = static_cast<std::size_t>(side.Cluster);
        if (!reached[other] && regions[other] < 0 && side.Angle < LargestTurn)
        {
          reached[other] = 1;
          if (this->Fits(side.Cluster, region.Surface, region.Reversed))
          {
            region.Clusters.push_back(side.Cluster);
          }
        }
      }
    }
    const std::vector<Vector3d> points = this->PointsOf(region.Clusters);
    region.NumPoints = static_cast<int>(points.size());
    if (points.size() <= fitted && round > 0)
    {
      break;
    }
    fitted = points.size();
    AnalyticSurface better = region.Surface;
    if (!FitSurface(points, better) || MaxDistance(points, better) > 2.0 * this->Noise)
    {
      break; // what is grown next drops points that are too far
    }
    region.Surface = better;
  }
  region.MeanSag = this->MeanSag(region);
  return true;
}

std::vector<std::array<int, 2>> SurfaceGrowth::EdgesOf(const std::vector<int>& clusters) const
{
  std::vector<std::array<int, 2>> edges;
  for (int c : clusters)
  {
    for (int t : this->Facets.Clusters[static_cast<std::size_t>(c)].Triangles)
    {
      const auto& corners = this->Surface.Triangles[static_cast<std::size_t>(t)];
      for (std::size_t k = 0; k < 3; ++k)
      {
        const int a = corners[k];
        const int b = corners[(k + 1) % 3];
        edges.push_back({ std::min(a, b), std::max(a, b) });
      }
    }
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

std::vector<std::array<int, 2>> SurfaceGrowth::EdgesInside(const std::vector<int>& clusters) const
{
  const std::vector<std::array<int, 2>> edges = this->EdgesOf(clusters);
  std::vector<std::array<int, 2>> twice;
  for (std::size_t i = 1; i < edges.size(); ++i)
  {
    if (edges[i] == edges[i - 1])
    {
      twice.push_back(edges[i]);
    }
  }
  return twice;
}

double SurfaceGrowth::MeanSag(const GrownRegion& region) const
{
  const auto edges = this->EdgesInside(region.Clusters);
  double sum = 0.0;
  for (const auto& [a, b] : edges)
  {
    const double sag =
      region.Surface.Distance((this->Surface.Point(a) + this->Surface.Point(b)) / 2.0);
    sum += sag * sag;
  }
  return edges.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(edges.size()));
}

void SurfaceGrowth::Measure(const GrownRegion& region, double& distance, double& sag) const
{
  distance = MaxDistance(this->PointsOf(region.Clusters), region.Surface);
  sag = 0.0;
  for (int c : region.Clusters)
  {
    for (int t : this->Facets.Clusters[static_cast<std::size_t>(c)].Triangles)
    {
      const auto& corners = this->Surface.Triangles[static_cast<std::size_t>(t)];
      sag = std::max(sag,
        MaxMiddleDistance(region.Surface,
          { this->Surface.Point(corners[0]), this->Surface.Point(corners[1]),
            this->Surface.Point(corners[2]) }));
    }
  }
}

bool SurfaceGrowth::Try(SurfaceType type, const Guess& from, const std::vector<int>& regions,
  std::vector<GrownRegion>& found) const
{
  for (const GrownRegion& other : found) // it is covered by that type already
  {
    if (other.Surface.Type == type &&
      std::all_of(from.begin(), from.end(),
        [&](int c) {
          return std::find(other.Clusters.begin(), other.Clusters.end(), c) != other.Clusters.end();
        }))
    {
      return true;
    }
  }
  const std::vector<Vector3d> points = this->PointsOf(from);
  AnalyticSurface surface;
  GrownRegion region;
  if (!GuessSurface(type, points, this->PiecesOf(from), surface) || !FitSurface(points, surface) ||
    MaxDistance(points, surface) > this->Noise || !this->Grow(surface, from, regions, region))
  {
    return false;
  }
  found.push_back(std::move(region));
  return true;
}

std::vector<int> SurfaceGrowth::NeighboursOf(int cluster, const std::vector<int>& regions) const
{
  // strips of a fillet are not guessed together with the flat face beside them
  const bool large =
    this->Facets.Clusters[static_cast<std::size_t>(cluster)].Points.size() >= PointsOfFlat;
  std::vector<std::pair<double, int>> found;
  for (const ClusterSide& side : this->Facets.Sides[static_cast<std::size_t>(cluster)])
  {
    const double length = this->LengthOf(side);
    const auto other = static_cast<std::size_t>(side.Cluster);
    const bool isFace = this->Facets.Clusters[other].Points.size() >= PointsOfFlat;
    if (side.Angle < LargestTurn && regions[other] < 0 && (!isFace || large))
    {
      found.emplace_back(-length, side.Cluster);
    }
  }
  std::sort(found.begin(), found.end());
  std::vector<int> neighbours;
  for (const auto& [length, other] : found)
  {
    if (std::find(neighbours.begin(), neighbours.end(), other) == neighbours.end() &&
      neighbours.size() < MostNeighbours)
    {
      neighbours.push_back(other);
    }
  }
  return neighbours;
}

void SurfaceGrowth::AddNeighbours(const std::vector<int>& regions, Guess& clusters) const
{
  std::set<int> known(clusters.begin(), clusters.end());
  const std::size_t count = clusters.size();
  for (std::size_t i = 0; i < count; ++i)
  {
    for (int other : this->NeighboursOf(clusters[i], regions))
    {
      if (known.insert(other).second)
      {
        clusters.push_back(other);
      }
    }
  }
}

void SurfaceGrowth::DropThroughPlane(std::vector<GrownRegion>& found) const
{
  if (found.empty() || found.front().Surface.Type != SurfaceType::Plane ||
    found.front().NumPoints < static_cast<int>(PointsOfFlat))
  {
    return;
  }
  Vector3d centre = Vector3d::Zero();
  double area = 0.0;
  for (const int c : found.front().Clusters)
  {
    const FacetCluster& cluster = this->Facets.Clusters[static_cast<std::size_t>(c)];
    centre += cluster.Area * cluster.Piece.Centre;
    area += cluster.Area;
  }
  centre /= area;
  found.erase(std::remove_if(found.begin() + 1, found.end(),
                [&](const GrownRegion& region)
                {
                  const SurfaceType type = region.Surface.Type;
                  const bool rulings = type == SurfaceType::Cylinder || type == SurfaceType::Cone;
                  return std::abs(region.Surface.Distance(centre)) >
                    (rulings ? this->Sag : 2.0 * this->Noise);
                }),
    found.end());
}

GrownRegion SurfaceGrowth::BestRegion(int seed, const std::vector<int>& regions) const
{
  std::vector<GrownRegion> found;
  this->Try(SurfaceType::Plane, { seed }, regions, found);
  const std::vector<int> neighbours = this->NeighboursOf(seed, regions);
  Guess ring = { seed };
  ring.insert(ring.end(), neighbours.begin(), neighbours.end());
  Guess second = ring;
  this->AddNeighbours(regions, second);
  const auto isSmall = [&](int c)
  { return this->Facets.Clusters[static_cast<std::size_t>(c)].Points.size() < PointsOfFlat; };
  for (int g : neighbours)
  {
    if (isSmall(seed) && isSmall(g)) // the plane of one triangle is not that of two with noise
    {
      std::vector<GrownRegion> planes;
      this->Try(SurfaceType::Plane, { seed, g }, regions, planes);
      if (!planes.empty() && planes.front().NumPoints < static_cast<int>(PointsOfFlat))
      {
        found.push_back(std::move(planes.front())); // larger ones of free shapes are chance
      }
    }
    this->Try(SurfaceType::Cylinder, { seed, g }, regions, found);
    this->Try(SurfaceType::Sphere, { seed, g }, regions, found);
  }
  for (std::size_t i = 0; i < neighbours.size(); ++i)
  {
    for (std::size_t j = i + 1; j < neighbours.size(); ++j)
    {
      const Guess three = { seed, neighbours[i], neighbours[j] };
      this->Try(SurfaceType::Cone, three, regions, found);
      this->Try(SurfaceType::Sphere, three, regions, found);
      this->Try(SurfaceType::Cylinder, three, regions, found);
    }
  }
  for (SurfaceType type :
    { SurfaceType::Cylinder, SurfaceType::Cone, SurfaceType::Sphere, SurfaceType::Torus })
  {
    this->Try(type, ring, regions, found);
    this->Try(type, second, regions, found);
  }
  Guess third = second;
  this->AddNeighbours(regions, third);
  this->Try(SurfaceType::Torus, third, regions, found);
  this->DropThroughPlane(found);
  GrownRegion best = Choose(found, seed, this->Noise);
  if (best.Surface.Type != SurfaceType::Plane && best.Clusters.size() >= ClustersOfRow)
  {
    // a row of a torus lies on a sphere or cone, too: the rows beside it tell
    Guess rows = best.Clusters;
    this->AddNeighbours(regions, rows);
    found = { best };
    this->Try(SurfaceType::Torus, rows, regions, found);
    best = Choose(found, seed, this->Noise);
  }
  return best;
}
}
