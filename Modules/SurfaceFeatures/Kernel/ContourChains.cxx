// SPDX-License-Identifier: BSD-3-Clause
#include "ContourChains.h"

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
struct ChainPoint
{
  int Element = 0;
  RealArray<2> Local{};
  RealArray<2> End{}; // of the straight piece
  RealArray<2> Parameter{};
};

class Linker
{
public:
  Linker(const SplineSpace<2>& space, const std::vector<LinkedPath>& paths, std::size_t numRoots,
    const std::vector<std::uint8_t>& seams, ContourSet& contours)
    : Space(space), Paths(paths), Seams(seams), Contours(contours), Next(numRoots, -1),
      Entered(numRoots, 0), Used(paths.size(), 0)
  {
  }

  void Run()
  {
    std::vector<std::vector<std::size_t>> byLevel(this->Contours.Levels.size());
    for (std::size_t i = 0; i < this->Paths.size(); ++i)
    {
      const ContourPath& path = this->Paths[i].Path;
      byLevel[static_cast<std::size_t>(path.Level)].push_back(i);
      if (path.From >= 0)
      {
        this->Next[static_cast<std::size_t>(path.From)] = static_cast<int>(i);
      }
      if (path.To >= 0)
      {
        this->Entered[static_cast<std::size_t>(path.To)] = 1;
      }
    }
    for (const std::vector<std::size_t>& level : byLevel)
    {
      for (std::size_t i : level)
      {
        const int from = this->Paths[i].Path.From;
        if (from >= 0 && !this->Entered[static_cast<std::size_t>(from)])
        {
          this->Follow(i);
        }
      }
      for (std::size_t i : level)
      {
        if (!this->Used[i])
        {
          this->Follow(i);
        }
      }
    }
    this->Store();
  }

private:
  ChainPoint Place(const LinkedPath& path, std::size_t i) const
  {
    const ParametricBox<2>& box =
      this->Space.Elements[static_cast<std::size_t>(path.Path.Element)].Box;
    const bool loop = path.Path.From < 0;
    const std::size_t next = i + 1 < path.Path.NumPoints ? i + 1 : (loop ? 0 : i);
    ChainPoint point{ path.Path.Element, path.Points[i], path.Points[next], {} };
    for (std::size_t d = 0; d < 2; ++d)
    {
      point.Parameter[d] = point.Local[d] == 1.0
        ? box.Upper[d]
        : box.Lower[d] + point.Local[d] * (box.Upper[d] - box.Lower[d]);
    }
    return point;
  }

  /// Paths of a component from its first one on. @return closed.
  bool ListPaths(std::size_t first)
  {
    this->Chain.clear();
    for (std::size_t at = first;;)
    {
      this->Used[at] = 1;
      this->Chain.push_back(at);
      const int to = this->Paths[at].Path.To;
      const int next = to < 0 ? -1 : this->Next[static_cast<std::size_t>(to)];
      if (next < 0 || next == static_cast<int>(first))
      {
        return to < 0 || next >= 0;
      }
      at = static_cast<std::size_t>(next);
    }
  }

  void Follow(std::size_t first)
  {
    ContourComponent component;
    component.Level = this->Paths[first].Path.Level;
    component.Closed = this->ListPaths(first);
    component.First = this->Points.size();
    for (std::size_t k = 0; k < this->Chain.size(); ++k)
    {
      const LinkedPath& path = this->Paths[this->Chain[k]];
      component.MaxError = std::max(component.MaxError, path.MaxError);
      const int to = path.Path.To;
      const bool end = !component.Closed && k + 1 == this->Chain.size();
      const bool withLast = to < 0 || end || this->Seams[static_cast<std::size_t>(to)] != 0;
      const std::size_t n = path.Path.NumPoints - (withLast ? 0 : 1);
      for (std::size_t i = 0; i < n; ++i)
      {
        this->Append(this->Place(path, i), path.Merge, component, end && i + 1 == n);
      }
    }
    const std::size_t n = this->Points.size() - component.First;
    if (component.Closed && n > 3 &&
      this->AreNear(
        this->Points.back(), this->Points[component.First], this->Paths[this->Chain.back()].Merge))
    {
      this->Points.pop_back();
    }
    component.NumPoints = this->Points.size() - component.First;
    this->Contours.Components.push_back(component);
  }

  bool AreNear(const ChainPoint& a, const ChainPoint& b, double merge) const
  {
    if (!this->Space.HasDomain() && a.Element != b.Element)
    {
      return false;
    }
    const ParametricBox<2>& box = this->Space.Elements[static_cast<std::size_t>(a.Element)].Box;
    for (std::size_t d = 0; d < 2; ++d)
    {
      if (std::abs(a.Parameter[d] - b.Parameter[d]) > merge * (box.Upper[d] - box.Lower[d]))
      {
        return false;
      }
    }
    return true;
  }

  /// Of points within rounding of each other the later one stays, but for the beginning of a
  /// component on the boundary.
  void Append(const ChainPoint& point, double merge, const ContourComponent& component, bool isEnd)
  {
    const std::size_t n = this->Points.size() - component.First;
    if (n == 0 || !this->AreNear(point, this->Points.back(), merge) ||
      (n == 1 && !component.Closed && isEnd))
    {
      this->Points.push_back(point);
      return;
    }
    ChainPoint& previous = this->Points.back();
    if (n > 1 || component.Closed)
    {
      previous = point;
      return;
    }
    previous.Element = point.Element;
    previous.Local = point.Local;
    previous.End = point.End;
  }

  void Store()
  {
    const std::size_t n = this->Points.size();
    this->Contours.Elements.resize(n);
    this->Contours.Local.resize(static_cast<Eigen::Index>(n), 2);
    this->Contours.Parameters.resize(static_cast<Eigen::Index>(n), 2);
    this->Contours.PieceEnds.resize(static_cast<Eigen::Index>(n), 2);
    for (std::size_t i = 0; i < n; ++i)
    {
      const Eigen::Index row = static_cast<Eigen::Index>(i);
      const ChainPoint& point = this->Points[i];
      this->Contours.Elements[i] = point.Element;
      this->Contours.Local.row(row) << point.Local[0], point.Local[1];
      this->Contours.PieceEnds.row(row) << point.End[0], point.End[1];
      this->Contours.Parameters.row(row) << point.Parameter[0], point.Parameter[1];
    }
    this->Contours.NumComponents.assign(this->Contours.Levels.size(), 0);
    this->Contours.NumClosed = this->Contours.NumComponents;
    for (const ContourComponent& component : this->Contours.Components)
    {
      const std::size_t level = static_cast<std::size_t>(component.Level);
      ++this->Contours.NumComponents[level];
      this->Contours.NumClosed[level] += component.Closed ? 1 : 0;
      this->Contours.MaxError = std::max(this->Contours.MaxError, component.MaxError);
    }
  }

  const SplineSpace<2>& Space;
  const std::vector<LinkedPath>& Paths;
  const std::vector<std::uint8_t>& Seams;
  ContourSet& Contours;
  std::vector<int> Next;             // path that leaves a root
  std::vector<std::uint8_t> Entered; // a path ends at a root
  std::vector<std::uint8_t> Used;
  std::vector<std::size_t> Chain;
  std::vector<ChainPoint> Points;
};
}

void LinkContours(const SplineSpace<2>& space, const std::vector<LinkedPath>& paths,
  std::size_t numRoots, const std::vector<std::uint8_t>& seams, ContourSet& contours)
{
  Linker(space, paths, numRoots, seams, contours).Run();
}
}
