// SPDX-License-Identifier: BSD-3-Clause
#include "BoundarySeparation.h"

#include "InterfaceGaps.h"
#include "SideOverlap.h"
#include <knotwork/SplineCore/BoxTree.h>
#include <knotwork/SplineCore/Parallel.h>

#include <algorithm>
#include <iterator>

namespace knotwork
{
namespace
{
/// What a pair gets at first when there are many.
constexpr std::int64_t LeastBoxes = 256;
/// Sides whose neighbours are looked up at a time, and pairs worked on before an overlap among them
/// ends the proof: the first so many, then twice as many each time, up to the last.
constexpr std::size_t SidesAtOnce = 256;
constexpr std::size_t FirstPairs = 32;
constexpr std::size_t MostPairs = 8192;
/// Of those worked on at a time, so many that cannot be separated are searched for an overlap, and
/// so many of which nothing is known but that boxes were not enough.
constexpr std::size_t MostSuspects = 16;
constexpr std::size_t MostUnknown = 2;

/// A pair of sides, and what is known of it.
struct PairState
{
  std::array<int, 2> Sides{};
  /// Sides of two patches within reach of each other.
  bool MayBeGap = false;
  bool Meet = false; ///< their boxes
  bool IsGap = false;
  InterfaceGap Gap;
  SeparationResult Separation;
  std::optional<InjectivityWitness> Overlap;
};

class PairSearch
{
public:
  PairSearch(const MapBoundary& boundary, const InjectivityParams& params, std::int64_t maxBoxes,
    BoundarySeparation& found)
    : Boundary(boundary), Params(params), MaxBoxes(maxBoxes), Found(found)
  {
  }

  bool SeparateAll(const ProgressCallback& report)
  {
    const std::size_t n = static_cast<std::size_t>(this->Boundary.SideCells.NumCells());
    if (n == 0)
    {
      return true;
    }
    const BoxTree tree(this->Boundary.Lower, this->Boundary.Upper);
    std::vector<PairState> open;
    std::size_t batch = FirstPairs;
    for (std::size_t first = 0; first < n; first += SidesAtOnce)
    {
      const std::vector<PairState> pairs =
        this->FindPairs(tree, first, std::min(n, first + SidesAtOnce));
      for (std::size_t done = 0; done < pairs.size();)
      {
        const std::size_t end = std::min(pairs.size(), done + batch);
        const std::int64_t share = (this->MaxBoxes - this->Found.Boxes) /
          static_cast<std::int64_t>(std::max<std::size_t>(end - done, 1));
        std::vector<PairState> now(pairs.begin() + static_cast<std::ptrdiff_t>(done),
          pairs.begin() + static_cast<std::ptrdiff_t>(end));
        this->SeparatePairs(
          now, std::min(std::clamp(share, LeastBoxes, FirstBoxes), this->Params.MaxBoxes), false);
        if (this->FindFirstOverlap(now))
        {
          return true;
        }
        for (PairState& pair : now)
        {
          if (pair.IsGap)
          {
            this->Found.Gaps.push_back(pair.Gap);
          }
          else if (pair.Separation.State != SeparationState::Separate)
          {
            open.push_back(std::move(pair));
          }
        }
        done = end;
        batch = std::min(2 * batch, MostPairs);
        if (this->Found.Boxes >= this->MaxBoxes && !open.empty())
        {
          this->SeparateOpen(open);
          return report(0.8);
        }
      }
      if (!report(0.2 + 0.5 * static_cast<double>(first) / static_cast<double>(n)))
      {
        return false;
      }
    }
    this->SeparateOpen(open);
    return report(0.8);
  }

private:
  InjectivityWitness::Place PlaceOf(const PairState& pair, std::size_t side) const
  {
    return PlaceOnSide(
      this->Boundary.Cells, this->Boundary.Side(pair.Sides[side]), pair.Separation.At[side]);
  }

  /// Pairs of the sides from first to end - 1 with those that follow, whose boxes meet or come
  /// within reach of a gap, without those of star-shaped components.
  std::vector<PairState> FindPairs(const BoxTree& tree, std::size_t first, std::size_t end) const
  {
    const PointMatrix& lower = this->Boundary.Lower;
    const PointMatrix& upper = this->Boundary.Upper;
    const double reach = this->Params.GapTolerance * this->Boundary.ModelSize;
    std::vector<std::vector<PairState>> near(end - first);
    ParallelFor(end - first, 64, this->Params.Threads,
      [&](std::size_t from, std::size_t to)
      {
        for (std::size_t i = from; i < to; ++i)
        {
          const int a = static_cast<int>(first + i);
          double low[3];
          double high[3];
          for (int d = 0; d < this->Boundary.Cells.NumComponents; ++d)
          {
            low[d] = lower(a, d) - reach;
            high[d] = upper(a, d) + reach;
          }
          const auto add = [&](int b, bool meet, bool close)
          {
            const int component = this->Boundary.Side(a).Component;
            const bool isSimple = component == this->Boundary.Side(b).Component &&
              this->Boundary.StarShaped[static_cast<std::size_t>(component)];
            PairState pair;
            pair.Sides = { a, b };
            pair.MayBeGap = close && this->Boundary.Side(a).Patch != this->Boundary.Side(b).Patch;
            pair.Meet = meet && !isSimple;
            if (pair.MayBeGap || pair.Meet)
            {
              near[i].push_back(std::move(pair));
            }
          };
          add(a, true, false);
          tree.ForNear(low, high,
            [&](int b)
            {
              if (b > a)
              {
                bool meet = true;
                bool close = true;
                for (int d = 0; d < this->Boundary.Cells.NumComponents; ++d)
                {
                  close = close && lower(b, d) <= high[d] && low[d] <= upper(b, d);
                  meet = meet && lower(b, d) <= upper(a, d) && lower(a, d) <= upper(b, d);
                }
                add(b, meet, close);
              }
            });
          std::sort(near[i].begin(), near[i].end(),
            [](const PairState& x, const PairState& y) { return x.Sides < y.Sides; });
        }
      });
    std::vector<PairState> pairs;
    for (auto& some : near)
    {
      std::move(some.begin(), some.end(), std::back_inserter(pairs));
    }
    return pairs;
  }

  /// @param last  no other attempt follows: overlaps are looked for where the limit was reached
  /// too.
  void SeparatePairs(std::vector<PairState>& pairs, std::int64_t limit, bool last)
  {
    SeparationInput input;
    input.Sides = &this->Boundary.Gluing.Boundary;
    input.Lattices = &this->Boundary.SideLattices;
    input.NumComponents = this->Boundary.Cells.NumComponents;
    input.Rational = this->Boundary.Cells.Rational;
    input.CollapseTolerance = this->Params.CollapseTolerance;
    input.Distance = this->Boundary.Shift.Distance;
    const InterfaceGaps gaps(this->Boundary.Gluing.Boundary, this->Boundary.SideCells,
      this->Boundary.SideLattices, this->Params.GapTolerance * this->Boundary.ModelSize,
      this->Boundary.Shift.Middle);
    ParallelFor(pairs.size(), 4, this->Params.Threads,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t k = begin; k < end; ++k)
        {
          PairState& pair = pairs[k];
          pair.IsGap = pair.MayBeGap && gaps.IsGap(pair.Sides[0], pair.Sides[1], pair.Gap);
          pair.MayBeGap = false;
          if (pair.IsGap || !pair.Meet)
          {
            continue;
          }
          pair.Separation = SeparateSides(input, pair.Sides[0], pair.Sides[1], limit);
        }
      });
    std::vector<PairState*> suspects;
    const auto add = [&](SeparationState state, std::size_t most)
    {
      for (auto pair = pairs.begin(); pair != pairs.end() && most > 0; ++pair)
      {
        if (pair->Separation.State == state)
        {
          suspects.push_back(&*pair);
          --most;
        }
      }
    };
    add(SeparationState::Stuck, MostSuspects);
    add(SeparationState::Boxes, last ? MostUnknown : 0);
    ParallelFor(suspects.size(), 1, this->Params.Threads,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t k = begin; k < end; ++k)
        {
          suspects[k]->Overlap =
            FindSideOverlap(this->Boundary, suspects[k]->Sides, suspects[k]->Separation.At);
        }
      });
    for (const PairState& pair : pairs)
    {
      this->Found.Boxes += pair.Separation.Boxes;
    }
  }

  bool FindFirstOverlap(const std::vector<PairState>& pairs)
  {
    for (const PairState& pair : pairs)
    {
      if (pair.Overlap)
      {
        this->Found.Overlap = pair.Overlap;
        return true;
      }
    }
    return false;
  }

  /// What the first attempt left open shares the boxes that are left.
  void SeparateOpen(std::vector<PairState>& open)
  {
    std::vector<PairState> limited;
    for (const PairState& pair : open)
    {
      if (pair.Separation.State == SeparationState::Boxes)
      {
        limited.push_back(pair);
      }
    }
    const std::int64_t left = this->MaxBoxes - this->Found.Boxes;
    if (left > static_cast<std::int64_t>(limited.size()) && !limited.empty())
    {
      this->SeparatePairs(limited, left / static_cast<std::int64_t>(limited.size()), true);
      if (this->FindFirstOverlap(limited))
      {
        return;
      }
      auto next = limited.begin();
      for (PairState& pair : open)
      {
        if (pair.Separation.State == SeparationState::Boxes)
        {
          pair = *next++;
        }
      }
    }
    for (const PairState& pair : open)
    {
      const auto& separation = pair.Separation;
      if (separation.State != SeparationState::Separate &&
        (this->Found.Obstacle == SeparationState::Separate ||
          (this->Found.Obstacle == SeparationState::Boxes &&
            separation.State == SeparationState::Stuck)))
      {
        this->Found.Obstacle = separation.State;
        this->Found.ObstaclePlaces = { this->PlaceOf(pair, 0), this->PlaceOf(pair, 1) };
      }
    }
  }

  const MapBoundary& Boundary;
  const InjectivityParams& Params;
  std::int64_t MaxBoxes;
  BoundarySeparation& Found;
};
}

bool SeparateBoundary(const MapBoundary& boundary, const InjectivityParams& params,
  std::int64_t maxBoxes, const ProgressCallback& report, BoundarySeparation& found)
{
  return PairSearch(boundary, params, maxBoxes, found).SeparateAll(report);
}
}
