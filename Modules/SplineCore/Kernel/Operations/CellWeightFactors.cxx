// SPDX-License-Identifier: BSD-3-Clause
#include "CellWeightFactors.h"

#include "Bernstein.h"
#include "Parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
/// Weight functions of two elements that should agree: factor(B) = factor(A) * Ratio.
struct Link
{
  int A = -1; ///< -1: no link
  int B = -1;
  double Ratio = 1.0;
};

template <int Dim>
const double* WeightBlock(const BezierForm<Dim>& form, int e)
{
  const auto& degree = form.Space->Elements[static_cast<std::size_t>(e)].Degree;
  return form.Block(e) + form.NumComponents * NumTensorFunctions<Dim>(degree);
}

template <int Dim>
double WeightAt(const BezierForm<Dim>& form, int e, const RealArray<Dim>& local)
{
  return BernsteinEvaluate<Dim>(
    form.Space->Elements[static_cast<std::size_t>(e)].Degree, WeightBlock(form, e), local.data());
}

bool ShareAny(const std::vector<int>& a, const std::vector<int>& b)
{
  auto i = a.begin();
  auto j = b.begin();
  while (i != a.end() && j != b.end())
  {
    if (*i == *j)
    {
      return true;
    }
    *i < *j ? ++i : ++j;
  }
  return false;
}

/// One link at most across the upper face of an element in a direction. Upper faces are enough: all
/// elements are connected through them with the one at the upper corner of the domain.
template <int Dim>
Link FaceLink(const BezierForm<Dim>& form, int e, std::size_t direction)
{
  const SplineSpace<Dim>& space = *form.Space;
  const ParametricBox<Dim>& box = space.Elements[static_cast<std::size_t>(e)].Box;
  if (box.Upper[direction] >= space.Domain().Upper[direction])
  {
    return {};
  }
  RealArray<Dim> u;
  RealArray<Dim> here;
  RealArray<Dim> there;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    u[d] = 0.5 * (box.Lower[d] + box.Upper[d]);
    here[d] = 0.5;
  }
  const double size = std::max(std::abs(box.Lower[direction]), std::abs(box.Upper[direction]));
  u[direction] = box.Upper[direction] + 4.0 * std::numeric_limits<double>::epsilon() * size;
  here[direction] = 1.0;
  const int neighbour = space.Locate(u.data(), there.data());
  // across a knot of full multiplicity the weights are independent of each other
  if (neighbour < 0 || neighbour == e ||
    !ShareAny(space.AliveFunctions(e), space.AliveFunctions(neighbour)))
  {
    return {};
  }
  there[direction] = 0.0;
  return { e, neighbour, WeightAt<Dim>(form, neighbour, there) / WeightAt<Dim>(form, e, here) };
}

template <int Dim>
std::vector<Link> FaceLinks(const BezierForm<Dim>& form, int threads)
{
  const auto elements = static_cast<std::size_t>(form.Space->NumElements());
  std::vector<Link> links(elements * Dim);
  ParallelFor(elements, 64, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t e = begin; e < end; ++e)
      {
        for (std::size_t d = 0; d < Dim; ++d)
        {
          links[e * Dim + d] = FaceLink(form, static_cast<int>(e), d);
        }
      }
    });
  return links;
}

/// Links between the first element on which a function's own coefficient appears and the others.
template <int Dim>
std::vector<Link> FunctionLinks(const BezierForm<Dim>& form, const DualFunctionals<Dim>& duals)
{
  struct Seen
  {
    int Element = -1;
    double Weight = 0.0;
  };
  const SplineSpace<Dim>& space = *form.Space;
  std::vector<Seen> first(static_cast<std::size_t>(space.NumFunctions));
  std::vector<Link> links;
  std::vector<double> row;
  for (int e = 0; e < space.NumElements(); ++e)
  {
    const int size = NumTensorFunctions<Dim>(space.Elements[static_cast<std::size_t>(e)].Degree);
    const Eigen::Map<const Eigen::VectorXd> weights(WeightBlock(form, e), size);
    row.resize(static_cast<std::size_t>(size));
    for (int i = 0; i < size; ++i)
    {
      const int function = OwnFunction(space, space.LocalFunctions(e)[i]);
      if (function < 0 || !std::isfinite(duals.Amplification(e, i)))
      {
        continue;
      }
      duals.Functional(e, i, row.data());
      const double weight = weights.dot(Eigen::Map<const Eigen::VectorXd>(row.data(), size));
      Seen& seen = first[static_cast<std::size_t>(function)];
      if (seen.Element < 0)
      {
        seen = { e, weight };
      }
      else if (seen.Element != e && weight > 0.0 && seen.Weight > 0.0)
      {
        links.push_back({ seen.Element, e, weight / seen.Weight });
      }
    }
  }
  return links;
}
}

template <int Dim>
std::vector<double> CellWeightFactors(
  const BezierForm<Dim>& form, const DualFunctionals<Dim>& duals, int threads)
{
  const std::vector<Link> links =
    form.Space->HasDomain() ? FaceLinks(form, threads) : FunctionLinks(form, duals);
  const auto elements = static_cast<std::size_t>(form.Space->NumElements());
  std::vector<std::vector<std::pair<std::size_t, double>>> neighbours(elements);
  for (const Link& link : links)
  {
    if (link.A >= 0)
    {
      const auto a = static_cast<std::size_t>(link.A);
      const auto b = static_cast<std::size_t>(link.B);
      neighbours[a].emplace_back(b, link.Ratio);
      neighbours[b].emplace_back(a, 1.0 / link.Ratio);
    }
  }
  std::vector<double> factors(elements, 0.0); // 0: not reached
  std::vector<std::size_t> queue;
  for (std::size_t start = 0; start < elements; ++start)
  {
    if (factors[start] > 0.0)
    {
      continue;
    }
    factors[start] = 1.0;
    queue.assign(1, start);
    for (std::size_t k = 0; k < queue.size(); ++k)
    {
      for (const auto& [next, ratio] : neighbours[queue[k]])
      {
        if (factors[next] == 0.0)
        {
          factors[next] = factors[queue[k]] * ratio;
          queue.push_back(next);
        }
      }
    }
  }
  return factors;
}

template std::vector<double> CellWeightFactors(
  const BezierForm<1>&, const DualFunctionals<1>&, int);
template std::vector<double> CellWeightFactors(
  const BezierForm<2>&, const DualFunctionals<2>&, int);
template std::vector<double> CellWeightFactors(
  const BezierForm<3>&, const DualFunctionals<3>&, int);
}
