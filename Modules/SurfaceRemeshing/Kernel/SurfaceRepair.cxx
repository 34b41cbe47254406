// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceRepair.h"

#include "AlphaWrap.h"
#include "FarthestDistance.h"
#include "HoleFilling.h"
#include "SheetSelection.h"
#include "SoupTopology.h"
#include "TrianglePairs.h"

#include <knotwork/SplineCore/Numbers.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

namespace knotwork
{
namespace
{
constexpr double StepShare = 1e-4; ///< of the diagonal: how far touching sheets are moved apart
constexpr double SnapShare =
  1e-7; ///< of the diagonal: shorter edges and heights of divided triangles go
constexpr double SliverShare = 1e-8;        ///< the same of all triangles: no mesher takes them
constexpr double ToleranceShare = 1e-4;     ///< of the diagonal: of distances
constexpr double WrapToleranceShare = 2e-3; ///< the same, of wraps
constexpr double LooseShare = 0.05;         ///< of the area: open pieces above are no loose ones
constexpr double CrumbShare = 0.01; ///< of the diagonal: smaller open pieces between faults go
constexpr int NamedPlaces = 5;      ///< in messages

/// Triangles on their way.
struct Soup
{
  PointMatrix Points;
  std::vector<MeshTriangle> Triangles;
  std::vector<int> Sources;  ///< of the input's triangles, -1: in a hole
  std::vector<int> PointIds; ///< of the input's points, -1: new

  Eigen::Vector3d Point(int i) const { return this->Points.row(i).transpose(); }
  Eigen::Vector3d MiddleOf(const std::pair<int, int>& edge) const
  {
    return 0.5 * (this->Point(edge.first) + this->Point(edge.second));
  }
  Eigen::Vector3d MiddleOf(int triangle) const
  {
    const MeshTriangle& t = this->Triangles[static_cast<std::size_t>(triangle)];
    return (this->Point(t[0]) + this->Point(t[1]) + this->Point(t[2])) / 3.0;
  }
  double AreaOf(int triangle) const
  {
    return TriangleArea(this->Points, this->Triangles[static_cast<std::size_t>(triangle)]);
  }
  /// Keeps triangles of which keep(number) is true.
  template <typename Keep>
  void Filter(Keep&& keep)
  {
    std::size_t kept = 0;
    for (std::size_t t = 0; t < this->Triangles.size(); ++t)
    {
      if (keep(static_cast<int>(t)))
      {
        this->Triangles[kept] = this->Triangles[t];
        this->Sources[kept++] = this->Sources[t];
      }
    }
    this->Triangles.resize(kept);
    this->Sources.resize(kept);
  }
};

std::string Place(const Eigen::Vector3d& point)
{
  return PointText(point.data(), 3);
}

/// "3 holes, at (0, 1, 2), (1, 2, 3) and 1 more".
std::string Places(const std::string& what, const std::vector<Eigen::Vector3d>& places)
{
  std::string text = what + (places.size() == 1 ? ", at " : ", some of them at ");
  if (places.size() > 1 && places.size() <= NamedPlaces)
  {
    text = what + ", at ";
  }
  for (std::size_t i = 0; i < std::min<std::size_t>(places.size(), NamedPlaces); ++i)
  {
    text += (i > 0 ? ", " : "") + Place(places[i]);
  }
  return text;
}

Eigen::Vector3d MiddleOfRim(const Soup& soup, const std::vector<int>& rim)
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const int point : rim)
  {
    sum += soup.Point(point);
  }
  return sum / static_cast<double>(rim.size());
}

double DiagonalOf(const PointMatrix& points, const std::vector<int>& numbers)
{
  Eigen::Vector3d lower = points.row(numbers.front()).transpose();
  Eigen::Vector3d upper = lower;
  for (const int i : numbers)
  {
    lower = lower.cwiseMin(points.row(i).transpose());
    upper = upper.cwiseMax(points.row(i).transpose());
  }
  return (upper - lower).norm();
}

std::vector<int> UsedPoints(const std::vector<MeshTriangle>& triangles)
{
  std::set<int> used;
  for (const MeshTriangle& corners : triangles)
  {
    used.insert(corners.begin(), corners.end());
  }
  return { used.begin(), used.end() };
}

MeshTriangle Sorted(MeshTriangle corners)
{
  std::sort(corners.begin(), corners.end());
  return corners;
}

Status CheckInput(const TriangleMesh& mesh, const SurfaceRepairParams& params)
{
  const std::pair<const char*, double> shares[] = { { "Limit", params.Limit },
    { "LargestHole", params.LargestHole }, { "OverlapDepth", params.OverlapDepth },
    { "SmallestPart", params.SmallestPart } };
  for (const double share : { params.WrapAlpha, params.WrapOffset })
  {
    if (params.AlphaWrap && !(share > 0.0 && share <= 1.0))
    {
      return { ErrorCode::InvalidParameter,
        "WrapAlpha and WrapOffset are shares of the diagonal, above 0 and at most 1; " +
          Digits(share) + " was given" };
    }
  }
  for (const auto& [name, share] : shares)
  {
    if (!(share >= 0.0 && share <= 1.0))
    {
      return { ErrorCode::InvalidParameter,
        std::string(name) + " is a share of the diagonal, between 0 and 1; " + Digits(share) +
          " was given" };
    }
  }
  if (mesh.Triangles.empty())
  {
    return { ErrorCode::EmptyInput, "the mesh has no triangles" };
  }
  if (mesh.Points.cols() != 3)
  {
    return { ErrorCode::DimensionMismatch,
      "points of a surface have three coordinates, not " + std::to_string(mesh.Points.cols()) };
  }
  for (Eigen::Index i = 0; i < mesh.Points.rows(); ++i)
  {
    if (!AllWithinLimit(mesh.Points.row(i)))
    {
      const bool finite = mesh.Points.row(i).array().isFinite().all();
      return { ErrorCode::NonFiniteInput,
        "point " + std::to_string(i) +
          (finite ? ": " + BeyondLimit() : " is not finite; remove it and its triangles") };
    }
  }
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    for (const int corner : mesh.Triangles[t])
    {
      if (corner < 0 || corner >= mesh.Points.rows())
      {
        return { ErrorCode::InvalidTopology,
          "triangle " + std::to_string(t) + " has a corner " + std::to_string(corner) +
            ", but there are " + std::to_string(mesh.Points.rows()) + " points" };
      }
    }
  }
  return {};
}

class Repair
{
public:
  Repair(const TriangleMesh& input, const SurfaceRepairParams& params)
    : Input(input), Params(params)
  {
  }

  Status Run(SurfaceRepair& result)
  {
    this->Start();
    for (const auto step : { &Repair::Clean, &Repair::Close, &Repair::Resolve, &Repair::Finish })
    {
      this->Shown = this->Done;
      if (!this->GoesOn())
      {
        return { ErrorCode::Aborted, "" };
      }
      if (Status status = (this->*step)(); !status)
      {
        return status;
      }
      this->Done += 0.25;
    }
    result = std::move(this->Result);
    return {};
  }

  /// A surface around the input instead.
  Status Wrap(const std::string& reason, SurfaceRepair& result)
  {
    this->Start();
    SurfaceRepair& made = this->Result;
    const std::vector<char> degenerate =
      FindDegenerate(this->Work.Points, this->Work.Triangles, this->Params.Threads);
    this->Work.Filter([&](int t) { return !degenerate[static_cast<std::size_t>(t)]; });
    if (this->Work.Triangles.empty())
    {
      return { ErrorCode::EmptyInput, "no triangle of the mesh has an area" };
    }
    made.Mesh = WrapTriangles({ this->Work.Points, this->Work.Triangles },
      this->Params.WrapAlpha * made.Diagonal, this->Params.WrapOffset * made.Diagonal);
    made.Wrapped = true;
    made.WrapReason = reason;
    made.Changed = true;
    made.PointIds.assign(static_cast<std::size_t>(made.Mesh.Points.rows()), -1);
    made.TriangleIds.assign(made.Mesh.Triangles.size(), -1);
    made.After = this->NumbersOf(made.Mesh.Points, made.Mesh.Triangles);
    const double tolerance = WrapToleranceShare * made.Diagonal;
    made.DistanceFromInput = FarthestFrom(TriangleIndex<3>(this->Work.Points, this->Work.Triangles),
      made.Mesh.Points, made.Mesh.Triangles, tolerance)
                               .Value;
    made.DistanceToInput = FarthestFrom(TriangleIndex<3>(made.Mesh.Points, made.Mesh.Triangles),
      this->Work.Points, this->Work.Triangles, tolerance)
                             .Value;
    result = std::move(made);
    return {};
  }

private:
  bool GoesOn() const { return !this->Params.Progress || this->Params.Progress(this->Shown); }
  void Add(RepairKind kind, const Eigen::Vector3d& place, double size = 0.0)
  {
    this->Result.Actions.push_back({ kind, place, size });
  }

  void Start()
  {
    const PointMatrix& points = this->Input.Points;
    this->Result = {};
    this->FirstOfEqual = FirstOfEqualPoints(points);
    this->Work.Points = points;
    this->Work.Triangles = ReplaceCorners(this->Input.Triangles, this->FirstOfEqual);
    this->Work.Sources.resize(this->Work.Triangles.size());
    std::iota(this->Work.Sources.begin(), this->Work.Sources.end(), 0);
    this->Work.PointIds.resize(static_cast<std::size_t>(points.rows()));
    std::iota(this->Work.PointIds.begin(), this->Work.PointIds.end(), 0);
    const std::vector<int> given = UsedPoints(this->Input.Triangles);
    const std::vector<int> used = UsedPoints(this->Work.Triangles);
    this->Result.MergedPoints = static_cast<int>(given.size() - used.size());
    this->Result.Diagonal = DiagonalOf(points, used);
    this->Result.Before = this->NumbersOf(points, this->Work.Triangles);
  }

  static RepairNumbers NumbersOf(
    const PointMatrix& points, const std::vector<MeshTriangle>& triangles)
  {
    RepairNumbers numbers;
    numbers.Points = static_cast<int>(UsedPoints(triangles).size());
    numbers.Triangles = static_cast<int>(triangles.size());
    NumberParts(triangles, true, numbers.Parts);
    numbers.Euler = EulerNumber(triangles);
    for (const MeshTriangle& corners : triangles)
    {
      numbers.Area += TriangleArea(points, corners);
    }
    numbers.Volume = SignedVolume(points, triangles);
    return numbers;
  }

  // ----------------------------------------------------------------- triangles as they come

  void DropEqualCorners()
  {
    this->Work.Filter(
      [&](int t)
      {
        const auto& [a, b, c] = this->Work.Triangles[static_cast<std::size_t>(t)];
        if (a != b && b != c && c != a)
        {
          return true;
        }
        this->Add(RepairKind::DegenerateFace, this->Work.Point(a));
        return false;
      });
  }
  void DropDuplicates()
  {
    std::set<MeshTriangle> seen;
    this->Work.Filter(
      [&](int t)
      {
        if (seen.insert(Sorted(this->Work.Triangles[static_cast<std::size_t>(t)])).second)
        {
          return true;
        }
        this->Add(RepairKind::DuplicateFace, this->Work.MiddleOf(t), this->Work.AreaOf(t));
        return false;
      });
  }
  void DropDegenerate()
  {
    const std::vector<char> degenerate =
      FindDegenerate(this->Work.Points, this->Work.Triangles, this->Params.Threads);
    this->Work.Filter(
      [&](int t)
      {
        if (!degenerate[static_cast<std::size_t>(t)])
        {
          return true;
        }
        this->Add(RepairKind::DegenerateFace, this->Work.MiddleOf(t));
        return false;
      });
  }
  Status Orient()
  {
    if (this->Defects().TwistedEdges.empty())
    {
      return {};
    }
    std::vector<int> turned;
    const std::pair<int, int> edge = OrientTriangles(this->Work.Triangles, turned);
    if (edge.first >= 0)
    {
      return { ErrorCode::InvalidTopology,
        "the surface has one side only, as seen at " + Place(this->Work.MiddleOf(edge)) +
          "; cut it there" };
    }
    for (const int t : turned)
    {
      this->Add(RepairKind::TurnedFace, this->Work.MiddleOf(t), this->Work.AreaOf(t));
    }
    return {};
  }
  SoupDefects Defects() const
  {
    return FindDefects(this->Work.Triangles, this->Work.Points.rows());
  }
  std::vector<std::pair<int, int>> Intersections() const
  {
    return FindIntersections(this->Work.Points, this->Work.Triangles, this->Params.Threads);
  }

  Status Clean()
  {
    this->DropEqualCorners();
    SoupDefects defects = this->Defects();
    if (!defects.OpenEdges.empty() || !defects.TwistedEdges.empty())
    {
      this->DropDuplicates();
    }
    if (Status status = this->Orient(); !status)
    {
      return status;
    }
    this->DropDegenerate();
    if (this->Work.Triangles.empty())
    {
      return { ErrorCode::EmptyInput, "no triangle of the mesh has an area" };
    }
    return {};
  }

  // ----------------------------------------------------------------- open edges

  Status Close()
  {
    if (this->Defects().OpenEdges.empty())
    {
      return {};
    }
    if (Status status = this->JoinOpenEdges(); !status)
    {
      return status;
    }
    this->DropLoosePieces();
    if (Status status = this->Orient(); !status)
    {
      return status;
    }
    const std::size_t first = this->Work.Triangles.size();
    Status status = this->FillHoles();
    for (std::size_t t = first; t < this->Work.Triangles.size(); ++t)
    {
      std::array<Eigen::Vector3d, 3> corners;
      for (std::size_t k = 0; k < 3; ++k)
      {
        corners[k] = this->Work.Point(this->Work.Triangles[t][k]);
      }
      this->Fillings.push_back(corners);
    }
    return status;
  }

  /// Edges that others meet, or that lie beside each other divided differently, become common.
  Status JoinOpenEdges()
  {
    const SoupDefects before = this->Defects();
    const std::vector<std::pair<int, int>> openBefore = SortedOpen(before);
    std::vector<char> isOpen(this->Work.Triangles.size(), 0);
    for (const SoupSide& side : SortedSides(this->Work.Triangles))
    {
      const std::pair<int, int> edge = side.Forward ? std::make_pair(side.First, side.Second)
                                                    : std::make_pair(side.Second, side.First);
      if (std::binary_search(openBefore.begin(), openBefore.end(), edge))
      {
        isOpen[static_cast<std::size_t>(side.Triangle)] = 1;
      }
    }
    const std::vector<std::pair<int, int>> pairs = this->Intersections();
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
    this->AddIntersections(pairs);
    knotwork::Result<DividedTriangles> divided =
      DivideTriangles(this->Work.Points, this->Work.Triangles, pairs);
    if (!divided)
    {
      return divided.Status;
    }
    Soup next;
    next.Points = std::move(divided->Points);
    next.Triangles = ReplaceCorners(std::move(divided->Triangles), FirstOfEqualPoints(next.Points));
    for (const int source : divided->Sources)
    {
      next.Sources.push_back(this->Work.Sources[static_cast<std::size_t>(source)]);
    }
    next.PointIds = this->Work.PointIds;
    next.PointIds.resize(static_cast<std::size_t>(next.Points.rows()), -1);
    this->Work = std::move(next);
    this->Work.Filter(
      [&](int t)
      {
        const auto& [a, b, c] = this->Work.Triangles[static_cast<std::size_t>(t)];
        return a != b && b != c && c != a;
      });
    this->DropDuplicates();
    const SoupDefects after = this->Defects();
    const std::vector<std::pair<int, int>> open = SortedOpen(after);
    for (const auto& edge : before.OpenEdges)
    {
      if (!std::binary_search(open.begin(), open.end(), edge))
      {
        this->Add(RepairKind::Junction, this->Work.MiddleOf(edge));
      }
    }
    return {};
  }
  static std::vector<std::pair<int, int>> SortedOpen(const SoupDefects& defects)
  {
    std::vector<std::pair<int, int>> open = defects.OpenEdges;
    std::sort(open.begin(), open.end());
    return open;
  }

  /// Small pieces with open edges that hang on edges of others go, the smallest first.
  void DropLoosePieces()
  {
    double area = 0.0;
    for (int t = 0; t < static_cast<int>(this->Work.Triangles.size()); ++t)
    {
      area += this->Work.AreaOf(t);
    }
    for (;;)
    {
      const SoupDefects defects = this->Defects();
      if (defects.OpenEdges.empty() || defects.CrowdedEdges.empty())
      {
        return;
      }
      int count = 0;
      const std::vector<int> parts = NumberParts(this->Work.Triangles, false, count);
      std::vector<double> areas(static_cast<std::size_t>(count), 0.0);
      std::vector<char> isOpen(static_cast<std::size_t>(count), 0);
      std::vector<char> hangs(static_cast<std::size_t>(count), 0);
      ForEachEdge(SortedSides(this->Work.Triangles),
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
        areas[static_cast<std::size_t>(parts[static_cast<std::size_t>(t)])] += this->Work.AreaOf(t);
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
      this->Work.Filter(
        [&](int t)
        {
          if (parts[static_cast<std::size_t>(t)] != smallest)
          {
            return true;
          }
          this->Add(RepairKind::LooseFace, this->Work.MiddleOf(t), this->Work.AreaOf(t));
          return false;
        });
    }
  }

  Status FillHoles()
  {
    const SoupDefects defects = this->Defects();
    if (defects.OpenEdges.empty())
    {
      return {};
    }
    std::vector<Eigen::Vector3d> places;
    double largest = 0.0;
    std::size_t traced = 0;
    const std::map<std::pair<int, int>, int> apexes = this->Apexes(defects);
    for (std::vector<int>& rim : TraceRims(this->Work.Triangles, defects))
    {
      traced += rim.size();
      const Eigen::Vector3d middle = MiddleOfRim(this->Work, rim);
      const double diameter = DiagonalOf(this->Work.Points, rim);
      if (diameter > this->Params.LargestHole * this->Result.Diagonal ||
        !this->FillHole(rim, apexes))
      {
        places.push_back(middle);
        largest = std::max(largest, diameter);
        continue;
      }
      this->Add(RepairKind::Hole, middle, diameter);
    }
    if (traced < defects.OpenEdges.size())
    {
      for (const auto& edge : defects.OpenEdges)
      {
        places.push_back(this->Work.MiddleOf(edge));
      }
      return { ErrorCode::InvalidTopology,
        Places(std::to_string(defects.OpenEdges.size()) + " open edges that make no rim", places) +
          "; mend or remove the triangles there" };
    }
    this->Result.Closed = places.empty();
    if (places.empty() || this->Params.AllowOpen)
    {
      return {};
    }
    return { ErrorCode::InvalidTopology,
      Places(places.size() == 1 ? "1 hole stays" : std::to_string(places.size()) + " holes stay",
        places) +
        "; the largest one's diameter is " + Digits(largest / this->Result.Diagonal, 3) +
        " of the diagonal: raise LargestHole to close it, or set AllowOpen to leave it" };
  }
  /// Third corners of triangles by their open edges, as they run.
  std::map<std::pair<int, int>, int> Apexes(const SoupDefects& defects) const
  {
    const std::vector<std::pair<int, int>> open = SortedOpen(defects);
    std::map<std::pair<int, int>, int> apexes;
    for (const MeshTriangle& corners : this->Work.Triangles)
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
  bool FillHole(std::vector<int> rim, const std::map<std::pair<int, int>, int>& apexes)
  {
    std::reverse(rim.begin(), rim.end());
    PointMatrix points(static_cast<Eigen::Index>(rim.size()), 3);
    PointMatrix beside(points.rows(), 3);
    for (std::size_t i = 0; i < rim.size(); ++i)
    {
      const auto row = static_cast<Eigen::Index>(i);
      points.row(row) = this->Work.Points.row(rim[i]);
      beside.row(row) = this->Work.Points.row(apexes.at({ rim[(i + 1) % rim.size()], rim[i] }));
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
      this->Work.Triangles.push_back(corners);
      this->Work.Sources.push_back(-1);
    }
    return true;
  }

  // ----------------------------------------------------------------- intersections

  void AddIntersections(const std::vector<std::pair<int, int>>& pairs)
  {
    for (const auto& [s, t] : pairs)
    {
      this->Add(RepairKind::Intersection, 0.5 * (this->Work.MiddleOf(s) + this->Work.MiddleOf(t)),
        std::min(this->Work.AreaOf(s), this->Work.AreaOf(t)));
    }
  }

  /// Edges and heights that are all but nothing go, with the triangles that have them.
  /// @return whether there were any.
  bool DropSlivers()
  {
    const double least = SliverShare * this->Result.Diagonal;
    std::vector<int> slivers;
    for (std::size_t t = 0; t < this->Work.Triangles.size(); ++t)
    {
      double longest = 0.0;
      for (std::size_t k = 0; k < 3; ++k)
      {
        const MeshTriangle& corners = this->Work.Triangles[t];
        longest = std::max(
          longest, (this->Work.Point(corners[(k + 1) % 3]) - this->Work.Point(corners[k])).norm());
      }
      if (2.0 * this->Work.AreaOf(static_cast<int>(t)) < least * longest)
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
      this->Add(RepairKind::DegenerateFace, this->Work.MiddleOf(t), this->Work.AreaOf(t));
    }
    DividedTriangles snapped = SnapTriangles(this->Work.Points, this->Work.Triangles, least);
    std::vector<int> sources;
    for (const int source : snapped.Sources)
    {
      sources.push_back(this->Work.Sources[static_cast<std::size_t>(source)]);
    }
    this->Work.Triangles = std::move(snapped.Triangles);
    this->Work.Sources = std::move(sources);
    return true;
  }

  Status Resolve()
  {
    this->DropSlivers();
    const Soup before = this->Work;
    Status status = this->SeparateAll();
    constexpr int MostTimes = 3; // that moving sheets apart may leave some more
    for (int again = 0; status && again < MostTimes && this->DropSlivers(); ++again)
    {
      status = this->SeparateAll();
    }
    if (status.Code == ErrorCode::NotConverged)
    {
      this->Work = before;
      auto& actions = this->Result.Actions; // only what was found stays true
      const auto isOfSheets = [](const RepairAction& action)
      {
        return action.Kind == RepairKind::DividedEdge || action.Kind == RepairKind::DividedPoint ||
          action.Kind == RepairKind::CutTip || action.Kind == RepairKind::Overlap ||
          action.Kind == RepairKind::InnerWall;
      };
      actions.erase(std::remove_if(actions.begin(), actions.end(), isOfSheets), actions.end());
      if (this->PatchFaults())
      {
        return {};
      }
    }
    return status;
  }

  /// Triangles of what meets, of edges of more or less than two triangles and of points of several
  /// fans.
  std::vector<char> FindFaults() const
  {
    std::vector<char> faults =
      FindDegenerate(this->Work.Points, this->Work.Triangles, this->Params.Threads);
    if (std::none_of(faults.begin(), faults.end(), [](char is) { return is != 0; }))
    {
      for (const auto& [s, t] : this->Intersections())
      {
        faults[static_cast<std::size_t>(s)] = 1;
        faults[static_cast<std::size_t>(t)] = 1;
      }
    }
    const SoupDefects defects = this->Defects();
    std::set<int> points(defects.SplitPoints.begin(), defects.SplitPoints.end());
    for (const auto* edges : { &defects.OpenEdges, &defects.CrowdedEdges, &defects.TwistedEdges })
    {
      for (const auto& [a, b] : *edges)
      {
        points.insert({ a, b });
      }
    }
    this->AddFans(points, faults);
    return faults;
  }
  /// Adds the triangles around points.
  void AddFans(const std::set<int>& points, std::vector<char>& triangles) const
  {
    for (std::size_t t = 0; t < triangles.size(); ++t)
    {
      for (const int corner : this->Work.Triangles[t])
      {
        triangles[t] = triangles[t] || points.count(corner) > 0 ? 1 : 0;
      }
    }
  }
  void Grow(std::vector<char>& triangles) const
  {
    std::set<int> points;
    for (std::size_t t = 0; t < triangles.size(); ++t)
    {
      if (triangles[t])
      {
        points.insert(this->Work.Triangles[t].begin(), this->Work.Triangles[t].end());
      }
    }
    this->AddFans(points, triangles);
  }

  /// The last way where sheets do not come apart: triangles around faults go and the holes are
  /// closed, each time with more around what is left.
  /// @return whether there are no faults any more.
  /// @source Attene, A lightweight approach to repairing digitized polygon meshes, The Visual
  /// Computer 26 (2010) 1393.
  bool PatchFaults()
  {
    constexpr int MostRounds = 16;
    constexpr int RoundsOfARing = 2; // that are tried with so much around the faults
    for (int round = 0; round < MostRounds && this->GoesOn(); ++round)
    {
      std::vector<char> faults = this->FindFaults();
      if (std::none_of(faults.begin(), faults.end(), [](char is) { return is != 0; }))
      {
        return true;
      }
      for (int ring = 0; ring < round / RoundsOfARing; ++ring)
      {
        this->Grow(faults);
      }
      const Soup gone = this->TakeAway(faults);
      this->Patch(gone);
    }
    return false;
  }
  /// Takes triangles away, so that rims of single fans stay, and small open pieces that are left.
  Soup TakeAway(const std::vector<char>& faults)
  {
    Soup gone = this->Work;
    gone.Filter([&](int t) { return faults[static_cast<std::size_t>(t)] != 0; });
    const auto drop = [&](const std::vector<char>& triangles)
    {
      for (std::size_t t = 0; t < triangles.size(); ++t)
      {
        if (triangles[t])
        {
          gone.Triangles.push_back(this->Work.Triangles[t]);
          gone.Sources.push_back(this->Work.Sources[t]);
        }
      }
      this->Work.Filter([&](int t) { return !triangles[static_cast<std::size_t>(t)]; });
    };
    this->Work.Filter([&](int t) { return !faults[static_cast<std::size_t>(t)]; });
    for (;;)
    {
      std::vector<char> more(this->Work.Triangles.size(), 0);
      const SoupDefects defects = this->Defects();
      this->AddFans({ defects.SplitPoints.begin(), defects.SplitPoints.end() }, more);
      this->AddCrumbs(more);
      if (std::none_of(more.begin(), more.end(), [](char is) { return is != 0; }))
      {
        return gone;
      }
      drop(more);
    }
  }
  /// Adds open parts that are smaller than the result may be off.
  void AddCrumbs(std::vector<char>& crumbs) const
  {
    int count = 0;
    const std::vector<int> parts = NumberParts(this->Work.Triangles, false, count);
    std::vector<Eigen::AlignedBox3d> boxes(static_cast<std::size_t>(count));
    std::vector<char> isOpen(static_cast<std::size_t>(count), 0);
    ForEachEdge(SortedSides(this->Work.Triangles),
      [&](const SoupSide* begin, const SoupSide* end)
      {
        const auto part =
          static_cast<std::size_t>(parts[static_cast<std::size_t>(begin->Triangle)]);
        isOpen[part] |= end - begin == 1 ? 1 : 0;
      });
    for (std::size_t t = 0; t < parts.size(); ++t)
    {
      for (const int corner : this->Work.Triangles[t])
      {
        boxes[static_cast<std::size_t>(parts[t])].extend(this->Work.Point(corner));
      }
    }
    const double most = std::min(this->Params.Limit, CrumbShare) * this->Result.Diagonal;
    for (std::size_t t = 0; t < parts.size(); ++t)
    {
      const auto part = static_cast<std::size_t>(parts[t]);
      if (isOpen[part] && boxes[part].diagonal().norm() <= most)
      {
        crumbs[t] = 1;
      }
    }
  }
  /// Closes all holes with triangles that come from the nearest ones that went.
  void Patch(const Soup& gone)
  {
    const std::size_t before = this->Work.Triangles.size();
    const SoupDefects defects = this->Defects();
    const std::map<std::pair<int, int>, int> apexes = this->Apexes(defects);
    for (std::vector<int>& rim : TraceRims(this->Work.Triangles, defects))
    {
      const Eigen::Vector3d middle = MiddleOfRim(this->Work, rim);
      const double diameter = DiagonalOf(this->Work.Points, rim);
      if (this->FillHole(rim, apexes))
      {
        this->Add(RepairKind::Patch, middle, diameter);
      }
    }
    for (std::size_t t = before; t < this->Work.Triangles.size(); ++t)
    {
      const Eigen::Vector3d middle = this->Work.MiddleOf(static_cast<int>(t));
      double nearest = std::numeric_limits<double>::infinity();
      for (std::size_t g = 0; g < gone.Triangles.size(); ++g)
      {
        const double squared = (gone.MiddleOf(static_cast<int>(g)) - middle).squaredNorm();
        if (squared < nearest)
        {
          nearest = squared;
          this->Work.Sources[t] = gone.Sources[g];
        }
      }
    }
  }

  /// Divides triangles where they meet and moves sheets apart.
  Status SeparateAll()
  {
    constexpr int MostRounds = 6;
    constexpr std::size_t MostNew = 100; // pairs of a round
    constexpr std::size_t MostGrowth = 3;
    constexpr std::size_t Small = 2000; // triangles
    const std::size_t most = MostGrowth * this->Work.Triangles.size() + Small;
    std::vector<std::pair<int, int>> pairs;
    for (int round = 0; round < MostRounds && (round < 2 || this->Work.Triangles.size() < most);
         ++round)
    {
      this->Shown = this->Done + 0.25 * round / MostRounds;
      if (!this->GoesOn())
      {
        return { ErrorCode::Aborted, "" };
      }
      this->Work.Triangles =
        ReplaceCorners(std::move(this->Work.Triangles), FirstOfEqualPoints(this->Work.Points));
      this->Work.Filter(
        [&](int t)
        {
          const auto& [a, b, c] = this->Work.Triangles[static_cast<std::size_t>(t)];
          return a != b && b != c && c != a;
        });
      const std::vector<char> degenerate =
        FindDegenerate(this->Work.Points, this->Work.Triangles, this->Params.Threads);
      const bool anyDegenerate =
        std::any_of(degenerate.begin(), degenerate.end(), [](char is) { return is != 0; });
      this->Work.Filter([&](int t) { return !degenerate[static_cast<std::size_t>(t)]; });
      const SoupDefects defects = this->Defects();
      const std::size_t before = pairs.size();
      pairs = this->Intersections();
      if (!anyDegenerate && defects.IsManifold() && pairs.empty())
      {
        return {};
      }
      if (round > 1 && pairs.size() > before + MostNew)
      {
        break; // it diverges
      }
      if (!this->Result.Closed)
      {
        return this->RefuseOpen(defects, pairs);
      }
      if (round == 0)
      {
        this->AddIntersections(pairs);
      }
      if (Status status = this->Rearrange(pairs, round == 0 ? &defects : nullptr); !status)
      {
        return status;
      }
    }
    std::vector<Eigen::Vector3d> places = this->PlacesOf(pairs);
    if (places.empty())
    {
      const SoupDefects defects = this->Defects();
      for (const auto* edges : { &defects.CrowdedEdges, &defects.TwistedEdges })
      {
        for (const auto& edge : *edges)
        {
          places.push_back(this->Work.MiddleOf(edge));
        }
      }
      for (const int point : defects.SplitPoints)
      {
        places.push_back(this->Work.Point(point));
      }
    }
    return { ErrorCode::NotConverged,
      Places(
        std::to_string(places.size()) + " places stay where the surface meets itself", places) +
        "; mend the triangles there" };
  }
  std::vector<Eigen::Vector3d> PlacesOf(const std::vector<std::pair<int, int>>& pairs) const
  {
    std::vector<Eigen::Vector3d> places;
    for (const auto& [s, t] : pairs)
    {
      places.push_back(0.5 * (this->Work.MiddleOf(s) + this->Work.MiddleOf(t)));
    }
    return places;
  }
  Status RefuseOpen(const SoupDefects& defects, const std::vector<std::pair<int, int>>& pairs) const
  {
    std::vector<Eigen::Vector3d> places = this->PlacesOf(pairs);
    std::string what = std::to_string(pairs.size()) + " intersections";
    if (pairs.empty())
    {
      for (const auto& edge : defects.CrowdedEdges)
      {
        places.push_back(this->Work.MiddleOf(edge));
      }
      for (const auto& edge : defects.TwistedEdges)
      {
        places.push_back(this->Work.MiddleOf(edge));
      }
      for (const int point : defects.SplitPoints)
      {
        places.push_back(this->Work.Point(point));
      }
      what = std::to_string(places.size()) + " edges and points where more than one sheet meets";
    }
    return { ErrorCode::InvalidTopology,
      Places(what + " of an open surface", places) +
        "; only what is closed has an inside by which they could be divided: raise LargestHole" };
  }

  Status Rearrange(const std::vector<std::pair<int, int>>& pairs, const SoupDefects* first)
  {
    knotwork::Result<SheetMesh> arranged = ArrangeSheets(
      this->Work.Points, this->Work.Triangles, pairs, SnapShare * this->Result.Diagonal);
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
        Places(std::to_string(places.size()) +
            (open ? " edges stay open" : " edges whose triangles cannot be joined in pairs"),
          places) +
          "; mend or remove the triangles there" };
    }
    SheetChoice choice = ChooseSheets(arranged.Value, this->Work.Points, this->Work.Triangles,
      this->Params.OverlapDepth * this->Result.Diagonal, this->Params.Threads);
    for (const Eigen::Vector3d& place : arranged->Cancelled)
    {
      this->Add(RepairKind::DuplicateFace, place);
    }
    this->AddSheets(arranged.Value, choice);
    if (first)
    {
      for (const auto& edge : first->CrowdedEdges)
      {
        this->Add(RepairKind::DividedEdge, this->Work.MiddleOf(edge));
      }
      for (const int point : first->SplitPoints)
      {
        this->Add(RepairKind::DividedPoint, this->Work.Point(point));
      }
    }
    SheetMesh kept = KeepSheets(arranged.Value, choice);
    std::vector<Eigen::Vector3d> cut;
    SeparateSheets(kept, choice.Levels, StepShare * this->Result.Diagonal, this->Params.Threads,
      cut, [this]() { return this->GoesOn(); });
    for (const Eigen::Vector3d& place : cut)
    {
      this->Add(RepairKind::CutTip, place);
    }
    Soup next;
    next.Points = std::move(kept.Points);
    next.Triangles = std::move(kept.Triangles);
    for (const int source : kept.Sources)
    {
      next.Sources.push_back(this->Work.Sources[static_cast<std::size_t>(source)]);
    }
    for (const int id : kept.PointIds)
    {
      next.PointIds.push_back(id < 0 ? -1 : this->Work.PointIds[static_cast<std::size_t>(id)]);
    }
    this->Work = std::move(next);
    return {};
  }
  /// What became of the sheets of overlaps.
  void AddSheets(const SheetMesh& sheets, const SheetChoice& choice)
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
        this->Add(choice.Kept[i] ? RepairKind::InnerWall : RepairKind::Overlap,
          places[i] / std::max(areas[i], std::numeric_limits<double>::min()), areas[i]);
      }
    }
  }

  // ----------------------------------------------------------------- the result

  Status Finish()
  {
    this->DropSmallParts();
    if (this->Work.Triangles.empty())
    {
      return { ErrorCode::InvalidTopology,
        "nothing of the mesh encloses a volume; it is flat or folded onto itself" };
    }
    this->TurnParts();
    SurfaceRepair& result = this->Result;
    result.Changed = !result.Actions.empty() || result.MergedPoints > 0;
    if (!result.Changed)
    {
      result.Mesh = this->Input;
      result.PointIds = this->Work.PointIds;
      result.TriangleIds = this->Work.Sources;
      result.After = result.Before;
      return {};
    }
    this->Encode();
    return this->CheckDistances();
  }

  void DropSmallParts()
  {
    if (this->Params.SmallestPart == 0.0)
    {
      return;
    }
    int count = 0;
    const std::vector<int> parts = NumberParts(this->Work.Triangles, true, count);
    std::vector<std::vector<MeshTriangle>> members(static_cast<std::size_t>(count));
    for (std::size_t t = 0; t < parts.size(); ++t)
    {
      members[static_cast<std::size_t>(parts[t])].push_back(this->Work.Triangles[t]);
    }
    std::vector<char> isSmall;
    for (const auto& triangles : members)
    {
      const std::vector<int> used = UsedPoints(triangles);
      const bool small =
        DiagonalOf(this->Work.Points, used) < this->Params.SmallestPart * this->Result.Diagonal;
      isSmall.push_back(small ? 1 : 0);
      if (small)
      {
        double area = 0.0;
        for (const MeshTriangle& corners : triangles)
        {
          area += TriangleArea(this->Work.Points, corners);
        }
        this->Add(RepairKind::SmallPart, MiddleOfRim(this->Work, used), area);
      }
    }
    this->Work.Filter([&](int t)
      { return !isSmall[static_cast<std::size_t>(parts[static_cast<std::size_t>(t)])]; });
  }

  /// Parts that lie in an even number of others enclose a volume, those in an odd number a void.
  void TurnParts()
  {
    if (!this->Result.Closed)
    {
      return;
    }
    int count = 0;
    const std::vector<int> parts = NumberParts(this->Work.Triangles, true, count);
    std::vector<std::vector<MeshTriangle>> members(static_cast<std::size_t>(count));
    for (std::size_t t = 0; t < parts.size(); ++t)
    {
      members[static_cast<std::size_t>(parts[t])].push_back(this->Work.Triangles[t]);
    }
    std::vector<Eigen::AlignedBox3d> boxes;
    for (const auto& triangles : members)
    {
      Eigen::AlignedBox3d box;
      for (const int point : UsedPoints(triangles))
      {
        box.extend(this->Work.Point(point));
      }
      boxes.push_back(box);
    }
    std::vector<char> turns(members.size(), 0);
    for (std::size_t i = 0; i < members.size(); ++i)
    {
      const Eigen::Vector3d point = this->Work.Point(members[i].front()[0]);
      bool isVoid = false;
      for (std::size_t j = 0; j < members.size(); ++j)
      {
        if (j != i && boxes[j].contains(point) &&
          std::lround(WindingNumber(this->Work.Points, members[j], point)) % 2 != 0)
        {
          isVoid = !isVoid;
        }
      }
      turns[i] = (SignedVolume(this->Work.Points, members[i]) < 0.0) != isVoid ? 1 : 0;
    }
    const bool insideOut =
      std::all_of(turns.begin(), turns.end(), [](char turn) { return turn != 0; });
    if (insideOut && this->Result.Actions.empty())
    {
      return; // it bounds a solid as well, nothing else is wrong with it
    }
    for (std::size_t t = 0; t < parts.size(); ++t)
    {
      if (turns[static_cast<std::size_t>(parts[t])])
      {
        std::swap(this->Work.Triangles[t][1], this->Work.Triangles[t][2]);
        this->Add(RepairKind::TurnedFace, this->Work.MiddleOf(static_cast<int>(t)),
          this->Work.AreaOf(static_cast<int>(t)));
      }
    }
  }

  void Encode()
  {
    SurfaceRepair& result = this->Result;
    const std::vector<int> used = UsedPoints(this->Work.Triangles);
    std::vector<int> numbers(static_cast<std::size_t>(this->Work.Points.rows()), -1);
    result.Mesh.Points.resize(static_cast<Eigen::Index>(used.size()), 3);
    for (std::size_t i = 0; i < used.size(); ++i)
    {
      numbers[static_cast<std::size_t>(used[i])] = static_cast<int>(i);
      result.Mesh.Points.row(static_cast<Eigen::Index>(i)) = this->Work.Points.row(used[i]);
      result.PointIds.push_back(this->Work.PointIds[static_cast<std::size_t>(used[i])]);
    }
    result.Mesh.Triangles = ReplaceCorners(this->Work.Triangles, numbers);
    result.TriangleIds = this->Work.Sources;
    result.After = this->NumbersOf(result.Mesh.Points, result.Mesh.Triangles);
  }

  /// Triangles that are not one of the other mesh, with points of the same numbers.
  Status CheckDistances()
  {
    SurfaceRepair& result = this->Result;
    const std::vector<MeshTriangle> given =
      ReplaceCorners(this->Input.Triangles, this->FirstOfEqual);
    std::set<MeshTriangle> stay;
    std::vector<MeshTriangle> changed; // of the result, but not in holes
    std::set<MeshTriangle> all;
    for (const MeshTriangle& corners : given)
    {
      all.insert(Sorted(corners));
    }
    for (std::size_t t = 0; t < result.Mesh.Triangles.size(); ++t)
    {
      const MeshTriangle& corners = result.Mesh.Triangles[t];
      MeshTriangle ids{};
      bool same = true;
      for (std::size_t k = 0; k < 3 && same; ++k)
      {
        const int id = result.PointIds[static_cast<std::size_t>(corners[k])];
        same = id >= 0 && result.Mesh.Points.row(corners[k]) == this->Input.Points.row(id);
        ids[k] = same ? this->FirstOfEqual[static_cast<std::size_t>(id)] : -1;
      }
      ids = Sorted(ids);
      if (same && all.count(ids) > 0)
      {
        stay.insert(ids);
      }
      else if (result.TriangleIds[t] >= 0)
      {
        changed.push_back(corners);
      }
    }
    std::vector<MeshTriangle> lost;
    for (const MeshTriangle& corners : given)
    {
      if (stay.count(Sorted(corners)) == 0)
      {
        lost.push_back(corners);
      }
    }
    const double tolerance = ToleranceShare * result.Diagonal;
    const LargestDistance from =
      FarthestFrom(this->InputAndFillings(given), result.Mesh.Points, changed, tolerance);
    const LargestDistance to =
      FarthestFrom(TriangleIndex<3>(result.Mesh.Points, result.Mesh.Triangles), this->Input.Points,
        lost, tolerance);
    result.DistanceFromInput = from.Value;
    result.DistanceToInput = to.Value;
    const LargestDistance& larger = from.Value > to.Value ? from : to;
    if (larger.Value <= this->Params.Limit * result.Diagonal)
    {
      return {};
    }
    return { ErrorCode::NotConverged,
      "the repaired surface is " + Digits(larger.Value / result.Diagonal, 3) +
        " of the diagonal from the given one at " + Place(larger.Place) + ", where " +
        this->NearestAction(larger.Place) + "; mend the triangles there, or raise Limit" };
  }
  /// The input and the triangles that closed its holes, which patches may lie on.
  TriangleIndex<3> InputAndFillings(std::vector<MeshTriangle> triangles) const
  {
    auto count = this->Input.Points.rows();
    PointMatrix points(count + 3 * static_cast<Eigen::Index>(this->Fillings.size()), 3);
    points.topRows(count) = this->Input.Points;
    for (const auto& corners : this->Fillings)
    {
      const auto first = static_cast<int>(count);
      triangles.push_back({ first, first + 1, first + 2 });
      for (const Eigen::Vector3d& corner : corners)
      {
        points.row(count++) = corner.transpose();
      }
    }
    return { std::move(points), std::move(triangles) };
  }
  /// What was done next to a place, in words.
  std::string NearestAction(const Eigen::Vector3d& place) const
  {
    const RepairAction* nearest = nullptr;
    for (const RepairAction& action : this->Result.Actions)
    {
      if (!nearest || (action.Place - place).squaredNorm() < (nearest->Place - place).squaredNorm())
      {
        nearest = &action;
      }
    }
    std::string words = nearest ? ToString(nearest->Kind) : "points";
    std::replace(words.begin(), words.end(), '_', ' ');
    return words + " were repaired";
  }

  const TriangleMesh& Input;
  const SurfaceRepairParams& Params;
  std::vector<int> FirstOfEqual;
  Soup Work;
  std::vector<std::array<Eigen::Vector3d, 3>> Fillings; ///< triangles that closed holes
  SurfaceRepair Result;
  double Done = 0.0;
  double Shown = 0.0; ///< of the progress
};
}

const char* ToString(RepairKind kind)
{
  switch (kind)
  {
    case RepairKind::DegenerateFace:
      return "degenerate_faces";
    case RepairKind::DuplicateFace:
      return "duplicate_faces";
    case RepairKind::LooseFace:
      return "loose_faces";
    case RepairKind::TurnedFace:
      return "turned_faces";
    case RepairKind::Junction:
      return "junctions";
    case RepairKind::Hole:
      return "holes";
    case RepairKind::Intersection:
      return "intersections";
    case RepairKind::DividedEdge:
      return "divided_edges";
    case RepairKind::DividedPoint:
      return "divided_points";
    case RepairKind::CutTip:
      return "cut_tips";
    case RepairKind::Overlap:
      return "overlaps";
    case RepairKind::InnerWall:
      return "inner_walls";
    case RepairKind::SmallPart:
      return "small_parts";
    case RepairKind::Patch:
      return "patches";
  }
  return "";
}

int SurfaceRepair::Count(RepairKind kind) const
{
  return static_cast<int>(std::count_if(this->Actions.begin(), this->Actions.end(),
    [kind](const RepairAction& action) { return action.Kind == kind; }));
}

knotwork::Result<SurfaceRepair> RepairSurface(
  const TriangleMesh& mesh, const SurfaceRepairParams& params)
try
{
  if (Status status = CheckInput(mesh, params); !status)
  {
    return status;
  }
  SurfaceRepair result;
  Status status = Repair(mesh, params).Run(result);
  if (params.AlphaWrap &&
    (status.Code == ErrorCode::InvalidTopology || status.Code == ErrorCode::NotConverged))
  {
    const std::string reason = status.Detail;
    status = Repair(mesh, params).Wrap(reason, result);
  }
  if (!status)
  {
    return status;
  }
  return result;
}
catch (...)
{
  return StatusOfException();
}
}
