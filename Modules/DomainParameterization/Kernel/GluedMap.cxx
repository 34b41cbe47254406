// SPDX-License-Identifier: BSD-3-Clause
#include "GluedMap.h"

#include <knotwork/SplineCore/HierarchicalSpace.h>

#include <numeric>

namespace knotwork
{
namespace
{
template <int Dim>
std::vector<bool> FixedFunctions(const SplineSpace<Dim>& space)
{
  std::vector<bool> fixed(static_cast<std::size_t>(space.NumFunctions));
  const auto functions = DescribeFunctions<Dim>(space);
  // numbers of functions of the level grids: a knot more in the middle of every element
  for (std::size_t i = 0; i < fixed.size(); ++i)
  {
    for (std::size_t d = 0; d < Dim; ++d)
    {
      const KnotVector& knots = space.Knots[d];
      const std::int64_t grown =
        (std::int64_t(1) << functions[i].Level) * knots.NumElements() - knots.NumElements();
      const std::int64_t last = knots.NumFunctions() + grown - 1;
      fixed[i] = fixed[i] || functions[i].Index[d] == 0 || functions[i].Index[d] == last;
    }
  }
  return fixed;
}
}

template <int Dim>
GluedMap<Dim> SingleMap(const Spline<Dim>& map)
{
  GluedMap<Dim> glued;
  glued.Patches.push_back(map);
  glued.Functions.emplace_back(static_cast<std::size_t>(map.Space->NumFunctions));
  std::iota(glued.Functions.front().begin(), glued.Functions.front().end(), 0);
  glued.Fixed = FixedFunctions<Dim>(*map.Space);
  return glued;
}

template <int Dim>
PointMatrix GluedPoints(const GluedMap<Dim>& map)
{
  PointMatrix points(map.NumFunctions(), Dim);
  for (std::size_t p = 0; p < map.Patches.size(); ++p)
  {
    for (std::size_t i = 0; i < map.Functions[p].size(); ++i)
    {
      points.row(map.Functions[p][i]) =
        map.Patches[p].ControlPoints.row(static_cast<Eigen::Index>(i));
    }
  }
  return points;
}

template GluedMap<2> SingleMap<2>(const Spline<2>&);
template GluedMap<3> SingleMap<3>(const Spline<3>&);
template PointMatrix GluedPoints<2>(const GluedMap<2>&);
template PointMatrix GluedPoints<3>(const GluedMap<3>&);
}
