// SPDX-License-Identifier: BSD-3-Clause
#include "LocatedSamples.h"

#include <algorithm>
#include <numeric>
#include <string>

namespace knotwork
{
template <int Dim>
Result<LocatedSamples<Dim>> LocateSamples(
  const SplineSpace<Dim>& space, const PointMatrix& parameters)
{
  LocatedSamples<Dim> result;
  const std::size_t n = static_cast<std::size_t>(parameters.rows());
  result.Local.resize(parameters.rows(), Dim);
  std::vector<int> elements(n);
  space.Locate(parameters.data(), Dim, n, elements.data(), result.Local.data());
  const auto outside = std::find_if(elements.begin(), elements.end(), [](int e) { return e < 0; });
  if (outside != elements.end())
  {
    return { ErrorCode::OutsideDomain, "sample " + std::to_string(outside - elements.begin()) };
  }
  result.Order.resize(n);
  std::iota(result.Order.begin(), result.Order.end(), Eigen::Index(0));
  const auto elementOf = [&](std::size_t k)
  { return elements[static_cast<std::size_t>(result.Order[k])]; };
  std::stable_sort(result.Order.begin(), result.Order.end(),
    [&](Eigen::Index a, Eigen::Index b)
    { return elements[static_cast<std::size_t>(a)] < elements[static_cast<std::size_t>(b)]; });
  for (std::size_t first = 0; first < n;)
  {
    std::size_t last = first + 1;
    while (last < n && elementOf(last) == elementOf(first))
    {
      ++last;
    }
    result.Groups.push_back({ elementOf(first), first, last });
    first = last;
  }
  return result;
}

template Result<LocatedSamples<2>> LocateSamples(const SplineSpace<2>&, const PointMatrix&);
template Result<LocatedSamples<3>> LocateSamples(const SplineSpace<3>&, const PointMatrix&);
}
