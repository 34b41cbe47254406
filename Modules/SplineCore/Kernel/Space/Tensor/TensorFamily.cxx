// SPDX-License-Identifier: BSD-3-Clause
// Tensor-product spaces as a family.
#include "DyadicTree.h"
#include "PointLine.h"
#include "Refinement.h"
#include "SpaceFamily.h"
#include "TensorSpace.h"

#include <cmath>

namespace knotwork
{
namespace
{
template <int Dim>
class TensorProduct final : public FamilyOfTrees<Dim>
{
public:
  const char* Name() const override { return "tensor-product"; }
  int StoredNumber() const override { return 1; }
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
    return knots ? MakeTensorSpace<Dim>(knots.Value) : knots.Status;
  }

  ElementPoints NumberPoints(const SplineSpace<Dim>& space) const override;
  double FunctionsAfterRefinement(
    const SplineSpace<Dim>& space, int elevation, int refinements) const override
  {
    const double pieces = std::ldexp(1.0, refinements); // of an element in a direction
    double functions = 1.0;
    for (const KnotVector& knots : space.Knots)
    {
      functions *= knots.NumFunctions() + (elevation + pieces - 1.0) * knots.NumElements();
    }
    return functions;
  }

  Result<RefinedSpline<Dim>> RefineAll(const Spline<Dim>& spline) const override
  {
    RefinedSpline<Dim> result;
    result.Value = spline;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      const std::vector<double>& breaks = spline.Space->Knots[d].Breaks();
      std::vector<double> middles;
      for (std::size_t b = 0; b + 1 < breaks.size(); ++b)
      {
        middles.push_back(0.5 * (breaks[b] + breaks[b + 1]));
      }
      auto refined = InsertKnots<Dim>(result.Value, static_cast<int>(d), middles);
      if (!refined)
      {
        return refined.Status;
      }
      result.Value = std::move(refined.Value);
    }
    result.Parents = ParentElements(*spline.Space, *result.Value.Space, 1);
    return result;
  }
  Result<RefinedSpline<Dim>> RefineMarked(const Spline<Dim>& spline, const std::vector<int>& marked,
    const RefinementParams& params) const override
  {
    return RefineByLevels<Dim>(spline, marked, params);
  }
  Result<Spline<Dim>> ElevateDegrees(const Spline<Dim>& spline, int times) const override
  {
    Spline<Dim> result = spline;
    for (int d = 0; d < Dim; ++d)
    {
      auto elevated = ElevateDegree<Dim>(result, d, times);
      if (!elevated)
      {
        return elevated;
      }
      result = std::move(elevated.Value);
    }
    return result;
  }
  Result<Spline<Dim>> TensorForm(const Spline<Dim>& spline, int, int) const override
  {
    return spline;
  }
};

template <int Dim>
ElementPoints TensorProduct<Dim>::NumberPoints(const SplineSpace<Dim>& space) const
{
  const std::vector<CellIndex<Dim>> cells = IndexElements(space);
  std::vector<PointLine> lines;
  for (const KnotVector& knots : space.Knots)
  {
    lines.emplace_back(knots);
  }
  ElementPoints numbering;
  numbering.Count = 1;
  for (const PointLine& line : lines)
  {
    numbering.Count *= line.Size();
  }
  for (std::size_t e = 0; e < cells.size(); ++e)
  {
    ForBernstein<Dim>(space.Elements[e].Degree,
      [&](int, const IntArray<Dim>& index)
      {
        std::int64_t id = 0;
        for (std::size_t d = Dim; d-- > 0;)
        {
          id = id * lines[d].Size() + lines[d].Position(0, cells[e][d], index[d]);
        }
        numbering.Ids.push_back(id);
      });
  }
  return numbering;
}
}

template <int Dim>
const SpaceFamily<Dim>& TensorFamily()
{
  static const TensorProduct<Dim> family;
  return family;
}

template const SpaceFamily<1>& TensorFamily<1>();
template const SpaceFamily<2>& TensorFamily<2>();
template const SpaceFamily<3>& TensorFamily<3>();
}
