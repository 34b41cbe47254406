// SPDX-License-Identifier: BSD-3-Clause
// LR B-splines as a family: spaces of two parameters. LRVolumeFamily.cxx has those of three.
#include "ChartCell.h"
#include "ChartLines.h"
#include "LRFunctionLists.h"
#include "LROperations.h"
#include "LRSpace.h"
#include "LRVolumeParts.h"
#include "LocalRefinement.h"
#include "PointLine.h"
#include "Refinement.h"
#include "SpaceFamily.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <unordered_map>

namespace knotwork
{
namespace
{
std::size_t At(std::int64_t i)
{
  return static_cast<std::size_t>(i);
}

enum Table
{
  MeshLines,
  LocalKnots,
  Scaling,
  NumTables
};

void LocateInBoxes(const SplineSpace<2>& space, const double* u, std::ptrdiff_t stride,
  std::size_t n, int* elements, double* local)
{
  const BoxLocator& locator = space.LocallyRefined->Locator;
  const ParametricBox<2> domain = space.Domain();
  RealArray<2> slack;
  for (std::size_t d = 0; d < 2; ++d)
  {
    slack[d] = 1e-12 * (domain.Upper[d] - domain.Lower[d]);
  }
  for (std::size_t i = 0; i < n; ++i, u += stride, local += 2)
  {
    bool inside = true;
    for (std::size_t d = 0; d < 2; ++d)
    {
      inside = inside && u[d] >= domain.Lower[d] - slack[d] && u[d] <= domain.Upper[d] + slack[d];
    }
    elements[i] = inside ? locator.Find(u[0], u[1]) : -1;
    if (!inside)
    {
      continue;
    }
    const ParametricBox<2>& box = space.Elements[static_cast<std::size_t>(elements[i])].Box;
    for (std::size_t d = 0; d < 2; ++d)
    {
      local[d] = std::clamp((u[d] - box.Lower[d]) / (box.Upper[d] - box.Lower[d]), 0.0, 1.0);
    }
  }
}
void PlaceBoxes(const LRData& data, int chart, std::vector<ChartCell<2>>& cells)
{
  const std::array<std::vector<std::int64_t>, 2> lines{ ChartLines(data.Basis.Knots[0]),
    ChartLines(data.Basis.Knots[1]) };
  for (std::size_t e = 0; e < cells.size(); ++e)
  {
    ChartCell<2>& cell = cells[e];
    cell.Chart = chart;
    for (std::size_t d = 0; d < 2; ++d)
    {
      const int low = data.ElementKnots[e][d];
      const int high = data.ElementKnots[e][d + 2];
      cell.Lower[d] = lines[d][At(low)];
      cell.Size[d] = lines[d][At(high)] - cell.Lower[d];
      cell.RimLow[d] = low == 0;
      cell.RimHigh[d] = At(high) + 1 == lines[d].size();
    }
  }
}
// Points on a side that two elements have in common from end to end, and on corners, are one where
// no line of full multiplicity is near.
ElementPoints NumberLR(const LRData& data)
{
  using Key = std::array<int, 5>; // corner: -1, knots; side: direction, line, its ends, point
  const LRBasis& basis = data.Basis;
  const auto most = [&basis](std::size_t d, int line)
  {
    int m = 0;
    for (const LRPiece& piece : basis.Lines[d][static_cast<std::size_t>(line)])
    {
      m = std::max(m, piece.Multiplicity);
    }
    return m;
  };
  std::array<std::vector<bool>, 2> torn; // lines that the map may jump across
  for (std::size_t d = 0; d < 2; ++d)
  {
    const auto last = static_cast<int>(basis.Knots[d].size()) - 1;
    for (int k = 0; k <= last; ++k)
    {
      torn[d].push_back(k > 0 && k < last && most(d, k) > basis.Degree[d]);
    }
  }
  const auto hash = [](const Key& key) { return HashNumbers(0, key); };
  ElementPoints numbering;
  std::unordered_map<Key, std::int64_t, decltype(hash)> shared(8 * data.ElementKnots.size(), hash);
  for (const auto& box : data.ElementKnots)
  {
    for (int j = 0; j <= basis.Degree[1]; ++j)
    {
      for (int i = 0; i <= basis.Degree[0]; ++i)
      {
        const std::array<int, 2> line{ i == 0 ? box[0]
            : i == basis.Degree[0]            ? box[2]
                                              : -1,
          j == 0                   ? box[1]
            : j == basis.Degree[1] ? box[3]
                                   : -1 };
        const bool jumps = (line[0] >= 0 && torn[0][static_cast<std::size_t>(line[0])]) ||
          (line[1] >= 0 && torn[1][static_cast<std::size_t>(line[1])]);
        if (jumps || (line[0] < 0 && line[1] < 0))
        {
          numbering.Ids.push_back(numbering.Count++);
          continue;
        }
        const Key key = line[0] >= 0 && line[1] >= 0 ? Key{ -1, line[0], line[1], 0, 0 }
          : line[0] >= 0                             ? Key{ 0, line[0], box[1], box[3], j }
                                                     : Key{ 1, line[1], box[0], box[2], i };
        const auto [place, isNew] = shared.try_emplace(key, numbering.Count);
        numbering.Count += isNew ? 1 : 0;
        numbering.Ids.push_back(place->second);
      }
    }
  }
  return numbering;
}

SpaceDefinition DescribeLR(const LRBasis& basis)
{
  SpaceDefinition definition;
  definition.Kind = SpaceKind::LocallyRefined;
  definition.Dimension = 2;
  definition.Tables.resize(NumTables);
  for (std::size_t d = 0; d < 2; ++d)
  {
    definition.Degree[d] = basis.Degree[d];
    definition.Knots[d] = basis.Knots[d];
    for (std::size_t k = 0; k < basis.Lines[d].size(); ++k)
    {
      for (const LRPiece& piece : basis.Lines[d][k])
      {
        const std::array<std::int64_t, 4> row{ static_cast<std::int64_t>(d),
          static_cast<std::int64_t>(k), piece.Knot, piece.Multiplicity };
        std::vector<std::int64_t>& rows = definition.Tables[MeshLines].Whole;
        rows.insert(rows.end(), row.begin(), row.end());
      }
    }
  }
  definition.Tables[LocalKnots].Whole.assign(basis.LocalKnots.begin(), basis.LocalKnots.end());
  definition.Tables[Scaling].Real = basis.Scaling;
  return definition;
}

// MakeLRSpace checks the rest.
Result<SplineSpacePtr<2>> BuildLR(const SpaceDefinition& definition, int threads)
{
  constexpr std::int64_t most = std::numeric_limits<int>::max();
  const auto fits = [](std::int64_t value) { return value >= 0 && value <= most; };
  LRBasis made;
  for (std::size_t d = 0; d < 2; ++d)
  {
    made.Degree[d] = definition.Degree[d];
    made.Knots[d] = definition.Knots[d];
    made.Lines[d].resize(definition.Knots[d].size());
  }
  const std::vector<std::int64_t>& pieces = definition.Tables[MeshLines].Whole;
  for (std::size_t i = 0; i + 4 <= pieces.size(); i += 4)
  {
    const std::int64_t* piece = pieces.data() + i;
    const bool known = (piece[0] == 0 || piece[0] == 1) && fits(piece[1]) && fits(piece[2]) &&
      fits(piece[3]) && At(piece[1]) < made.Lines[At(piece[0])].size();
    if (!known)
    {
      return { ErrorCode::InvalidTopology, "a piece of a mesh line is out of range" };
    }
    made.Lines[At(piece[0])][At(piece[1])].push_back(
      { static_cast<int>(piece[2]), static_cast<int>(piece[3]) });
  }
  for (const std::int64_t knot : definition.Tables[LocalKnots].Whole)
  {
    if (!fits(knot))
    {
      return { ErrorCode::InvalidTopology, "a local knot is out of range" };
    }
    made.LocalKnots.push_back(static_cast<int>(knot));
  }
  made.Scaling = definition.Tables[Scaling].Real;
  return MakeLRSpace(std::move(made), threads);
}

constexpr const char* TwoOrThreeParameters = "locally refined spaces have two or three parameters";

/// Curves have no such spaces, and no definition makes one.
template <int Dim>
class LocallyRefined final : public SpaceFamily<Dim>
{
public:
  const char* Name() const override { return "LR"; }
  int StoredNumber() const override { return 3; }
  const std::vector<DefinitionTableLayout>& Tables() const override
  {
    static const std::vector<DefinitionTableLayout> tables{
      { "MeshLines", { "Direction", "Line", "Knot", "Multiplicity" }, true },
      { "LocalKnots", { "" }, true }, { "Scaling", { "" }, false }
    };
    return tables;
  }
  std::size_t NumRows(
    const SpaceDefinition& definition, int numFunctions, std::size_t table) const override
  {
    return At(numFunctions) *
      (table == LocalKnots ? At(definition.Degree[0]) + At(definition.Degree[1]) + 4 : 1);
  }
  SpaceDefinition Describe(const SplineSpace<Dim>& space) const override
  {
    return DescribeLR(space.LocallyRefined->Basis);
  }
  Result<SplineSpacePtr<Dim>> Build(
    [[maybe_unused]] const SpaceDefinition& definition, [[maybe_unused]] int threads) const override
  {
    if constexpr (Dim == 2)
    {
      return BuildLR(definition, threads);
    }
    return { ErrorCode::InvalidTopology, TwoOrThreeParameters };
  }

  void Locate(const SplineSpace<Dim>& space, const double* u, std::ptrdiff_t stride, std::size_t n,
    int* elements, double* local) const override
  {
    if constexpr (Dim == 2)
    {
      LocateInBoxes(space, u, stride, n, elements, local);
    }
  }
  std::vector<FunctionInfo<Dim>> DescribeFunctions(const SplineSpace<Dim>& space) const override
  {
    if constexpr (Dim == 2)
    {
      return DescribeLRFunctions<2>(space.LocallyRefined->Basis);
    }
    return {};
  }
  std::vector<NetEdge> ControlNetEdges(const SplineSpace<Dim>& space) const override
  {
    return LREdges<2>(space.LocallyRefined->Basis);
  }
  std::vector<ChartCell<Dim>> Charts(const SplineSpace<Dim>& space, int& numCharts) const override
  {
    std::vector<ChartCell<Dim>> cells(space.Elements.size());
    if constexpr (Dim == 2)
    {
      PlaceBoxes(*space.LocallyRefined, numCharts++, cells);
    }
    return cells;
  }
  ElementPoints NumberPoints(const SplineSpace<Dim>& space) const override
  {
    return NumberLR(*space.LocallyRefined);
  }
  double FunctionsAfterRefinement(
    const SplineSpace<Dim>& space, int, int refinements) const override
  {
    return FunctionsOfHalvedElements<Dim>(space, refinements);
  }

  Result<RefinedSpline<Dim>> RefineAll(const Spline<Dim>& spline) const override
  {
    std::vector<int> all(spline.Space->Elements.size());
    std::iota(all.begin(), all.end(), 0);
    return this->RefineMarked(spline, all, {});
  }
  Result<RefinedSpline<Dim>> RefineMarked(const Spline<Dim>& spline, const std::vector<int>& marked,
    const RefinementParams&) const override
  {
    if constexpr (Dim == 2)
    {
      return RefineMarkedLR(spline, marked);
    }
    return { ErrorCode::DimensionMismatch, TwoOrThreeParameters };
  }
  Result<Spline<Dim>> ElevateDegrees(const Spline<Dim>&, int) const override
  {
    return { ErrorCode::DimensionMismatch, NoElevation };
  }
  Result<Spline<Dim>> TensorForm(
    const Spline<Dim>& spline, int threads, int maxFunctions) const override
  {
    if constexpr (Dim == 2)
    {
      return ExpandToTensor(spline, threads, maxFunctions);
    }
    return { ErrorCode::DimensionMismatch, TwoOrThreeParameters };
  }
};
}

template <int Dim>
const SpaceFamily<Dim>& LRFamily()
{
  if constexpr (Dim == 3)
  {
    return LRVolumeFamily();
  }
  else
  {
    static const LocallyRefined<Dim> family;
    return family;
  }
}

template const SpaceFamily<1>& LRFamily<1>();
template const SpaceFamily<2>& LRFamily<2>();
template const SpaceFamily<3>& LRFamily<3>();
}
