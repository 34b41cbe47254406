// SPDX-License-Identifier: BSD-3-Clause
#include "UnstructuredData.h"

#include <algorithm>

namespace knotwork
{
namespace
{
/// Knots outward from a side of a cell, in distances from it.
template <int Dim>
void WalkOut(const UnstructuredData<Dim>& data, int cell, int side, double* knots)
{
  double x = 0.0;
  for (int count = 0; count < data.Degree;)
  {
    const int m = data.Multiplicity(cell, side);
    const int end = m == data.Degree ? data.Degree : std::min(data.Degree, count + m);
    std::fill(knots + count, knots + end, x);
    count = end;
    if (count < data.Degree)
    {
      const int next = data.Topology.Neighbour(cell, side);
      side = data.Topology.Crossing(cell, side).Image[static_cast<std::size_t>(side)];
      cell = next;
      x += data.Length(cell, side / 2);
    }
  }
}
}

template <int Dim>
std::vector<int> FindWindows(const UnstructuredData<Dim>& data, KnotWindows& windows)
{
  const int cells = data.Topology.NumCells();
  std::vector<int> numbers(static_cast<std::size_t>(cells) * Dim);
  double window[2 * MaxDegree + 1];
  for (int c = 0; c < cells; ++c)
  {
    for (int d = 0; d < Dim; ++d)
    {
      window[0] = data.Length(c, d);
      WalkOut(data, c, 2 * d, window + 1);
      WalkOut(data, c, 2 * d + 1, window + 1 + data.Degree);
      numbers[static_cast<std::size_t>(c * Dim + d)] = windows.Add(window);
    }
  }
  windows.Finish();
  return numbers;
}

template std::vector<int> FindWindows<2>(const UnstructuredData<2>&, KnotWindows&);
template std::vector<int> FindWindows<3>(const UnstructuredData<3>&, KnotWindows&);
}
