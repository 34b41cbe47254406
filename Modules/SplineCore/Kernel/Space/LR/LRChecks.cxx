// SPDX-License-Identifier: BSD-3-Clause
#include "LRParts.h"
#include "Parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
constexpr std::size_t ChunkSize = 256;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// The function's knots are lines across its support as often as it says, and all such lines are
/// among its knots.
Status CheckMinimalSupport(const LRBasis& basis, int f)
{
  const auto fail = [&](const std::string& what)
  { return Status(ErrorCode::InvalidTopology, "function " + std::to_string(f) + " " + what); };
  for (int d = 0; d < 2; ++d)
  {
    const int last = basis.Degree[At(d)] + 1;
    const int* knots = basis.Local(f, d);
    if (knots[0] < 0 || knots[last] >= static_cast<int>(basis.Knots[At(d)].size()) ||
      knots[0] >= knots[last] || !std::is_sorted(knots, knots + last + 1))
    {
      return fail("has knots out of order or out of range");
    }
  }
  for (int d = 0; d < 2; ++d)
  {
    const int last = basis.Degree[At(d)] + 1;
    const int* knots = basis.Local(f, d);
    const int low = basis.Local(f, 1 - d)[0];
    const int high = basis.Local(f, 1 - d)[basis.Degree[At(1 - d)] + 1];
    for (int k = knots[0]; k <= knots[last]; ++k)
    {
      const auto has = static_cast<int>(std::count(knots, knots + last + 1, k));
      const LRLine& line = basis.Lines[At(d)][At(k)];
      if (has == 0 && line.size() == 1 && line[0].Multiplicity == 0)
      {
        continue;
      }
      const int there = LRMultiplicity(line, low, high);
      const bool isEnd = k == knots[0] || k == knots[last];
      if (there < has)
      {
        return fail("has a knot where no mesh line crosses its support");
      }
      if (!isEnd && there > has)
      {
        return fail("has not minimal support: a mesh line traverses it that is not its knot");
      }
    }
  }
  return {};
}

Status CheckFunction(const LRBasis& basis, int f)
{
  if (!(basis.Scaling[At(f)] > 0.0) || !std::isfinite(basis.Scaling[At(f)]))
  {
    return { ErrorCode::InvalidParameter,
      "the scaling factor of function " + std::to_string(f) + " is not positive" };
  }
  if (Status status = CheckMinimalSupport(basis, f); !status)
  {
    return status;
  }
  if (f == 0)
  {
    return {};
  }
  const int n0 = basis.Degree[0] + 2;
  const int n1 = basis.Degree[1] + 2;
  const auto key = [&](int i, int d) { return basis.Local(i, d); };
  const bool same = std::equal(key(f, 1), key(f, 1) + n1, key(f - 1, 1));
  const bool ascends = same
    ? std::lexicographical_compare(key(f - 1, 0), key(f - 1, 0) + n0, key(f, 0), key(f, 0) + n0)
    : std::lexicographical_compare(key(f - 1, 1), key(f - 1, 1) + n1, key(f, 1), key(f, 1) + n1);
  if (!ascends)
  {
    return { ErrorCode::InvalidTopology,
      "function " + std::to_string(f) + " is out of order or there twice" };
  }
  return {};
}
}

Status CheckLRLines(const LRBasis& basis)
{
  for (int d = 0; d < 2; ++d)
  {
    const int p = basis.Degree[At(d)];
    if (p < 1 || p > MaxDegree)
    {
      return { ErrorCode::InvalidDegree, "degree " + std::to_string(p) };
    }
    const std::vector<double>& knots = basis.Knots[At(d)];
    const std::string where = "direction " + std::to_string(d) + ": ";
    if (knots.size() < 2 || knots.size() > At(std::numeric_limits<int>::max()))
    {
      return { ErrorCode::InvalidKnots, where + "it needs at least two distinct knots" };
    }
    for (std::size_t k = 0; k < knots.size(); ++k)
    {
      if (!std::isfinite(knots[k]) || (k > 0 && !(knots[k] > knots[k - 1])))
      {
        return { ErrorCode::InvalidKnots,
          where + "knot " + std::to_string(k) + " is not finite or not above the one before" };
      }
    }
    if (basis.Lines[At(d)].size() != knots.size())
    {
      return { ErrorCode::SizeMismatch, where + "there must be one line a knot" };
    }
    const auto end = static_cast<int>(basis.Knots[At(1 - d)].size()) - 1;
    for (std::size_t k = 0; k < knots.size(); ++k)
    {
      const LRLine& line = basis.Lines[At(d)][k];
      const std::string what = where + "line " + std::to_string(k);
      if (line.empty() || line.front().Knot != 0)
      {
        return { ErrorCode::InvalidTopology, what + " does not start at knot 0" };
      }
      for (std::size_t i = 0; i < line.size(); ++i)
      {
        if (line[i].Knot >= end || line[i].Multiplicity < 0 || line[i].Multiplicity > p + 1 ||
          (i > 0 &&
            (line[i].Knot <= line[i - 1].Knot || line[i].Multiplicity == line[i - 1].Multiplicity)))
        {
          return { ErrorCode::InvalidTopology,
            what + ", piece " + std::to_string(i) + " is out of order or out of range" };
        }
      }
      if ((k == 0 || k + 1 == knots.size()) && line != LRLine{ { 0, p + 1 } })
      {
        return { ErrorCode::InvalidTopology,
          what + " is an end of the domain and must have multiplicity " + std::to_string(p + 1) +
            " all along" };
      }
    }
  }
  return {};
}

Status CheckLRFunctions(const LRBasis& basis, int threads)
{
  if (basis.LocalKnots.size() != basis.Scaling.size() * At(basis.Stride()) || basis.Scaling.empty())
  {
    return { ErrorCode::SizeMismatch, "local knots and scaling factors do not fit together" };
  }
  const std::size_t n = basis.Scaling.size();
  std::vector<Status> first((n + ChunkSize - 1) / ChunkSize); // of every chunk
  ParallelFor(n, ChunkSize, threads,
    [&](std::size_t begin, std::size_t end)
    {
      Status& status = first[begin / ChunkSize];
      for (std::size_t f = begin; f < end && status; ++f)
      {
        status = CheckFunction(basis, static_cast<int>(f));
      }
    });
  const auto bad =
    std::find_if(first.begin(), first.end(), [](const Status& status) { return !status; });
  return bad == first.end() ? Status() : *bad;
}
}
