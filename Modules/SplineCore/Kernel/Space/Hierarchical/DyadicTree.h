// SPDX-License-Identifier: BSD-3-Clause
// Spaces whose elements are the leaves of a tree of halved level-0 cells (tensor-product ones are
// the trees without a halved cell), private to the kernel.
#pragma once
#include "ChartCell.h"
#include "ControlNet.h"
#include "FunctionInfo.h"
#include "SpaceFamily.h"

namespace knotwork
{
/// See SpaceFamily.
template <int Dim>
void LocateInTree(const SplineSpace<Dim>& space, const double* u, std::ptrdiff_t stride,
  std::size_t n, int* elements, double* local);
template <int Dim>
std::vector<ChartCell<Dim>> ChartsOfTree(const SplineSpace<Dim>& space, int& numCharts);
template <int Dim>
std::vector<FunctionInfo<Dim>> FunctionsOfLevels(const SplineSpace<Dim>& space);
/// Lines between functions of one level with neighbouring indices.
template <int Dim>
std::vector<NetEdge> EdgesOfLevels(const SplineSpace<Dim>& space);
/// Degrees and level-0 knots.
template <int Dim>
SpaceDefinition DefinitionOfKnots(const SplineSpace<Dim>& space);
/// @return KnotVector::Create's errors.
template <int Dim>
Result<std::array<KnotVector, Dim>> KnotsOfDefinition(const SpaceDefinition& definition);

/// Splits marked elements: a level more there (TransferToRefined of RefineElements).
template <int Dim>
Result<RefinedSpline<Dim>> RefineByLevels(
  const Spline<Dim>& spline, const std::vector<int>& marked, const RefinementParams& params);

/// What families of such spaces share.
template <int Dim>
class FamilyOfTrees : public SpaceFamily<Dim>
{
public:
  void Locate(const SplineSpace<Dim>& space, const double* u, std::ptrdiff_t stride, std::size_t n,
    int* elements, double* local) const override
  {
    LocateInTree<Dim>(space, u, stride, n, elements, local);
  }
  std::vector<FunctionInfo<Dim>> DescribeFunctions(const SplineSpace<Dim>& space) const override
  {
    return FunctionsOfLevels<Dim>(space);
  }
  std::vector<NetEdge> ControlNetEdges(const SplineSpace<Dim>& space) const override
  {
    return EdgesOfLevels<Dim>(space);
  }
  std::vector<ChartCell<Dim>> Charts(const SplineSpace<Dim>& space, int& numCharts) const override
  {
    return ChartsOfTree<Dim>(space, numCharts);
  }
};
}
