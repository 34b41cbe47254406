// SPDX-License-Identifier: BSD-3-Clause
#include "JacobianCertificate.h"

#include "CellProof.h"
#include "FilterCells.h"
#include <knotwork/SplineCore/Parallel.h>
#include <knotwork/SplineCore/WideVectors.h>

#include <atomic>
#include <limits>
#include <numeric>
#include <string>

namespace knotwork
{
namespace
{
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
  const auto filter = HasWideVectors() ? FilterCells<4> : FilterCells<2>;
  std::atomic<bool> good{ true };
  for (std::size_t first = 0; first < n; first += Slice)
  {
    const std::size_t last = std::min(n, first + Slice);
    ParallelFor(last - first, chunk, params.Threads,
      [&](std::size_t begin, std::size_t end)
      {
        if (!filter(cells, params, first + begin, first + end, result.Cells.data()))
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
