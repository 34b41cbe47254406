// SPDX-License-Identifier: BSD-3-Clause
#include "LRStrategies.h"

#include <algorithm>

namespace knotwork
{
namespace
{
constexpr double LeastShare = 0.5; // of the longest span of a function, that is still halved

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// A local function's knots by their values.
class View
{
public:
  explicit View(const SplineSpace<2>& space) : Data(*space.LocallyRefined) {}

  double Knot(int f, int d, int i) const
  {
    return this->Data.Basis.Knots[At(d)][At(this->Data.Basis.Local(f, d)[i])];
  }
  double Low(int f, int d) const { return this->Knot(f, d, 0); }
  double High(int f, int d) const { return this->Knot(f, d, this->Degree(d) + 1); }
  double Length(int f, int d) const { return this->High(f, d) - this->Low(f, d); }
  int Degree(int d) const { return this->Data.Basis.Degree[At(d)]; }
  const int* AliveBegin(int e) const
  {
    return this->Data.AliveFunctions.data() + this->Data.AliveStart[At(e)];
  }
  const int* AliveEnd(int e) const
  {
    return this->Data.AliveFunctions.data() + this->Data.AliveStart[At(e) + 1];
  }
  /// The function on an element for which a measure is least, the first of equals.
  template <typename Measure>
  int Least(int e, Measure&& measure) const
  {
    return *std::min_element(this->AliveBegin(e), this->AliveEnd(e),
      [&](int a, int b) { return measure(a) < measure(b); });
  }

private:
  const LRData& Data;
};

/// Bits of knot spans of every function, by direction.
using SpanMasks = std::array<std::vector<unsigned>, 2>;
constexpr unsigned AllSpans = ~0U;

/// The spans that hold elements. An element lies in one span of every function on it.
SpanMasks SpansWithElements(
  const SplineSpace<2>& space, const View& view, const std::vector<int>& elements)
{
  SpanMasks masks;
  masks.fill(std::vector<unsigned>(At(space.NumFunctions), 0U));
  for (const int e : elements)
  {
    const ParametricBox<2>& box = space.Elements[At(e)].Box;
    for (int d = 0; d < 2; ++d)
    {
      const double middle = 0.5 * (box.Lower[At(d)] + box.Upper[At(d)]);
      for (const int* f = view.AliveBegin(e); f != view.AliveEnd(e); ++f)
      {
        int i = 0;
        while (i < view.Degree(d) && view.Knot(*f, d, i + 1) <= middle)
        {
          ++i;
        }
        masks[At(d)][At(*f)] |= 1U << i;
      }
    }
  }
  return masks;
}

/// Halves knot spans of a function.
/// @param mask  of the spans that are considered, with RestrictedMesh.
void HalveSpans(const View& view, int f, int d, LRStrategy strategy, unsigned mask,
  std::vector<LRSegment>& segments)
{
  const auto length = [&](int i) { return view.Knot(f, d, i + 1) - view.Knot(f, d, i); };
  const auto isConsidered = [&](int i)
  { return strategy != LRStrategy::RestrictedMesh || (mask >> i & 1U) != 0; };
  int longest = -1;
  for (int i = 0; i <= view.Degree(d); ++i)
  {
    if (isConsidered(i) && (longest < 0 || length(i) > length(longest)))
    {
      longest = i;
    }
  }
  for (int i = 0; i <= view.Degree(d); ++i)
  {
    const bool isHalved = strategy == LRStrategy::StructuredMesh ? length(i) > 0.0
      : strategy == LRStrategy::RestrictedMesh
      ? isConsidered(i) && length(i) > LeastShare * length(longest)
      : i == longest;
    if (isHalved)
    {
      segments.push_back({ d, 0.5 * (view.Knot(f, d, i) + view.Knot(f, d, i + 1)),
        view.Low(f, 1 - d), view.High(f, 1 - d) });
    }
  }
}

/// @param masks  spans with marked elements, for RestrictedMesh.
void HalveElement(const SplineSpace<2>& space, const View& view, int e, int d, LRStrategy strategy,
  const SpanMasks& masks, std::vector<LRSegment>& segments)
{
  const ParametricBox<2>& box = space.Elements[At(e)].Box;
  const int across = 1 - d;
  LRSegment segment{ d, 0.5 * (box.Lower[At(d)] + box.Upper[At(d)]), box.Lower[At(across)],
    box.Upper[At(across)] };
  if (strategy == LRStrategy::StructuredMesh || strategy == LRStrategy::RestrictedMesh)
  {
    const int f = view.Least(e, [&](int i) { return view.Length(i, 0) * view.Length(i, 1); });
    const bool isStructured = strategy == LRStrategy::StructuredMesh;
    HalveSpans(view, f, d, strategy, isStructured ? AllSpans : masks[At(d)][At(f)], segments);
    return;
  }
  if (strategy == LRStrategy::MinimumSpan)
  {
    const int f = view.Least(e, [&](int i) { return view.Length(i, across); });
    segment.Start = view.Low(f, across);
    segment.End = view.High(f, across);
  }
  else
  {
    for (const int* f = view.AliveBegin(e); f != view.AliveEnd(e); ++f)
    {
      segment.Start = std::min(segment.Start, view.Low(*f, across));
      segment.End = std::max(segment.End, view.High(*f, across));
    }
  }
  segments.push_back(segment);
}

Status CheckIds(
  const SplineSpace<2>& space, const std::vector<int>& ids, int count, const char* what)
{
  if (space.Kind != SpaceKind::LocallyRefined)
  {
    return { ErrorCode::DimensionMismatch, "the space is not locally refined" };
  }
  for (const int id : ids)
  {
    if (id < 0 || id >= count)
    {
      return { ErrorCode::InvalidParameter,
        std::string("there is no ") + what + " " + std::to_string(id) + " among " +
          std::to_string(count) };
    }
  }
  return {};
}
}

Result<std::vector<LRSegment>> SegmentsForElements(
  const SplineSpace<2>& space, const std::vector<int>& elements, const LRStrategyParams& params)
{
  if (Status status = CheckIds(space, elements, space.NumElements(), "element"); !status)
  {
    return status;
  }
  const View view(space);
  const SpanMasks masks = params.Strategy == LRStrategy::RestrictedMesh
    ? SpansWithElements(space, view, elements)
    : SpanMasks();
  std::vector<LRSegment> segments;
  for (const int e : elements)
  {
    for (int d = 0; d < 2; ++d)
    {
      if (params.Directions[At(d)])
      {
        HalveElement(space, view, e, d, params.Strategy, masks, segments);
      }
    }
  }
  return segments;
}

Result<std::vector<LRSegment>> SegmentsForFunctions(
  const SplineSpace<2>& space, const std::vector<int>& functions, const LRStrategyParams& params)
{
  if (Status status = CheckIds(space, functions, space.NumFunctions, "function"); !status)
  {
    return status;
  }
  const View view(space);
  if (params.Strategy == LRStrategy::FullSpan)
  {
    std::vector<bool> chosen(At(space.NumFunctions), false);
    for (const int f : functions)
    {
      chosen[At(f)] = true;
    }
    std::vector<int> elements;
    for (int e = 0; e < space.NumElements(); ++e)
    {
      if (std::any_of(view.AliveBegin(e), view.AliveEnd(e), [&](int f) { return chosen[At(f)]; }))
      {
        elements.push_back(e);
      }
    }
    return SegmentsForElements(space, elements, params);
  }
  std::vector<LRSegment> segments;
  for (const int f : functions)
  {
    for (int d = 0; d < 2; ++d)
    {
      if (params.Directions[At(d)])
      {
        HalveSpans(view, f, d, params.Strategy, AllSpans, segments);
      }
    }
  }
  return segments;
}
}
