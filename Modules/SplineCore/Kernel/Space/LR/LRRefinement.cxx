// SPDX-License-Identifier: BSD-3-Clause
#include "LRRefinement.h"

#include "LRState.h"
#include "Numbers.h"

#include <cmath>
#include <numeric>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

std::string Describe(const LRSegment& segment)
{
  const char* names = "uv";
  const auto d = At(segment.Direction);
  return std::string("segment ") + names[d] + " = " + Digits(segment.Value) + ", " + names[1 - d] +
    " from " + Digits(segment.Start) + " to " + Digits(segment.End);
}
}

Status LRRefinement::State::Resolve(const LRSegment& segment, Request& request) const
{
  if (segment.Direction != 0 && segment.Direction != 1)
  {
    return { ErrorCode::InvalidParameter,
      "a segment has direction " + std::to_string(segment.Direction) + ", choose 0 or 1" };
  }
  const int d = segment.Direction;
  if (!std::isfinite(segment.Value) || !std::isfinite(segment.Start) || !std::isfinite(segment.End))
  {
    return { ErrorCode::NonFiniteInput, Describe(segment) };
  }
  if (segment.Start >= segment.End)
  {
    return { ErrorCode::InvalidParameter, Describe(segment) + ": it has no length" };
  }
  const int most = this->Order[At(d)] - 1;
  if (segment.Multiplicity < 1 || segment.Multiplicity > most)
  {
    return { ErrorCode::InvalidParameter,
      Describe(segment) + ": multiplicity " + std::to_string(segment.Multiplicity) +
        " is outside [1, " + std::to_string(most) + "]" };
  }
  request = { d, this->FindKnot(d, segment.Value), segment.Value,
    this->FindKnot(1 - d, segment.Start), this->FindKnot(1 - d, segment.End),
    segment.Multiplicity };
  if (request.Line < 0 && !(segment.Value > this->Begin[At(d)] && segment.Value < this->End[At(d)]))
  {
    return { ErrorCode::OutsideDomain, Describe(segment) + ": the line is outside the domain" };
  }
  if (request.Start < 0 || request.End < 0)
  {
    return { ErrorCode::InvalidTopology,
      Describe(segment) + ": no mesh line for it to " + (request.Start < 0 ? "start" : "end") +
        " at" };
  }
  if (this->Value(1 - d, request.Start) >= this->Value(1 - d, request.End))
  {
    return { ErrorCode::InvalidParameter, Describe(segment) + ": it has no length" };
  }
  if (request.Line >= 0)
  {
    request.Value = this->Value(d, request.Line);
  }
  return {};
}

/// Where the line begins or ends anew there must be a line across it, or an element is left that is
/// no box.
Status LRRefinement::State::CheckEnds(
  const Request& request, const LRLine& before, const LRLine& after) const
{
  const int d = request.Direction;
  const auto at = [&](const LRLine& line, double x, bool below)
  {
    int m = 0;
    for (const LRPiece& piece : line)
    {
      const double value = this->Value(1 - d, piece.Knot);
      if (below ? value >= x : value > x)
      {
        break;
      }
      m = piece.Multiplicity;
    }
    return m;
  };
  for (const int end : { request.Start, request.End })
  {
    const double x = this->Value(1 - d, end);
    if (x == this->Begin[At(1 - d)] || x == this->End[At(1 - d)] ||
      (at(after, x, true) > 0) == (at(after, x, false) > 0) ||
      (at(before, x, true) > 0) != (at(before, x, false) > 0))
    {
      continue;
    }
    // the crossing line is positive on both sides of the value
    const LRLine& cross = this->Lines[At(1 - d)][At(end)];
    bool closed = false;
    for (std::size_t k = 0; k < cross.size(); ++k)
    {
      const bool below = this->Value(d, cross[k].Knot) < request.Value;
      const bool above = k + 1 == cross.size() || this->Value(d, cross[k + 1].Knot) > request.Value;
      closed = closed || (below && above && cross[k].Multiplicity > 0);
      closed = closed ||
        (below && k + 1 < cross.size() && this->Value(d, cross[k + 1].Knot) == request.Value &&
          cross[k].Multiplicity > 0 && cross[k + 1].Multiplicity > 0);
    }
    if (!closed)
    {
      return { ErrorCode::InvalidTopology,
        "it ends inside an element, at " + Digits(x) + ", where no mesh line crosses it" };
    }
  }
  return {};
}

/// Functions whose support the line now traverses more often than they know.
std::vector<LRRefinement::State::Traverse> LRRefinement::State::FindTraversed(
  const Request& request, const LRLine& after) const
{
  const int d = request.Direction;
  const int e = 1 - d;
  const double start = this->Value(e, request.Start);
  const double end = this->Value(e, request.End);
  // the line may go on below the segment
  double low = start;
  for (std::size_t k = after.size(); k-- > 0;)
  {
    if (this->Value(e, after[k].Knot) < end)
    {
      if (after[k].Multiplicity == 0)
      {
        break;
      }
      low = std::min(low, this->Value(e, after[k].Knot));
    }
  }
  const std::vector<LineSummary>& across = this->Sorted[At(e)];
  auto line = std::lower_bound(across.begin(), across.end(), low,
    [&](const LineSummary& summary, double v) { return this->Value(e, summary.Line) < v; });
  std::vector<Traverse> found;
  for (; line != across.end() && this->Value(e, line->Line) < end; ++line)
  {
    const double from = this->Value(e, line->Line);
    for (const Stretch& stretch : this->Starts[At(e)][At(line->Line)])
    {
      if (stretch.Low < request.Value && stretch.High > request.Value && stretch.End > start)
      {
        const int has = request.Line < 0
          ? 0
          : CountKnot(this->Knots(stretch.Function, d), this->Order[At(d)], request.Line);
        const int missing = this->Multiplicity(d, after, from, stretch.End) - has;
        if (missing > 0)
        {
          found.push_back({ stretch.Function, request.Line, missing });
        }
      }
    }
  }
  return found;
}

Status LRRefinement::Check(const LRSegment& segment) const
{
  State::Request request{};
  Status status = this->S->Resolve(segment, request);
  return status.Code == ErrorCode::InvalidTopology ? Status() : status;
}

Status LRRefinement::Insert(const LRSegment& segment)
{
  State& s = *this->S;
  State::Request request{};
  if (const Status status = s.Resolve(segment, request); !status)
  {
    return status;
  }
  const int d = request.Direction;
  const LRLine before = request.Line < 0 ? LRLine{ { 0, 0 } } : s.Lines[At(d)][At(request.Line)];
  const LRLine after = s.Raised(d, before, request.Start, request.End, request.Multiplicity);
  if (after == before)
  {
    return {};
  }
  if (const Status status = s.CheckEnds(request, before, after); !status)
  {
    return { status.Code, Describe(segment) + ": " + status.Detail };
  }
  std::vector<State::Traverse> traversed = s.FindTraversed(request, after);
  if (traversed.empty())
  {
    return { ErrorCode::InvalidTopology,
      Describe(segment) + ": it traverses the support of no function; make it longer" };
  }
  if (request.Line < 0)
  {
    request.Line = s.AddKnot(d, request.Value);
  }
  s.Lines[At(d)][At(request.Line)] = after;
  s.Sorted[At(d)][At(s.Ranks[At(d)][At(request.Line)])] = s.Summary(d, request.Line);
  for (State::Traverse& traverse : traversed)
  {
    traverse.Line = request.Line; // it may be new
    s.Split(traverse, d, static_cast<unsigned char>(2 >> d));
  }
  s.RestoreMinimalSupport();
  return {};
}

LRRefinement::LRRefinement(const SplineSpace<2>& space, const PointMatrixView& rows)
  : S(std::make_unique<State>())
{
  State& s = *this->S;
  const LRBasis& basis = space.LocallyRefined->Basis;
  s.Order = { basis.Degree[0] + 2, basis.Degree[1] + 2 };
  s.Stride = basis.Stride();
  s.Values = basis.Knots;
  s.Lines = basis.Lines;
  for (int d = 0; d < 2; ++d)
  {
    s.Begin[At(d)] = basis.Knots[At(d)].front();
    s.End[At(d)] = basis.Knots[At(d)].back();
  }
  for (int d = 0; d < 2; ++d)
  {
    s.Ranks[At(d)].resize(s.Values[At(d)].size());
    std::iota(s.Ranks[At(d)].begin(), s.Ranks[At(d)].end(), 0);
    for (const int k : s.Ranks[At(d)])
    {
      s.Sorted[At(d)].push_back(s.Summary(d, k));
    }
    s.Starts[At(d)].resize(s.Values[At(d)].size());
  }
  s.Columns = static_cast<int>(rows.cols());
  std::vector<double> row(At(s.Columns));
  s.Count = basis.NumFunctions();
  s.GrowTable();
  s.Count = 0;
  for (int f = 0; f < basis.NumFunctions(); ++f)
  {
    for (int c = 0; c < s.Columns; ++c)
    {
      row[At(c)] = rows(f, c);
    }
    s.Add(basis.Local(f, 0), basis.Scaling[At(f)], row.data(), 0);
  }
}

LRRefinement::LRRefinement(LRRefinement&&) noexcept = default;
LRRefinement& LRRefinement::operator=(LRRefinement&&) noexcept = default;
LRRefinement::~LRRefinement() = default;

int LRRefinement::NumFunctions() const
{
  return this->S->Count;
}
}
