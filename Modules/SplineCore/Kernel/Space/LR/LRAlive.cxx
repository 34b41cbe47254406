// SPDX-License-Identifier: BSD-3-Clause
#include "LRParts.h"
#include "Parallel.h"

#include <algorithm>
#include <atomic>
#include <numeric>

namespace knotwork
{
namespace
{
constexpr std::size_t ChunkSize = 64;   // functions
constexpr std::size_t MaxOverload = 16; // functions on an element on average, over (p + 1)(q + 1)

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// The elements that begin at a height, by their left sides: a table of about as many places as
/// elements says where to start to look.
class ElementRows
{
public:
  explicit ElementRows(const LRData& data)
    : Left(data.ElementKnots.size()), Rows(data.Basis.Knots[1].size())
  {
    const std::size_t n = this->Left.size();
    std::size_t e = 0;
    for (std::size_t y = 0; y < this->Rows.size(); ++y)
    {
      Row& row = this->Rows[y];
      row.Begin = e;
      while (e < n && At(data.ElementKnots[e][1]) == y)
      {
        this->Left[e] = data.ElementKnots[e][0];
        ++e;
      }
      row.End = e;
      const std::size_t width = data.Basis.Knots[0].size();
      while ((width >> row.Shift) > 2 * (row.End - row.Begin) + 1)
      {
        ++row.Shift;
      }
      row.Table = this->Table.size();
      std::size_t next = row.Begin;
      for (std::size_t place = 0; place <= width >> row.Shift; ++place)
      {
        while (next < row.End && At(this->Left[next]) < place << row.Shift)
        {
          ++next;
        }
        this->Table.push_back(next);
      }
    }
  }

  /// Calls use(element) for those that begin at height y and whose left side is in [from, to).
  template <typename Use>
  void ForEach(int y, int from, int to, Use&& use) const
  {
    const Row& row = this->Rows[At(y)];
    std::size_t e = this->Table[row.Table + (At(from) >> row.Shift)];
    while (e < row.End && this->Left[e] < from)
    {
      ++e;
    }
    for (; e < row.End && this->Left[e] < to; ++e)
    {
      use(e);
    }
  }

private:
  struct Row
  {
    std::size_t Begin = 0;
    std::size_t End = 0;
    std::size_t Table = 0;
    int Shift = 0;
  };
  std::vector<int> Left;
  std::vector<Row> Rows;
  std::vector<std::size_t> Table;
};

/// Elements in the supports of a chunk of functions, one after the other.
struct Supports
{
  std::vector<int> Elements;
  std::vector<std::size_t> End; // of every function
};
}

Status FindAliveFunctions(LRData& data, int threads)
{
  const LRBasis& basis = data.Basis;
  const std::size_t numElements = data.ElementKnots.size();
  const std::size_t limit = MaxOverload * At(NumTensorFunctions<2>(basis.Degree)) * numElements;
  const ElementRows rows(data);
  const std::size_t n = basis.Scaling.size();
  std::vector<Supports> chunks((n + ChunkSize - 1) / ChunkSize);
  std::atomic<std::size_t> total{ 0 };
  ParallelFor(n, ChunkSize, threads,
    [&](std::size_t begin, std::size_t end)
    {
      Supports& chunk = chunks[begin / ChunkSize];
      for (std::size_t f = begin; f < end && total <= limit; ++f)
      {
        const int* u = basis.Local(static_cast<int>(f), 0);
        const int* v = basis.Local(static_cast<int>(f), 1);
        const std::size_t before = chunk.Elements.size();
        for (int y = v[0]; y < v[basis.Degree[1] + 1]; ++y)
        {
          rows.ForEach(y, u[0], u[basis.Degree[0] + 1],
            [&](std::size_t e) { chunk.Elements.push_back(static_cast<int>(e)); });
        }
        chunk.End.push_back(chunk.Elements.size());
        total += chunk.Elements.size() - before;
      }
    });
  if (total > limit)
  {
    return { ErrorCode::TooLarge, "more than " + std::to_string(limit) + " functions on elements" };
  }
  data.AliveStart.assign(numElements + 1, 0);
  for (const Supports& chunk : chunks)
  {
    for (const int e : chunk.Elements)
    {
      ++data.AliveStart[At(e) + 1];
    }
  }
  std::partial_sum(data.AliveStart.begin(), data.AliveStart.end(), data.AliveStart.begin());
  data.AliveFunctions.resize(total);
  std::vector<std::size_t> next(data.AliveStart.begin(), data.AliveStart.end() - 1);
  for (std::size_t c = 0; c < chunks.size(); ++c)
  {
    std::size_t k = 0;
    for (std::size_t i = 0; i < chunks[c].End.size(); ++i)
    {
      for (; k < chunks[c].End[i]; ++k)
      {
        data.AliveFunctions[next[At(chunks[c].Elements[k])]++] =
          static_cast<int>(c * ChunkSize + i);
      }
    }
  }
  return {};
}
}
