// SPDX-License-Identifier: BSD-3-Clause
#include "BezierSpace.h"

namespace knotwork
{
template <int Dim>
Result<SplineSpacePtr<Dim>> MakeBezierSpace(
  const std::vector<IntArray<Dim>>& degrees, const std::vector<int>& pointIds, int numFunctions)
{
  auto space = std::make_shared<SplineSpace<Dim>>();
  space->Kind = SpaceKind::Bezier;
  space->NumFunctions = numFunctions;
  space->NumLocalFunctions = numFunctions;
  space->Elements.resize(degrees.size());
  std::size_t first = 0;
  for (std::size_t e = 0; e < degrees.size(); ++e)
  {
    const std::string cell = "cell " + std::to_string(e);
    auto& element = space->Elements[e];
    element.Degree = degrees[e];
    element.FirstLocal = first;
    element.Factor.fill(-1);
    element.Box.Upper.fill(1.0);
    for (int p : degrees[e])
    {
      if (p < 1 || p > MaxDegree)
      {
        return { ErrorCode::InvalidDegree, cell + " has degree " + std::to_string(p) };
      }
    }
    const std::size_t end = first + static_cast<std::size_t>(NumTensorFunctions<Dim>(degrees[e]));
    if (end > pointIds.size())
    {
      return { ErrorCode::SizeMismatch, cell + " needs more point ids than there are" };
    }
    for (; first < end; ++first)
    {
      if (pointIds[first] < 0 || pointIds[first] >= numFunctions)
      {
        return { ErrorCode::InvalidTopology,
          cell + " refers to point " + std::to_string(pointIds[first]) + " of " +
            std::to_string(numFunctions) };
      }
    }
  }
  if (first != pointIds.size())
  {
    return { ErrorCode::SizeMismatch,
      std::to_string(pointIds.size()) + " point ids, the cells need " + std::to_string(first) };
  }
  space->LocalFunctionIds = pointIds;
  return SplineSpacePtr<Dim>(std::move(space));
}

template Result<SplineSpacePtr<1>> MakeBezierSpace<1>(
  const std::vector<IntArray<1>>&, const std::vector<int>&, int);
template Result<SplineSpacePtr<2>> MakeBezierSpace<2>(
  const std::vector<IntArray<2>>&, const std::vector<int>&, int);
template Result<SplineSpacePtr<3>> MakeBezierSpace<3>(
  const std::vector<IntArray<3>>&, const std::vector<int>&, int);
}
