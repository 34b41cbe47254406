// SPDX-License-Identifier: BSD-3-Clause
#include "SheetSelection.h"

#include "FanTruncation.h"
#include "FarthestDistance.h"
#include "TrianglePairs.h"

#include <knotwork/SplineCore/Parallel.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

namespace knotwork
{
namespace
{
constexpr int NumVotes = 5; ///< faces that tell a sheet's winding number

Eigen::Vector3d Row(const PointMatrix& points, int i)
{
  return points.row(i).transpose();
}

Eigen::Vector3d AreaVector(const PointMatrix& points, const MeshTriangle& t)
{
  const Eigen::Vector3d a = Row(points, t[0]);
  return 0.5 * (Row(points, t[1]) - a).cross(Row(points, t[2]) - a);
}

Eigen::Vector3d Middle(const PointMatrix& points, const MeshTriangle& t)
{
  return (Row(points, t[0]) + Row(points, t[1]) + Row(points, t[2])) / 3.0;
}

/// Triangles of each sheet.
std::vector<std::vector<int>> TrianglesOfSheets(const SheetMesh& sheets)
{
  std::vector<std::vector<int>> members(static_cast<std::size_t>(sheets.NumSheets));
  for (std::size_t t = 0; t < sheets.Triangles.size(); ++t)
  {
    members[static_cast<std::size_t>(sheets.Sheets[t])].push_back(static_cast<int>(t));
  }
  return members;
}

/// The winding number inside of a sheet, by most of its largest triangles.
int LevelOf(const SheetMesh& sheets, std::vector<int> members, const PointMatrix& points,
  const std::vector<MeshTriangle>& triangles)
{
  const auto area = [&](int t)
  { return AreaVector(sheets.Points, sheets.Triangles[static_cast<std::size_t>(t)]).norm(); };
  const std::size_t count = std::min<std::size_t>(members.size(), NumVotes);
  std::vector<std::pair<double, int>> order;
  order.reserve(members.size());
  for (const int t : members)
  {
    order.emplace_back(-area(t), t);
  }
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), order.end());
  std::map<int, int> votes;
  for (std::size_t i = 0; i < count; ++i)
  {
    const auto t = static_cast<std::size_t>(order[i].second);
    const double winding = WindingNumber(
      points, triangles, Middle(sheets.Points, sheets.Triangles[t]), sheets.Sources[t]);
    ++votes[static_cast<int>(std::lround(winding + 0.5))];
  }
  return std::max_element(
    votes.begin(), votes.end(), [](const auto& a, const auto& b) { return a.second < b.second; })
    ->first;
}

/// Whether all of a sheet is near others.
bool IsNear(const SheetMesh& sheets, const std::vector<int>& members,
  const TriangleIndex<3>& others, double depth)
{
  std::vector<MeshTriangle> triangles;
  for (const int t : members)
  {
    triangles.push_back(sheets.Triangles[static_cast<std::size_t>(t)]);
  }
  constexpr double Exactness = 0.05; // of the depth
  return FarthestFrom(others, sheets.Points, triangles, Exactness * depth, depth).Value <= depth;
}

/// Points whose place another one has.
std::vector<char> FindCopies(const SheetMesh& sheets)
{
  std::map<int, int> count;
  for (const int place : sheets.Places)
  {
    ++count[place];
  }
  std::vector<char> copies;
  for (const int place : sheets.Places)
  {
    copies.push_back(count[place] > 1 ? 1 : 0);
  }
  return copies;
}

/// The direction that leaves all planes of a fan as much as possible: the point of the hull of
/// their normals that is nearest to the origin.
/// @source Gilbert, SIAM J. Control 4 (1966) 61.
Eigen::Vector3d WayOut(const std::vector<Eigen::Vector3d>& normals)
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& normal : normals)
  {
    sum += normal;
  }
  Eigen::Vector3d nearest = sum / static_cast<double>(normals.size());
  for (int step = 0; step < 100; ++step)
  {
    const auto least = std::min_element(normals.begin(), normals.end(),
      [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b)
      { return nearest.dot(a) < nearest.dot(b); });
    const Eigen::Vector3d way = *least - nearest;
    const double length = way.squaredNorm();
    if (length == 0.0)
    {
      break;
    }
    const double share = std::clamp(-nearest.dot(way) / length, 0.0, 1.0);
    if (share < 1e-9)
    {
      break;
    }
    nearest += share * way;
  }
  const double length = nearest.norm();
  return length > 1e-6 ? Eigen::Vector3d(nearest / length) : Eigen::Vector3d::Zero();
}
}

double WindingNumber(const PointMatrix& points, const std::vector<MeshTriangle>& triangles,
  const Eigen::Vector3d& point, int leftOut)
{
  double angle = 0.0;
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    if (static_cast<int>(t) == leftOut)
    {
      continue;
    }
    const Eigen::Vector3d a = Row(points, triangles[t][0]) - point;
    const Eigen::Vector3d b = Row(points, triangles[t][1]) - point;
    const Eigen::Vector3d c = Row(points, triangles[t][2]) - point;
    const double la = a.norm();
    const double lb = b.norm();
    const double lc = c.norm();
    angle +=
      std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return angle / (2.0 * M_PI);
}

SheetChoice ChooseSheets(const SheetMesh& sheets, const PointMatrix& points,
  const std::vector<MeshTriangle>& triangles, double depth, int threads)
{
  const std::vector<std::vector<int>> members = TrianglesOfSheets(sheets);
  const std::size_t count = members.size();
  SheetChoice choice;
  choice.Levels.resize(count);
  ParallelFor(count, 1, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        choice.Levels[i] = LevelOf(sheets, members[i], points, triangles);
      }
    });
  const std::vector<char> copies = FindCopies(sheets);
  std::vector<char> touches(count, 0);
  for (std::size_t t = 0; t < sheets.Triangles.size(); ++t)
  {
    for (const int corner : sheets.Triangles[t])
    {
      touches[static_cast<std::size_t>(sheets.Sheets[t])] |=
        copies[static_cast<std::size_t>(corner)];
    }
  }
  // those that bound the solid from the largest one on, then the others
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
    [&](std::size_t a, std::size_t b)
    {
      const bool first = choice.Levels[a] == 1;
      const bool second = choice.Levels[b] == 1;
      return first != second ? first : members[a].size() > members[b].size();
    });
  choice.Kept.assign(count, 0);
  std::vector<MeshTriangle> kept;
  TriangleIndex<3> index; // of those kept, when it was needed last
  for (const std::size_t i : order)
  {
    if (touches[i] && !kept.empty())
    {
      if (index.Triangles().size() < kept.size())
      {
        index = TriangleIndex<3>(sheets.Points, kept);
      }
      if (IsNear(sheets, members[i], index, depth))
      {
        continue;
      }
    }
    choice.Kept[i] = 1;
    for (const int t : members[i])
    {
      kept.push_back(sheets.Triangles[static_cast<std::size_t>(t)]);
    }
  }
  return choice;
}

SheetMesh KeepSheets(const SheetMesh& sheets, SheetChoice& choice)
{
  SheetMesh result;
  std::vector<int> sheetNumbers(choice.Kept.size(), -1);
  std::vector<int> levels;
  for (std::size_t i = 0; i < choice.Kept.size(); ++i)
  {
    if (choice.Kept[i])
    {
      sheetNumbers[i] = result.NumSheets++;
      levels.push_back(choice.Levels[i]);
    }
  }
  std::vector<int> numbers(static_cast<std::size_t>(sheets.Points.rows()), -1);
  for (std::size_t t = 0; t < sheets.Triangles.size(); ++t)
  {
    const int sheet = sheetNumbers[static_cast<std::size_t>(sheets.Sheets[t])];
    if (sheet >= 0)
    {
      result.Triangles.push_back(sheets.Triangles[t]);
      result.Sources.push_back(sheets.Sources[t]);
      result.Sheets.push_back(sheet);
      for (const int corner : sheets.Triangles[t])
      {
        numbers[static_cast<std::size_t>(corner)] = 0;
      }
    }
  }
  int count = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i)
  {
    if (numbers[i] >= 0)
    {
      numbers[i] = count++;
      result.PointIds.push_back(sheets.PointIds[i]);
      result.Places.push_back(sheets.Places[i]);
    }
  }
  result.Points.resize(count, 3);
  for (std::size_t i = 0; i < numbers.size(); ++i)
  {
    if (numbers[i] >= 0)
    {
      result.Points.row(numbers[i]) = sheets.Points.row(static_cast<Eigen::Index>(i));
    }
  }
  result.Triangles = ReplaceCorners(std::move(result.Triangles), numbers);
  choice.Levels = levels;
  choice.Kept.assign(levels.size(), 1);
  return result;
}

namespace
{
/// Moves points of sheets that touch.
class Separation
{
public:
  Separation(SheetMesh& sheets, const std::vector<int>& levels, double step, int threads,
    const std::function<bool()>& goesOn)
    : Sheets(sheets), Levels(levels), Step(step), Threads(threads), GoesOn(goesOn)
  {
    this->NextPlace =
      sheets.Places.empty() ? 0 : 1 + *std::max_element(sheets.Places.begin(), sheets.Places.end());
    // the outermost sheet of a place stays, those inside move the farther the deeper they are
    this->Shares.assign(this->NumPoints(), 0.0);
    std::vector<int> rank(this->NumPoints(), 0);
    for (std::size_t t = 0; t < sheets.Triangles.size(); ++t)
    {
      const int level = this->LevelOf(t);
      for (const int corner : sheets.Triangles[t])
      {
        rank[static_cast<std::size_t>(corner)] = level >= 1 ? level - 1 : 1 - level;
      }
    }
    std::map<int, std::vector<int>> places;
    for (std::size_t i = 0; i < this->NumPoints(); ++i)
    {
      places[sheets.Places[i]].push_back(static_cast<int>(i));
    }
    for (auto& [place, members] : places)
    {
      std::stable_sort(members.begin(), members.end(),
        [&](int a, int b)
        { return rank[static_cast<std::size_t>(a)] < rank[static_cast<std::size_t>(b)]; });
      for (std::size_t j = 1; j < members.size(); ++j)
      {
        this->Shares[static_cast<std::size_t>(members[j])] =
          static_cast<double>(j) / static_cast<double>(members.size() - 1);
      }
    }
  }

  void Run()
  {
    constexpr int MostCuts = 6;
    for (int round = 0;; ++round)
    {
      const PointMatrix start = this->Sheets.Points;
      const std::vector<std::pair<int, int>> pairs = this->Move();
      if (pairs.empty() || round == MostCuts || !this->GoesOn())
      {
        return;
      }
      const PointMatrix moved = this->Sheets.Points;
      this->Sheets.Points = start;
      if (!this->CutTips(pairs))
      {
        this->Sheets.Points = moved;
        return;
      }
    }
  }
  std::vector<Eigen::Vector3d> Cut; ///< places of tips that were cut

private:
  std::size_t NumPoints() const { return static_cast<std::size_t>(this->Sheets.Points.rows()); }
  int LevelOf(std::size_t triangle) const
  {
    return this->Levels[static_cast<std::size_t>(this->Sheets.Sheets[triangle])];
  }

  /// Moves points as far as nothing meets.
  std::vector<std::pair<int, int>> Move()
  {
    const std::size_t count = this->NumPoints();
    std::vector<std::vector<Eigen::Vector3d>> normals(count);
    std::vector<double> room(count, this->Step);
    for (std::size_t t = 0; t < this->Sheets.Triangles.size(); ++t)
    {
      const MeshTriangle& corners = this->Sheets.Triangles[t];
      const Eigen::Vector3d normal = AreaVector(this->Sheets.Points, corners);
      for (std::size_t k = 0; k < 3; ++k)
      {
        const auto i = static_cast<std::size_t>(corners[k]);
        if (this->Shares[i] == 0.0)
        {
          continue;
        }
        if (normal.norm() > 0.0)
        {
          normals[i].push_back((this->LevelOf(t) >= 1 ? -1.0 : 1.0) * normal.normalized());
        }
        for (const std::size_t other : { (k + 1) % 3, (k + 2) % 3 })
        {
          room[i] = std::min(room[i],
            0.25 *
              (Row(this->Sheets.Points, corners[other]) - Row(this->Sheets.Points, corners[k]))
                .norm());
        }
      }
    }
    std::vector<std::size_t> movable;
    std::vector<Eigen::Vector3d> ways(count, Eigen::Vector3d::Zero());
    for (std::size_t i = 0; i < count; ++i)
    {
      if (!normals[i].empty())
      {
        ways[i] = this->Shares[i] * WayOut(normals[i]);
        movable.push_back(i);
      }
    }
    std::vector<char> moves; // triangles
    for (const MeshTriangle& corners : this->Sheets.Triangles)
    {
      moves.push_back(std::any_of(corners.begin(), corners.end(),
        [&](int corner) { return !normals[static_cast<std::size_t>(corner)].empty(); }));
    }
    if (movable.empty())
    {
      return {};
    }
    const PointMatrix start = this->Sheets.Points;
    std::vector<std::pair<int, int>> pairs;
    constexpr int MostHalvings = 16;
    constexpr int MostInVain = 4;
    std::size_t fewest = std::numeric_limits<std::size_t>::max();
    int best = 0;
    for (int round = 0;; ++round)
    {
      for (const std::size_t i : movable)
      {
        const auto row = static_cast<Eigen::Index>(i);
        this->Sheets.Points.row(row) = start.row(row) + (room[i] * ways[i]).transpose();
      }
      pairs = FindIntersections(this->Sheets.Points, this->Sheets.Triangles, this->Threads, moves);
      if (pairs.size() < fewest)
      {
        fewest = pairs.size();
        best = round;
      }
      if (pairs.empty() || round == MostHalvings || round - best > MostInVain || !this->GoesOn())
      {
        break;
      }
      std::vector<char> halved(count, 0);
      for (const auto& [s, t] : pairs)
      {
        for (const int triangle : { s, t })
        {
          for (const int corner : this->Sheets.Triangles[static_cast<std::size_t>(triangle)])
          {
            halved[static_cast<std::size_t>(corner)] = 1;
          }
        }
      }
      for (const std::size_t i : movable)
      {
        room[i] *= halved[i] ? 0.5 : 1.0;
      }
    }
    return pairs;
  }

  /// Cuts the tips at points that cannot be moved apart.
  /// @return whether there were any.
  bool CutTips(const std::vector<std::pair<int, int>>& pairs)
  {
    std::vector<char> stuck(this->NumPoints(), 0);
    for (const auto& [s, t] : pairs)
    {
      for (const int triangle : { s, t })
      {
        for (const int corner : this->Sheets.Triangles[static_cast<std::size_t>(triangle)])
        {
          stuck[static_cast<std::size_t>(corner)] = 1;
        }
      }
    }
    this->Fans.assign(this->NumPoints(), {});
    for (std::size_t t = 0; t < this->Sheets.Triangles.size(); ++t)
    {
      this->AddToFans(t);
    }
    bool cut = false;
    for (std::size_t i = 0; i < stuck.size(); ++i)
    {
      if (stuck[i] && this->Shares[i] > 0.0 && this->FromCut.count(static_cast<int>(i)) == 0)
      {
        const auto point = static_cast<int>(i);
        cut = this->CutTip(point, true) || this->CutOther(i) || this->CutTip(point, false) || cut;
      }
    }
    return cut;
  }

  /// The same of the fan that stays where a point is: it lies in a dent of one without a cap.
  bool CutOther(std::size_t point)
  {
    for (std::size_t i = 0; i < this->Shares.size(); ++i)
    {
      if (this->Sheets.Places[i] == this->Sheets.Places[point] && this->Shares[i] == 0.0)
      {
        this->Shares[i] = this->Shares[point];
        const bool cut = this->CutTip(static_cast<int>(i), true);
        this->Shares[cut ? point : i] = 0.0;
        return cut;
      }
    }
    return false;
  }

  bool CutTip(int point, bool inside)
  {
    std::map<int, std::pair<int, int>>
      next; // neighbour: triangle that begins there, next neighbour
    for (const int t : this->Fans[static_cast<std::size_t>(point)])
    {
      const MeshTriangle& corners = this->Sheets.Triangles[static_cast<std::size_t>(t)];
      for (std::size_t k = 0; k < 3; ++k)
      {
        if (corners[k] == point)
        {
          next[corners[(k + 1) % 3]] = { t, corners[(k + 2) % 3] };
        }
      }
    }
    if (next.size() < 3)
    {
      return false;
    }
    const Eigen::Vector3d tip = Row(this->Sheets.Points, point);
    std::vector<int> ring;
    std::vector<int> triangles;
    std::vector<Eigen::Vector3d> neighbours;
    double radius = this->Step * this->Shares[static_cast<std::size_t>(point)];
    for (int at = next.begin()->first; ring.size() < next.size();)
    {
      const auto found = next.find(at);
      if (found == next.end())
      {
        return false;
      }
      ring.push_back(at);
      triangles.push_back(found->second.first);
      neighbours.push_back(Row(this->Sheets.Points, at));
      radius = std::min(radius, (neighbours.back() - tip).norm() / 3.0);
      at = found->second.second;
    }
    const auto source = static_cast<std::size_t>(triangles.front());
    const std::vector<MeshTriangle> cap =
      CapOfFan(tip, neighbours, (this->LevelOf(source) >= 1) == inside);
    if (cap.empty())
    {
      return false;
    }
    this->Cut.push_back(tip);
    // the first point of the ring takes the tip's number
    std::vector<int> inner;
    for (std::size_t i = 0; i < ring.size(); ++i)
    {
      const int number = i == 0 ? point : this->AddPoint(point);
      inner.push_back(number);
      this->FromCut.insert(number);
      this->Sheets.Points.row(number) = tip + radius * (neighbours[i] - tip).normalized();
    }
    this->Sheets.PointIds[static_cast<std::size_t>(point)] = -1;
    this->Sheets.Places[static_cast<std::size_t>(point)] = this->NextPlace++;
    for (std::size_t i = 0; i < ring.size(); ++i)
    {
      const std::size_t j = (i + 1) % ring.size();
      const auto t = static_cast<std::size_t>(triangles[i]);
      this->Sheets.Triangles[t] = { inner[i], ring[i], ring[j] };
      this->AddToFans(t);
      this->AddTriangle({ inner[i], ring[j], inner[j] }, t);
    }
    for (const MeshTriangle& corners : cap)
    {
      this->AddTriangle(
        { inner[static_cast<std::size_t>(corners[0])], inner[static_cast<std::size_t>(corners[1])],
          inner[static_cast<std::size_t>(corners[2])] },
        source);
    }
    return true;
  }
  int AddPoint(int like)
  {
    const auto number = static_cast<int>(this->NumPoints());
    this->Sheets.Points.conservativeResize(number + 1, Eigen::NoChange);
    this->Sheets.PointIds.push_back(-1);
    this->Sheets.Places.push_back(this->NextPlace++);
    this->Fans.emplace_back();
    this->Shares.push_back(this->Shares[static_cast<std::size_t>(like)]);
    return number;
  }
  void AddTriangle(const MeshTriangle& corners, std::size_t like)
  {
    this->Sheets.Triangles.push_back(corners);
    this->Sheets.Sources.push_back(this->Sheets.Sources[like]);
    this->Sheets.Sheets.push_back(this->Sheets.Sheets[like]);
    this->AddToFans(this->Sheets.Triangles.size() - 1);
  }
  void AddToFans(std::size_t triangle)
  {
    for (const int corner : this->Sheets.Triangles[triangle])
    {
      this->Fans[static_cast<std::size_t>(corner)].push_back(static_cast<int>(triangle));
    }
  }

  SheetMesh& Sheets;
  const std::vector<int>& Levels;
  double Step;
  int Threads;
  const std::function<bool()>& GoesOn;
  int NextPlace = 0;
  std::vector<std::vector<int>> Fans; ///< triangles of points, and some that were theirs
  std::set<int> FromCut;              ///< points that cuts made
  std::vector<double> Shares;         ///< of the step that a point moves; 0: it stays
};
}

void SeparateSheets(SheetMesh& sheets, const std::vector<int>& levels, double step, int threads,
  std::vector<Eigen::Vector3d>& cut, const std::function<bool()>& goesOn)
{
  Separation separation(sheets, levels, step, threads, goesOn);
  separation.Run();
  cut.insert(cut.end(), separation.Cut.begin(), separation.Cut.end());
}
}
