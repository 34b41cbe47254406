// SPDX-License-Identifier: BSD-3-Clause
#include "ScanFeatures.h"

#include "FeatureEdges.h"
#include "FeatureGaps.h"
#include "FeatureRegions.h"
#include "FittedNormals.h"
#include "MeshNoise.h"
#include "NarrowBands.h"

#include <knotwork/SplineCore/AngleBetween.h>
#include <knotwork/SplineCore/TriangleIndex.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace knotwork
{
namespace
{
constexpr double PrecisionShare = 1.0 / 16.0; // of SharpAngle: of fitted normals
constexpr double SideShare = 0.5;             // of SharpAngle: what turns by more is another side
constexpr double KnownShare = 1.0 / 8.0;      // of SharpAngle: worse normals are not known
constexpr double BluntShare = 0.5;            // of WeakAngle: bounds of bands, and gaps
constexpr double PatchShare = 0.5; // of the patches of its normals, below which a region is none
constexpr double NoiseShare = 0.3; // of the time of a part
constexpr double FitShare = 0.6;
constexpr double Pi = 3.14159265358979323846;

Status CheckAll(const TriangleMesh& mesh, const ScanFeatureParams& params)
{
  if (Status status = CheckParams(params.Angles); !status)
  {
    return status;
  }
  const auto isShare = [](double value) { return value >= 0.0 && value <= 1.0; };
  if (!std::isfinite(params.Noise))
  {
    return { ErrorCode::InvalidParameter, "Noise must be finite; below 0 it is estimated" };
  }
  if (!(params.SmallestRegion >= 0.0 && params.SmallestRegion < 1.0))
  {
    return { ErrorCode::InvalidParameter,
      "SmallestRegion must be at least 0 and below 1, a share of the area" };
  }
  if (!isShare(params.NarrowWidth) || !isShare(params.LargestGap))
  {
    return { ErrorCode::InvalidParameter,
      std::string(isShare(params.NarrowWidth) ? "LargestGap" : "NarrowWidth") +
        " must be between 0 and 1, a share of the diagonal of the mesh's box" };
  }
  const KnownFeatures& known = params.Known;
  if (known.Only && known.Edges.empty() && known.Regions.empty())
  {
    return { ErrorCode::InvalidParameter,
      "known features replace what would be found (Mode REPLACE), and none are given; give edges "
      "(input 1) or regions (RegionArray), or take Mode EXTEND" };
  }
  if (!known.Regions.empty() && known.Regions.size() != mesh.Triangles.size())
  {
    return { ErrorCode::SizeMismatch,
      std::to_string(known.Regions.size()) + " known regions for " +
        std::to_string(mesh.Triangles.size()) + " triangles; give one a triangle" };
  }
  for (std::size_t i = 0; i < known.Edges.size(); ++i)
  {
    for (const int end : known.Edges[i])
    {
      if (end < 0 || end >= mesh.Points.rows())
      {
        return { ErrorCode::OutsideDomain,
          "known edge " + std::to_string(i) + " has the point " + std::to_string(end) +
            "; the mesh has " + std::to_string(mesh.Points.rows()) + " points, from 0" };
      }
    }
  }
  return {};
}

/// A part of a mesh on its way.
struct Part
{
  DiscMesh Surface;
  std::vector<MeshEdge> Known; ///< ascending, of its own points
};

/// What holds for a part, in the unit of the points: but for the area nothing beside it counts.
struct Limits
{
  double Noise = 0.0;
  double Area = 0.0; ///< of the smallest region
  double Width = 0.0;
  double Gap = 0.0;
};

/// The features of a part, with its own numbers.
struct PartFeatures
{
  MeshFeatures Found;
  std::vector<FeatureLine> Lines;
  int Joined = 0;
  int ClosedGaps = 0;
  int SharpEdges = 0;
  int RimEdges = 0;
  double Noise = 0.0;
};

class PartFinder
{
public:
  /// @param area  of the smallest region.
  PartFinder(const Part& part, const ScanFeatureParams& params, double area)
    : Params(params), Parts(part.Surface, NoHoles), Known(this->Parts), Marks(this->Parts)
  {
    this->Known.Set(part.Known);
    const PointMatrix& points = part.Surface.Points;
    const double diagonal = (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
    this->Limit.Noise = params.Noise;
    this->Limit.Area = area;
    this->Limit.Width = params.NarrowWidth * diagonal;
    this->Limit.Gap = params.LargestGap * diagonal;
  }

  /// @return Aborted.
  Result<PartFeatures> Find(const ProgressCallback& progress)
  {
    if (this->Params.Noise < 0.0)
    {
      const auto noise = EstimateNoise(this->Parts, this->Params.Threads,
        [&](double share) { return progress(NoiseShare * share); });
      if (!noise)
      {
        return noise.Status;
      }
      this->Limit.Noise = noise.Value;
    }
    NormalFitParams fit;
    fit.Noise = this->Limit.Noise;
    fit.Precision = this->Params.Angles.SharpAngle * PrecisionShare / Degrees;
    fit.Bend = this->Params.Angles.SharpAngle * SideShare / Degrees;
    fit.Known = this->KnownDeviation;
    fit.Threads = this->Params.Threads;
    fit.Progress = [&](double share) { return progress(NoiseShare + FitShare * share); };
    auto fitted =
      FitNormals(this->Parts, fit, [&](std::size_t t, std::size_t k) { return this->Known(t, k); });
    if (!fitted)
    {
      return fitted.Status;
    }
    this->Fitted = std::move(fitted.Value);
    this->MarkKnown();
    PartFeatures features;
    features.Noise = this->Limit.Noise;
    if (!this->Params.Known.Only)
    {
      this->Marks.Set(SharpEdges(this->Parts, this->Params.Angles, this->Angle));
      this->JoinBands(features);
      this->JoinSmall(features);
      features.ClosedGaps = CloseGaps(this->Parts, this->Angle,
        { this->Limit.Gap, BluntShare * this->Params.Angles.WeakAngle }, this->Marks);
      if (features.ClosedGaps > 0)
      {
        this->JoinSmall(features); // what they have divided may be too small
      }
      if (this->Limit.Noise > 0.0)
      {
        this->DropNoise();
      }
    }
    this->Trace(features);
    return features;
  }

private:
  double Diameter(std::size_t t) const { return 2.0 * std::sqrt(this->Fitted.Areas[t] / Pi); }

  void MarkKnown() { this->Marks.Set(this->Known.Edges()); }

  void JoinBands(PartFeatures& features)
  {
    const NarrowBandParams params = { this->Limit.Width, this->Params.Angles.SharpAngle,
      BluntShare * this->Params.Angles.WeakAngle };
    NarrowBands bands =
      FindNarrowBands(this->Parts, this->Fitted.Normals, this->Angle, params, this->Marks);
    this->Turns = std::move(bands.Turns);
    if (std::find(bands.InBand.begin(), bands.InBand.end(), 1) == bands.InBand.end())
    {
      return;
    }
    const RegionLabels labels = this->Label();
    features.Joined += JoinRegions(
      this->Parts, this->Angle, labels, this->Sums(labels, bands.InBand),
      [](const RegionSums& sums) { return sums.AllBand; }, this->Known, this->Marks);
    // chains that end within a band are none
    const RegionLabels joined = this->Label();
    VisitInnerEdges(this->Parts,
      [&](std::size_t t, std::size_t k)
      {
        const auto other = static_cast<std::size_t>(this->Parts.Adjacency.Triangle[t][k]);
        if (bands.InBand[t] && bands.InBand[other] && joined.Of[t] == joined.Of[other] &&
          !this->Known(t, k))
        {
          this->Marks.Set(t, k, false);
        }
      });
  }

  /// Regions that are smaller than is asked for, or no more than noise.
  void JoinSmall(PartFeatures& features)
  {
    const RegionLabels labels = this->Label();
    features.Joined += JoinRegions(
      this->Parts, this->Angle, labels, this->Sums(labels, {}),
      [&](const RegionSums& sums)
      {
        return !sums.HasKnown || sums.Area < this->Limit.Area ||
          sums.Area * sums.Area < PatchShare * sums.Patches;
      },
      this->Known, this->Marks);
  }

  /// @param inBand  one a triangle, or empty: none is.
  std::vector<RegionSums> Sums(const RegionLabels& labels, const std::vector<char>& inBand) const
  {
    std::vector<RegionSums> sums(static_cast<std::size_t>(labels.Count));
    for (std::size_t t = 0; t < labels.Of.size(); ++t)
    {
      const double area = this->Parts.Areas[t];
      sums[static_cast<std::size_t>(labels.Of[t])].Add({ area, area * this->Fitted.Areas[t],
        this->Fitted.Deviations[t] <= this->KnownDeviation, !inBand.empty() && inBand[t] != 0 });
    }
    return sums;
  }

  void DropNoise()
  {
    std::vector<double> sizes;
    for (std::size_t t = 0; t < this->Fitted.Areas.size(); ++t)
    {
      sizes.push_back(this->Diameter(t));
    }
    DropSpurs(this->Parts, sizes, this->Known, this->Marks);
  }

  RegionLabels Label() const
  {
    return LabelRegions(
      this->Parts, [&](std::size_t t, std::size_t k) { return this->Marks(t, k); });
  }

  void Trace(PartFeatures& features)
  {
    std::vector<MeshEdge> edges = this->Marks.Edges();
    const std::vector<MeshEdge> rims = RimEdges(this->Parts);
    features.SharpEdges = static_cast<int>(edges.size());
    features.RimEdges = static_cast<int>(rims.size());
    edges.insert(edges.end(), rims.begin(), rims.end());
    std::sort(edges.begin(), edges.end());
    std::vector<double> reach(static_cast<std::size_t>(this->Parts.Mesh.NumPoints()), 0.0);
    for (std::size_t t = 0; t < this->Fitted.Areas.size(); ++t)
    {
      for (const int corner : this->Parts.Mesh.Triangles[t])
      {
        double& own = reach[static_cast<std::size_t>(corner)];
        own = std::max(own, this->Diameter(t));
      }
    }
    features.Found = TraceFeatures(this->Parts, edges, this->Params.Angles.CornerAngle, reach);
    this->Measure(rims, features);
  }

  void Measure(const std::vector<MeshEdge>& rims, PartFeatures& features)
  {
    std::map<MeshEdge, double> angles;
    VisitInnerEdges(this->Parts,
      [&](std::size_t t, std::size_t k)
      {
        if (this->Marks(t, k))
        {
          const MeshEdge edge = EdgeOf(this->Parts, t, k);
          const auto turn = this->Turns.find(edge);
          angles[edge] = turn == this->Turns.end() ? this->Angle(t, k) : turn->second;
        }
      });
    for (FeatureChain& chain : features.Found.Chains)
    {
      FeatureLine line;
      const std::size_t count = chain.Points.size();
      line.IsRim =
        std::binary_search(rims.begin(), rims.end(), EdgeBetween(chain.Points[0], chain.Points[1]));
      for (std::size_t i = 0; i + 1 < count + (chain.Closed ? 1 : 0); ++i)
      {
        const int a = chain.Points[i];
        const int b = chain.Points[(i + 1) % count];
        const double length = (this->Parts.Mesh.Point(b) - this->Parts.Mesh.Point(a)).norm();
        const double angle = line.IsRim ? 0.0 : angles.at(EdgeBetween(a, b));
        line.Length += length;
        line.MeanAngle += length * angle;
        line.MaxAngle = std::max(line.MaxAngle, angle);
      }
      line.MeanAngle /= line.Length;
      line.Chain = std::move(chain);
      features.Lines.push_back(std::move(line));
    }
  }

  const ScanFeatureParams& Params;
  const double KnownDeviation = this->Params.Angles.SharpAngle * KnownShare / Degrees;
  Limits Limit;
  const std::vector<int> NoHoles;
  const SurfaceParts Parts;
  EdgeMarks Known;
  EdgeMarks Marks;
  FittedNormals Fitted;
  std::map<MeshEdge, double> Turns; ///< of edges that were bands
  const EdgeAngle Angle = [this](std::size_t t, std::size_t k)
  {
    const Eigen::Vector3d& own = this->Fitted.Normals[t];
    const Eigen::Vector3d& other =
      this->Fitted.Normals[static_cast<std::size_t>(this->Parts.Adjacency.Triangle[t][k])];
    return Degrees * AngleBetween(own, other);
  };
};

/// The way along edges between two points of a mesh.
struct Way
{
  std::size_t Part = 0;
  std::vector<int> Points; ///< of the part; empty: there is none
  double Length = std::numeric_limits<double>::infinity();
};

/// Where points lie: part and number there, of points where parts touch all of them.
using Places = std::map<int, std::vector<std::array<int, 2>>>;

/// The shortest way on a part that has both points, of equal ones on the first.
Way WayBetween(const std::vector<Part>& parts, const Places& places, int a, int b)
{
  Way shortest;
  for (const auto& [part, from] : places.at(a))
  {
    for (const auto& [other, to] : places.at(b))
    {
      if (part != other)
      {
        continue;
      }
      Way way;
      way.Part = static_cast<std::size_t>(part);
      const DiscMesh& surface = parts[way.Part].Surface;
      way.Points = ShortestWay(surface, from, to);
      way.Length = 0.0;
      for (std::size_t j = 0; j + 1 < way.Points.size(); ++j)
      {
        way.Length += (surface.Point(way.Points[j + 1]) - surface.Point(way.Points[j])).norm();
      }
      if (way.Length < shortest.Length)
      {
        shortest = std::move(way);
      }
    }
  }
  return shortest;
}

/// Known edges as edges of the parts. @param first  of equal points, the first one.
Status SetKnown(const KnownFeatures& known, const std::vector<int>& first, std::vector<Part>& parts)
{
  const auto firstOf = [&](int point) { return first[static_cast<std::size_t>(point)]; };
  Places places;
  for (const auto& [a, b] : known.Edges)
  {
    places[firstOf(a)];
    places[firstOf(b)];
  }
  for (std::size_t i = 0; i < parts.size() && !places.empty(); ++i)
  {
    const std::vector<int>& ids = parts[i].Surface.PointIds;
    for (std::size_t v = 0; v < ids.size(); ++v)
    {
      if (const auto found = places.find(ids[v]); found != places.end())
      {
        found->second.push_back({ static_cast<int>(i), static_cast<int>(v) });
      }
    }
  }
  for (std::size_t i = 0; i < known.Edges.size(); ++i)
  {
    const auto& [a, b] = known.Edges[i];
    const Way way = WayBetween(parts, places, firstOf(a), firstOf(b));
    if (way.Points.empty())
    {
      return { ErrorCode::InvalidTopology,
        "known edge " + std::to_string(i) + " (points " + std::to_string(a) + " and " +
          std::to_string(b) +
          ") does not lie on one connected part of the mesh; draw it along the "
          "surface" };
    }
    for (std::size_t j = 0; j + 1 < way.Points.size(); ++j)
    {
      parts[way.Part].Known.push_back(EdgeBetween(way.Points[j], way.Points[j + 1]));
    }
  }
  for (Part& part : parts)
  {
    if (!known.Regions.empty())
    {
      const std::vector<int> noHoles;
      const SurfaceParts surface(part.Surface, noHoles);
      const auto region = [&](int t)
      {
        return known
          .Regions[static_cast<std::size_t>(part.Surface.TriangleIds[static_cast<std::size_t>(t)])];
      };
      VisitInnerEdges(surface,
        [&](std::size_t t, std::size_t k)
        {
          if (region(static_cast<int>(t)) != region(surface.Adjacency.Triangle[t][k]))
          {
            part.Known.push_back(EdgeOf(surface, t, k));
          }
        });
    }
    std::sort(part.Known.begin(), part.Known.end());
    part.Known.erase(std::unique(part.Known.begin(), part.Known.end()), part.Known.end());
  }
  return {};
}

void Append(const DiscMesh& surface, PartFeatures&& part, ScanFeatures& all)
{
  const auto point = [&](int p) { return surface.PointIds[static_cast<std::size_t>(p)]; };
  for (FeatureLine& line : part.Lines)
  {
    for (int& p : line.Chain.Points)
    {
      p = point(p);
    }
    all.Lines.push_back(std::move(line));
  }
  for (const int corner : part.Found.Corners)
  {
    all.Corners.push_back(point(corner));
  }
  for (std::size_t t = 0; t < part.Found.Regions.size(); ++t)
  {
    all.RegionOfTriangle[static_cast<std::size_t>(surface.TriangleIds[t])] =
      all.NumRegions + part.Found.Regions[t];
  }
  all.NumRegions += part.Found.NumRegions;
  all.NumSharpEdges += part.SharpEdges;
  all.NumRimEdges += part.RimEdges;
  all.NumJoined += part.Joined;
  all.NumClosedGaps += part.ClosedGaps;
  all.Noise = std::max(all.Noise, part.Noise);
}
}

Result<ScanFeatures> FindScanFeatures(const TriangleMesh& mesh, const ScanFeatureParams& params)
{
  if (Status status = CheckAll(mesh, params); !status)
  {
    return status;
  }
  const std::vector<MeshComponent> components = ConnectedComponents(mesh);
  if (components.empty() || mesh.Triangles.empty())
  {
    return { ErrorCode::EmptyInput, "the mesh has no triangles" };
  }
  std::vector<Part> parts;
  double area = 0.0;
  for (const MeshComponent& component : components)
  {
    auto surface = CheckComponent(mesh, component);
    if (!surface)
    {
      return surface.Status;
    }
    area += surface->Area;
    parts.push_back({ std::move(surface.Value), {} });
  }
  if (Status status = SetKnown(params.Known, FirstOfEqualPoints(mesh.Points), parts); !status)
  {
    return status;
  }
  ScanFeatures all;
  all.RegionOfTriangle.assign(mesh.Triangles.size(), -1);
  for (std::size_t i = 0; i < parts.size(); ++i)
  {
    const auto at = [&](double share)
    {
      return !params.Progress ||
        params.Progress((static_cast<double>(i) + share) / static_cast<double>(parts.size()));
    };
    auto found = PartFinder(parts[i], params, params.SmallestRegion * area).Find(at);
    if (!found)
    {
      return found.Status;
    }
    if (!at(1.0))
    {
      return { ErrorCode::Aborted, "stopped in the search for features" };
    }
    Append(parts[i].Surface, std::move(found.Value), all);
  }
  return all;
}
}
