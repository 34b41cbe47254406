// SPDX-License-Identifier: BSD-3-Clause
#include "ComponentCount.h"

#include "BoundarySeparation.h"
#include "PreimageProof.h"
#include <knotwork/SplineCore/BoxTree.h>
#include <knotwork/SplineCore/Parallel.h>

#include <algorithm>
#include <limits>

namespace knotwork
{
namespace
{
/// Sides of a component at which it is tried to count preimages.
constexpr int PlacesOfComponent = 4;

/// Components whose boxes meet no other's. The number of preimages is the sum of the components'
/// winding numbers: near such a component it is 0 on one side and 1 on the other.
std::vector<bool> FindLonely(const MapBoundary& boundary)
{
  const PointMatrix& lower = boundary.Lower;
  const PointMatrix& upper = boundary.Upper;
  const Eigen::Index n = boundary.Gluing.NumComponents;
  const double infinity = std::numeric_limits<double>::infinity();
  PointMatrix low = PointMatrix::Constant(n, lower.cols(), infinity);
  PointMatrix high = PointMatrix::Constant(n, lower.cols(), -infinity);
  for (std::size_t i = 0; i < boundary.Gluing.Boundary.size(); ++i)
  {
    const int component = boundary.Gluing.Boundary[i].Component;
    const Eigen::Index at = static_cast<Eigen::Index>(i);
    low.row(component) = low.row(component).cwiseMin(lower.row(at));
    high.row(component) = high.row(component).cwiseMax(upper.row(at));
  }
  const BoxTree tree(low, high);
  std::vector<bool> lonely(static_cast<std::size_t>(n), true);
  for (Eigen::Index i = 0; i < n; ++i)
  {
    const Eigen::RowVectorXd from = low.row(i);
    const Eigen::RowVectorXd to = high.row(i);
    tree.ForNear(from.data(), to.data(),
      [&](int other)
      {
        if (other != i && (low.row(other).array() <= to.array()).all() &&
          (from.array() <= high.row(other).array()).all())
        {
          lonely[static_cast<std::size_t>(i)] = false;
        }
      });
  }
  return lonely;
}
}

ComponentCount CountAtComponents(const MapBoundary& boundary, std::int64_t maxBoxes, int threads)
{
  ComponentCount count;
  const std::vector<bool> lonely = FindLonely(boundary);
  std::vector<std::vector<int>> places; // any of them is enough
  std::vector<int> first(static_cast<std::size_t>(boundary.Gluing.NumComponents), -1);
  for (std::size_t i = 0; i < boundary.Gluing.Boundary.size(); ++i)
  {
    const std::size_t component = static_cast<std::size_t>(boundary.Gluing.Boundary[i].Component);
    if (boundary.Gluing.NumTouching > 0)
    {
      places.push_back({ static_cast<int>(i) });
    }
    else if (!lonely[component])
    {
      if (first[component] < 0)
      {
        first[component] = static_cast<int>(places.size());
        places.emplace_back();
      }
      std::vector<int>& some = places[static_cast<std::size_t>(first[component])];
      if (some.size() < PlacesOfComponent)
      {
        some.push_back(static_cast<int>(i));
      }
    }
  }
  if (places.size() <= 1)
  {
    return count;
  }
  PointMatrix lower;
  PointMatrix upper;
  MakeBoxes(boundary.Cells, boundary.Lattices, lower, upper, threads);
  const BoxTree tree(lower, upper);
  std::vector<MultiplicityResult> results(places.size());
  const std::int64_t each =
    std::max<std::int64_t>(FirstBoxes, maxBoxes / static_cast<std::int64_t>(places.size()));
  ParallelFor(places.size(), 4, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t k = begin; k < end; ++k)
      {
        for (const int place : places[k])
        {
          const BoundarySide& side = boundary.Side(place);
          const std::int64_t before = results[k].Boxes;
          results[k] = CountPreimages(boundary.Cells, boundary.Lattices, tree, side.Cell,
            MiddleOfSide(boundary.Cells, side.Cell, side.Number).Parameters, each - before);
          results[k].Boxes += before;
          if (results[k].State != Multiplicity::Unknown || results[k].Boxes > each)
          {
            places[k] = { place };
            break;
          }
        }
      }
    });
  for (std::size_t k = 0; k < results.size(); ++k)
  {
    const MultiplicityResult& result = results[k];
    count.Boxes += result.Boxes;
    const BoundarySide& side = boundary.Side(places[k][0]);
    const InjectivityWitness::Place place = MiddleOfSide(boundary.Cells, side.Cell, side.Number);
    if (result.State == Multiplicity::Several)
    {
      count.Verdict = InjectivityVerdict::NotInjective;
      count.Reason = InjectivityReason::Overlap;
      count.Witness.Places = { place,
        PlaceInCell(boundary.Cells, result.Cell, -1, result.Other.Parameters) };
      count.Witness.Radius = result.Other.Radius;
      return count;
    }
    if (result.State == Multiplicity::Unknown && count.Verdict == InjectivityVerdict::Injective)
    {
      count.Verdict = InjectivityVerdict::Undecided;
      count.Reason = result.Boxes > each ? InjectivityReason::Boxes : InjectivityReason::TooClose;
      count.Witness.Places = { place, place };
    }
  }
  return count;
}
}
