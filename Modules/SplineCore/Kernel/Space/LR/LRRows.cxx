// SPDX-License-Identifier: BSD-3-Clause
#include "LRLineRows.h"
#include "LRParts.h"
#include "Parallel.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>

namespace knotwork
{
namespace
{
constexpr double UnityTolerance = 1e-9;
constexpr std::size_t ElementChunk = 32;
constexpr std::size_t RowChunk = 128;
constexpr std::size_t WordBits = 64;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

using LineRows = LRLineRows<double>;

void MakeRow(const LRBasis& basis, int direction, const int* knots, int low, int high, double* row)
{
  const std::vector<double>& t = basis.Knots[At(direction)];
  LRBlossomRow(
    basis.Degree[At(direction)], knots, low, high,
    [&t](int u, int lower, int upper, double a, double b)
    {
      return ((t[At(upper)] - t[At(u)]) * a + (t[At(u)] - t[At(lower)]) * b) /
        (t[At(upper)] - t[At(lower)]);
    },
    row);
}

/// The rows of T: Bernstein coefficients of all functions on all elements.
class RowBuilder
{
public:
  RowBuilder(SplineSpace<2>& space, const LRData& data, int threads)
    : Space(space), Data(data), Threads(threads), N0(data.Basis.Degree[0] + 1),
      N1(data.Basis.Degree[1] + 1)
  {
  }

  Status Build()
  {
    // the directions have nothing to do with each other
    ParallelFor(2, 1, this->Threads,
      [this](std::size_t d, std::size_t) { this->FindLineRows(static_cast<int>(d)); });
    this->FillLineRows(0);
    this->FillLineRows(1);
    this->Allocate();
    const std::size_t numElements = this->Data.ElementKnots.size();
    std::vector<int> bad((numElements + ElementChunk - 1) / ElementChunk, -1);
    ParallelFor(numElements, ElementChunk, this->Threads,
      [&](std::size_t begin, std::size_t end)
      {
        Workspace work;
        int& first = bad[begin / ElementChunk];
        for (std::size_t e = begin; e < end; ++e)
        {
          const double off = this->WriteElement(e, work);
          first = first < 0 && !(off <= UnityTolerance) ? static_cast<int>(e) : first;
        }
      });
    const auto first = std::find_if(bad.begin(), bad.end(), [](int e) { return e >= 0; });
    if (first != bad.end())
    {
      return { ErrorCode::InvalidTopology,
        "the functions' sum on element " + std::to_string(*first) + " is not 1" };
    }
    return {};
  }

private:
  /// Of the alive functions on an element.
  struct Workspace
  {
    std::vector<double> U; // rows of direction 0, one after the other
    std::vector<double> V; // of direction 1, times the scaling factors
    // bit k: the coefficient of function k is positive; as many words a coefficient as it takes
    std::vector<std::uint64_t> MaskU;
    std::vector<std::uint64_t> MaskV;
  };

  const LRBasis& Basis() const { return this->Data.Basis; }

  /// Numbers the rows of a direction that all the functions on all elements need.
  void FindLineRows(int d)
  {
    LineRows& lines = this->Lines[At(d)].emplace(this->Basis(), d);
    std::vector<int>& numbers = this->Numbers[At(d)];
    numbers.resize(this->Data.AliveFunctions.size());
    for (std::size_t e = 0; e < this->Data.ElementKnots.size(); ++e)
    {
      const std::array<int, 4>& box = this->Data.ElementKnots[e];
      for (std::size_t k = this->Data.AliveStart[e]; k < this->Data.AliveStart[e + 1]; ++k)
      {
        numbers[k] = lines.Number(this->Data.AliveFunctions[k], box[At(d)], box[At(d) + 2]);
      }
    }
    lines.Allocate();
  }

  void FillLineRows(int d)
  {
    LineRows& lines = *this->Lines[At(d)];
    const int n = this->Basis().Degree[At(d)] + 1;
    std::vector<unsigned char>& positive = this->Positive[At(d)];
    positive.resize(At(lines.Size()));
    ParallelFor(positive.size(), RowChunk, this->Threads,
      [&](std::size_t begin, std::size_t end)
      {
        lines.Fill(static_cast<int>(begin), static_cast<int>(end),
          [&](const int* knots, int low, int high, double* row)
          { MakeRow(this->Basis(), d, knots, low, high, row); });
        for (std::size_t k = begin; k < end; ++k)
        {
          const double* row = lines.Row(static_cast<int>(k));
          positive[k] = static_cast<unsigned char>(
            std::count_if(row, row + n, [](double x) { return x > 0.0; }));
        }
      });
  }

  /// Where the entries of every element begin.
  void Allocate()
  {
    const std::size_t n = this->Data.ElementKnots.size();
    this->First.assign(n + 1, 0);
    ParallelFor(n, ElementChunk, this->Threads,
      [this](std::size_t begin, std::size_t end)
      {
        for (std::size_t e = begin; e < end; ++e)
        {
          std::size_t sum = 0;
          for (std::size_t k = this->Data.AliveStart[e]; k < this->Data.AliveStart[e + 1]; ++k)
          {
            sum += std::size_t{ this->Positive[0][At(this->Numbers[0][k])] } *
              this->Positive[1][At(this->Numbers[1][k])];
          }
          this->First[e + 1] = sum;
        }
      });
    std::partial_sum(this->First.begin(), this->First.end(), this->First.begin());
    this->Space.RowFunction.resize(this->First.back());
    this->Space.RowCoefficient.resize(this->First.back());
    this->Space.RowStart.resize(At(this->Space.NumLocalFunctions) + 1);
    this->Space.RowStart.back() = this->First.back();
  }

  /// Copies the rows of a direction, times a factor each, and notes what is positive.
  template <typename Factor>
  void Gather(std::size_t e, std::size_t d, int n, Factor&& factor, std::vector<double>& rows,
    std::vector<std::uint64_t>& masks) const
  {
    const std::size_t first = this->Data.AliveStart[e];
    const std::size_t alive = this->Data.AliveStart[e + 1] - first;
    const std::size_t words = (alive + WordBits - 1) / WordBits;
    rows.resize(alive * At(n));
    masks.assign(words * At(n), 0);
    double* to = rows.data();
    for (std::size_t k = 0; k < alive; ++k)
    {
      const double* row = this->Lines[d]->Row(this->Numbers[d][first + k]);
      const double by = factor(this->Data.AliveFunctions[first + k]);
      std::uint64_t* mask = masks.data() + k / WordBits;
      for (int i = 0; i < n; ++i, mask += words)
      {
        *to++ = by * row[i];
        *mask |= std::uint64_t{ row[i] > 0.0 } << (k % WordBits);
      }
    }
  }

  /// @return largest distance of a row's sum from 1.
  double WriteElement(std::size_t e, Workspace& work)
  {
    this->Gather(
      e, 0, this->N0, [](int) { return 1.0; }, work.U, work.MaskU);
    this->Gather(
      e, 1, this->N1, [this](int f) { return this->Basis().Scaling[At(f)]; }, work.V, work.MaskV);
    const std::size_t words = work.MaskU.size() / At(this->N0);
    const int* alive = this->Data.AliveFunctions.data() + this->Data.AliveStart[e];
    int* function = this->Space.RowFunction.data() + this->First[e];
    double* coefficient = this->Space.RowCoefficient.data() + this->First[e];
    std::size_t* rowStart = this->Space.RowStart.data() + this->Space.Elements[e].FirstLocal;
    double off = 0.0;
    for (int j = 0; j < this->N1; ++j)
    {
      for (int i = 0; i < this->N0; ++i)
      {
        *rowStart++ = static_cast<std::size_t>(function - this->Space.RowFunction.data());
        double sum = 0.0;
        for (std::size_t w = 0; w < words; ++w)
        {
          for (std::uint64_t mask = work.MaskU[At(i) * words + w] & work.MaskV[At(j) * words + w];
               mask != 0; mask &= mask - 1)
          {
            const std::size_t k = w * WordBits + At(__builtin_ctzll(mask));
            const double value =
              work.U[k * At(this->N0) + At(i)] * work.V[k * At(this->N1) + At(j)];
            *function++ = alive[k];
            *coefficient++ = value;
            sum += value;
          }
        }
        off = std::max(off, std::fabs(sum - 1.0));
      }
    }
    return off;
  }

  SplineSpace<2>& Space;
  const LRData& Data;
  int Threads;
  int N0;
  int N1;
  std::array<std::optional<LineRows>, 2> Lines;
  std::array<std::vector<int>, 2> Numbers; // of the rows of the functions on the elements
  std::array<std::vector<unsigned char>, 2> Positive; // coefficients of every row
  std::vector<std::size_t> First;                     // entry of T of every element
};
}

Status BuildLRRows(SplineSpace<2>& space, const LRData& data, int threads)
{
  return RowBuilder(space, data, threads).Build();
}
}
