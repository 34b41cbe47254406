// SPDX-License-Identifier: BSD-3-Clause
#include "ElementFunctions.h"

#include <knotwork/SplineCore/LRVolume.h>
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
template <int Dim>
void CollectFunctions(const SplineSpace<Dim>& space, int e, int perElement, std::vector<int>& alive)
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

template <int Dim>
void WriteRows(
  const SplineSpace<Dim>& space, int e, const ElementFunctions& functions, double* rows)
{
  const std::size_t first = functions.First(e);
  const int alive = functions.Alive(e);
  const int* ids = functions.Functions.data() + first;
  const int n = functions.PerElement;
  const IntArray<Dim>& degree = space.Elements[At(e)].Degree;
  const std::array<const double*, Dim> factors = space.Factors(e);
  const bool isPlain =
    std::all_of(factors.begin(), factors.end(), [](const double* f) { return f == nullptr; });
  std::fill_n(rows, std::ptrdiff_t{ alive } * n, 0.0);
  const int* locals = space.LocalFunctions(e);
  for (int j = 0; j < n; ++j)
  {
    const auto add = [&](int k, double coefficient)
    {
      double* row = rows + std::ptrdiff_t{ k } * n;
      if (isPlain)
      {
        row[j] += coefficient;
        return;
      }
      for (int b = 0; b < n; ++b)
      {
        double value = coefficient;
        int restOfJ = j;
        int restOfB = b;
        for (std::size_t d = 0; d < Dim; ++d)
        {
          const int size = degree[d] + 1;
          const int own = restOfJ % size;
          const int other = restOfB % size;
          value *= factors[d] ? factors[d][own * size + other] : (own == other ? 1.0 : 0.0);
          restOfJ /= size;
          restOfB /= size;
        }
        row[b] += value;
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

template <int Dim>
ElementFunctions FindElementFunctions(const SplineSpace<Dim>& space, int threads)
{
  ElementFunctions functions;
  const int numElements = space.NumElements();
  functions.NumFunctions = space.NumFunctions;
  functions.PerElement = NumTensorFunctions<Dim>(space.Elements[0].Degree);
  if (space.LocallyRefined)
  {
    const auto take = [&functions](const auto& data)
    {
      functions.Start = data.AliveStart;
      functions.Functions = data.AliveFunctions;
    };
    if constexpr (Dim == 3)
    {
      take(LRVolumeOf(space));
    }
    else
    {
      take(*space.LocallyRefined);
    }
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

template ElementFunctions FindElementFunctions<2>(const SplineSpace<2>&, int);
template ElementFunctions FindElementFunctions<3>(const SplineSpace<3>&, int);
}
