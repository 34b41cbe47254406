// SPDX-License-Identifier: BSD-3-Clause
#include "IntersectionRepair.h"

#include "FaultPatching.h"
#include "SheetSelection.h"
#include "SoupCleaning.h"
#include "TrianglePairs.h"

#include <algorithm>
#include <limits>

namespace knotwork
{
namespace
{
constexpr double StepShare = 1e-4; ///< of the diagonal: how far touching sheets are moved apart
constexpr double SnapShare =
  1e-7; ///< of the diagonal: shorter edges and heights of divided triangles go

std::vector<Eigen::Vector3d> PlacesOf(
  const RepairSoup& soup, const std::vector<std::pair<int, int>>& pairs)
{
  std::vector<Eigen::Vector3d> places;
  for (const auto& [s, t] : pairs)
  {
    places.push_back(0.5 * (soup.MiddleOf(s) + soup.MiddleOf(t)));
  }
  return places;
}

/// Edges and points where more than one sheet meets.
std::vector<Eigen::Vector3d> PlacesOf(const RepairSoup& soup, const SoupDefects& defects)
{
  std::vector<Eigen::Vector3d> places;
  for (const auto* edges : { &defects.CrowdedEdges, &defects.TwistedEdges })
  {
    for (const auto& edge : *edges)
    {
      places.push_back(soup.MiddleOf(edge));
    }
  }
  for (const int point : defects.SplitPoints)
  {
    places.push_back(soup.Point(point));
  }
  return places;
}

Status RefuseOpen(
  const RepairSoup& soup, const SoupDefects& defects, const std::vector<std::pair<int, int>>& pairs)
{
  std::vector<Eigen::Vector3d> places = PlacesOf(soup, pairs);
  std::string what = std::to_string(pairs.size()) + " intersections";
  if (pairs.empty())
  {
    places = PlacesOf(soup, defects);
    what = std::to_string(places.size()) + " edges and points where more than one sheet meets";
  }
  return { ErrorCode::InvalidTopology,
    PlacesText(what + " of an open surface", places) +
      "; only what is closed has an inside by which they could be divided: raise LargestHole" };
}

/// What became of the sheets of overlaps.
void AddSheets(const SheetMesh& sheets, const SheetChoice& choice, OngoingRepair& repair)
{
  const auto count = static_cast<std::size_t>(sheets.NumSheets);
  std::vector<double> areas(count, 0.0);
  std::vector<Eigen::Vector3d> places(count, Eigen::Vector3d::Zero());
  for (std::size_t t = 0; t < sheets.Triangles.size(); ++t)
  {
    const auto sheet = static_cast<std::size_t>(sheets.Sheets[t]);
    const MeshTriangle& corners = sheets.Triangles[t];
    const double area = TriangleArea(sheets.Points, corners);
    areas[sheet] += area;
    places[sheet] += area / 3.0 *
      (sheets.Points.row(corners[0]) + sheets.Points.row(corners[1]) +
        sheets.Points.row(corners[2]))
        .transpose();
  }
  for (std::size_t i = 0; i < count; ++i)
  {
    if (!choice.Kept[i] || choice.Levels[i] != 1)
    {
      repair.Add(choice.Kept[i] ? RepairKind::InnerWall : RepairKind::Overlap,
        places[i] / std::max(areas[i], std::numeric_limits<double>::min()), areas[i]);
    }
  }
}

Status Rearrange(const std::vector<std::pair<int, int>>& pairs, const SoupDefects* first,
  RepairSoup& soup, OngoingRepair& repair)
{
  Result<SheetMesh> arranged =
    ArrangeSheets(soup.Points, soup.Triangles, pairs, SnapShare * repair.Diagonal);
  if (!arranged)
  {
    return arranged.Status;
  }
  if (!arranged->OpenEdges.empty() || !arranged->TwistedEdges.empty())
  {
    const bool open = !arranged->OpenEdges.empty();
    const std::vector<Eigen::Vector3d>& places =
      open ? arranged->OpenEdges : arranged->TwistedEdges;
    return { ErrorCode::InvalidTopology,
      PlacesText(std::to_string(places.size()) +
          (open ? " edges stay open" : " edges whose triangles cannot be joined in pairs"),
        places) +
        "; mend or remove the triangles there" };
  }
  SheetChoice choice = ChooseSheets(arranged.Value, soup.Points, soup.Triangles,
    repair.Params.OverlapDepth * repair.Diagonal, repair.Params.Threads);
  for (const Eigen::Vector3d& place : arranged->Cancelled)
  {
    repair.Add(RepairKind::DuplicateFace, place);
  }
  AddSheets(arranged.Value, choice, repair);
  if (first)
  {
    for (const auto& edge : first->CrowdedEdges)
    {
      repair.Add(RepairKind::DividedEdge, soup.MiddleOf(edge));
    }
    for (const int point : first->SplitPoints)
    {
      repair.Add(RepairKind::DividedPoint, soup.Point(point));
    }
  }
  SheetMesh kept = KeepSheets(arranged.Value, choice);
  std::vector<Eigen::Vector3d> cut;
  SeparateSheets(kept, choice.Levels, StepShare * repair.Diagonal, repair.Params.Threads, cut,
    [&repair]() { return repair.GoesOn(); });
  for (const Eigen::Vector3d& place : cut)
  {
    repair.Add(RepairKind::CutTip, place);
  }
  RepairSoup next;
  next.Points = std::move(kept.Points);
  next.Triangles = std::move(kept.Triangles);
  for (const int source : kept.Sources)
  {
    next.Sources.push_back(soup.Sources[static_cast<std::size_t>(source)]);
  }
  for (const int id : kept.PointIds)
  {
    next.PointIds.push_back(id < 0 ? -1 : soup.PointIds[static_cast<std::size_t>(id)]);
  }
  soup = std::move(next);
  return {};
}

/// Divides triangles where they meet and moves sheets apart.
Status SeparateAll(RepairSoup& soup, OngoingRepair& repair)
{
  constexpr int MostRounds = 6;
  constexpr std::size_t MostNew = 100; // pairs of a round
  constexpr std::size_t MostGrowth = 3;
  constexpr std::size_t Small = 2000; // triangles
  const std::size_t most = MostGrowth * soup.Triangles.size() + Small;
  std::vector<std::pair<int, int>> pairs;
  for (int round = 0; round < MostRounds && (round < 2 || soup.Triangles.size() < most); ++round)
  {
    repair.Shown = repair.Done + 0.25 * round / MostRounds;
    if (!repair.GoesOn())
    {
      return { ErrorCode::Aborted, "" };
    }
    soup.Triangles = ReplaceCorners(std::move(soup.Triangles), FirstOfEqualPoints(soup.Points));
    soup.Filter([&](int t) { return !soup.HasEqualCorners(t); });
    const std::vector<char> degenerate =
      FindDegenerate(soup.Points, soup.Triangles, repair.Params.Threads);
    const bool anyDegenerate =
      std::any_of(degenerate.begin(), degenerate.end(), [](char is) { return is != 0; });
    soup.Filter([&](int t) { return !degenerate[static_cast<std::size_t>(t)]; });
    const SoupDefects defects = soup.Defects();
    const std::size_t before = pairs.size();
    pairs = FindIntersections(soup.Points, soup.Triangles, repair.Params.Threads);
    if (!anyDegenerate && defects.IsManifold() && pairs.empty())
    {
      return {};
    }
    if (round > 1 && pairs.size() > before + MostNew)
    {
      break; // it diverges
    }
    if (!repair.Closed)
    {
      return RefuseOpen(soup, defects, pairs);
    }
    if (round == 0)
    {
      repair.AddIntersections(soup, pairs);
    }
    if (Status status = Rearrange(pairs, round == 0 ? &defects : nullptr, soup, repair); !status)
    {
      return status;
    }
  }
  std::vector<Eigen::Vector3d> places = PlacesOf(soup, pairs);
  if (places.empty())
  {
    places = PlacesOf(soup, soup.Defects());
  }
  return { ErrorCode::NotConverged,
    PlacesText(
      std::to_string(places.size()) + " places stay where the surface meets itself", places) +
      "; mend the triangles there" };
}
}

Status RepairIntersections(RepairSoup& soup, OngoingRepair& repair)
{
  DropSlivers(soup, repair);
  const RepairSoup before = soup;
  Status status = SeparateAll(soup, repair);
  constexpr int MostTimes = 3; // that moving sheets apart may leave some more
  for (int again = 0; status && again < MostTimes && DropSlivers(soup, repair); ++again)
  {
    status = SeparateAll(soup, repair);
  }
  if (status.Code == ErrorCode::NotConverged)
  {
    soup = before;
    auto& actions = repair.Actions; // only what was found stays true
    const auto isOfSheets = [](const RepairAction& action)
    {
      return action.Kind == RepairKind::DividedEdge || action.Kind == RepairKind::DividedPoint ||
        action.Kind == RepairKind::CutTip || action.Kind == RepairKind::Overlap ||
        action.Kind == RepairKind::InnerWall;
    };
    actions.erase(std::remove_if(actions.begin(), actions.end(), isOfSheets), actions.end());
    if (PatchFaults(soup, repair))
    {
      return {};
    }
  }
  return status;
}
}
