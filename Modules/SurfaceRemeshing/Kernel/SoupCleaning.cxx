// SPDX-License-Identifier: BSD-3-Clause
#include "SoupCleaning.h"

#include "SheetArrangement.h"
#include "SheetSelection.h"
#include "TrianglePairs.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <set>

namespace knotwork
{
namespace
{
constexpr double SliverShare = 1e-8; ///< of the diagonal: no mesher takes shorter edges and heights

void DropEqualCorners(RepairSoup& soup, OngoingRepair& repair)
{
  soup.Filter(
    [&](int t)
    {
      if (!soup.HasEqualCorners(t))
      {
        return true;
      }
      repair.Add(
        RepairKind::DegenerateFace, soup.Point(soup.Triangles[static_cast<std::size_t>(t)][0]));
      return false;
    });
}

void DropDegenerate(RepairSoup& soup, OngoingRepair& repair)
{
  const std::vector<char> degenerate =
    FindDegenerate(soup.Points, soup.Triangles, repair.Params.Threads);
  soup.Filter(
    [&](int t)
    {
      if (!degenerate[static_cast<std::size_t>(t)])
      {
        return true;
      }
      repair.Add(RepairKind::DegenerateFace, soup.MiddleOf(t));
      return false;
    });
}

std::vector<std::vector<MeshTriangle>> TrianglesOfParts(
  const RepairSoup& soup, const std::vector<int>& parts, int count)
{
  std::vector<std::vector<MeshTriangle>> members(static_cast<std::size_t>(count));
  for (std::size_t t = 0; t < parts.size(); ++t)
  {
    members[static_cast<std::size_t>(parts[t])].push_back(soup.Triangles[t]);
  }
  return members;
}

void DropSmallParts(RepairSoup& soup, OngoingRepair& repair)
{
  if (repair.Params.SmallestPart == 0.0)
  {
    return;
  }
  int count = 0;
  const std::vector<int> parts = NumberParts(soup.Triangles, true, count);
  const std::vector<std::vector<MeshTriangle>> members = TrianglesOfParts(soup, parts, count);
  std::vector<char> isSmall;
  for (const auto& triangles : members)
  {
    const std::vector<int> used = UsedPoints(triangles);
    const bool small = DiagonalOf(soup.Points, used) < repair.Params.SmallestPart * repair.Diagonal;
    isSmall.push_back(small ? 1 : 0);
    if (small)
    {
      double area = 0.0;
      for (const MeshTriangle& corners : triangles)
      {
        area += TriangleArea(soup.Points, corners);
      }
      repair.Add(RepairKind::SmallPart, MiddleOfRim(soup, used), area);
    }
  }
  soup.Filter(
    [&](int t) { return !isSmall[static_cast<std::size_t>(parts[static_cast<std::size_t>(t)])]; });
}

/// Parts that lie in an even number of others enclose a volume, those in an odd number a void.
void TurnParts(RepairSoup& soup, OngoingRepair& repair)
{
  if (!repair.Closed)
  {
    return;
  }
  int count = 0;
  const std::vector<int> parts = NumberParts(soup.Triangles, true, count);
  const std::vector<std::vector<MeshTriangle>> members = TrianglesOfParts(soup, parts, count);
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const auto& triangles : members)
  {
    Eigen::AlignedBox3d box;
    for (const int point : UsedPoints(triangles))
    {
      box.extend(soup.Point(point));
    }
    boxes.push_back(box);
  }
  std::vector<char> turns(members.size(), 0);
  for (std::size_t i = 0; i < members.size(); ++i)
  {
    const Eigen::Vector3d point = soup.Point(members[i].front()[0]);
    bool isVoid = false;
    for (std::size_t j = 0; j < members.size(); ++j)
    {
      if (j != i && boxes[j].contains(point) &&
        std::lround(WindingNumber(soup.Points, members[j], point)) % 2 != 0)
      {
        isVoid = !isVoid;
      }
    }
    turns[i] = (SignedVolume(soup.Points, members[i]) < 0.0) != isVoid ? 1 : 0;
  }
  const bool insideOut =
    std::all_of(turns.begin(), turns.end(), [](char turn) { return turn != 0; });
  if (insideOut && repair.Actions.empty())
  {
    return; // it bounds a solid as well, nothing else is wrong with it
  }
  for (std::size_t t = 0; t < parts.size(); ++t)
  {
    if (turns[static_cast<std::size_t>(parts[t])])
    {
      std::swap(soup.Triangles[t][1], soup.Triangles[t][2]);
      repair.Add(RepairKind::TurnedFace, soup.MiddleOf(static_cast<int>(t)),
        soup.AreaOf(static_cast<int>(t)));
    }
  }
}
}

void DropDuplicates(RepairSoup& soup, OngoingRepair& repair)
{
  std::set<MeshTriangle> seen;
  soup.Filter(
    [&](int t)
    {
      if (seen.insert(Sorted(soup.Triangles[static_cast<std::size_t>(t)])).second)
      {
        return true;
      }
      repair.Add(RepairKind::DuplicateFace, soup.MiddleOf(t), soup.AreaOf(t));
      return false;
    });
}

Status OrientSoup(RepairSoup& soup, OngoingRepair& repair)
{
  if (soup.Defects().TwistedEdges.empty())
  {
    return {};
  }
  std::vector<int> turned;
  const std::pair<int, int> edge = OrientTriangles(soup.Triangles, turned);
  if (edge.first >= 0)
  {
    return { ErrorCode::InvalidTopology,
      "the surface has one side only, as seen at " + PlaceText(soup.MiddleOf(edge)) +
        "; cut it there" };
  }
  for (const int t : turned)
  {
    repair.Add(RepairKind::TurnedFace, soup.MiddleOf(t), soup.AreaOf(t));
  }
  return {};
}

Status CleanSoup(RepairSoup& soup, OngoingRepair& repair)
{
  DropEqualCorners(soup, repair);
  SoupDefects defects = soup.Defects();
  if (!defects.OpenEdges.empty() || !defects.TwistedEdges.empty())
  {
    DropDuplicates(soup, repair);
  }
  if (Status status = OrientSoup(soup, repair); !status)
  {
    return status;
  }
  DropDegenerate(soup, repair);
  if (soup.Triangles.empty())
  {
    return { ErrorCode::EmptyInput, "no triangle of the mesh has an area" };
  }
  return {};
}

bool DropSlivers(RepairSoup& soup, OngoingRepair& repair)
{
  const double least = SliverShare * repair.Diagonal;
  std::vector<int> slivers;
  for (std::size_t t = 0; t < soup.Triangles.size(); ++t)
  {
    double longest = 0.0;
    for (std::size_t k = 0; k < 3; ++k)
    {
      const MeshTriangle& corners = soup.Triangles[t];
      longest =
        std::max(longest, (soup.Point(corners[(k + 1) % 3]) - soup.Point(corners[k])).norm());
    }
    if (2.0 * soup.AreaOf(static_cast<int>(t)) < least * longest)
    {
      slivers.push_back(static_cast<int>(t));
    }
  }
  if (slivers.empty())
  {
    return false;
  }
  for (const int t : slivers)
  {
    repair.Add(RepairKind::DegenerateFace, soup.MiddleOf(t), soup.AreaOf(t));
  }
  DividedTriangles snapped = SnapTriangles(soup.Points, soup.Triangles, least);
  std::vector<int> sources;
  for (const int source : snapped.Sources)
  {
    sources.push_back(soup.Sources[static_cast<std::size_t>(source)]);
  }
  soup.Triangles = std::move(snapped.Triangles);
  soup.Sources = std::move(sources);
  return true;
}

Status SettleParts(RepairSoup& soup, OngoingRepair& repair)
{
  DropSmallParts(soup, repair);
  if (soup.Triangles.empty())
  {
    return { ErrorCode::InvalidTopology,
      "nothing of the mesh encloses a volume; it is flat or folded onto itself" };
  }
  TurnParts(soup, repair);
  return {};
}
}
