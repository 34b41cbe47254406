// SPDX-License-Identifier: BSD-3-Clause
// LR B-splines as a family: spaces of three parameters.
#include "ChartCell.h"
#include "ChartLines.h"
#include "LRFunctionLists.h"
#include "LRVolumeParts.h"
#include "LocalRefinement.h"
#include "PointLine.h"
#include "TensorSpace.h"

#include <algorithm>
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
  MeshRectangles,
  LocalKnots,
  Scaling,
  NumTables
};
constexpr std::size_t RectangleNumbers =
  7; // of a row: direction, plane, lower, upper, multiplicity

/// Rectangles of one multiplicity that cover the faces with one, each as long as it can be in the
/// first direction and then as wide: the same for equal meshes.
void AppendRectangles(const LRVolumeBasis& basis, int d, std::vector<std::int64_t>& rows)
{
  const auto across = LRVolumeBasis::Across(d);
  const int width = basis.Spans(across[0]);
  const int height = basis.Spans(across[1]);
  for (int plane = 0; plane <= basis.Spans(d); ++plane)
  {
    const std::uint8_t* faces = basis.Faces[At(d)].data() + basis.FaceIndex(d, plane, 0, 0);
    std::vector<bool> isDone(At(width) * At(height), false);
    const auto isFree = [&](int a, int b, std::uint8_t multiplicity)
    {
      const std::size_t face = At(b) * At(width) + At(a);
      return !isDone[face] && faces[face] == multiplicity;
    };
    for (int b = 0; b < height; ++b)
    {
      for (int a = 0; a < width; ++a)
      {
        const std::uint8_t multiplicity = faces[At(b) * At(width) + At(a)];
        if (multiplicity == 0 || !isFree(a, b, multiplicity))
        {
          continue;
        }
        int right = a + 1;
        while (right < width && isFree(right, b, multiplicity))
        {
          ++right;
        }
        int top = b;
        bool isWhole = true;
        while (isWhole)
        {
          std::fill(isDone.begin() + top * width + a, isDone.begin() + top * width + right, true);
          ++top;
          isWhole = top < height;
          for (int i = a; i < right && isWhole; ++i)
          {
            isWhole = isFree(i, top, multiplicity);
          }
        }
        const std::array<std::int64_t, RectangleNumbers> row{ d, plane, a, b, right, top,
          multiplicity };
        rows.insert(rows.end(), row.begin(), row.end());
      }
    }
  }
}

SpaceDefinition DescribeVolume(const LRVolumeBasis& basis)
{
  SpaceDefinition definition;
  definition.Kind = SpaceKind::LocallyRefined;
  definition.Dimension = 3;
  definition.Tables.resize(NumTables);
  for (std::size_t d = 0; d < 3; ++d)
  {
    definition.Degree[d] = basis.Degree[d];
    definition.Knots[d] = basis.Knots[d];
    AppendRectangles(basis, static_cast<int>(d), definition.Tables[MeshRectangles].Whole);
  }
  definition.Tables[LocalKnots].Whole.assign(basis.LocalKnots.begin(), basis.LocalKnots.end());
  definition.Tables[Scaling].Real = basis.Scaling;
  return definition;
}

// MakeLRVolumeSpace checks the rest.
Result<SplineSpacePtr<3>> BuildVolume(const SpaceDefinition& definition, int threads)
{
  LRVolumeBasis basis;
  for (std::size_t d = 0; d < 3; ++d)
  {
    basis.Degree[d] = definition.Degree[d];
    basis.Knots[d] = definition.Knots[d];
    if (basis.Knots[d].size() < 2)
    {
      return { ErrorCode::InvalidKnots,
        "direction " + std::to_string(d) + ": it needs at least two distinct knots" };
    }
  }
  if (Status status = CheckLRVolumeSize(basis); !status)
  {
    return status;
  }
  for (int d = 0; d < 3; ++d)
  {
    const auto [a, b] = LRVolumeBasis::Across(d);
    basis.Faces[At(d)].assign(
      basis.Knots[At(d)].size() * At(basis.Spans(a)) * At(basis.Spans(b)), 0);
  }
  const std::vector<std::int64_t>& rows = definition.Tables[MeshRectangles].Whole;
  for (std::size_t i = 0; i + RectangleNumbers <= rows.size(); i += RectangleNumbers)
  {
    const std::int64_t* row = rows.data() + i;
    bool isKnown = row[0] >= 0 && row[0] < 3 && row[6] > 0 && row[6] <= MaxDegree + 1;
    if (isKnown)
    {
      const auto d = static_cast<int>(row[0]);
      const auto [a, b] = LRVolumeBasis::Across(d);
      isKnown = row[1] >= 0 && row[1] <= basis.Spans(d) && row[2] >= 0 && row[2] < row[4] &&
        row[4] <= basis.Spans(a) && row[3] >= 0 && row[3] < row[5] && row[5] <= basis.Spans(b);
    }
    if (!isKnown)
    {
      return { ErrorCode::InvalidTopology, "a mesh rectangle is out of range" };
    }
    const auto d = static_cast<int>(row[0]);
    for (std::int64_t y = row[3]; y < row[5]; ++y)
    {
      for (std::int64_t x = row[2]; x < row[4]; ++x)
      {
        std::uint8_t& face = basis.Faces[At(d)][basis.FaceIndex(
          d, static_cast<int>(row[1]), static_cast<int>(x), static_cast<int>(y))];
        if (face > 0)
        {
          return { ErrorCode::InvalidTopology, "two mesh rectangles overlap" };
        }
        face = static_cast<std::uint8_t>(row[6]);
      }
    }
  }
  for (const std::int64_t knot : definition.Tables[LocalKnots].Whole)
  {
    if (knot < 0 || knot > std::numeric_limits<int>::max())
    {
      return { ErrorCode::InvalidTopology, "a local knot is out of range" };
    }
    basis.LocalKnots.push_back(static_cast<int>(knot));
  }
  basis.Scaling = definition.Tables[Scaling].Real;
  return MakeLRVolumeSpace(std::move(basis), threads);
}

// Points on corners, edges and faces that elements have in common from end to end are one where no
// plane of full multiplicity is near.
ElementPoints NumberVolume(const SplineSpace<3>& space)
{
  using Key = std::array<int, 9>; // a direction: the knot twice, or the ends and the number between
  const LRVolume& volume = LRVolumeOf(space);
  const LRVolumeBasis& basis = volume.Basis;
  std::array<std::vector<bool>, 3> torn; // planes that the map may jump across
  for (std::size_t d = 0; d < 3; ++d)
  {
    const KnotVector& knots = space.Knots[d];
    for (int k = 0; k <= knots.NumElements(); ++k)
    {
      torn[d].push_back(
        k > 0 && k < knots.NumElements() && knots.Multiplicity(k) > basis.Degree[d]);
    }
  }
  const auto hash = [](const Key& key) { return HashNumbers(0, key); };
  ElementPoints numbering;
  std::unordered_map<Key, std::int64_t, decltype(hash)> shared(
    8 * volume.ElementKnots.size(), hash);
  for (const auto& box : volume.ElementKnots)
  {
    ForBernstein<3>(basis.Degree,
      [&](int, const IntArray<3>& index)
      {
        Key key{};
        bool isOwn = false;
        bool isInside = true;
        for (std::size_t d = 0; d < 3; ++d)
        {
          const bool isLow = index[d] == 0;
          const bool isHigh = index[d] == basis.Degree[d];
          const int low = isHigh ? box[d + 3] : box[d];
          const int high = isLow ? box[d] : box[d + 3];
          key[3 * d] = low;
          key[3 * d + 1] = high;
          key[3 * d + 2] = isLow || isHigh ? 0 : index[d];
          isOwn = isOwn || ((isLow || isHigh) && torn[d][At(low)]);
          isInside = isInside && !isLow && !isHigh;
        }
        if (isOwn || isInside)
        {
          numbering.Ids.push_back(numbering.Count++);
          return;
        }
        const auto [place, isNew] = shared.try_emplace(key, numbering.Count);
        numbering.Count += isNew ? 1 : 0;
        numbering.Ids.push_back(place->second);
      });
  }
  return numbering;
}

class LocallyRefinedVolumes final : public SpaceFamily<3>
{
public:
  const char* Name() const override { return "LR"; }
  int StoredNumber() const override { return 3; }
  const std::vector<DefinitionTableLayout>& Tables() const override
  {
    static const std::vector<DefinitionTableLayout> tables{ { "MeshRectangles",
                                                              { "Direction", "Plane", "LowerFirst",
                                                                "LowerSecond", "UpperFirst",
                                                                "UpperSecond", "Multiplicity" },
                                                              true },
      { "LocalKnots", { "" }, true }, { "Scaling", { "" }, false } };
    return tables;
  }
  std::size_t NumRows(
    const SpaceDefinition& definition, int numFunctions, std::size_t table) const override
  {
    const auto& p = definition.Degree;
    return At(numFunctions) * (table == LocalKnots ? At(p[0]) + At(p[1]) + At(p[2]) + 6 : 1);
  }
  SpaceDefinition Describe(const SplineSpace<3>& space) const override
  {
    return DescribeVolume(LRVolumeOf(space).Basis);
  }
  Result<SplineSpacePtr<3>> Build(const SpaceDefinition& definition, int threads) const override
  {
    return BuildVolume(definition, threads);
  }

  void Locate(const SplineSpace<3>& space, const double* u, std::ptrdiff_t stride, std::size_t n,
    int* elements, double* local) const override
  {
    const LRVolume& volume = LRVolumeOf(space);
    for (std::size_t i = 0; i < n; ++i, u += stride, local += 3)
    {
      bool inside = true;
      std::array<std::size_t, 3> cell{};
      for (std::size_t d = 0; d < 3; ++d)
      {
        const std::vector<double>& knots = volume.Basis.Knots[d];
        const double slack = 1e-12 * (knots.back() - knots.front());
        inside = inside && u[d] >= knots.front() - slack && u[d] <= knots.back() + slack;
        const auto above = std::upper_bound(knots.begin() + 1, knots.end() - 1, u[d]);
        cell[d] = At(above - knots.begin()) - 1;
      }
      elements[i] = -1;
      if (!inside)
      {
        continue;
      }
      elements[i] =
        volume.Cells[(cell[2] * At(volume.Basis.Spans(1)) + cell[1]) * At(volume.Basis.Spans(0)) +
          cell[0]];
      const ParametricBox<3>& box = space.Elements[At(elements[i])].Box;
      for (std::size_t d = 0; d < 3; ++d)
      {
        local[d] = std::clamp((u[d] - box.Lower[d]) / (box.Upper[d] - box.Lower[d]), 0.0, 1.0);
      }
    }
  }
  std::vector<FunctionInfo<3>> DescribeFunctions(const SplineSpace<3>& space) const override
  {
    return DescribeLRFunctions<3>(LRVolumeOf(space).Basis);
  }
  std::vector<NetEdge> ControlNetEdges(const SplineSpace<3>& space) const override
  {
    return LREdges<3>(LRVolumeOf(space).Basis);
  }
  std::vector<ChartCell<3>> Charts(const SplineSpace<3>& space, int& numCharts) const override
  {
    const LRVolume& volume = LRVolumeOf(space);
    std::vector<ChartCell<3>> cells(space.Elements.size());
    for (std::size_t d = 0; d < 3; ++d)
    {
      const std::vector<std::int64_t> lines = ChartLines(volume.Basis.Knots[d]);
      for (std::size_t e = 0; e < cells.size(); ++e)
      {
        const int low = volume.ElementKnots[e][d];
        const int high = volume.ElementKnots[e][d + 3];
        cells[e].Chart = numCharts;
        cells[e].Lower[d] = lines[At(low)];
        cells[e].Size[d] = lines[At(high)] - lines[At(low)];
        cells[e].RimLow[d] = low == 0;
        cells[e].RimHigh[d] = high == volume.Basis.Spans(static_cast<int>(d));
      }
    }
    ++numCharts;
    return cells;
  }
  ElementPoints NumberPoints(const SplineSpace<3>& space) const override
  {
    return NumberVolume(space);
  }
  double FunctionsAfterRefinement(const SplineSpace<3>& space, int, int refinements) const override
  {
    return FunctionsOfHalvedElements<3>(space, refinements);
  }

  Result<RefinedSpline<3>> RefineAll(const Spline<3>& spline) const override
  {
    std::vector<int> all(spline.Space->Elements.size());
    std::iota(all.begin(), all.end(), 0);
    return RefineMarkedLRVolume(spline, all);
  }
  Result<RefinedSpline<3>> RefineMarked(
    const Spline<3>& spline, const std::vector<int>& marked, const RefinementParams&) const override
  {
    return RefineMarkedLRVolume(spline, marked);
  }
  Result<Spline<3>> ElevateDegrees(const Spline<3>&, int) const override
  {
    return { ErrorCode::DimensionMismatch, NoElevation };
  }
  Result<Spline<3>> TensorForm(
    const Spline<3>& spline, int threads, int maxFunctions) const override
  {
    const SplineSpace<3>& space = *spline.Space;
    double size = 1.0;
    std::vector<LRRectangle> planes;
    for (int d = 0; d < 3; ++d)
    {
      const KnotVector& knots = space.Knots[At(d)];
      const auto [a, b] = LRVolumeBasis::Across(d);
      size *= knots.NumFunctions();
      for (int k = 1; k < knots.NumElements(); ++k)
      {
        planes.push_back(
          { d, knots.Breaks()[At(k)], { space.Knots[At(a)].Begin(), space.Knots[At(b)].Begin() },
            { space.Knots[At(a)].End(), space.Knots[At(b)].End() }, knots.Multiplicity(k) });
      }
    }
    const int limit = std::max(maxFunctions, space.NumFunctions);
    if (Status status = CheckSize(size, limit); !status)
    {
      return status;
    }
    Result<Spline<3>> expanded = InsertRectangles(spline, planes, limit, threads);
    if (!expanded)
    {
      return expanded;
    }
    Result<SplineSpacePtr<3>> tensor = MakeTensorSpace<3>(space.Knots);
    expanded->Space = tensor.Value; // functions have the same order
    return tensor ? std::move(expanded) : tensor.Status;
  }
};
}

const SpaceFamily<3>& LRVolumeFamily()
{
  static const LocallyRefinedVolumes family;
  return family;
}
}
