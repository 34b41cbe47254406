// SPDX-License-Identifier: BSD-3-Clause
#include "LRParts.h"
#include "LRState.h"

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}
}

Result<SplineSpacePtr<2>> LRRefinement::Finish(PointMatrix* rows, int threads) const
{
  const State& s = *this->S;
  LRBasis basis;
  basis.Degree = { s.Order[0] - 2, s.Order[1] - 2 };
  for (std::size_t d = 0; d < 2; ++d)
  {
    for (const State::LineSummary& line : s.Sorted[d])
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
