// SPDX-License-Identifier: BSD-3-Clause
// A family as small as one can be: splines that are constant on every element.
#include "ConstantSpace.h"
#include "DyadicTree.h"
#include "Refinement.h"
#include "TensorSpace.h"

#include <cmath>
#include <numeric>

namespace knotwork
{
template <int Dim>
Result<SplineSpacePtr<Dim>> MakeConstantSpace(const std::array<KnotVector, Dim>& knots)
{
  const auto tensor = MakeTensorSpace<Dim>(knots);
  if (!tensor)
  {
    return tensor.Status;
  }
  auto space = std::make_shared<SplineSpace<Dim>>(*tensor.Value);
  space->Kind = SpaceKind::Constant;
  space->NumFunctions = space->NumElements();
  space->NumLocalFunctions = space->NumFunctions;
  for (int e = 0; e < space->NumElements(); ++e)
  {
    auto& element = space->Elements[static_cast<std::size_t>(e)];
    element.Factor.fill(-1); // its Bernstein coefficients are all the same
    std::fill_n(space->LocalFunctionIds.begin() + static_cast<std::ptrdiff_t>(element.FirstLocal),
      NumTensorFunctions<Dim>(element.Degree), e);
  }
  return SplineSpacePtr<Dim>(std::move(space));
}

namespace
{
template <int Dim>
class ConstantOnElements final : public SpaceFamily<Dim>
{
public:
  const char* Name() const override { return "constant"; }
  int StoredNumber() const override { return 1000; }
  const std::vector<DefinitionTableLayout>& Tables() const override
  {
    static const std::vector<DefinitionTableLayout> none;
    return none;
  }
  std::size_t NumRows(const SpaceDefinition&, int, std::size_t) const override { return 0; }
  SpaceDefinition Describe(const SplineSpace<Dim>& space) const override
  {
    return DefinitionOfKnots<Dim>(space);
  }
  Result<SplineSpacePtr<Dim>> Build(const SpaceDefinition& definition, int) const override
  {
    auto knots = KnotsOfDefinition<Dim>(definition);
    return knots ? MakeConstantSpace<Dim>(knots.Value) : knots.Status;
  }

  void Locate(const SplineSpace<Dim>& space, const double* u, std::ptrdiff_t stride, std::size_t n,
    int* elements, double* local) const override
  {
    LocateInTree<Dim>(space, u, stride, n, elements, local);
  }
  std::vector<FunctionInfo<Dim>> DescribeFunctions(const SplineSpace<Dim>& space) const override
  {
    std::vector<FunctionInfo<Dim>> infos(space.Elements.size());
    for (std::size_t e = 0; e < infos.size(); ++e)
    {
      infos[e].Index[0] = static_cast<std::int64_t>(e);
      for (std::size_t d = 0; d < Dim; ++d)
      {
        const ParametricBox<Dim>& box = space.Elements[e].Box;
        infos[e].Greville[d] = 0.5 * (box.Lower[d] + box.Upper[d]);
      }
    }
    return infos;
  }
  std::vector<NetEdge> ControlNetEdges(const SplineSpace<Dim>&) const override { return {}; }
  std::vector<ChartCell<Dim>> Charts(const SplineSpace<Dim>& space, int& numCharts) const override
  {
    return ChartsOfTree<Dim>(space, numCharts);
  }
  ElementPoints NumberPoints(const SplineSpace<Dim>& space) const override
  {
    ElementPoints points; // elements share no value
    points.Count = static_cast<std::int64_t>(space.LocalFunctionIds.size());
    points.Ids.resize(space.LocalFunctionIds.size());
    std::iota(points.Ids.begin(), points.Ids.end(), std::int64_t{ 0 });
    return points;
  }
  double FunctionsAfterRefinement(
    const SplineSpace<Dim>& space, int, int refinements) const override
  {
    return space.NumElements() * std::pow(std::ldexp(1.0, refinements), Dim);
  }

  Result<RefinedSpline<Dim>> RefineAll(const Spline<Dim>& spline) const override
  {
    std::array<KnotVector, Dim> knots = spline.Space->Knots;
    for (KnotVector& direction : knots)
    {
      direction = direction.Dyadic();
    }
    const auto space = MakeConstantSpace<Dim>(knots);
    if (!space)
    {
      return space.Status;
    }
    RefinedSpline<Dim> refined;
    refined.Parents = ParentElements(*spline.Space, *space.Value, 1);
    refined.Value.Space = space.Value;
    refined.Value.ControlPoints.resize(space.Value->NumFunctions, spline.ControlPoints.cols());
    for (Eigen::Index e = 0; e < refined.Value.ControlPoints.rows(); ++e)
    {
      refined.Value.ControlPoints.row(e) =
        spline.ControlPoints.row(refined.Parents[static_cast<std::size_t>(e)]);
    }
    return refined;
  }
  Result<RefinedSpline<Dim>> RefineMarked(
    const Spline<Dim>&, const std::vector<int>&, const RefinementParams&) const override
  {
    return { ErrorCode::DimensionMismatch, "constant splines are refined everywhere" };
  }
  Result<Spline<Dim>> ElevateDegrees(const Spline<Dim>&, int) const override
  {
    return { ErrorCode::DimensionMismatch, "constant splines have no degree to raise" };
  }
  Result<Spline<Dim>> TensorForm(const Spline<Dim>&, int, int) const override
  {
    return { ErrorCode::DimensionMismatch, "constant splines jump" };
  }
};
}

template <int Dim>
const SpaceFamily<Dim>& ConstantFamily()
{
  static const ConstantOnElements<Dim> family;
  return family;
}

#define KNOTWORK_INSTANTIATE(Dim)                                                                  \
  template Result<SplineSpacePtr<Dim>> MakeConstantSpace<Dim>(const std::array<KnotVector, Dim>&); \
  template const SpaceFamily<Dim>& ConstantFamily<Dim>();
KNOTWORK_INSTANTIATE(1)
KNOTWORK_INSTANTIATE(2)
KNOTWORK_INSTANTIATE(3)
#undef KNOTWORK_INSTANTIATE
}
