// SPDX-License-Identifier: BSD-3-Clause
#include "LRRefinement.h"

#include <algorithm>
#include <limits>
#include <map>
#include <tuple>

namespace knotwork
{
namespace
{
std::string Named(std::size_t segment, const Status& status)
{
  return "segment " + std::to_string(segment) + ": " + status.Detail;
}

Status InsertAll(LRRefinement& refinement, const std::vector<LRSegment>& segments)
{
  for (std::size_t i = 0; i < segments.size(); ++i)
  {
    if (const Status status = refinement.Insert(segments[i]); !status)
    {
      return { status.Code, Named(i, status) };
    }
  }
  return {};
}

/// A part of a mesh line, and the first of the given segments that it is made of.
struct LinePart
{
  LRSegment Segment;
  std::size_t Given = 0;
};

/// Values so near to each other that they are one knot become the smallest of them.
class KnotValues
{
public:
  KnotValues(std::vector<double> values, double domainSize)
  {
    std::sort(values.begin(), values.end());
    double kept = -std::numeric_limits<double>::infinity();
    for (const double value : values)
    {
      kept = value - kept <= 1e-12 * domainSize ? kept : value; // as LRRefinement::Insert
      this->Knots[value] = kept;
    }
  }

  double At(double value) const { return this->Knots.at(value); }

private:
  std::map<double, double> Knots;
};

/// Along every line the longest parts of at least one multiplicity, then two, and so on: the same
/// for every order and division of the segments.
std::vector<LinePart> UniteSegments(
  const SplineSpace<2>& space, const std::vector<LRSegment>& segments)
{
  std::array<std::vector<double>, 2> values;
  for (const LRSegment& segment : segments)
  {
    const auto d = static_cast<std::size_t>(segment.Direction);
    values[d].push_back(segment.Value);
    values[1 - d].insert(values[1 - d].end(), { segment.Start, segment.End });
  }
  const ParametricBox<2> domain = space.Domain();
  const std::array<KnotValues, 2> knots{ KnotValues(values[0], domain.Upper[0] - domain.Lower[0]),
    KnotValues(values[1], domain.Upper[1] - domain.Lower[1]) };
  std::map<std::tuple<int, double, int>, std::vector<LinePart>>
    lines; // direction, value, multiplicity
  for (std::size_t i = 0; i < segments.size(); ++i)
  {
    LRSegment segment = segments[i];
    const auto d = static_cast<std::size_t>(segment.Direction);
    segment.Value = knots[d].At(segment.Value);
    segment.Start = knots[1 - d].At(segment.Start);
    segment.End = knots[1 - d].At(segment.End);
    for (int m = 1; m <= segments[i].Multiplicity; ++m)
    {
      segment.Multiplicity = m;
      lines[{ segment.Direction, segment.Value, m }].push_back({ segment, i });
    }
  }
  std::vector<LinePart> parts;
  for (auto& [key, line] : lines)
  {
    std::sort(line.begin(), line.end(),
      [](const LinePart& a, const LinePart& b)
      { return std::tie(a.Segment.Start, a.Given) < std::tie(b.Segment.Start, b.Given); });
    const std::size_t first = parts.size();
    for (const LinePart& part : line)
    {
      if (parts.size() == first || part.Segment.Start > parts.back().Segment.End)
      {
        parts.push_back(part);
        continue;
      }
      LinePart& whole = parts.back();
      whole.Segment.End = std::max(whole.Segment.End, part.Segment.End);
      whole.Given = std::min(whole.Given, part.Given);
    }
  }
  return parts;
}

/// Inserts what is legal until nothing waits.
Status InsertInAnyOrder(const SplineSpace<2>& space, const std::vector<LRSegment>& segments,
  int maxFunctions, LRRefinement& refinement)
{
  for (std::size_t i = 0; i < segments.size(); ++i)
  {
    if (const Status status = refinement.Check(segments[i]); !status)
    {
      return { status.Code, Named(i, status) };
    }
  }
  std::vector<LinePart> waiting = UniteSegments(space, segments);
  while (!waiting.empty())
  {
    std::vector<LinePart> next;
    Status first;
    for (const LinePart& part : waiting)
    {
      Status status = refinement.Insert(part.Segment);
      if (!status && status.Code != ErrorCode::InvalidTopology)
      {
        return { status.Code, Named(part.Given, status) };
      }
      if (refinement.NumFunctions() > maxFunctions)
      {
        return { ErrorCode::TooLarge,
          "the segments make more than " + std::to_string(maxFunctions) +
            " functions; pass fewer, or raise the limit" };
      }
      if (!status)
      {
        first = first ? Status(status.Code, Named(part.Given, status)) : first;
        next.push_back(part);
      }
    }
    if (next.size() == waiting.size())
    {
      return first;
    }
    waiting = std::move(next);
  }
  return {};
}

Result<SplineSpacePtr<2>> AsLocallyRefined(const SplineSpacePtr<2>& space, int threads)
{
  if (space->Kind == SpaceKind::LocallyRefined)
  {
    return space;
  }
  Result<LRBasis> basis = LRBasisOfTensor(*space);
  return basis ? MakeLRSpace(std::move(basis.Value), threads) : basis.Status;
}
}

Result<SplineSpacePtr<2>> InsertSegments(
  const SplineSpacePtr<2>& space, const std::vector<LRSegment>& segments, int threads)
{
  const Result<SplineSpacePtr<2>> start = AsLocallyRefined(space, threads);
  if (!start || segments.empty())
  {
    return start;
  }
  LRRefinement refinement(*start.Value, PointMatrix(space->NumFunctions, 0));
  const Status status = InsertAll(refinement, segments);
  return status ? refinement.Finish(nullptr, threads) : status;
}

namespace
{
/// The same map in a space that segments make larger.
/// @param insert  Status of an LRRefinement and the space that it begins with.
template <typename Insert>
Result<Spline<2>> Grow(const Spline<2>& spline, const std::vector<LRSegment>& segments, int threads,
  const Insert& insert)
{
  if (Status status = spline.Check(); !status)
  {
    return status;
  }
  Spline<2> result = spline;
  Result<SplineSpacePtr<2>> space = AsLocallyRefined(spline.Space, threads);
  if (space && !segments.empty())
  {
    LRRefinement refinement(*space.Value, spline.HomogeneousPoints());
    if (const Status status = insert(refinement, *space.Value); !status)
    {
      return status;
    }
    PointMatrix rows;
    const Result<SplineSpacePtr<2>> larger = refinement.Finish(&rows, threads);
    if (!larger)
    {
      return larger.Status;
    }
    // where all was there already, points keep every bit
    if (!(larger.Value->LocallyRefined->Basis == space.Value->LocallyRefined->Basis))
    {
      space = larger;
      result.SetHomogeneousPoints(rows, spline.IsRational());
    }
  }
  result.Space = space.Value;
  return space ? Result<Spline<2>>(std::move(result)) : space.Status;
}
}

Result<Spline<2>> InsertSegments(
  const Spline<2>& spline, const std::vector<LRSegment>& segments, int threads)
{
  return Grow(spline, segments, threads,
    [&](LRRefinement& refinement, const SplineSpace<2>&)
    { return InsertAll(refinement, segments); });
}

Result<Spline<2>> InsertAllSegments(
  const Spline<2>& spline, const std::vector<LRSegment>& segments, int maxFunctions, int threads)
{
  return Grow(spline, segments, threads,
    [&](LRRefinement& refinement, const SplineSpace<2>& space)
    { return InsertInAnyOrder(space, segments, maxFunctions, refinement); });
}
}
