// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "MeshCases.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/UnstructuredSpace.h>

#include <Eigen/LU>
#include <gtest/gtest.h>

/// Splines on a mesh by their definition: Bernstein coefficients on every cell that meet the
/// conditions of continuity across every facet. The facets are found by comparing points.
namespace oracle
{
using knotwork::CellMesh;
using knotwork::SplineSpace;

/// A condition: whole-number multiples of Bernstein coefficients (by number) that sum to zero.
using Condition = std::map<int, std::int64_t>;

template <int Dim>
class SmoothnessConditions
{
public:
  /// @param lengths  whole numbers, one a cell and direction.
  SmoothnessConditions(const CellMesh<Dim>& mesh, int degree, const std::vector<int>& continuity,
    const std::vector<int>& lengths)
    : Mesh(mesh), P(degree), Lengths(lengths)
  {
    std::map<std::vector<int>, std::array<int, 2>> facets;
    for (int c = 0; c < mesh.NumCells(); ++c)
    {
      for (int side = 0; side < 2 * Dim; ++side)
      {
        std::vector<int> points = this->Points(c, side);
        std::sort(points.begin(), points.end());
        const auto [place, isNew] = facets.try_emplace(points, std::array<int, 2>{ c, side });
        if (!isNew)
        {
          const int r = continuity[static_cast<std::size_t>(c * 2 * Dim + side)];
          this->AddFacet(place->second[0], place->second[1], c, side, r);
        }
      }
    }
  }
  int NumCoefficients() const { return this->Mesh.NumCells() * this->Size(); }
  const std::vector<Condition>& All() const { return this->Conditions; }

  /// Dimension of the solutions, exactly but for an unlucky prime.
  int NullSpaceDimension() const
  {
    constexpr std::uint64_t prime = 2147483647; // 2^31 - 1
    const auto inverse = [](std::uint64_t a)
    {
      std::uint64_t result = 1;
      for (std::uint64_t e = prime - 2; e > 0; e >>= 1)
      {
        result = (e & 1) != 0 ? result * a % prime : result;
        a = a * a % prime;
      }
      return result;
    };
    const auto n = static_cast<std::size_t>(this->NumCoefficients());
    std::vector<std::vector<std::pair<std::size_t, std::uint64_t>>> pivots(n);
    std::vector<std::uint64_t> row(n, 0);
    int rank = 0;
    for (const Condition& condition : this->Conditions)
    {
      std::size_t first = n;
      for (const auto& [column, factor] : condition)
      {
        const auto residue = factor % static_cast<std::int64_t>(prime);
        row[static_cast<std::size_t>(column)] = static_cast<std::uint64_t>(
          residue < 0 ? residue + static_cast<std::int64_t>(prime) : residue);
        first = std::min(first, static_cast<std::size_t>(column));
      }
      for (std::size_t column = first; column < n; ++column)
      {
        if (row[column] == 0)
        {
          continue;
        }
        if (pivots[column].empty())
        {
          const std::uint64_t scale = inverse(row[column]);
          for (std::size_t k = column; k < n; ++k)
          {
            if (row[k] != 0)
            {
              pivots[column].emplace_back(k, row[k] * scale % prime);
              row[k] = 0;
            }
          }
          ++rank;
          break;
        }
        const std::uint64_t factor = prime - row[column];
        for (const auto& [k, value] : pivots[column])
        {
          row[k] = (row[k] + factor * value) % prime;
        }
      }
    }
    return static_cast<int>(n) - rank;
  }

private:
  int Size() const
  {
    int size = 1;
    for (int d = 0; d < Dim; ++d)
    {
      size *= this->P + 1;
    }
    return size;
  }
  std::vector<int> Points(int cell, int side) const
  {
    std::vector<int> points;
    for (int corner = 0; corner < (1 << Dim); ++corner)
    {
      if ((corner >> (side / 2) & 1) == side % 2)
      {
        points.push_back(this->Mesh.Cell(cell)[corner]);
      }
    }
    return points;
  }
  /// Coefficient of a cell at a depth behind a side, and at an index on the facet.
  int Number(int cell, int side, int depth, const std::array<int, 2>& on) const
  {
    int number = 0;
    int stride = 1;
    for (int d = 0, k = 0; d < Dim; ++d, stride *= this->P + 1)
    {
      const int index = d == side / 2 ? (side % 2 == 0 ? depth : this->P - depth) : on[k++];
      number += stride * index;
    }
    return cell * this->Size() + number;
  }
  void AddFacet(int a, int sideA, int b, int sideB, int r)
  {
    const std::vector<int> pointsA = this->Points(a, sideA);
    const std::vector<int> pointsB = this->Points(b, sideB);
    const auto placeInB = [&](int corner)
    {
      const auto found =
        std::find(pointsB.begin(), pointsB.end(), pointsA[static_cast<std::size_t>(corner)]);
      return static_cast<int>(found - pointsB.begin());
    };
    const int origin = placeInB(0);
    const int layer = this->Size() / (this->P + 1);
    const auto length = [this](int cell, int side)
    { return this->Lengths[static_cast<std::size_t>(cell * Dim + side / 2)]; };
    for (int i = 0; i < layer; ++i)
    {
      const std::array<int, 2> onA{ i % (this->P + 1), i / (this->P + 1) };
      std::array<int, 2> onB{};
      for (int k = 0; k + 1 < Dim; ++k)
      {
        onB[static_cast<std::size_t>(k)] = (origin >> k & 1) * this->P;
      }
      for (int k = 0; k + 1 < Dim; ++k)
      {
        const int toward = placeInB(1 << k) ^ origin; // the bit that direction k of the facet is
        const int axis = toward == 1 ? 0 : 1;
        const int x = onA[static_cast<std::size_t>(k)];
        onB[static_cast<std::size_t>(axis)] = (origin & toward) != 0 ? this->P - x : x;
      }
      for (int order = 0; order <= r; ++order)
      {
        // differences over the lengths, times both lengths' powers
        Condition condition;
        std::int64_t binomial = 1;
        std::int64_t powerA = 1;
        std::int64_t powerB = 1;
        for (int k = 0; k < order; ++k)
        {
          powerA *= length(a, sideA);
          powerB *= length(b, sideB);
        }
        for (int k = 0; k <= order; ++k)
        {
          const std::int64_t sign = (order - k) % 2 == 0 ? 1 : -1;
          condition[this->Number(a, sideA, k, onA)] += sign * binomial * powerB;
          condition[this->Number(b, sideB, k, onB)] -=
            (order % 2 == 0 ? 1 : -1) * sign * binomial * powerA;
          binomial = binomial * (order - k) / (k + 1);
        }
        this->Conditions.push_back(std::move(condition));
      }
    }
  }

  const CellMesh<Dim>& Mesh;
  int P;
  std::vector<int> Lengths;
  std::vector<Condition> Conditions;
};

/// The functions meet the conditions, are not negative, sum to one and are independent on every
/// cell.
template <int Dim>
void ExpectFunctions(
  const SplineSpace<Dim>& space, const SmoothnessConditions<Dim>& conditions, Random& random)
{
  for (int e = 0; e < space.NumElements(); ++e)
  {
    const Eigen::MatrixXd rows = space.ExtractionOperator(e);
    ASSERT_EQ(rows.rows(), rows.cols()) << "element " << e;
    ASSERT_GE(rows.minCoeff(), 0.0) << "element " << e;
    ASSERT_LE((rows.colwise().sum().array() - 1.0).abs().maxCoeff(), 1e-13) << "element " << e;
    ASSERT_TRUE(rows.fullPivLu().isInvertible()) << "element " << e;
  }

  auto shared = std::make_shared<SplineSpace<Dim>>(space);
  knotwork::Spline<Dim> spline;
  spline.Space = shared;
  spline.ControlPoints.resize(space.NumFunctions, 1);
  for (Eigen::Index i = 0; i < spline.ControlPoints.size(); ++i)
  {
    spline.ControlPoints(i, 0) = random.In(-1.0, 1.0);
  }
  const auto form = knotwork::MakeBezierForm(spline, 1);
  for (const Condition& condition : conditions.All())
  {
    double sum = 0.0;
    double size = 0.0;
    for (const auto& [coefficient, factor] : condition)
    {
      const double term =
        static_cast<double>(factor) * form.Data[static_cast<std::size_t>(coefficient)];
      sum += term;
      size += std::fabs(static_cast<double>(factor));
    }
    // roundings of some dozen products of coefficients below 1
    ASSERT_LE(std::fabs(sum), 1e-12 * size);
  }
}

/// They are a basis of all splines with the continuities of the space.
template <int Dim>
void ExpectBasis(const SplineSpace<Dim>& space, const std::vector<int>& lengths, Random& random)
{
  const SmoothnessConditions<Dim> conditions(
    knotwork::MeshOf(space), space.Elements[0].Degree[0], knotwork::ContinuityOf(space), lengths);
  ASSERT_EQ(space.NumFunctions, conditions.NullSpaceDimension());
  ExpectFunctions(space, conditions, random);
}

/// Random lengths from 1 to `most` for the sheets, and what they are on cells.
template <int Dim>
std::vector<int> RandomLengths(
  Random& random, const CellMesh<Dim>& mesh, int most, std::vector<double>& ofSheets)
{
  const auto sheets = knotwork::MeshTopology<Dim>::Make(mesh).Value.FindSheets();
  ofSheets.clear();
  for (int s = 0; s < sheets.Count; ++s)
  {
    ofSheets.push_back(random.Int(1, most));
  }
  std::vector<int> lengths;
  for (const int sheet : sheets.Of)
  {
    lengths.push_back(static_cast<int>(ofSheets[static_cast<std::size_t>(sheet)]));
  }
  if (most == 1)
  {
    ofSheets.clear();
  }
  return lengths;
}

/// Random control points of three components.
template <int Dim>
knotwork::Spline<Dim> RandomMap(
  Random& random, const knotwork::SplineSpacePtr<Dim>& space, bool rational)
{
  knotwork::Spline<Dim> spline;
  spline.Space = space;
  spline.ControlPoints.resize(space->NumFunctions, 3);
  for (Eigen::Index i = 0; i < spline.ControlPoints.size(); ++i)
  {
    spline.ControlPoints.data()[i] = random.In(-1.0, 1.0);
  }
  spline.Weights.resize(rational ? space->NumFunctions : 0);
  for (double& w : spline.Weights)
  {
    w = random.In(0.5, 2.0);
  }
  return spline;
}

/// On a random mesh, whose knot intervals are the lengths.
template <int Dim>
knotwork::Spline<Dim> RandomSpline(
  Random& random, int mostDegree, int mostCells, std::vector<int>& lengths)
{
  const CellMesh<Dim> mesh = meshes::RandomMesh<Dim>(random, mostCells);
  knotwork::UnstructuredParams params;
  params.Degree = random.Int(1, mostDegree);
  params.Policy =
    random.Unit() < 0.5 ? knotwork::CreasePolicy::Automatic : knotwork::CreasePolicy::Minimal;
  lengths = RandomLengths(random, mesh, random.Unit() < 0.5 ? 1 : 3, params.Lengths);
  auto made = knotwork::MakeUnstructuredSpace<Dim>(mesh, params);
  EXPECT_TRUE(made) << made.Status.Message();
  return RandomMap<Dim>(random, made->Space, random.Unit() < 0.3);
}

template <int Dim>
void ExpectRandomSpace(unsigned seed, int mostDegree, int mostCells)
{
  SCOPED_TRACE("seed " + std::to_string(seed));
  Random random(seed);
  const CellMesh<Dim> mesh = meshes::RandomMesh<Dim>(random, mostCells);
  knotwork::UnstructuredParams params;
  params.Degree = random.Int(1, mostDegree);
  const int policy = random.Int(0, 3);
  params.Policy = policy == 0 ? knotwork::CreasePolicy::Automatic
    : policy == 1             ? knotwork::CreasePolicy::Full
    : policy == 2 && Dim == 2 ? knotwork::CreasePolicy::Motorcycle
                              : knotwork::CreasePolicy::Minimal;
  const std::vector<int> lengths =
    RandomLengths(random, mesh, random.Unit() < 0.5 ? 1 : 3, params.Lengths);
  const auto topology = knotwork::MeshTopology<Dim>::Make(mesh);
  for (int features = random.Unit() < 0.3 ? random.Int(1, 4) : 0; features > 0; --features)
  {
    const knotwork::CellSide side{ random.Int(0, mesh.NumCells() - 1), random.Int(0, 2 * Dim - 1) };
    if (!topology.Value.IsBoundary(side.Cell, side.Side))
    {
      params.Features.push_back(side);
    }
  }
  const auto made = knotwork::MakeUnstructuredSpace<Dim>(mesh, params);
  ASSERT_TRUE(made) << made.Status.Message();
  SCOPED_TRACE("degree " + std::to_string(params.Degree) + ", policy " +
    std::to_string(static_cast<int>(made->Policy)) + ", " + std::to_string(mesh.NumCells()) +
    " cells, " + std::to_string(made->Repairs) + " repairs");
  for (const knotwork::CellSide& side : params.Features)
  {
    EXPECT_EQ(knotwork::ContinuityOf(
                *made->Space)[static_cast<std::size_t>(side.Cell * 2 * Dim + side.Side)],
      0);
  }
  ExpectBasis<Dim>(*made->Space, lengths, random);
}
}
