// SPDX-License-Identifier: BSD-3-Clause
#include "LRKnotHash.h"
#include "LRState.h"

namespace knotwork
{
std::uint64_t LRRefinement::State::HashOf(const int* local) const
{
  return LRKnotHash(local, this->Stride);
}

std::size_t LRRefinement::State::Slot(const int* local, std::uint64_t hash) const
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

void LRRefinement::State::GrowTable()
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

void LRRefinement::State::Link(int f)
{
  for (int d = 0; d < 2; ++d)
  {
    std::vector<Stretch>& list = this->Starts[At(d)][At(this->Knots(f, d)[0])];
    this->Places[At(d)][At(f)] = static_cast<int>(list.size());
    list.push_back({ this->Low(f, 1 - d), this->High(f, 1 - d), this->High(f, d), f });
  }
}

void LRRefinement::State::Unlink(int f)
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
      const bool between = slot <= next ? slot < home && home <= next : slot < home || home <= next;
      if (!between)
      {
        break;
      }
    }
    this->Table[slot] = this->Table[next];
    slot = next;
  }
}

int LRRefinement::State::NewFunction()
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

void LRRefinement::State::Add(
  const int* local, double gamma, const double* row, unsigned char pending)
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

void LRRefinement::State::AddParts(const int* local, double gamma, const double* row, int d,
  int knot, int times, unsigned char pending)
{
  const int n = this->Order[At(d)];
  const int offset = d == 0 ? 0 : this->Order[0];
  const int* old = local + offset;
  const double z = this->Value(d, knot);
  const auto t = [&](int i) { return this->Value(d, old[i]); };
  if (times == 0 || z <= t(0) || z >= t(n - 1))
  {
    this->Add(local, gamma, row, pending);
    return;
  }
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
  int part[2 * MaxDegree + 4];
  std::copy_n(local, this->Stride, part);
  std::copy_n(merged, n, part + offset);
  this->AddParts(part, lower * gamma, row, d, knot, times - 1, pending);
  std::copy_n(merged + 1, n, part + offset);
  this->AddParts(part, upper * gamma, row, d, knot, times - 1, pending);
}

void LRRefinement::State::Split(const Traverse& traverse, int d, unsigned char pending)
{
  const int f = traverse.Function;
  int local[2 * MaxDegree + 4];
  std::copy_n(this->Knots(f, 0), this->Stride, local);
  double row[64];
  std::vector<double> longRow;
  double* kept = row;
  if (this->Columns > 64)
  {
    longRow.resize(At(this->Columns));
    kept = longRow.data();
  }
  std::copy_n(this->Rows.data() + std::ptrdiff_t{ f } * this->Columns, this->Columns, kept);
  const double gamma = this->Scaling[At(f)];
  this->Unlink(f);
  this->Pending[At(f)] = 0;
  this->Free.push_back(f);
  --this->Count;
  this->AddParts(local, gamma, kept, d, traverse.Line, traverse.Times, pending);
}

LRRefinement::State::Traverse LRRefinement::State::Traversing(int f, int d) const
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
    if (has < line.Most)
    {
      const int missing = this->Multiplicity(d, this->Lines[At(d)][At(line.Line)], low, high) - has;
      if (missing > 0)
      {
        return { f, line.Line, missing };
      }
    }
  }
  return { f, -1, 0 };
}

void LRRefinement::State::RestoreMinimalSupport()
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
      const Traverse found = this->Traversing(f, d);
      if (found.Line >= 0)
      {
        // the parts are narrower: more lines of the other direction may traverse them
        this->Split(found, d, static_cast<unsigned char>(pending | (2 >> d)));
        break;
      }
      this->Pending[At(f)] &= static_cast<unsigned char>(~(1 << d));
    }
  }
  this->Queue.clear();
}
}
