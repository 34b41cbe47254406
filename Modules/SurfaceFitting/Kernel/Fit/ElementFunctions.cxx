// SPDX-License-Identifier: BSD-3-Clause
#include "ElementFunctions.h"

#include <knotwork/SplineCore/LRSpace.h>
#include <knotwork/SplineCore/Parallel.h>

#include <algorithm>
#include <numeric>

namespace knotwork
{
namespace
{
constexpr std::size_t ElementChunk = 32;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Functions with a part on an element, ascending.
void CollectFunctions(const SplineSpace<2>& space, int e, int perElement, std::vector<int>& alive)
{
  alive.clear();
  const int* locals = space.LocalFunctions(e);
  for (int j = 0; j < perElement; ++j)
  {
    if (space.IsIdentityMap())
    {
      alive.push_back(locals[j]);
      continue;
    }
    for (std::size_t k = space.RowStart[At(locals[j])]; k < space.RowStart[At(locals[j]) + 1]; ++k)
    {
      alive.push_back(space.RowFunction[k]);
    }
  }
  std::sort(alive.begin(), alive.end());
  alive.erase(std::unique(alive.begin(), alive.end()), alive.end());
}

void WriteRows(const SplineSpace<2>& space, int e, const ElementFunctions& functions, double* rows)
{
  const std::size_t first = functions.First(e);
  const int alive = functions.Alive(e);
  const int* ids = functions.Functions.data() + first;
  const int n = functions.PerElement;
  const IntArray<2>& degree = space.Elements[At(e)].Degree;
  const int n0 = degree[0] + 1;
  const std::array<const double*, 2> factors = space.Factors(e);
  std::fill_n(rows, std::ptrdiff_t{ alive } * n, 0.0);
  const int* locals = space.LocalFunctions(e);
  for (int j = 0; j < n; ++j)
  {
    const auto add = [&](int k, double coefficient)
    {
      double* row = rows + std::ptrdiff_t{ k } * n;
      if (factors[0] == nullptr && factors[1] == nullptr)
      {
        row[j] += coefficient;
        return;
      }
      const int j0 = j % n0;
      const int j1 = j / n0;
      for (int b = 0; b < n; ++b)
      {
        const int b0 = b % n0;
        const int b1 = b / n0;
        const double f0 = factors[0] ? factors[0][j0 * n0 + b0] : (j0 == b0 ? 1.0 : 0.0);
        const double f1 =
          factors[1] ? factors[1][j1 * (degree[1] + 1) + b1] : (j1 == b1 ? 1.0 : 0.0);
        row[b] += coefficient * f0 * f1;
      }
    };
    const auto find = [&](int function, int from)
    { return static_cast<int>(std::lower_bound(ids + from, ids + alive, function) - ids); };
    if (space.IsIdentityMap())
    {
      add(find(locals[j], 0), 1.0);
      continue;
    }
    int k = 0;
    for (std::size_t i = space.RowStart[At(locals[j])]; i < space.RowStart[At(locals[j]) + 1]; ++i)
    {
      const int function = space.RowFunction[i];
      while (k < alive && ids[k] < function)
      {
        ++k;
      }
      add(k, space.RowCoefficient[i]);
    }
  }
}
}

void ElementFunctions::LocalCoefficients(
  int e, const PointMatrix& coefficients, double* local) const
{
  const std::size_t first = this->First(e);
  const int alive = this->Alive(e);
  const auto columns = coefficients.cols();
  std::fill_n(local, columns * this->PerElement, 0.0);
  for (int k = 0; k < alive; ++k)
  {
    const double* row = this->Row(first + At(k));
    for (Eigen::Index c = 0; c < columns; ++c)
    {
      const double value = coefficients(this->Functions[first + At(k)], c);
      double* out = local + c * this->PerElement;
      for (int b = 0; b < this->PerElement; ++b)
      {
        out[b] += row[b] * value;
      }
    }
  }
}

ElementFunctions FindElementFunctions(const SplineSpace<2>& space, int threads)
{
  ElementFunctions functions;
  const int numElements = space.NumElements();
  functions.NumFunctions = space.NumFunctions;
  functions.PerElement = NumTensorFunctions<2>(space.Elements[0].Degree);
  if (space.LocallyRefined)
  {
    functions.Start = space.LocallyRefined->AliveStart;
    functions.Functions = space.LocallyRefined->AliveFunctions;
  }
  else
  {
    std::vector<std::vector<int>> alive(At(numElements));
    ParallelFor(alive.size(), ElementChunk, threads,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t e = begin; e < end; ++e)
        {
          CollectFunctions(space, static_cast<int>(e), functions.PerElement, alive[e]);
        }
      });
    functions.Start.push_back(0);
    for (const std::vector<int>& ids : alive)
    {
      functions.Functions.insert(functions.Functions.end(), ids.begin(), ids.end());
      functions.Start.push_back(functions.Functions.size());
    }
  }
  functions.Rows.resize(functions.Functions.size() * At(functions.PerElement));
  functions.ElementOfEntry.resize(functions.Functions.size());
  ParallelFor(At(numElements), ElementChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t e = begin; e < end; ++e)
      {
        WriteRows(space, static_cast<int>(e), functions,
          functions.Rows.data() + functions.Start[e] * At(functions.PerElement));
        std::fill(
          functions.ElementOfEntry.begin() + static_cast<std::ptrdiff_t>(functions.Start[e]),
          functions.ElementOfEntry.begin() + static_cast<std::ptrdiff_t>(functions.Start[e + 1]),
          static_cast<int>(e));
      }
    });
  functions.UseStart.assign(At(space.NumFunctions) + 1, 0);
  for (const int f : functions.Functions)
  {
    ++functions.UseStart[At(f) + 1];
  }
  std::partial_sum(
    functions.UseStart.begin(), functions.UseStart.end(), functions.UseStart.begin());
  functions.Uses.resize(functions.Functions.size());
  std::vector<std::size_t> next(functions.UseStart.begin(), functions.UseStart.end() - 1);
  for (std::size_t k = 0; k < functions.Functions.size(); ++k)
  {
    functions.Uses[next[At(functions.Functions[k])]++] = k;
  }
  return functions;
}
}
