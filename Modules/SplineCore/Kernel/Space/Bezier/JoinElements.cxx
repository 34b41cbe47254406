// SPDX-License-Identifier: BSD-3-Clause
#include "JoinElements.h"

#include "TensorSpace.h"

#include <algorithm>
#include <string>

namespace knotwork
{
namespace
{
template <int Dim>
using Breaks = std::array<std::vector<double>, Dim>;

template <int Dim>
Breaks<Dim> FindBreaks(const std::vector<ParametricBox<Dim>>& boxes)
{
  Breaks<Dim> breaks;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    for (const ParametricBox<Dim>& box : boxes)
    {
      breaks[d].push_back(box.Lower[d]);
      breaks[d].push_back(box.Upper[d]);
    }
    std::sort(breaks[d].begin(), breaks[d].end());
    breaks[d].erase(std::unique(breaks[d].begin(), breaks[d].end()), breaks[d].end());
  }
  return breaks;
}

/// Ends with multiplicity degree + 1, the others with degree.
Result<KnotVector> ContinuousKnots(int degree, const std::vector<double>& breaks)
{
  std::vector<double> knots(1, breaks.front());
  for (double t : breaks)
  {
    knots.insert(knots.end(), static_cast<std::size_t>(degree), t);
  }
  knots.push_back(breaks.back());
  return KnotVector::Create(degree, std::move(knots));
}

/// Place of a box on the chess board; false when it is not one of its squares.
template <int Dim>
bool Find(const Breaks<Dim>& breaks, const ParametricBox<Dim>& box, IntArray<Dim>& place)
{
  for (std::size_t d = 0; d < Dim; ++d)
  {
    const auto lower = std::lower_bound(breaks[d].begin(), breaks[d].end(), box.Lower[d]);
    if (lower + 1 == breaks[d].end() || *(lower + 1) != box.Upper[d])
    {
      return false;
    }
    place[d] = static_cast<int>(lower - breaks[d].begin());
  }
  return true;
}
}

template <int Dim>
Result<Spline<Dim>> JoinElements(
  const Spline<Dim>& elements, const std::vector<ParametricBox<Dim>>& boxes)
{
  const SplineSpace<Dim>& space = *elements.Space;
  if (boxes.empty() || static_cast<int>(boxes.size()) != space.NumElements())
  {
    return { ErrorCode::SizeMismatch,
      std::to_string(boxes.size()) + " boxes for " + std::to_string(space.NumElements()) +
        " elements" };
  }
  const IntArray<Dim> degree = space.Elements.front().Degree;
  const Breaks<Dim> breaks = FindBreaks<Dim>(boxes);
  std::array<KnotVector, Dim> knots;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    auto made = ContinuousKnots(degree[d], breaks[d]);
    if (!made)
    {
      return made.Status;
    }
    knots[d] = std::move(made.Value);
  }
  auto tensor = MakeTensorSpace<Dim>(knots);
  if (!tensor)
  {
    return tensor.Status;
  }
  Result<Spline<Dim>> result;
  Spline<Dim>& joined = result.Value;
  joined.Space = tensor.Value;
  const PointMatrix rows = elements.HomogeneousPoints();
  PointMatrix points(joined.Space->NumFunctions, rows.cols());
  std::vector<char> known(static_cast<std::size_t>(points.rows()), 0);
  std::vector<char> taken(static_cast<std::size_t>(joined.Space->NumElements()), 0);
  const double slack = 1e-9 * rows.cwiseAbs().maxCoeff();
  for (int e = 0; e < space.NumElements(); ++e)
  {
    const std::string where = "element " + std::to_string(e);
    const auto& element = space.Elements[static_cast<std::size_t>(e)];
    IntArray<Dim> place{};
    if (element.Degree != degree)
    {
      return { ErrorCode::InvalidDegree, where + " has another degree than the first one" };
    }
    const bool found = Find<Dim>(breaks, boxes[static_cast<std::size_t>(e)], place);
    int square = 0;
    for (std::size_t d = Dim; d-- > 0;)
    {
      square = square * knots[d].NumElements() + place[d];
    }
    if (!found || taken[static_cast<std::size_t>(square)]++ > 0)
    {
      return { ErrorCode::InvalidTopology, where + " is no square of a board, or lies on another" };
    }
    const int* functions = joined.Space->LocalFunctions(square);
    for (int i = 0; i < NumTensorFunctions<Dim>(degree); ++i)
    {
      const int to = functions[i];
      const auto row = rows.row(space.LocalFunctions(e)[i]);
      if (known[static_cast<std::size_t>(to)] != 0 &&
        !((points.row(to) - row).cwiseAbs().maxCoeff() <= slack))
      {
        return { ErrorCode::NotInSpace, where + " does not join its neighbours" };
      }
      points.row(to) = row;
      known[static_cast<std::size_t>(to)] = 1;
    }
  }
  if (std::find(taken.begin(), taken.end(), char{ 0 }) != taken.end())
  {
    return { ErrorCode::InvalidTopology, "the elements leave gaps in their parameter box" };
  }
  joined.SetHomogeneousPoints(points, elements.IsRational());
  return result;
}

template Result<Spline<1>> JoinElements<1>(const Spline<1>&, const std::vector<ParametricBox<1>>&);
template Result<Spline<2>> JoinElements<2>(const Spline<2>&, const std::vector<ParametricBox<2>>&);
template Result<Spline<3>> JoinElements<3>(const Spline<3>&, const std::vector<ParametricBox<3>>&);
}
