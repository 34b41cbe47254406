// SPDX-License-Identifier: BSD-3-Clause
#include "JacobianCertificate.h"

#include "CellProof.h"
#include "CoefficientFilter.h"
#include <knotwork/SplineCore/Parallel.h>

#include <atomic>
#include <limits>
#include <numeric>
#include <string>

namespace knotwork
{
namespace
{
/// Filters cells [begin, end); the cells that it does not decide keep Undecided.
class FilterRun
{
public:
  FilterRun(const BernsteinCells& cells, const JacobianParams& params)
    : Cells(cells), Params(params)
  {
  }

  /// @return false when a value is not finite or a weight not positive.
  bool Run(std::size_t begin, std::size_t end, CellCertificate* results)
  {
    bool good = true;
    for (std::size_t c = begin; c < end;)
    {
      std::size_t count = 1;
      while (count < PackSize && c + count < end && this->Cells.AreAlike(c + count, c))
      {
        ++count;
      }
      std::array<const double*, PackSize> blocks{};
      Pack given{};
      for (std::size_t l = 0; l < PackSize; ++l)
      {
        const std::size_t cell = c + std::min(l, count - 1);
        blocks[l] = this->Cells.Block(static_cast<int>(cell));
        if (!this->Cells.Errors.empty())
        {
          given[l] = this->Cells.Errors[cell];
        }
      }
      const CellShape shape = this->Cells.Shapes[c];
      const bool norm = this->Cells.NumComponents > NumParameters(shape);
      if (norm)
      {
        this->Filter.Norm(shape, this->Cells.Degrees[c], this->Cells.NumComponents,
          this->Cells.Rational, blocks, given, this->Bounds);
      }
      else
      {
        this->Filter.Determinant(
          shape, this->Cells.Degrees[c], this->Cells.Rational, blocks, given, this->Bounds);
      }
      const int power = this->Cells.Rational ? NumParameters(shape) + 1 : 0;
      for (std::size_t l = 0; l < count; ++l)
      {
        good = this->Decide(static_cast<int>(l), norm, power, given[l], results[c + l]) && good;
      }
      c += count;
    }
    return good;
  }

private:
  bool Decide(int l, bool norm, int power, double given, CellCertificate& r) const
  {
    const CoefficientBounds& b = this->Bounds;
    if (!(b.NotFinite[l] == 0.0) || !(b.SmallestWeight[l] > 0.0) || !(given >= 0.0) ||
      std::isinf(given))
    {
      return false;
    }
    if (!(b.Magnitude[l] >= 0x1p-200 && b.Magnitude[l] <= 0x1p200) ||
      !(b.SmallestWeight[l] > given) || (power > 0 && b.SmallestWeight[l] < 0x1p-200))
    {
      return true;
    }
    constexpr double Outward = 1.0 + 0x1p-48; // covers the few roundings from here on
    constexpr double Inward = 1.0 - 0x1p-48;
    const double e = b.Error[l];
    const bool reversed = !norm && b.Largest[l] < 0.0;
    double smallest = reversed ? -b.Largest[l] : b.Smallest[l];
    double largest = reversed ? -b.Smallest[l] : b.Largest[l];
    double corner = reversed ? -b.LargestCorner[l] : b.SmallestCorner[l];
    double largestCorner = reversed ? -b.SmallestCorner[l] : b.LargestCorner[l];
    if (!(smallest > e * Outward))
    {
      return true;
    }
    double lower = (smallest - e) * Inward;
    double upper = (largest + e) * Outward;
    double cornerError = e;
    if (power > 0)
    {
      double low = 1.0;
      double high = 1.0;
      for (int k = 0; k < power; ++k)
      {
        low *= b.SmallestWeight[l] - given;
        high *= b.LargestWeight[l] + given;
      }
      lower = lower / high * Inward;
      upper = upper / low * Outward;
      cornerError = e / low * Outward;
      if (given > 0.0)
      {
        cornerError += corner; // corner weights are uncertain too: a bound that is only safe
        cornerError = std::max(cornerError, upper);
      }
    }
    const double cornerUpper = std::min((corner + cornerError) * Outward, upper);
    const double cornerLower = std::max((largestCorner - cornerError) * Inward, lower);
    if (cornerUpper - lower > this->Params.RelativeGap * cornerUpper ||
      (this->Params.ComputeMax && upper - cornerLower > this->Params.RelativeGap * upper))
    {
      return true;
    }
    r.Verdict = reversed ? Verdict::Reversed : Verdict::Valid;
    r.OneSided = norm;
    r.MinLower = reversed ? -upper : lower;
    r.MinUpper = reversed ? -cornerLower : cornerUpper;
    r.MaxLower = reversed ? -cornerUpper : cornerLower;
    r.MaxUpper = reversed ? -lower : upper;
    return true;
  }

  const BernsteinCells& Cells;
  const JacobianParams& Params;
  CoefficientFilter Filter;
  CoefficientBounds Bounds;
};

Status CheckInput(const BernsteinCells& cells, const JacobianParams& params)
{
  if (!(params.RelativeGap >= 1e-10 && params.RelativeGap <= 1.0))
  {
    return { ErrorCode::InvalidParameter, "the relative gap must be in [1e-10, 1]" };
  }
  if (params.MaxBoxes < 1)
  {
    return { ErrorCode::InvalidParameter, "the number of boxes must be at least 1" };
  }
  if (!(params.CollapseTolerance >= 0.0 && params.CollapseTolerance <= 1e-6))
  {
    return { ErrorCode::InvalidParameter, "the collapse tolerance must be in [0, 1e-6]" };
  }
  if (params.Threads < 0)
  {
    return { ErrorCode::InvalidParameter, "the number of threads must not be negative" };
  }
  if (const Status status = cells.CheckStructure(); !status)
  {
    return status;
  }
  if (cells.NumCells() == 0)
  {
    return { ErrorCode::EmptyInput, "there are no cells" };
  }
  for (std::size_t c = 0; c < cells.Shapes.size(); ++c)
  {
    if (c > 0 && cells.Shapes[c] == cells.Shapes[c - 1])
    {
      continue;
    }
    if (cells.NumComponents < NumParameters(cells.Shapes[c]) || cells.NumComponents > 3)
    {
      return { ErrorCode::DimensionMismatch,
        "cell " + std::to_string(c) + ": " + std::to_string(cells.NumComponents) +
          " components for " + std::to_string(NumParameters(cells.Shapes[c])) + " parameters" };
    }
    if (NumParameters(cells.Shapes[c]) == 1 && cells.NumComponents == 1)
    {
      return { ErrorCode::DimensionMismatch, "curves need 2 or 3 components" };
    }
  }
  return {};
}
}

void Summarize(JacobianCertificate& result)
{
  const double infinity = std::numeric_limits<double>::infinity();
  result.MinLower = result.MinUpper = infinity;
  result.MaxLower = result.MaxUpper = -infinity;
  for (const CellCertificate& c : result.Cells)
  {
    result.NumValid += c.Verdict == Verdict::Valid;
    result.NumReversed += c.Verdict == Verdict::Reversed;
    result.NumInvalid += c.Verdict == Verdict::Invalid;
    result.NumUndecided += c.Verdict == Verdict::Undecided;
    result.NumDegenerate += c.Degenerate != 0;
    result.Boxes += c.Boxes;
    result.MinLower = std::min(result.MinLower, c.MinLower);
    result.MinUpper = std::min(result.MinUpper, c.MinUpper);
    result.MaxLower = std::max(result.MaxLower, c.MaxLower);
    result.MaxUpper = std::max(result.MaxUpper, c.MaxUpper);
  }
  if (result.NumInvalid > 0 || (result.NumValid > 0 && result.NumReversed > 0))
  {
    result.Verdict = Verdict::Invalid;
  }
  else if (result.NumUndecided > 0)
  {
    result.Verdict = Verdict::Undecided;
  }
  else
  {
    result.Verdict = result.NumReversed > 0 ? Verdict::Reversed : Verdict::Valid;
  }
}

Result<JacobianCertificate> ValidateJacobian(
  const BernsteinCells& cells, const JacobianParams& params, const ProgressCallback& progress)
{
  if (const Status status = CheckInput(cells, params); !status)
  {
    return status;
  }
  const std::size_t n = cells.Shapes.size();
  JacobianCertificate result;
  result.Cells.resize(n);

  // The progress callback belongs to this thread: between slices.
  constexpr std::size_t Slice = std::size_t(1) << 19;
  // Work for all threads from some hundred heavy cells on.
  constexpr std::size_t ChunkData = std::size_t(1) << 16;
  const std::size_t perCell = cells.Data.size() / std::max<std::size_t>(n, 1) + 1;
  const std::size_t chunk =
    std::clamp<std::size_t>(ChunkData / perCell & ~std::size_t(7), 64, 2048);
  std::atomic<bool> good{ true };
  for (std::size_t first = 0; first < n; first += Slice)
  {
    const std::size_t last = std::min(n, first + Slice);
    ParallelFor(last - first, chunk, params.Threads,
      [&](std::size_t begin, std::size_t end)
      {
        FilterRun run(cells, params);
        if (!run.Run(first + begin, first + end, result.Cells.data()))
        {
          good = false;
        }
      });
    if (!good)
    {
      return cells.Check();
    }
    if (progress && !progress(0.5 * static_cast<double>(last) / static_cast<double>(n)))
    {
      return Status{ ErrorCode::Aborted, "while filtering" };
    }
  }

  // Subdivision: equal shares of the boxes; what some leave over is shared again by those still
  // open.
  std::vector<int> open;
  for (std::size_t c = 0; c < n; ++c)
  {
    if (result.Cells[c].Verdict == Verdict::Undecided)
    {
      open.push_back(static_cast<int>(c));
    }
  }
  std::vector<JacobianWitness> witnesses(open.size());
  std::vector<std::size_t> pending(open.size());
  std::iota(pending.begin(), pending.end(), std::size_t(0));
  std::int64_t left = params.MaxBoxes;
  std::int64_t share = 0;
  while (!pending.empty())
  {
    const std::int64_t next = std::max<std::int64_t>(std::min<std::int64_t>(4096, params.MaxBoxes),
      left / static_cast<std::int64_t>(pending.size()));
    if (next < 2 * share)
    {
      break;
    }
    share = next;
    constexpr std::size_t Step = 256;
    for (std::size_t first = 0; first < pending.size(); first += Step)
    {
      const std::size_t last = std::min(pending.size(), first + Step);
      ParallelFor(last - first, 1, params.Threads,
        [&](std::size_t begin, std::size_t end)
        {
          LayoutCache cache;
          for (std::size_t k = begin; k < end; ++k)
          {
            const std::size_t at = pending[first + k];
            result.Cells[static_cast<std::size_t>(open[at])] =
              ProveCell(cells, open[at], params, share, cache, witnesses[at]);
          }
        });
      if (progress &&
        !progress(0.5 + 0.5 * static_cast<double>(last) / static_cast<double>(pending.size())))
      {
        return Status{ ErrorCode::Aborted, "while subdividing" };
      }
    }
    std::vector<std::size_t> again;
    for (std::size_t at : pending)
    {
      const CellCertificate& c = result.Cells[static_cast<std::size_t>(open[at])];
      left -= std::min(c.Boxes, left);
      if (c.Verdict == Verdict::Undecided && c.Limit == JacobianLimit::Boxes)
      {
        again.push_back(at);
      }
    }
    pending = std::move(again);
  }
  for (std::size_t k = 0; k < open.size(); ++k)
  {
    CellCertificate& c = result.Cells[static_cast<std::size_t>(open[k])];
    if (c.Verdict == Verdict::Invalid)
    {
      c.Witness = static_cast<std::int32_t>(result.Witnesses.size());
      result.Witnesses.push_back(witnesses[k]);
    }
  }
  Summarize(result);
  return result;
}

const char* ToString(JacobianLimit limit)
{
  switch (limit)
  {
    case JacobianLimit::None:
      return "";
    case JacobianLimit::Boxes:
      return "the limit of boxes was reached";
    case JacobianLimit::Depth:
      return "it is zero, or all but zero, at a place that no subdivision separates";
    case JacobianLimit::Precision:
      return "rounding of its conversion to Bernstein form hides the sign";
    case JacobianLimit::Rounding:
      return "degenerate within the rounding of its coordinates";
  }
  return "";
}

const char* ToString(Verdict verdict)
{
  switch (verdict)
  {
    case Verdict::Valid:
      return "valid";
    case Verdict::Invalid:
      return "invalid";
    case Verdict::Reversed:
      return "reversed";
    case Verdict::Undecided:
      break;
  }
  return "undecided";
}
}
