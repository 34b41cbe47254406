// SPDX-License-Identifier: BSD-3-Clause
#include "RegionEvidence.h"
#include <knotwork/MeshParameterization/TriangleAdjacency.h>
#include <knotwork/SplineCore/AngleBetween.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

double NumParameters(SurfaceType type)
{
  switch (type)
  {
    case SurfaceType::Plane:
      return 3.0;
    case SurfaceType::Sphere:
      return 4.0;
    case SurfaceType::Cylinder:
      return 5.0;
    case SurfaceType::Cone:
      return 6.0;
    case SurfaceType::Torus:
      return 7.0;
    case SurfaceType::Extrusion:
    case SurfaceType::Revolution:
      return 5.0; // of a direction or axis and a short profile
    case SurfaceType::FreeForm:
      break;
  }
  return HUGE_VAL;
}

/// Degrees between the normals of the two triangles at an edge, 0 on a rim.
double AngleAlong(const DiscMesh& surface, int from, int to)
{
  constexpr double Degrees = 180.0 / 3.14159265358979323846;
  const int begin = surface.FanStart[At(from)];
  const int end = surface.FanStart[At(from) + 1];
  const auto fan = surface.Fan.begin();
  const auto found = std::find(fan + begin, fan + end, to);
  const auto at = static_cast<int>(found - fan);
  const bool isOpen = surface.OnBoundary[At(from)] != 0;
  if (at == end || (isOpen && (at == begin || at + 1 == end)))
  {
    return 0.0;
  }
  const Eigen::Vector3d origin = surface.Point(from);
  const Eigen::Vector3d along = surface.Point(to) - origin;
  const auto offset = [&](int i) -> Eigen::Vector3d
  { return surface.Point(surface.Fan[At(i)]) - origin; };
  const Eigen::Vector3d left = along.cross(offset(at + 1 == end ? begin : at + 1));
  const Eigen::Vector3d right = offset(at == begin ? end - 1 : at - 1).cross(along);
  return Degrees * AngleBetween(left, right);
}

/// Lengths of the borders of regions with others.
class Borders
{
public:
  Borders(const DiscMesh& surface, const SurfaceRecognition& recognition)
    : Recognition(recognition), Sharp(recognition.Regions.size(), 0.0),
      All(recognition.Regions.size(), 0.0)
  {
    const auto adjacency = FindAdjacency(surface.Triangles);
    for (std::size_t t = 0; adjacency && t < surface.Triangles.size(); ++t)
    {
      for (std::size_t k = 0; k < 3; ++k)
      {
        const int beside = adjacency->Triangle[t][k];
        const int own = recognition.RegionOfTriangle[t];
        const int other = beside < 0 ? own : recognition.RegionOfTriangle[At(beside)];
        if (own == other)
        {
          continue;
        }
        const int a = surface.Triangles[t][k];
        const int b = surface.Triangles[t][(k + 1) % 3];
        const double length = (surface.Point(a) - surface.Point(b)).norm();
        const bool isSharp = AngleAlong(surface, a, b) >= SharpDegrees;
        this->All[At(own)] += length;
        (isSharp ? this->Sharp[At(own)] : this->Smooth[own][other]) += length;
      }
    }
  }

  /// Whether the mesh is sharp along most of a region's border, and goes on smoothly into what is
  /// of free form along little of it.
  bool EndAtEdges(int region) const
  {
    constexpr double LeastSharp = 0.5;
    constexpr double MostIntoFree = 0.25;
    double intoFree = 0.0;
    if (const auto smooth = this->Smooth.find(region); smooth != this->Smooth.end())
    {
      for (const auto& [other, length] : smooth->second)
      {
        const SurfaceType type = this->Recognition.Regions[At(other)].Surface.Type;
        intoFree += type == SurfaceType::FreeForm ? length : 0.0;
      }
    }
    const double all = this->All[At(region)];
    return all > 0.0 && this->Sharp[At(region)] >= LeastSharp * all &&
      intoFree <= MostIntoFree * all;
  }

private:
  const SurfaceRecognition& Recognition;
  std::map<int, std::map<int, double>> Smooth;
  std::vector<double> Sharp;
  std::vector<double> All;
};

}

bool IsOnItsSurface(const DiscMesh& surface, const RecognizedRegion& region, bool endsAtEdges,
  double tolerance, double noise)
{
  constexpr double Enough = 3.0;        // points a parameter
  constexpr double EnoughAtEdges = 2.0; // of what edges mark off
  constexpr double Many = 10.0;         // by which residuals of few points do not pass for noise
  constexpr double MaxNoise = 0.5;  // of the tolerance: what grew as far as it could goes up to it
  constexpr double MaxAlike = 0.25; // correlation of neighbours; that of noise is about 0
  std::map<int, double> distances;
  for (const int t : region.Triangles)
  {
    for (const int corner : surface.Triangles[At(t)])
    {
      distances[corner] = region.Surface.Distance(surface.Point(corner));
    }
  }
  const double parameters = NumParameters(region.Surface.Type);
  const auto count = static_cast<double>(distances.size());
  // facets of any shape are planes, and their rows cylinders
  const bool isQuiet = noise <= MaxNoise * tolerance;
  const bool isFlat = region.Surface.Type == SurfaceType::Plane && endsAtEdges;
  const double least =
    isFlat ? parameters + 2.0 : (endsAtEdges ? EnoughAtEdges : Enough) * parameters;
  if (count < least)
  {
    return false;
  }
  double squares = 0.0;
  double largest = 0.0;
  for (const auto& [point, distance] : distances)
  {
    squares += distance * distance;
    largest = std::max(largest, std::abs(distance));
  }
  if (largest <= ExactDistance * tolerance || endsAtEdges)
  {
    return true;
  }
  if (largest > MaxNoise * tolerance)
  {
    return false;
  }
  if (isQuiet || count < Many * parameters)
  {
    return isQuiet;
  }
  double products = 0.0;
  double pairs = 0.0;
  for (const int t : region.Triangles)
  {
    const auto& corners = surface.Triangles[At(t)];
    for (std::size_t k = 0; k < 3; ++k)
    {
      products += distances[corners[k]] * distances[corners[(k + 1) % 3]];
      ++pairs;
    }
  }
  return products / pairs < MaxAlike * squares / count;
}

double ReleaseDoubtfulRegions(const DiscMesh& surface, SurfaceRecognition& recognition)
{
  const Borders borders(surface, recognition);
  for (bool isNew = true; isNew;) // what is released is beside others
  {
    isNew = false;
    for (std::size_t r = 0; r < recognition.Regions.size(); ++r)
    {
      RecognizedRegion& region = recognition.Regions[r];
      if (region.Surface.Type != SurfaceType::FreeForm &&
        !IsOnItsSurface(surface, region, borders.EndAtEdges(static_cast<int>(r)),
          recognition.Tolerance, recognition.Noise))
      {
        region.Surface.Type = SurfaceType::FreeForm;
        isNew = true;
      }
    }
  }
  double analytic = 0.0;
  recognition.NumOfType = {};
  for (const RecognizedRegion& region : recognition.Regions)
  {
    ++recognition.NumOfType[static_cast<std::size_t>(region.Surface.Type)];
    for (const int t : region.Triangles)
    {
      analytic += region.Surface.Type == SurfaceType::FreeForm
        ? 0.0
        : TriangleArea(surface.Points, surface.Triangles[At(t)]);
    }
  }
  return analytic / surface.Area;
}

bool IsPatchwork(const DiscMesh& surface, const SurfaceRecognition& recognition)
{
  SurfaceRecognition left = recognition;
  ReleaseDoubtfulRegions(surface, left);
  double doubtful = 0.0;
  for (std::size_t r = 0; r < left.Regions.size(); ++r)
  {
    const RecognizedRegion& region = left.Regions[r];
    if (region.Surface.Type == SurfaceType::FreeForm &&
      region.MaxDistance > ExactDistance * recognition.Tolerance)
    {
      for (const int t : region.Triangles)
      {
        doubtful += TriangleArea(surface.Points, surface.Triangles[At(t)]);
      }
    }
  }
  return doubtful > 0.5 * surface.Area;
}

}
