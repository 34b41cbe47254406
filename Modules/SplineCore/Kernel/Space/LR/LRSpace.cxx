// SPDX-License-Identifier: BSD-3-Clause
#include "LRSpace.h"

#include "LRParts.h"
#include "Parallel.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

void AppendElements(SplineSpace<2>& space, const LRData& data)
{
  const LRBasis& basis = data.Basis;
  const int perElement = NumTensorFunctions<2>(basis.Degree);
  const std::size_t numElements = data.ElementKnots.size();
  space.NumFunctions = basis.NumFunctions();
  space.NumLocalFunctions = perElement * static_cast<int>(numElements);
  space.LocalFunctionIds.resize(At(space.NumLocalFunctions));
  std::iota(space.LocalFunctionIds.begin(), space.LocalFunctionIds.end(), 0);
  space.Elements.resize(numElements);
  for (std::size_t e = 0; e < numElements; ++e)
  {
    const std::array<int, 4>& corners = data.ElementKnots[e];
    auto& element = space.Elements[e];
    element.Degree = basis.Degree;
    element.FirstLocal = e * At(perElement);
    element.Factor.fill(-1);
    for (std::size_t d = 0; d < 2; ++d)
    {
      element.Box.Lower[d] = basis.Knots[d][At(corners[d])];
      element.Box.Upper[d] = basis.Knots[d][At(corners[d + 2])];
    }
  }
}

BoxLocator MakeLocator(const SplineSpace<2>& space, const LRBasis& basis)
{
  std::vector<ParametricBox<2>> boxes;
  boxes.reserve(space.Elements.size());
  for (const auto& element : space.Elements)
  {
    boxes.push_back(element.Box);
  }
  return { space.Domain(), boxes, { basis.Knots[0].size() - 1, basis.Knots[1].size() - 1 } };
}

Result<KnotVector> TensorKnots(const LRBasis& basis, int d)
{
  std::vector<double> knots;
  for (std::size_t k = 0; k < basis.Knots[At(d)].size(); ++k)
  {
    int most = 0;
    for (const LRPiece& piece : basis.Lines[At(d)][k])
    {
      most = std::max(most, piece.Multiplicity);
    }
    knots.insert(knots.end(), At(most), basis.Knots[At(d)][k]);
  }
  return KnotVector::Create(basis.Degree[At(d)], std::move(knots));
}
}

int LRMultiplicity(const LRLine& line, int low, int high)
{
  auto piece = std::upper_bound(line.begin(), line.end(), low,
                 [](int knot, const LRPiece& p) { return knot < p.Knot; }) -
    1;
  int least = piece->Multiplicity;
  for (++piece; piece != line.end() && piece->Knot < high; ++piece)
  {
    least = std::min(least, piece->Multiplicity);
  }
  return least;
}

Result<SplineSpacePtr<2>> MakeLRSpace(LRBasis basis, int threads)
{
  Status status = CheckLRLines(basis);
  if (status)
  {
    status = CheckLRFunctions(basis, threads);
  }
  return status ? AssembleLRSpace(std::move(basis), threads) : status;
}

Result<SplineSpacePtr<2>> AssembleLRSpace(LRBasis basis, int threads)
{
  auto elements = LRElements(basis);
  if (!elements)
  {
    return elements.Status;
  }
  const auto limit = At(std::numeric_limits<int>::max() / NumTensorFunctions<2>(basis.Degree));
  if (elements.Value.size() > limit)
  {
    return { ErrorCode::TooLarge, std::to_string(elements.Value.size()) + " elements" };
  }
  auto space = std::make_shared<SplineSpace<2>>();
  auto data = std::make_shared<LRData>();
  space->Kind = SpaceKind::LocallyRefined;
  for (int d = 0; d < 2; ++d)
  {
    Result<KnotVector> knots = TensorKnots(basis, d);
    if (!knots)
    {
      return knots.Status;
    }
    space->Knots[At(d)] = std::move(knots.Value);
  }
  data->Basis = std::move(basis);
  data->ElementKnots = std::move(elements.Value);
  AppendElements(*space, *data);
  // the locator has nothing to do with the functions
  Status status;
  ParallelFor(2, 1, threads,
    [&](std::size_t part, std::size_t)
    {
      if (part == 0)
      {
        data->Locator = MakeLocator(*space, data->Basis);
        return;
      }
      status = FindAliveFunctions(*data, threads);
      status = status ? BuildLRRows(*space, *data, threads) : status;
    });
  if (!status)
  {
    return status;
  }
  space->LocallyRefined = std::move(data);
  return SplineSpacePtr<2>(std::move(space));
}

Result<LRBasis> LRBasisOfTensor(const SplineSpace<2>& space)
{
  if (space.Kind != SpaceKind::Tensor)
  {
    return { ErrorCode::DimensionMismatch, "only a tensor-product space becomes locally refined" };
  }
  LRBasis basis;
  std::array<std::vector<int>, 2> ranks; // of every knot
  for (std::size_t d = 0; d < 2; ++d)
  {
    const KnotVector& knots = space.Knots[d];
    const int p = knots.Degree();
    basis.Degree[d] = p;
    basis.Knots[d] = knots.Breaks();
    if (knots.Knots().front() != knots.Begin() || knots.Knots().back() != knots.End() ||
      knots.Multiplicity(0) != p + 1 || knots.Multiplicity(knots.NumElements()) != p + 1)
    {
      return { ErrorCode::InvalidKnots,
        "the ends of direction " + std::to_string(d) + " must have multiplicity " +
          std::to_string(p + 1) + "; insert knots at the ends first" };
    }
    for (int b = 0; b <= knots.NumElements(); ++b)
    {
      basis.Lines[d].push_back({ { 0, knots.Multiplicity(b) } });
      ranks[d].insert(ranks[d].end(), At(knots.Multiplicity(b)), b);
    }
  }
  const int n0 = space.Knots[0].NumFunctions();
  const int n1 = space.Knots[1].NumFunctions();
  for (int j = 0; j < n1; ++j)
  {
    for (int i = 0; i < n0; ++i)
    {
      basis.LocalKnots.insert(
        basis.LocalKnots.end(), ranks[0].begin() + i, ranks[0].begin() + i + basis.Degree[0] + 2);
      basis.LocalKnots.insert(
        basis.LocalKnots.end(), ranks[1].begin() + j, ranks[1].begin() + j + basis.Degree[1] + 2);
    }
  }
  basis.Scaling.assign(At(n0) * At(n1), 1.0);
  return basis;
}
}
