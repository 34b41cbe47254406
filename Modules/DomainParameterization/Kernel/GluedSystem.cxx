// SPDX-License-Identifier: BSD-3-Clause
#include "GluedSystem.h"

#include "InitialMaps.h"
#include <knotwork/SplineCore/BasisEvaluation.h>
#include <knotwork/SplineCore/FunctionMap.h>
#include <knotwork/SplineCore/Quadrature.h>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
using Triplets = std::vector<Eigen::Triplet<double>>;

template <int Dim>
IntArray<Dim> Counts(const SplineSpace<Dim>& space)
{
  IntArray<Dim> counts{};
  for (std::size_t d = 0; d < Dim; ++d)
  {
    counts[d] = space.Knots[d].NumFunctions();
  }
  return counts;
}

template <int Dim>
void AddLaplacian(
  const SplineSpace<Dim>& space, const std::vector<int>& numbers, Triplets& triplets)
{
  std::vector<LineIntegrals> lines;
  for (const KnotVector& knots : space.Knots)
  {
    lines.push_back(IntegrateLine(knots));
  }
  const IntArray<Dim> counts = Counts<Dim>(space);
  std::size_t i = 0;
  ForEachOffset<Dim>(counts,
    [&](const IntArray<Dim>& index)
    {
      IntArray<Dim> lower{}, span{};
      for (std::size_t d = 0; d < Dim; ++d)
      {
        const int p = space.Knots[d].Degree();
        lower[d] = std::max(0, index[d] - p);
        span[d] = std::min(counts[d] - 1, index[d] + p) - lower[d] + 1;
      }
      ForEachOffset<Dim>(span,
        [&](const IntArray<Dim>& offset)
        {
          double value = 0.0;
          std::size_t j = 0;
          std::size_t stride = 1;
          for (std::size_t d = 0; d < Dim; ++d)
          {
            double product = 1.0;
            for (std::size_t m = 0; m < Dim; ++m)
            {
              const Eigen::MatrixXd& matrix = m == d ? lines[m].Stiffness : lines[m].Mass;
              product *= matrix(index[m], lower[m] + offset[m]);
            }
            value += product;
            j += stride * static_cast<std::size_t>(lower[d] + offset[d]);
            stride *= static_cast<std::size_t>(counts[d]);
          }
          triplets.emplace_back(numbers[i], numbers[j], value);
        });
      ++i;
    });
}

/// Sums entries of the same place.
void Compress(Eigen::Index size, Triplets& triplets)
{
  Eigen::SparseMatrix<double> sums(size, size);
  sums.setFromTriplets(triplets.begin(), triplets.end());
  triplets.clear();
  for (Eigen::Index column = 0; column < size; ++column)
  {
    for (Eigen::SparseMatrix<double>::InnerIterator entry(sums, column); entry; ++entry)
    {
      triplets.emplace_back(static_cast<int>(entry.row()), static_cast<int>(column), entry.value());
    }
  }
}

/// The same on any space, element by element.
/// @param weights  nullptr, or those of rational functions.
template <int Dim>
void AddElementLaplacian(const SplineSpace<Dim>& space, const Eigen::VectorXd* weights,
  const std::vector<int>& numbers, Eigen::Index size, Triplets& triplets)
{
  constexpr std::size_t enough = std::size_t(1) << 22; // a function is alive on many elements
  std::size_t limit = triplets.size() + enough;
  FunctionValues basis;
  Eigen::MatrixXd slopes, products;
  for (int e = 0; e < space.NumElements(); ++e)
  {
    const auto& element = space.Elements[static_cast<std::size_t>(e)];
    IntArray<Dim> counts;
    double volume = 1.0;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      counts[d] = element.Degree[d] + (weights ? 3 : 1); // exact for polynomials
      volume *= element.Box.Upper[d] - element.Box.Lower[d];
    }
    const ElementQuadrature<Dim> rule = MakeElementQuadrature<Dim>(counts);
    for (Eigen::Index q = 0; q < rule.Local.rows(); ++q)
    {
      EvaluateFunctions<Dim>(space, e, rule.Local.row(q).data(), 1, weights, basis);
      slopes.resize(basis.Values.rows(), Dim * rule.Local.rows());
      slopes.middleCols(Dim * q, Dim) =
        std::sqrt(volume * rule.Weights[q]) * basis.Values.middleCols(1, Dim);
    }
    products.noalias() = slopes * slopes.transpose();
    for (std::size_t a = 0; a < basis.Functions.size(); ++a)
    {
      for (std::size_t b = 0; b < basis.Functions.size(); ++b)
      {
        triplets.emplace_back(numbers[static_cast<std::size_t>(basis.Functions[a])],
          numbers[static_cast<std::size_t>(basis.Functions[b])],
          products(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)));
      }
    }
    if (triplets.size() > limit)
    {
      Compress(size, triplets);
      limit = triplets.size() + enough;
    }
  }
}

template <int Dim>
void AddPairs(const SplineSpace<Dim>& space, const std::vector<int>& numbers,
  std::vector<std::array<int, 2>>& pairs)
{
  const IntArray<Dim> counts = Counts<Dim>(space);
  std::size_t i = 0;
  ForEachOffset<Dim>(counts,
    [&](const IntArray<Dim>& index)
    {
      std::size_t stride = 1;
      for (std::size_t d = 0; d < Dim; ++d)
      {
        if (index[d] + 1 < counts[d])
        {
          const auto [a, b] = std::minmax(numbers[i], numbers[i + stride]);
          pairs.push_back({ a, b });
        }
        stride *= static_cast<std::size_t>(counts[d]);
      }
      ++i;
    });
}
}

template <int Dim>
GluedSystem<Dim>::GluedSystem(const GluedMap<Dim>& map, GluedOperator kind)
{
  this->Unknown.assign(map.Fixed.size(), -1);
  for (std::size_t i = 0; i < map.Fixed.size(); ++i)
  {
    if (!map.Fixed[i])
    {
      this->Unknown[i] = static_cast<int>(this->NumFree++);
    }
  }
  Triplets all;
  std::vector<std::array<int, 2>> pairs;
  for (std::size_t p = 0; p < map.Patches.size(); ++p)
  {
    const SplineSpace<Dim>& space = *map.Patches[p].Space;
    const bool rational = kind == GluedOperator::Rational && map.Patches[p].IsRational();
    if (rational || (kind != GluedOperator::Spring && space.Kind != SpaceKind::Tensor))
    {
      AddElementLaplacian<Dim>(space, rational ? &map.Patches[p].Weights : nullptr,
        map.Functions[p], map.NumFunctions(), all);
    }
    else if (kind != GluedOperator::Spring)
    {
      AddLaplacian<Dim>(space, map.Functions[p], all);
    }
    else
    {
      AddPairs<Dim>(space, map.Functions[p], pairs);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  for (const auto& [a, b] : pairs)
  {
    all.emplace_back(a, a, 1.0);
    all.emplace_back(b, b, 1.0);
    all.emplace_back(a, b, -1.0);
    all.emplace_back(b, a, -1.0);
  }
  Triplets toAll, inner;
  for (const Eigen::Triplet<double>& entry : all)
  {
    const int row = this->Unknown[static_cast<std::size_t>(entry.row())];
    const int column = this->Unknown[static_cast<std::size_t>(entry.col())];
    if (row >= 0)
    {
      toAll.emplace_back(row, entry.col(), entry.value());
    }
    if (row >= 0 && column >= 0)
    {
      inner.emplace_back(row, column, entry.value());
    }
  }
  this->ToAll.resize(this->NumFree, map.NumFunctions());
  this->ToAll.setFromTriplets(toAll.begin(), toAll.end());
  Eigen::SparseMatrix<double> matrix(this->NumFree, this->NumFree);
  matrix.setFromTriplets(inner.begin(), inner.end());
  if (this->NumFree > 0)
  {
    this->Solver.compute(matrix);
  }
}

template <int Dim>
void GluedSystem<Dim>::Apply(Eigen::VectorXd& planes) const
{
  if (this->NumFree > 0 && this->Solver.info() == Eigen::Success)
  {
    Eigen::Map<Eigen::MatrixXd> columns(
      planes.data(), this->NumFree, planes.size() / this->NumFree);
    columns = this->Solver.solve(columns).eval();
  }
}

template <int Dim>
Status GluedSystem<Dim>::Fill(GluedMap<Dim>& map) const
{
  if (this->NumFree == 0)
  {
    return {};
  }
  Eigen::MatrixXd points = GluedPoints<Dim>(map);
  for (std::size_t i = 0; i < this->Unknown.size(); ++i)
  {
    if (this->Unknown[i] >= 0)
    {
      points.row(static_cast<Eigen::Index>(i)).setZero();
    }
  }
  Eigen::MatrixXd solution;
  if (this->Solver.info() == Eigen::Success)
  {
    solution = this->Solver.solve(-(this->ToAll * points).eval());
  }
  if (solution.rows() != this->NumFree || !solution.allFinite())
  {
    return { ErrorCode::SingularSystem, "the equations of the first map have no unique solution" };
  }
  for (std::size_t p = 0; p < map.Patches.size(); ++p)
  {
    for (std::size_t i = 0; i < map.Functions[p].size(); ++i)
    {
      const int row = this->Unknown[static_cast<std::size_t>(map.Functions[p][i])];
      if (row >= 0)
      {
        map.Patches[p].ControlPoints.row(static_cast<Eigen::Index>(i)) = solution.row(row);
      }
    }
  }
  return {};
}

template class GluedSystem<2>;
template class GluedSystem<3>;
}
