// SPDX-License-Identifier: BSD-3-Clause
#include "Refinement.h"

#include "Parallel.h"
#include "SpaceFamily.h"

#include <numeric>

namespace knotwork
{
namespace
{
constexpr std::size_t ElementChunk = 256;
}

template <int Dim>
std::vector<int> ParentElements(
  const SplineSpace<Dim>& coarse, const SplineSpace<Dim>& fine, int threads)
{
  std::vector<int> parents(fine.Elements.size());
  ParallelFor(parents.size(), ElementChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t e = begin; e < end; ++e)
      {
        const ParametricBox<Dim>& box = fine.Elements[e].Box;
        RealArray<Dim> center;
        for (std::size_t d = 0; d < Dim; ++d)
        {
          center[d] = 0.5 * (box.Lower[d] + box.Upper[d]);
        }
        double local[Dim];
        parents[e] = coarse.Locate(center.data(), local);
      }
    });
  return parents;
}

template <int Dim>
Result<RefinedSpline<Dim>> RefineAllElements(const Spline<Dim>& spline)
{
  if (const Status status = spline.Check(); !status)
  {
    return status;
  }
  return FamilyOf(*spline.Space).RefineAll(spline);
}

template <int Dim>
Result<RefinedSpline<Dim>> RefineMarkedElements(
  const Spline<Dim>& spline, const std::vector<int>& marked, const RefinementParams& params)
{
  if (const Status status = spline.Check(); !status)
  {
    return status;
  }
  if (!marked.empty() || !spline.Space->HasDomain())
  {
    return FamilyOf(*spline.Space).RefineMarked(spline, marked, params);
  }
  RefinedSpline<Dim> same{ spline, std::vector<int>(spline.Space->Elements.size()) };
  std::iota(same.Parents.begin(), same.Parents.end(), 0);
  return same;
}

template <int Dim>
Result<Spline<Dim>> ElevateAllDegrees(const Spline<Dim>& spline, int times)
{
  if (const Status status = spline.Check(); !status)
  {
    return status;
  }
  if (times < 0)
  {
    return { ErrorCode::InvalidParameter, "degrees can only be raised" };
  }
  if (times == 0)
  {
    return spline;
  }
  for (const auto& element : spline.Space->Elements)
  {
    for (const int p : element.Degree)
    {
      if (p + times > MaxDegree)
      {
        return { ErrorCode::InvalidDegree,
          "degree " + std::to_string(p) + " cannot be raised by " + std::to_string(times) };
      }
    }
  }
  return FamilyOf(*spline.Space).ElevateDegrees(spline, times);
}

template struct RefinedSpline<1>;
template struct RefinedSpline<2>;
template struct RefinedSpline<3>;
template std::vector<int> ParentElements<1>(const SplineSpace<1>&, const SplineSpace<1>&, int);
template std::vector<int> ParentElements<2>(const SplineSpace<2>&, const SplineSpace<2>&, int);
template std::vector<int> ParentElements<3>(const SplineSpace<3>&, const SplineSpace<3>&, int);
template Result<RefinedSpline<1>> RefineAllElements<1>(const Spline<1>&);
template Result<RefinedSpline<2>> RefineAllElements<2>(const Spline<2>&);
template Result<RefinedSpline<3>> RefineAllElements<3>(const Spline<3>&);
template Result<RefinedSpline<1>> RefineMarkedElements<1>(
  const Spline<1>&, const std::vector<int>&, const RefinementParams&);
template Result<RefinedSpline<2>> RefineMarkedElements<2>(
  const Spline<2>&, const std::vector<int>&, const RefinementParams&);
template Result<RefinedSpline<3>> RefineMarkedElements<3>(
  const Spline<3>&, const std::vector<int>&, const RefinementParams&);
template Result<Spline<1>> ElevateAllDegrees<1>(const Spline<1>&, int);
template Result<Spline<2>> ElevateAllDegrees<2>(const Spline<2>&, int);
template Result<Spline<3>> ElevateAllDegrees<3>(const Spline<3>&, int);
}
