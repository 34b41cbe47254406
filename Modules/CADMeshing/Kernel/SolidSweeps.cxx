// SPDX-License-Identifier: BSD-3-Clause
#include "SolidSweeps.h"

#include "SolidShape.h"
#include <knotwork/SplineCore/DisjointSets.h>

#include <algorithm>
#include <iterator>
#include <map>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// The sweeps of all bodies that suit each other.
class SweepChoice
{
public:
  SweepChoice(int numFaces, std::vector<std::vector<SolidSweep>> sweeps)
    : NumFaces(numFaces), Sweeps(std::move(sweeps))
  {
  }

  /// @return whether there are some; Deepest is the first body that could not be reached else.
  bool Find(std::vector<SolidSweep>& chosen)
  {
    if (!this->Try())
    {
      return false;
    }
    for (std::size_t body = 0; body < this->Chosen.size(); ++body)
    {
      chosen.push_back(this->Sweeps[body][this->Chosen[body]]);
    }
    return true;
  }

  std::size_t Deepest = 0;

private:
  bool Try()
  {
    constexpr int MostSteps = 100000;
    const std::size_t body = this->Chosen.size();
    if (body == this->Sweeps.size())
    {
      return true;
    }
    for (std::size_t s = 0; s < this->Sweeps[body].size() && this->Steps < MostSteps; ++s)
    {
      ++this->Steps;
      this->Chosen.push_back(s);
      if (this->Suits())
      {
        this->Deepest = std::max(this->Deepest, this->Chosen.size());
        if (this->Try())
        {
          return true;
        }
      }
      this->Chosen.pop_back();
    }
    return false;
  }

  /// Faces that sweeps join have the same mesh. One that links is a grid: blocks can all be grids;
  /// else the others of its end suit it, and all other ends are copies of that one.
  bool Suits() const
  {
    DisjointSets ends(this->NumFaces);
    DisjointSets joined(this->NumFaces);
    std::set<int> links;
    const auto unite = [](DisjointSets& sets, const std::vector<int>& faces)
    {
      for (const int face : faces)
      {
        sets.Unite(faces.front(), face);
      }
    };
    for (std::size_t body = 0; body < this->Chosen.size(); ++body)
    {
      const SolidSweep& sweep = this->Sweeps[body][this->Chosen[body]];
      links.insert(sweep.Linking.begin(), sweep.Linking.end());
      if (sweep.Corners)
      {
        continue;
      }
      for (const auto* faces : { &sweep.Source, &sweep.Target })
      {
        unite(ends, *faces);
        unite(joined, *faces);
      }
      joined.Unite(sweep.Source.front(), sweep.Target.front());
    }
    std::map<int, std::set<int>> fixedEnds; ///< of what is joined
    for (const int face : links)
    {
      fixedEnds[joined.Find(face)].insert(ends.Find(face));
    }
    for (std::size_t body = 0; body < this->Chosen.size(); ++body)
    {
      const SolidSweep& sweep = this->Sweeps[body][this->Chosen[body]];
      if (sweep.Corners)
      {
        continue;
      }
      const auto fixed = fixedEnds.find(joined.Find(sweep.Source.front()));
      if (sweep.IsBlock || fixed == fixedEnds.end())
      {
        continue;
      }
      const bool atTarget = *fixed->second.begin() == ends.Find(sweep.Target.front());
      if (fixed->second.size() > 1 || (atTarget && !sweep.BothWays))
      {
        return false;
      }
    }
    return true;
  }

  int NumFaces;
  std::vector<std::vector<SolidSweep>> Sweeps;
  std::vector<std::size_t> Chosen;
  int Steps = 0;
};

std::string BodyName(int body)
{
  return "solid " + std::to_string(body);
}

std::string FaceList(const CADTopology& model, const std::set<int>& faces)
{
  std::string list;
  for (const int face : faces)
  {
    list += (list.empty() ? "" : ", ") + FaceName(model, face);
  }
  return list;
}
}

namespace
{
/// As many segments on all sides.
SolidSweep CornerSweep(const CADTopology& model, int body, CornerSolid corners)
{
  SolidSweep sweep;
  sweep.Body = body;
  for (const CADTopologySide& side : model.Bodies[At(body)].Sides)
  {
    sweep.Linking.push_back(side.Face);
  }
  for (const CornerSide& side : corners.Sides)
  {
    if (&side != corners.Sides.data())
    {
      sweep.Equal.push_back({ corners.Sides.front().Edges, side.Edges });
    }
  }
  sweep.Corners = std::move(corners);
  return sweep;
}
}

SolidSweep Reversed(const SolidSweep& sweep)
{
  SolidSweep reversed = sweep;
  std::swap(reversed.Source, reversed.Target);
  std::swap(reversed.Origin, reversed.Arrival);
  for (EdgePair& pair : reversed.Imprints)
  {
    std::swap(pair.Source, pair.Target);
  }
  return reversed;
}

Result<std::vector<SolidSweep>> SweepsOf(
  const CADTopology& model, const FaceMesher& faces, int body)
{
  if (!model.Bodies[At(body)].IsSolid)
  {
    return { ErrorCode::InvalidTopology,
      "body " + std::to_string(body) + " is no solid; close it, or take it out of the file" };
  }
  const SolidShape shape(model, faces, body);
  std::vector<SolidSweep> found;
  std::set<int> blockers;
  std::vector<int> from;
  std::vector<std::vector<int>> sources = shape.Sources();
  for (std::size_t i = 0; i < sources.size(); ++i)
  {
    const std::vector<int> source = sources[i];
    SolidSweep sweep;
    SolidSweep shorter;
    std::set<int> ofSource;
    std::set<int> ofShorter;
    if (shape.Sweep(source, true, sweep, ofSource))
    {
      found.push_back(std::move(sweep));
    }
    else if (shape.Sweep(source, false, shorter, ofShorter))
    {
      found.push_back(std::move(shorter));
    }
    else if (!ofSource.empty() && (from.empty() || ofSource.size() < blockers.size()))
    {
      from = source;
      blockers = std::move(ofSource);
    }
    else if (std::find(sources.begin(), sources.end(), sweep.Target) == sources.end() &&
      !sweep.Target.empty())
    {
      sources.push_back(sweep.Target); // the other way round
    }
  }
  std::stable_sort(found.begin(), found.end(),
    [](const SolidSweep& a, const SolidSweep& b) { return a.Score < b.Score; });
  if (auto corners = CornersOf(model, faces, body))
  {
    found.push_back(CornerSweep(model, body, std::move(*corners)));
  }
  if (found.empty())
  {
    return { ErrorCode::InvalidTopology,
      BodyName(body) + " is neither mapped nor swept: " +
        (from.empty() ? std::string("no face of it is a source with others around it")
                      : "from " + FaceList(model, { from.begin(), from.end() }) +
              "; what prevents it is " + FaceList(model, blockers) +
              ", no rectangles that lead from source to target, or bent away") +
        "; cut it (cadmodify, which has --suggest)" };
  }
  for (std::size_t rank = 0; rank < found.size(); ++rank)
  {
    found[rank].Rank = static_cast<int>(rank);
  }
  return found;
}

Result<std::vector<SolidSweep>> ChooseSweeps(
  const CADTopology& model, const FaceMesher& faces, const std::set<SweepNumber>& leftOut)
{
  std::vector<std::vector<SolidSweep>> sweeps;
  for (int body = 0; body < static_cast<int>(model.Bodies.size()); ++body)
  {
    auto found = SweepsOf(model, faces, body);
    if (!found)
    {
      return found.Status;
    }
    std::vector<SolidSweep>& ofBody = sweeps.emplace_back();
    std::copy_if(found->begin(), found->end(), std::back_inserter(ofBody),
      [&](const SolidSweep& sweep) {
        return leftOut.count({ body, sweep.Rank }) == 0;
      });
  }
  const auto numFaces = static_cast<int>(model.Faces.size());
  SweepChoice choice(numFaces, std::move(sweeps));
  std::vector<SolidSweep> chosen;
  if (!choice.Find(chosen))
  {
    return { ErrorCode::InvalidTopology,
      BodyName(static_cast<int>(choice.Deepest)) +
        " cannot be swept such that its faces suit those of its neighbours; cut it (cadmodify), or "
        "mesh it alone" };
  }
  return chosen;
}
}
