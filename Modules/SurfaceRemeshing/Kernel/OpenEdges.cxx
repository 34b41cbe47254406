// SPDX-License-Identifier: BSD-3-Clause
#include "OpenEdges.h"

#include "HoleFilling.h"
#include "SheetArrangement.h"
#include "SoupCleaning.h"
#include "TrianglePairs.h"

#include <knotwork/SplineCore/Numbers.h>

#include <algorithm>

namespace knotwork
{
namespace
{
constexpr double LooseShare = 0.05; ///< of the area: open pieces above are no loose ones

std::vector<std::pair<int, int>> SortedOpen(const SoupDefects& defects)
{
  std::vector<std::pair<int, int>> open = defects.OpenEdges;
  std::sort(open.begin(), open.end());
  return open;
}

/// Edges that others meet, or that lie beside each other divided differently, become common.
Status JoinOpenEdges(RepairSoup& soup, OngoingRepair& repair)
{
  const SoupDefects before = soup.Defects();
  const std::vector<std::pair<int, int>> openBefore = SortedOpen(before);
  std::vector<char> isOpen(soup.Triangles.size(), 0);
  for (const SoupSide& side : SortedSides(soup.Triangles))
  {
    const std::pair<int, int> edge = side.Forward ? std::make_pair(side.First, side.Second)
                                                  : std::make_pair(side.Second, side.First);
    if (std::binary_search(openBefore.begin(), openBefore.end(), edge))
    {
      isOpen[static_cast<std::size_t>(side.Triangle)] = 1;
    }
  }
  const std::vector<std::pair<int, int>> pairs =
    FindIntersections(soup.Points, soup.Triangles, repair.Params.Threads);
  const bool needed = std::any_of(pairs.begin(), pairs.end(),
    [&](const auto& pair)
    {
      return isOpen[static_cast<std::size_t>(pair.first)] ||
        isOpen[static_cast<std::size_t>(pair.second)];
    });
  if (!needed)
  {
    return {};
  }
  repair.AddIntersections(soup, pairs);
  Result<DividedTriangles> divided = DivideTriangles(soup.Points, soup.Triangles, pairs);
  if (!divided)
  {
    return divided.Status;
  }
  RepairSoup next;
  next.Points = std::move(divided->Points);
  next.Triangles = ReplaceCorners(std::move(divided->Triangles), FirstOfEqualPoints(next.Points));
  for (const int source : divided->Sources)
  {
    next.Sources.push_back(soup.Sources[static_cast<std::size_t>(source)]);
  }
  next.PointIds = soup.PointIds;
  next.PointIds.resize(static_cast<std::size_t>(next.Points.rows()), -1);
  soup = std::move(next);
  soup.Filter([&](int t) { return !soup.HasEqualCorners(t); });
  DropDuplicates(soup, repair);
  const SoupDefects after = soup.Defects();
  const std::vector<std::pair<int, int>> open = SortedOpen(after);
  for (const auto& edge : before.OpenEdges)
  {
    if (!std::binary_search(open.begin(), open.end(), edge))
    {
      repair.Add(RepairKind::Junction, soup.MiddleOf(edge));
    }
  }
  return {};
}

/// Small pieces with open edges that hang on edges of others go, the smallest first.
void DropLoosePieces(RepairSoup& soup, OngoingRepair& repair)
{
  double area = 0.0;
  for (int t = 0; t < static_cast<int>(soup.Triangles.size()); ++t)
  {
    area += soup.AreaOf(t);
  }
  for (;;)
  {
    const SoupDefects defects = soup.Defects();
    if (defects.OpenEdges.empty() || defects.CrowdedEdges.empty())
    {
      return;
    }
    int count = 0;
    const std::vector<int> parts = NumberParts(soup.Triangles, false, count);
    std::vector<double> areas(static_cast<std::size_t>(count), 0.0);
    std::vector<char> isOpen(static_cast<std::size_t>(count), 0);
    std::vector<char> hangs(static_cast<std::size_t>(count), 0);
    ForEachEdge(SortedSides(soup.Triangles),
      [&](const SoupSide* begin, const SoupSide* end)
      {
        for (const SoupSide* side = begin; side < end; ++side)
        {
          const auto part =
            static_cast<std::size_t>(parts[static_cast<std::size_t>(side->Triangle)]);
          isOpen[part] |= end - begin == 1 ? 1 : 0;
          hangs[part] |= end - begin > 2 ? 1 : 0;
        }
      });
    for (int t = 0; t < static_cast<int>(parts.size()); ++t)
    {
      areas[static_cast<std::size_t>(parts[static_cast<std::size_t>(t)])] += soup.AreaOf(t);
    }
    int smallest = -1;
    for (int part = 0; part < count; ++part)
    {
      const auto i = static_cast<std::size_t>(part);
      if (isOpen[i] && hangs[i] && areas[i] < LooseShare * area &&
        (smallest < 0 || areas[i] < areas[static_cast<std::size_t>(smallest)]))
      {
        smallest = part;
      }
    }
    if (smallest < 0)
    {
      return;
    }
    soup.Filter(
      [&](int t)
      {
        if (parts[static_cast<std::size_t>(t)] != smallest)
        {
          return true;
        }
        repair.Add(RepairKind::LooseFace, soup.MiddleOf(t), soup.AreaOf(t));
        return false;
      });
  }
}

Status FillHoles(RepairSoup& soup, OngoingRepair& repair)
{
  const SoupDefects defects = soup.Defects();
  if (defects.OpenEdges.empty())
  {
    return {};
  }
  std::vector<Eigen::Vector3d> places;
  double largest = 0.0;
  std::size_t traced = 0;
  const std::map<std::pair<int, int>, int> apexes = ApexesOf(soup, defects);
  for (std::vector<int>& rim : TraceRims(soup.Triangles, defects))
  {
    traced += rim.size();
    const Eigen::Vector3d middle = MiddleOfRim(soup, rim);
    const double diameter = DiagonalOf(soup.Points, rim);
    if (diameter > repair.Params.LargestHole * repair.Diagonal || !FillHole(soup, rim, apexes))
    {
      places.push_back(middle);
      largest = std::max(largest, diameter);
      continue;
    }
    repair.Add(RepairKind::Hole, middle, diameter);
  }
  if (traced < defects.OpenEdges.size())
  {
    for (const auto& edge : defects.OpenEdges)
    {
      places.push_back(soup.MiddleOf(edge));
    }
    return { ErrorCode::InvalidTopology,
      PlacesText(
        std::to_string(defects.OpenEdges.size()) + " open edges that make no rim", places) +
        "; mend or remove the triangles there" };
  }
  repair.Closed = places.empty();
  if (places.empty() || repair.Params.AllowOpen)
  {
    return {};
  }
  return { ErrorCode::InvalidTopology,
    PlacesText(
      places.size() == 1 ? "1 hole stays" : std::to_string(places.size()) + " holes stay", places) +
      "; the largest one's diameter is " + Digits(largest / repair.Diagonal, 3) +
      " of the diagonal: raise LargestHole to close it, or set AllowOpen to leave it" };
}
}

std::map<std::pair<int, int>, int> ApexesOf(const RepairSoup& soup, const SoupDefects& defects)
{
  const std::vector<std::pair<int, int>> open = SortedOpen(defects);
  std::map<std::pair<int, int>, int> apexes;
  for (const MeshTriangle& corners : soup.Triangles)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      const std::pair<int, int> edge(corners[k], corners[(k + 1) % 3]);
      if (std::binary_search(open.begin(), open.end(), edge))
      {
        apexes[edge] = corners[(k + 2) % 3];
      }
    }
  }
  return apexes;
}

bool FillHole(
  RepairSoup& soup, std::vector<int> rim, const std::map<std::pair<int, int>, int>& apexes)
{
  std::reverse(rim.begin(), rim.end());
  PointMatrix points(static_cast<Eigen::Index>(rim.size()), 3);
  PointMatrix beside(points.rows(), 3);
  for (std::size_t i = 0; i < rim.size(); ++i)
  {
    const auto row = static_cast<Eigen::Index>(i);
    points.row(row) = soup.Points.row(rim[i]);
    beside.row(row) = soup.Points.row(apexes.at({ rim[(i + 1) % rim.size()], rim[i] }));
  }
  std::vector<MeshTriangle> triangles = FillRim(points, beside);
  if (triangles.empty())
  {
    return false;
  }
  bool runsAlong = false;
  for (const MeshTriangle& corners : triangles)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      runsAlong = runsAlong || (corners[k] == 0 && corners[(k + 1) % 3] == 1);
    }
  }
  for (MeshTriangle& corners : triangles)
  {
    if (!runsAlong)
    {
      std::swap(corners[1], corners[2]);
    }
    for (int& corner : corners)
    {
      corner = rim[static_cast<std::size_t>(corner)];
    }
    soup.Triangles.push_back(corners);
    soup.Sources.push_back(-1);
  }
  return true;
}

Status CloseOpenEdges(RepairSoup& soup, OngoingRepair& repair)
{
  if (soup.Defects().OpenEdges.empty())
  {
    return {};
  }
  if (Status status = JoinOpenEdges(soup, repair); !status)
  {
    return status;
  }
  DropLoosePieces(soup, repair);
  if (Status status = OrientSoup(soup, repair); !status)
  {
    return status;
  }
  const std::size_t first = soup.Triangles.size();
  Status status = FillHoles(soup, repair);
  for (std::size_t t = first; t < soup.Triangles.size(); ++t)
  {
    std::array<Eigen::Vector3d, 3> corners;
    for (std::size_t k = 0; k < 3; ++k)
    {
      corners[k] = soup.Point(soup.Triangles[t][k]);
    }
    repair.Fillings.push_back(corners);
  }
  return status;
}
}
