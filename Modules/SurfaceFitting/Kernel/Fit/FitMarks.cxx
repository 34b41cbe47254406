// SPDX-License-Identifier: BSD-3-Clause
#include "FitMarks.h"

#include "FitUpdate.h"
#include <knotwork/SplineCore/Parallel.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace knotwork
{
namespace
{
constexpr double SplitBoth = 0.5;      // a direction's gain, of the other one's: from here on both
constexpr double EndShare = 0.01;      // of the elements
constexpr int LastOfShare = 10;        // iteration; from then on the share is halved in each
constexpr double ReweightRatio = 1.3;  // largest distance / tolerance
constexpr double ReweightShare = 1e-3; // of all points may be outside
constexpr double ReweightFloor = 0.9;  // of the tolerance: from here on points gain
constexpr double ReweightGain = 4.0;
constexpr std::size_t ElementChunk = 64;
constexpr std::size_t MarkChunk = 4;
constexpr std::size_t MostCompared = 32; // points of an element, with each other
constexpr double SamePlace = 1e-12;      // of the domain: no elements are asked to be smaller

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// A share of the domain in both directions.
RealArray<2> ShareOfDomain(const FitState& state, double share)
{
  const ParametricBox<2> domain = state.Space->Domain();
  return { share * (domain.Upper[0] - domain.Lower[0]),
    share * (domain.Upper[1] - domain.Lower[1]) };
}

/// Directions in which an element may be split. A hierarchical space splits in both or not at all.
/// @param least  size of an element.
std::array<bool, 2> AllowedDirections(
  const ParametricBox<2>& box, const RealArray<2>& least, FitSpace space)
{
  std::array<bool, 2> allowed{};
  for (std::size_t d = 0; d < 2; ++d)
  {
    allowed[d] = 0.5 * (box.Upper[d] - box.Lower[d]) >= least[d];
  }
  const bool both = allowed[0] && allowed[1];
  return space == FitSpace::Hierarchical ? std::array<bool, 2>{ both, both } : allowed;
}

/// Whether two points are nearer to each other than a distance in both directions, with values so
/// different that no surface meets both. Outliers contradict nothing.
bool Contradict(const FitPoints& points, int numMeasured, const RealArray<2>& distance,
  std::size_t i, std::size_t k)
{
  double squares = 0.0;
  for (std::size_t c = 0; c < At(numMeasured); ++c)
  {
    const FitPoints::Column& values = points.Values[c];
    squares += (values[i] - values[k]) * (values[i] - values[k]);
  }
  // a surface between them has the higher one above and the lower one below
  const bool isHigher = numMeasured > 1 || points.Values[0][i] > points.Values[0][k];
  const double own = points.Tolerance[i] * (isHigher ? points.FactorAbove : points.FactorBelow);
  const double other = points.Tolerance[k] * (isHigher ? points.FactorBelow : points.FactorAbove);
  return points.Base[k] > 0.0 && std::fabs(points.U[i] - points.U[k]) < distance[0] &&
    std::fabs(points.V[i] - points.V[k]) < distance[1] && std::sqrt(squares) > own + other;
}

bool IsOutside(const FitPoints& points, std::size_t i)
{
  return points.Base[i] > 0.0 && std::fabs(points.Distance[i]) > points.Limit(i);
}

/// Whether all of the element's points outside lie on held edges of the start.
/// @param least  size of an element.
bool AllHeld(const RealArray<2>& least, const FitState& state, const FitPoints& points,
  const FitParams& params, std::size_t e)
{
  if (!params.Start)
  {
    return false;
  }
  const ParametricBox<2> domain = state.Space->Domain();
  const FitPoints::Range range = points.Ranges[e];
  for (std::size_t i = range.Begin; i < range.End; ++i)
  {
    if (IsOutside(points, i) &&
      !IsOnHeldEdge(domain, params.Start->Edges, least, points.U[i], points.V[i]))
    {
      return false;
    }
  }
  return true;
}

/// False when each of the element's points outside contradicts another one, or all lie on held
/// edges.
/// @param least  size of an element.
bool SplitHelps(const RealArray<2>& least, const FitState& state, const FitPoints& points,
  const FitParams& params, std::size_t e)
{
  const FitPoints::Range range = points.Ranges[e];
  if (AllHeld(least, state, points, params, e))
  {
    return false;
  }
  if (range.Count() > MostCompared)
  {
    return true; // its parts will tell
  }
  for (std::size_t i = range.Begin; i < range.End; ++i)
  {
    bool isHopeless = !IsOutside(points, i);
    for (std::size_t k = range.Begin; k < range.End && !isHopeless; ++k)
    {
      isHopeless = Contradict(points, params.NumMeasured, least, i, k);
    }
    if (!isHopeless)
    {
      return true;
    }
  }
  return false;
}

/// Whether each of the element's points outside contradicts another one in the same place.
/// @param place  its size.
bool AllContradict(
  const RealArray<2>& place, const FitPoints& points, int numMeasured, std::size_t e)
{
  const FitPoints::Range range = points.Ranges[e];
  std::vector<std::size_t> order(range.Count());
  std::iota(order.begin(), order.end(), range.Begin);
  std::sort(order.begin(), order.end(),
    [&](std::size_t a, std::size_t b) { return points.U[a] < points.U[b]; });
  auto low = order.begin(); // the first one that is not too far below
  for (const std::size_t i : order)
  {
    while (points.U[*low] < points.U[i] && points.U[i] - points.U[*low] >= place[0])
    {
      ++low;
    }
    bool isFound = !IsOutside(points, i);
    for (auto k = low; k != order.end() && points.U[*k] - points.U[i] < place[0] && !isFound; ++k)
    {
      isFound = Contradict(points, numMeasured, place, i, *k);
    }
    if (!isFound)
    {
      return false;
    }
  }
  return true;
}

/// Directions in which an element is split, of the allowed ones.
std::array<bool, 2> ChooseDirections(const std::array<bool, 2>& allowed, const FitState& state,
  const ElementFunctions& functions, const FitPoints& points, const FitParams& params,
  int iteration, int e)
{
  if (!allowed[0] || !allowed[1] || params.Space == FitSpace::Hierarchical ||
    params.Directions == FitDirections::Both)
  {
    return allowed;
  }
  if (params.Directions == FitDirections::Alternating)
  {
    return { iteration % 2 == 0, iteration % 2 == 1 };
  }
  const RealArray<2> gains =
    SplitGains(*state.Space, functions, state.Coefficients, params.NumMeasured, points, e);
  return { gains[0] >= SplitBoth * gains[1], gains[1] >= SplitBoth * gains[0] };
}

/// Those of the elements that may be split that FitParams::Threshold asks for.
/// @param share  of the largest error or number.
std::vector<SplitMark> ChooseElements(const std::vector<std::array<bool, 2>>& allowed,
  const std::vector<ElementErrors>& errors, const FitParams& params, double share)
{
  double worst = 0.0;
  std::size_t most = 0;
  std::size_t left = 0;
  for (std::size_t e = 0; e < errors.size(); ++e)
  {
    if (allowed[e][0] || allowed[e][1])
    {
      worst = std::max(worst, errors[e].Ratio);
      most = std::max(most, errors[e].NumOutside);
      ++left;
    }
  }
  // near the end what is left is split at once
  const bool isEnd = static_cast<double>(left) <= EndShare * static_cast<double>(errors.size());
  const auto isChosen = [&](const ElementErrors& own)
  {
    switch (params.Threshold)
    {
      case FitThreshold::LargestErrors:
        return own.Ratio - 1.0 >= share * (worst - 1.0);
      case FitThreshold::MostPoints:
        return static_cast<double>(own.NumOutside) >= share * static_cast<double>(most);
      default:
        return true;
    }
  };
  std::vector<SplitMark> marks;
  for (std::size_t e = 0; e < errors.size(); ++e)
  {
    if ((allowed[e][0] || allowed[e][1]) && (isEnd || isChosen(errors[e])))
    {
      marks.push_back({ static_cast<int>(e), allowed[e] });
    }
  }
  return marks;
}
}

std::vector<SplitMark> MarkElements(const FitState& state, const ElementFunctions& functions,
  const FitPoints& points, const std::vector<ElementErrors>& errors, const FitParams& params,
  const FitDivision& division, int iteration)
{
  const RealArray<2> least = ShareOfDomain(state, params.MinElementSize);
  std::vector<std::array<bool, 2>> allowed(errors.size(), { false, false });
  ParallelFor(errors.size(), ElementChunk, params.Threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t e = begin; e < end; ++e)
      {
        if (errors[e].NumOutside > 0 && division.Owns(e) &&
          SplitHelps(least, state, points, params, e))
        {
          allowed[e] = AllowedDirections(state.Space->Elements[e].Box, least, params.Space);
        }
      }
    });
  division.ShareAll([&](std::size_t e) { return std::pair(allowed[e].data(), std::size_t{ 2 }); });
  std::vector<SplitMark> marks = ChooseElements(allowed, errors, params,
    std::ldexp(params.ThresholdShare, -std::clamp(iteration - LastOfShare, 0, 1000)));
  ParallelFor(marks.size(), MarkChunk, params.Threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t k = begin; k < end; ++k)
      {
        SplitMark& mark = marks[k];
        if (division.Owns(At(mark.Element)))
        {
          mark.Directions = ChooseDirections(
            mark.Directions, state, functions, points, params, iteration, mark.Element);
        }
      }
    });
  std::vector<int> marked;
  for (const SplitMark& mark : marks)
  {
    marked.push_back(mark.Element);
  }
  division.Share(
    marked, [&](std::size_t k) { return std::pair(marks[k].Directions.data(), std::size_t{ 2 }); });
  return marks;
}

bool PointsContradict(const FitState& state, const FitPoints& points,
  const std::vector<ElementErrors>& errors, const FitParams& params)
{
  const RealArray<2> place = ShareOfDomain(state, std::min(SamePlace, params.MinElementSize));
  for (std::size_t e = 0; e < errors.size(); ++e)
  {
    if (errors[e].NumOutside > 0 && !AllContradict(place, points, params.NumMeasured, e))
    {
      return false;
    }
  }
  return true;
}

bool PointsAreHeld(const FitState& state, const FitPoints& points,
  const std::vector<ElementErrors>& errors, const FitParams& params)
{
  const RealArray<2> least = ShareOfDomain(state, params.MinElementSize);
  for (std::size_t e = 0; e < errors.size(); ++e)
  {
    if (errors[e].NumOutside > 0 && !AllHeld(least, state, points, params, e))
    {
      return false;
    }
  }
  return true;
}

std::vector<int> ReweightPoints(
  const std::vector<ElementErrors>& errors, int perElement, FitPoints& points)
{
  double worst = 0.0;
  std::size_t outside = 0;
  std::size_t total = 0;
  for (const ElementErrors& own : errors)
  {
    worst = std::max(worst, own.Ratio);
    outside += own.NumOutside;
    total += own.Count;
  }
  std::vector<int> changed;
  if (outside == 0 || worst > ReweightRatio ||
    static_cast<double>(outside) > ReweightShare * static_cast<double>(total))
  {
    return changed;
  }
  for (std::size_t e = 0; e < errors.size(); ++e)
  {
    if (errors[e].NumOutside == 0)
    {
      continue;
    }
    changed.push_back(static_cast<int>(e));
    const FitPoints::Range& range = points.Ranges[e];
    const double unit = std::max(1.0, static_cast<double>(range.Count()) / perElement);
    for (std::size_t i = range.Begin; i < range.End; ++i)
    {
      const double ratio = std::fabs(points.Distance[i]) / points.Limit(i);
      if (ratio > ReweightFloor)
      {
        points.Boost[i] += ReweightGain * unit * (ratio - ReweightFloor) / ReweightFloor;
      }
    }
  }
  return changed;
}
}
