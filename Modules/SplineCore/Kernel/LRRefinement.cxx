// SPDX-License-Identifier: BSD-3-Clause
#include "LRRefinement.h"

#include "LRParts.h"
#include "Numbers.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace knotwork
{
namespace
{
constexpr double KnotTolerance = 1e-12; // of the domain's size

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Where a function's support lies, beside the list that it is in.
struct Stretch
{
  double Low; // in the list's other direction
  double High;
  double End; // in the list's own direction
  int Function;
};

/// What is asked of every line, in the order of their values.
struct LineSummary
{
  double Low = 0.0; // ends of the part with a positive multiplicity
  double High = 0.0;
  int Most = 0; // largest multiplicity
  int Line = 0;
};
}

struct LRRefinement::State
{
  std::array<int, 2> Order{}; // p + 2
  int Stride = 0;
  std::array<std::vector<double>, 2> Values; // of the knots, in the order of their creation
  RealArray<2> Begin{};
  RealArray<2> End{};
  std::array<std::vector<int>, 2> Ranks;
  std::array<std::vector<LineSummary>, 2> Sorted;
  std::array<std::vector<LRLine>, 2> Lines;

  int Columns = 0;
  std::vector<int> Local;
  std::vector<double> Scaling;
  std::vector<double> Rows;
  std::vector<std::uint64_t> Hashes;
  std::vector<unsigned char> Pending; // bit d: lines of direction d are to be looked at
  std::vector<int> Free;
  std::vector<int> Table; // function + 1, open addressing
  int Count = 0;
  std::array<std::vector<std::vector<Stretch>>, 2> Starts; // [d][knot]
  std::array<std::vector<int>, 2> Places;                  // of a function in its list
  std::vector<int> Queue;

  const int* Knots(int f, int d) const
  {
    return this->Local.data() + std::ptrdiff_t{ f } * this->Stride + (d == 0 ? 0 : this->Order[0]);
  }
  double Value(int d, int knot) const { return this->Values[At(d)][At(knot)]; }
  double Low(int f, int d) const { return this->Value(d, this->Knots(f, d)[0]); }
  double High(int f, int d) const
  {
    return this->Value(d, this->Knots(f, d)[this->Order[At(d)] - 1]);
  }

  // ---- mesh lines ----

  /// Smallest multiplicity of a line of direction d between two values of the other direction.
  int Multiplicity(int d, const LRLine& line, double low, double high) const
  {
    const auto after = std::upper_bound(line.begin(), line.end(), low,
      [&](double value, const LRPiece& piece) { return value < this->Value(1 - d, piece.Knot); });
    auto piece = after == line.begin() ? after : after - 1;
    int least = piece->Multiplicity;
    for (++piece; piece != line.end() && this->Value(1 - d, piece->Knot) < high; ++piece)
    {
      least = std::min(least, piece->Multiplicity);
    }
    return least;
  }

  /// The line with at least a multiplicity between two knots of the other direction.
  LRLine Raised(int d, const LRLine& line, int start, int end, int multiplicity) const
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

  LineSummary Summary(int d, int id) const
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

  /// Knot at a value up to the tolerance, -1 when there is none.
  int FindKnot(int d, double value) const
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

  int AddKnot(int d, double value)
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

  // ---- functions ----

  std::uint64_t HashOf(const int* local) const
  {
    std::uint64_t h = 0x9e3779b97f4a7c15ULL;
    for (int i = 0; i < this->Stride; ++i)
    {
      h = (h ^ static_cast<std::uint64_t>(local[i])) * 0xff51afd7ed558ccdULL;
      h ^= h >> 32;
    }
    return h;
  }

  std::size_t Home(std::uint64_t hash) const { return hash & (this->Table.size() - 1); }

  /// Slot of a function with these local knots, or the empty slot where it belongs.
  std::size_t Slot(const int* local, std::uint64_t hash) const
  {
    std::size_t slot = this->Home(hash);
    while (this->Table[slot] > 0)
    {
      const int f = this->Table[slot] - 1;
      if (this->Hashes[At(f)] == hash && std::equal(local, local + this->Stride, this->Knots(f, 0)))
      {
        break;
      }
      slot = (slot + 1) & (this->Table.size() - 1);
    }
    return slot;
  }

  void GrowTable()
  {
    std::size_t size = std::max<std::size_t>(64, this->Table.size());
    while (size < 3 * (At(this->Count) + 1))
    {
      size *= 2;
    }
    if (size == this->Table.size())
    {
      return;
    }
    std::vector<int> old(size, 0);
    old.swap(this->Table);
    for (const int entry : old)
    {
      if (entry > 0)
      {
        std::size_t slot = this->Home(this->Hashes[At(entry - 1)]);
        while (this->Table[slot] > 0)
        {
          slot = (slot + 1) & (size - 1);
        }
        this->Table[slot] = entry;
      }
    }
  }

  void Link(int f)
  {
    for (int d = 0; d < 2; ++d)
    {
      std::vector<Stretch>& list = this->Starts[At(d)][At(this->Knots(f, d)[0])];
      this->Places[At(d)][At(f)] = static_cast<int>(list.size());
      list.push_back({ this->Low(f, 1 - d), this->High(f, 1 - d), this->High(f, d), f });
    }
  }

  void Unlink(int f)
  {
    for (int d = 0; d < 2; ++d)
    {
      std::vector<Stretch>& list = this->Starts[At(d)][At(this->Knots(f, d)[0])];
      const int place = this->Places[At(d)][At(f)];
      list[At(place)] = list.back();
      this->Places[At(d)][At(list[At(place)].Function)] = place;
      list.pop_back();
    }
    std::size_t slot = this->Slot(this->Knots(f, 0), this->Hashes[At(f)]);
    // entries behind the hole move up, so that searches do not end too early
    for (std::size_t next = slot;;)
    {
      this->Table[slot] = 0;
      for (;;)
      {
        next = (next + 1) & (this->Table.size() - 1);
        if (this->Table[next] == 0)
        {
          return;
        }
        const std::size_t home = this->Home(this->Hashes[At(this->Table[next] - 1)]);
        const bool between =
          slot <= next ? slot < home && home <= next : slot < home || home <= next;
        if (!between)
        {
          break;
        }
      }
      this->Table[slot] = this->Table[next];
      slot = next;
    }
  }

  int NewFunction()
  {
    if (!this->Free.empty())
    {
      const int f = this->Free.back();
      this->Free.pop_back();
      return f;
    }
    const int f = static_cast<int>(this->Scaling.size());
    this->Local.resize(this->Local.size() + At(this->Stride));
    this->Scaling.push_back(0.0);
    this->Rows.resize(this->Rows.size() + At(this->Columns));
    this->Hashes.push_back(0);
    this->Pending.push_back(0);
    this->Places[0].push_back(0);
    this->Places[1].push_back(0);
    return f;
  }

  /// Adds gamma * row to the function with these local knots, which is made when there is none.
  void Add(const int* local, double gamma, const double* row, unsigned char pending)
  {
    const std::uint64_t hash = this->HashOf(local);
    const std::size_t slot = this->Slot(local, hash);
    if (this->Table[slot] > 0)
    {
      const int twin = this->Table[slot] - 1;
      double& old = this->Scaling[At(twin)];
      old += gamma;
      double* target = this->Rows.data() + std::ptrdiff_t{ twin } * this->Columns;
      for (int c = 0; c < this->Columns; ++c)
      {
        target[c] += gamma / old * (row[c] - target[c]);
      }
      return;
    }
    const int f = this->NewFunction();
    std::copy_n(local, this->Stride, this->Local.begin() + std::ptrdiff_t{ f } * this->Stride);
    std::copy_n(row, this->Columns, this->Rows.begin() + std::ptrdiff_t{ f } * this->Columns);
    this->Scaling[At(f)] = gamma;
    this->Hashes[At(f)] = hash;
    this->Table[slot] = f + 1;
    ++this->Count;
    this->Link(f);
    this->Pending[At(f)] = pending;
    if (pending != 0)
    {
      this->Queue.push_back(f);
    }
    this->GrowTable();
  }

  /// Replaces a function by its two parts at a knot inside its support.
  void Split(int f, int d, int knot, unsigned char pending)
  {
    const int n = this->Order[At(d)];
    const int* old = this->Knots(f, d);
    const double z = this->Value(d, knot);
    const auto t = [&](int i) { return this->Value(d, old[i]); };
    const double lower = z >= t(n - 2) ? 1.0 : (z - t(0)) / (t(n - 2) - t(0));
    const double upper = z <= t(1) ? 1.0 : (t(n - 1) - z) / (t(n - 1) - t(1));

    int merged[MaxDegree + 3];
    int count = 0;
    for (; count < n && t(count) <= z; ++count)
    {
      merged[count] = old[count];
    }
    merged[count] = knot;
    std::copy(old + count, old + n, merged + count + 1);

    int parts[2][2 * MaxDegree + 4];
    double row[64];
    std::vector<double> longRow;
    double* kept = row;
    if (this->Columns > 64)
    {
      longRow.resize(At(this->Columns));
      kept = longRow.data();
    }
    std::copy_n(this->Rows.data() + std::ptrdiff_t{ f } * this->Columns, this->Columns, kept);
    for (int part = 0; part < 2; ++part)
    {
      std::copy_n(this->Knots(f, 0), this->Stride, parts[part]);
      std::copy_n(merged + part, n, parts[part] + (d == 0 ? 0 : this->Order[0]));
    }
    const double gamma = this->Scaling[At(f)];
    this->Unlink(f);
    this->Pending[At(f)] = 0;
    this->Free.push_back(f);
    --this->Count;
    this->Add(parts[0], lower * gamma, kept, pending);
    this->Add(parts[1], upper * gamma, kept, pending);
  }

  static int CountKnot(const int* local, int n, int knot)
  {
    return static_cast<int>(std::count(local, local + n, knot));
  }

  /// A line of direction d that traverses the support of a function and is not among its knots
  /// often enough; -1 when there is none.
  int Traversing(int f, int d) const
  {
    const int n = this->Order[At(d)];
    const int* local = this->Knots(f, d);
    const double low = this->Low(f, 1 - d);
    const double high = this->High(f, 1 - d);
    const int end = this->Ranks[At(d)][At(local[n - 1])];
    const LineSummary* lines = this->Sorted[At(d)].data();
    for (int r = this->Ranks[At(d)][At(local[0])] + 1; r < end; ++r)
    {
      const LineSummary& line = lines[r];
      if (line.Low > low || line.High < high)
      {
        continue;
      }
      const int has = CountKnot(local, n, line.Line);
      if (has<line.Most&& this->Multiplicity(d, this->Lines[At(d)][At(line.Line)], low, high)> has)
      {
        return line.Line;
      }
    }
    return -1;
  }

  /// What an insertion is about, in knots. Line is -1 while there is no such line.
  struct Request
  {
    int Direction;
    int Line;
    double Value;
    int Start;
    int End;
    int Multiplicity;
  };
  Status Resolve(const LRSegment& segment, Request& request) const;
  Status CheckEnds(const Request& request, const LRLine& before, const LRLine& after) const;
  std::vector<int> FindTraversed(const Request& request, const LRLine& after) const;

  void RestoreMinimalSupport()
  {
    for (std::size_t i = 0; i < this->Queue.size(); ++i)
    {
      const int f = this->Queue[i];
      const unsigned char pending = this->Pending[At(f)]; // 0: split since, or seen already
      for (int d = 0; d < 2; ++d)
      {
        if ((pending >> d & 1) == 0)
        {
          continue;
        }
        const int line = this->Traversing(f, d);
        if (line >= 0)
        {
          // the parts are narrower: more lines of the other direction may traverse them
          this->Split(f, d, line, static_cast<unsigned char>(pending | (2 >> d)));
          break;
        }
        this->Pending[At(f)] &= static_cast<unsigned char>(~(1 << d));
      }
    }
    this->Queue.clear();
  }
};

namespace
{
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
std::vector<int> LRRefinement::State::FindTraversed(
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
  std::vector<int> found;
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
        if (this->Multiplicity(d, after, from, stretch.End) > has)
        {
          found.push_back(stretch.Function);
        }
      }
    }
  }
  return found;
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
  const std::vector<int> traversed = s.FindTraversed(request, after);
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
  const int own = request.Multiplicity > 1 ? 1 << d : 0;
  for (const int f : traversed)
  {
    s.Split(f, d, request.Line, static_cast<unsigned char>(own | (2 >> d)));
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

Result<SplineSpacePtr<2>> LRRefinement::Finish(PointMatrix* rows, int threads) const
{
  const State& s = *this->S;
  LRBasis basis;
  basis.Degree = { s.Order[0] - 2, s.Order[1] - 2 };
  for (std::size_t d = 0; d < 2; ++d)
  {
    for (const LineSummary& line : s.Sorted[d])
    {
      basis.Knots[d].push_back(s.Values[d][At(line.Line)]);
      basis.Lines[d].push_back(s.Lines[d][At(line.Line)]);
      for (LRPiece& piece : basis.Lines[d].back())
      {
        piece.Knot = s.Ranks[1 - d][At(piece.Knot)];
      }
    }
  }
  // functions in their order: by the second direction's local knots, then by the first's
  const auto n = s.Scaling.size();
  std::vector<int> ranks(s.Local.size());
  std::vector<bool> alive(n, false);
  for (const int entry : s.Table)
  {
    if (entry > 0)
    {
      alive[At(entry - 1)] = true;
    }
  }
  std::vector<int> order;
  for (std::size_t f = 0; f < n; ++f)
  {
    if (!alive[f])
    {
      continue;
    }
    order.push_back(static_cast<int>(f));
    const std::size_t begin = f * At(s.Stride);
    for (std::size_t i = 0; i < At(s.Stride); ++i)
    {
      ranks[begin + i] = s.Ranks[i < At(s.Order[0]) ? 0 : 1][At(s.Local[begin + i])];
    }
  }
  std::sort(order.begin(), order.end(),
    [&](int a, int b)
    {
      const int* first = ranks.data() + std::ptrdiff_t{ a } * s.Stride;
      const int* second = ranks.data() + std::ptrdiff_t{ b } * s.Stride;
      for (int i = s.Order[0]; i < s.Stride; ++i)
      {
        if (first[i] != second[i])
        {
          return first[i] < second[i];
        }
      }
      return std::lexicographical_compare(first, first + s.Order[0], second, second + s.Order[0]);
    });
  if (rows)
  {
    rows->resize(static_cast<Eigen::Index>(order.size()), s.Columns);
  }
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    const auto begin = ranks.begin() + std::ptrdiff_t{ order[i] } * s.Stride;
    basis.LocalKnots.insert(basis.LocalKnots.end(), begin, begin + s.Stride);
    basis.Scaling.push_back(s.Scaling[At(order[i])]);
    for (int c = 0; rows && c < s.Columns; ++c)
    {
      (*rows)(static_cast<Eigen::Index>(i), c) = s.Rows[At(order[i]) * At(s.Columns) + At(c)];
    }
  }
  return AssembleLRSpace(std::move(basis), threads);
}
}
