// SPDX-License-Identifier: BSD-3-Clause
#include "LRState.h"

#include <cmath>

namespace knotwork
{
namespace
{
constexpr double KnotTolerance = 1e-12; // of the domain's size
}

LRLine LRRefinement::State::Raised(
  int d, const LRLine& line, int start, int end, int multiplicity) const
{
  const double from = this->Value(1 - d, start);
  const double to = this->Value(1 - d, end);
  LRLine raised;
  const auto append = [&](int knot, int m)
  {
    if (!raised.empty() && raised.back().Knot == knot)
    {
      raised.pop_back();
    }
    if (raised.empty() || raised.back().Multiplicity != m)
    {
      raised.push_back({ knot, m });
    }
  };
  int last = 0; // multiplicity of the line as it was
  bool started = false;
  bool ended = false;
  for (const LRPiece& piece : line)
  {
    const double value = this->Value(1 - d, piece.Knot);
    if (!started && value > from)
    {
      append(start, std::max(last, multiplicity));
      started = true;
    }
    if (!ended && value > to)
    {
      append(end, last);
      ended = true;
    }
    last = piece.Multiplicity;
    const bool inside = value >= from && value < to;
    started = started || value == from;
    append(piece.Knot, inside ? std::max(last, multiplicity) : last);
    ended = ended || value == to;
  }
  if (!started)
  {
    append(start, std::max(last, multiplicity));
  }
  if (!ended && to < this->End[At(1 - d)])
  {
    append(end, last);
  }
  return raised;
}

LRRefinement::State::LineSummary LRRefinement::State::Summary(int d, int id) const
{
  const LRLine& line = this->Lines[At(d)][At(id)];
  LineSummary summary;
  summary.Line = id;
  summary.Low = this->End[At(1 - d)];
  summary.High = this->Begin[At(1 - d)];
  for (std::size_t k = 0; k < line.size(); ++k)
  {
    if (line[k].Multiplicity > 0)
    {
      summary.Low = std::min(summary.Low, this->Value(1 - d, line[k].Knot));
      summary.High =
        k + 1 < line.size() ? this->Value(1 - d, line[k + 1].Knot) : this->End[At(1 - d)];
      summary.Most = std::max(summary.Most, line[k].Multiplicity);
    }
  }
  return summary;
}

int LRRefinement::State::FindKnot(int d, double value) const
{
  const std::vector<LineSummary>& sorted = this->Sorted[At(d)];
  const double slack = KnotTolerance * (this->End[At(d)] - this->Begin[At(d)]);
  const auto above = std::lower_bound(sorted.begin(), sorted.end(), value - slack,
    [&](const LineSummary& line, double v) { return this->Value(d, line.Line) < v; });
  int best = -1;
  for (auto k = above; k != sorted.end() && this->Value(d, k->Line) <= value + slack; ++k)
  {
    if (best < 0 ||
      std::fabs(this->Value(d, k->Line) - value) < std::fabs(this->Value(d, best) - value))
    {
      best = k->Line;
    }
  }
  return best;
}

int LRRefinement::State::AddKnot(int d, double value)
{
  const int id = static_cast<int>(this->Values[At(d)].size());
  this->Values[At(d)].push_back(value);
  this->Lines[At(d)].push_back({ { 0, 0 } });
  this->Starts[At(d)].emplace_back();
  std::vector<LineSummary>& sorted = this->Sorted[At(d)];
  const auto place = std::lower_bound(sorted.begin(), sorted.end(), value,
    [&](const LineSummary& line, double v) { return this->Value(d, line.Line) < v; });
  auto rank = static_cast<int>(place - sorted.begin());
  sorted.insert(place, this->Summary(d, id));
  this->Ranks[At(d)].push_back(0);
  for (; At(rank) < sorted.size(); ++rank)
  {
    this->Ranks[At(d)][At(sorted[At(rank)].Line)] = rank;
  }
  return id;
}
}
