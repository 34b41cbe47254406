// SPDX-License-Identifier: BSD-3-Clause
// Hierarchical spaces as a family.
#include "DyadicTree.h"
#include "HierarchicalSpace.h"
#include "LocalRefinement.h"
#include "PointLine.h"
#include "Refinement.h"
#include "SizeLimit.h"
#include "SpaceFamily.h"
#include "TensorSpace.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

namespace knotwork
{
namespace
{
constexpr std::size_t BoxColumns = 7; // level, lower corner, upper corner

template <int Dim>
struct PointKey
{
  int Level;
  CellIndex<Dim> Position;
  bool operator==(const PointKey& other) const
  {
    return this->Level == other.Level && this->Position == other.Position;
  }
};

template <int Dim>
struct PointKeyHash
{
  std::size_t operator()(const PointKey<Dim>& key) const
  {
    return HashNumbers(static_cast<std::uint64_t>(key.Level), key.Position);
  }
};

template <int Dim>
Result<Spline<Dim>> FinestLevel(const Spline<Dim>& spline, int maxFunctions)
{
  const SplineSpace<Dim>& space = *spline.Space;
  HierarchyBox<Dim> all;
  all.Level = 0;
  for (const auto& element : space.Elements)
  {
    all.Level = std::max(all.Level, element.Level);
  }
  double functions = 1.0;
  std::array<KnotVector, Dim> knots = space.Knots;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    all.Upper[d] = static_cast<std::int64_t>(space.Knots[d].NumElements()) << all.Level;
    functions *= static_cast<double>(all.Upper[d]) + space.Knots[d].NumFunctions() -
      space.Knots[d].NumElements();
  }
  if (Status status = CheckSize(functions, std::max(maxFunctions, space.NumFunctions)); !status)
  {
    return status;
  }
  for (KnotVector& direction : knots)
  {
    for (int level = 0; level < all.Level; ++level)
    {
      direction = direction.Dyadic();
    }
  }
  Result<SplineSpacePtr<Dim>> tensor = MakeTensorSpace<Dim>(knots);
  if (!tensor)
  {
    return tensor.Status;
  }
  Spline<Dim> finest = spline;
  if (all.Level > 0)
  {
    auto refined = RefineBoxes<Dim>(spline.Space, { all });
    auto transferred =
      refined ? TransferToRefined<Dim>(spline, refined.Value) : Result<Spline<Dim>>(refined.Status);
    if (!transferred)
    {
      return transferred;
    }
    finest = std::move(transferred.Value);
  }
  // functions of one level stand in the order of the tensor product's
  if (finest.Space->NumFunctions != tensor.Value->NumFunctions)
  {
    return { ErrorCode::DimensionMismatch,
      "knots outside the domain carry functions that a hierarchical spline does not have" };
  }
  finest.Space = std::move(tensor.Value);
  return finest;
}
template <int Dim>
class Truncated final : public FamilyOfTrees<Dim>
{
public:
  const char* Name() const override { return "THB"; }
  int StoredNumber() const override { return 2; }
  const std::vector<DefinitionTableLayout>& Tables() const override
  {
    static const std::vector<DefinitionTableLayout> tables{ { "Boxes",
      { "Level", "Lower0", "Lower1", "Lower2", "Upper0", "Upper1", "Upper2" }, true } };
    return tables;
  }
  std::size_t NumRows(const SpaceDefinition&, int, std::size_t) const override { return 0; }
  SpaceDefinition Describe(const SplineSpace<Dim>& space) const override
  {
    SpaceDefinition definition = DefinitionOfKnots<Dim>(space);
    definition.Tables.resize(1);
    for (const HierarchyBox<Dim>& box : HierarchyBoxes(space))
    {
      std::array<std::int64_t, BoxColumns> row{ box.Level };
      std::copy(box.Lower.begin(), box.Lower.end(), row.begin() + 1);
      std::copy(box.Upper.begin(), box.Upper.end(), row.begin() + 4);
      std::vector<std::int64_t>& rows = definition.Tables[0].Whole;
      rows.insert(rows.end(), row.begin(), row.end());
    }
    return definition;
  }
  Result<SplineSpacePtr<Dim>> Build(const SpaceDefinition& definition, int) const override
  {
    auto knots = KnotsOfDefinition<Dim>(definition);
    if (!knots)
    {
      return knots.Status;
    }
    const std::vector<std::int64_t>& rows = definition.Tables[0].Whole;
    std::vector<HierarchyBox<Dim>> boxes(rows.size() / BoxColumns);
    for (std::size_t i = 0; i < boxes.size(); ++i)
    {
      const auto row = rows.begin() + static_cast<std::ptrdiff_t>(i * BoxColumns);
      boxes[i].Level =
        static_cast<int>(std::min<std::int64_t>(std::max<std::int64_t>(row[0], 0), 99));
      std::copy_n(row + 1, Dim, boxes[i].Lower.begin());
      std::copy_n(row + 4, Dim, boxes[i].Upper.begin());
    }
    return MakeHierarchicalSpace<Dim>(knots.Value, boxes);
  }

  ElementPoints NumberPoints(const SplineSpace<Dim>& space) const override;
  double FunctionsAfterRefinement(
    const SplineSpace<Dim>& space, int, int refinements) const override
  {
    return FunctionsOfHalvedElements<Dim>(space, refinements);
  }

  Result<RefinedSpline<Dim>> RefineAll(const Spline<Dim>& spline) const override
  {
    std::vector<int> all(spline.Space->Elements.size());
    std::iota(all.begin(), all.end(), 0);
    return RefineByLevels<Dim>(spline, all, {});
  }
  Result<RefinedSpline<Dim>> RefineMarked(const Spline<Dim>& spline, const std::vector<int>& marked,
    const RefinementParams& params) const override
  {
    return RefineByLevels<Dim>(spline, marked, params);
  }
  Result<Spline<Dim>> ElevateDegrees(const Spline<Dim>&, int) const override
  {
    return { ErrorCode::DimensionMismatch, NoElevation };
  }
  Result<Spline<Dim>> TensorForm(const Spline<Dim>& spline, int, int maxFunctions) const override
  {
    return FinestLevel(spline, maxFunctions);
  }
};

template <int Dim>
ElementPoints Truncated<Dim>::NumberPoints(const SplineSpace<Dim>& space) const
{
  const std::vector<CellIndex<Dim>> cells = IndexElements(space);
  std::vector<PointLine> lines;
  for (const KnotVector& knots : space.Knots)
  {
    lines.emplace_back(knots);
  }
  ElementPoints numbering;
  std::unordered_map<PointKey<Dim>, std::int64_t, PointKeyHash<Dim>> shared;
  for (std::size_t e = 0; e < cells.size(); ++e)
  {
    const auto& element = space.Elements[e];
    ForBernstein<Dim>(element.Degree,
      [&](int, const IntArray<Dim>& index)
      {
        bool boundary = false;
        PointKey<Dim> key{ element.Level, {} };
        for (std::size_t d = 0; d < Dim; ++d)
        {
          boundary = boundary || index[d] == 0 || index[d] == element.Degree[d];
          key.Position[d] = lines[d].Position(element.Level, cells[e][d], index[d]);
        }
        std::int64_t id = numbering.Count;
        if (boundary)
        {
          id = shared.emplace(key, id).first->second;
        }
        numbering.Count += id == numbering.Count ? 1 : 0;
        numbering.Ids.push_back(id);
      });
  }
  return numbering;
}
}

template <int Dim>
const SpaceFamily<Dim>& HierarchicalFamily()
{
  static const Truncated<Dim> family;
  return family;
}

template const SpaceFamily<1>& HierarchicalFamily<1>();
template const SpaceFamily<2>& HierarchicalFamily<2>();
template const SpaceFamily<3>& HierarchicalFamily<3>();
}
