// SPDX-License-Identifier: BSD-3-Clause
#include "BodyGroups.h"

#include <knotwork/SplineCore/DisjointSets.h>

#include <map>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}
}

std::vector<int> GroupsOfBodies(const CADTopology& model)
{
  DisjointSets sets(static_cast<int>(model.Bodies.size()));
  std::vector<std::vector<int>> bodiesOfEdges(model.Edges.size());
  for (const CADTopologyFace& face : model.Faces)
  {
    for (const int body : face.Bodies)
    {
      sets.Unite(body, face.Bodies.front());
      for (const auto& loop : face.Loops)
      {
        for (const CADTopologyUse& use : loop)
        {
          if (use.Edge >= 0)
          {
            bodiesOfEdges[At(use.Edge)].push_back(body);
          }
        }
      }
    }
  }
  for (const std::vector<int>& bodies : bodiesOfEdges)
  {
    for (const int body : bodies)
    {
      for (const int other : bodies)
      {
        if (!model.Bodies[At(body)].IsSolid)
        {
          sets.Unite(body, other);
        }
      }
    }
  }
  std::map<int, int> numbers;
  std::vector<int> groups;
  for (int body = 0; body < sets.Size(); ++body)
  {
    groups.push_back(
      numbers.try_emplace(sets.Find(body), static_cast<int>(numbers.size())).first->second);
  }
  return groups;
}

std::vector<int> SeparatePoints(
  std::vector<int>& corners, const std::vector<int>& groupOf, int numPoints)
{
  std::vector<int> first(At(numPoints), -1);  ///< group that keeps the point
  std::map<std::pair<int, int>, int> numbers; ///< by point and group
  std::vector<int> added;
  const std::size_t ofCell = groupOf.empty() ? 0 : corners.size() / groupOf.size();
  for (std::size_t i = 0; i < corners.size(); ++i)
  {
    const int group = groupOf[i / ofCell];
    int& keeps = first[At(corners[i])];
    keeps = keeps < 0 ? group : keeps;
    if (keeps == group)
    {
      continue;
    }
    const auto [known, isNew] =
      numbers.try_emplace({ corners[i], group }, numPoints + static_cast<int>(added.size()));
    if (isNew)
    {
      added.push_back(corners[i]);
    }
    corners[i] = known->second;
  }
  return added;
}
}
