// SPDX-License-Identifier: BSD-3-Clause
// Bezier elements without a common parameter domain as a family.
#include "BezierRefinement.h"
#include "BezierSpace.h"
#include "ControlNet.h"
#include "FamilyWithoutDomain.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace knotwork
{
namespace
{
template <int Dim>
std::vector<NetEdge> BezierEdges(const SplineSpace<Dim>& space)
{
  std::vector<NetEdge> edges;
  std::set<std::array<int, 2>> seen;
  for (int e = 0; e < space.NumElements(); ++e)
  {
    const IntArray<Dim>& p = space.Elements[static_cast<std::size_t>(e)].Degree;
    const int* ids = space.LocalFunctions(e);
    for (int i = 0; i < NumTensorFunctions<Dim>(p); ++i)
    {
      int rest = i;
      int stride = 1;
      for (std::size_t d = 0; d < Dim; ++d)
      {
        if (rest % (p[d] + 1) < p[d])
        {
          const int a = ids[i];
          const int b = ids[i + stride];
          if (seen.insert({ std::min(a, b), std::max(a, b) }).second)
          {
            edges.push_back({ a, b, static_cast<int>(d) });
          }
        }
        rest /= p[d] + 1;
        stride *= p[d] + 1;
      }
    }
  }
  return edges;
}
/// Control points that no element uses get no point.
template <int Dim>
ElementPoints NumberBezier(const SplineSpace<Dim>& space)
{
  ElementPoints numbering;
  std::vector<std::int64_t> point(static_cast<std::size_t>(space.NumFunctions), -1);
  for (int function : space.LocalFunctionIds)
  {
    point[static_cast<std::size_t>(function)] = 0;
  }
  for (std::int64_t& id : point)
  {
    id = id < 0 ? -1 : numbering.Count++;
  }
  for (int function : space.LocalFunctionIds)
  {
    numbering.Ids.push_back(point[static_cast<std::size_t>(function)]);
  }
  return numbering;
}

template <int Dim>
class BezierElements final : public FamilyWithoutDomain<Dim>
{
public:
  const char* Name() const override { return "Bezier"; }
  int StoredNumber() const override { return 0; }
  const std::vector<DefinitionTableLayout>& Tables() const override
  {
    static const std::vector<DefinitionTableLayout> none;
    return none;
  }
  std::size_t NumRows(const SpaceDefinition&, int, std::size_t) const override { return 0; }
  SpaceDefinition Describe(const SplineSpace<Dim>&) const override
  {
    SpaceDefinition definition;
    definition.Dimension = Dim;
    return definition;
  }
  Result<SplineSpacePtr<Dim>> Build(const SpaceDefinition&, int) const override
  {
    return { ErrorCode::InvalidTopology, "a Bezier space is made from its cells" };
  }

  std::vector<NetEdge> ControlNetEdges(const SplineSpace<Dim>& space) const override
  {
    return BezierEdges(space);
  }
  ElementPoints NumberPoints(const SplineSpace<Dim>& space) const override
  {
    return NumberBezier<Dim>(space);
  }
  double FunctionsAfterRefinement(
    const SplineSpace<Dim>& space, int elevation, int refinements) const override
  {
    const double pieces = std::ldexp(1.0, refinements); // of an element in a direction
    double functions = 0.0;
    for (const auto& element : space.Elements)
    {
      double inside = 1.0;
      for (const int degree : element.Degree)
      {
        inside *= (degree + elevation) * pieces;
      }
      functions += inside;
    }
    return functions;
  }

  Result<RefinedSpline<Dim>> RefineAll(const Spline<Dim>& spline) const override
  {
    return SplitBezierElements(spline);
  }
  Result<RefinedSpline<Dim>> RefineMarked(
    const Spline<Dim>&, const std::vector<int>&, const RefinementParams&) const override
  {
    return { ErrorCode::DimensionMismatch,
      "Bezier elements without a common parameter domain can only be refined all together" };
  }
  Result<Spline<Dim>> ElevateDegrees(const Spline<Dim>& spline, int times) const override
  {
    return ElevateBezierElements(spline, times);
  }
  Result<Spline<Dim>> TensorForm(const Spline<Dim>&, int, int) const override
  {
    return { ErrorCode::DimensionMismatch,
      "Bezier elements without knots are no tensor product; write .vtu" };
  }
};
}

template <int Dim>
const SpaceFamily<Dim>& BezierFamily()
{
  static const BezierElements<Dim> family;
  return family;
}

template const SpaceFamily<1>& BezierFamily<1>();
template const SpaceFamily<2>& BezierFamily<2>();
template const SpaceFamily<3>& BezierFamily<3>();
}
