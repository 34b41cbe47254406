// SPDX-License-Identifier: BSD-3-Clause
#include "DomainCases.h"
#include "GluedSystem.h"
#include "InitialMaps.h"
#include <knotwork/SplineCore/HierarchicalSpace.h>

#include <gtest/gtest.h>

namespace knotwork
{
namespace
{
template <int Dim>
std::array<KnotVector, Dim> SomeKnots(int degree)
{
  std::array<KnotVector, Dim> knots;
  for (int d = 0; d < Dim; ++d)
  {
    std::vector<double> t(static_cast<std::size_t>(degree) + 1, 0.0);
    t.insert(t.end(), { 0.2, 0.3 + 0.1 * d, 0.75 });
    t.insert(t.end(), static_cast<std::size_t>(degree) + 1, 1.0);
    knots[static_cast<std::size_t>(d)] = KnotVector::Create(degree, t).Value;
  }
  return knots;
}

template <int Dim>
std::array<double, Dim> Multilinear(const std::array<double, Dim>& u)
{
  std::array<double, Dim> x = u;
  double product = 1.0;
  for (double t : u)
  {
    product *= t;
  }
  for (int d = 0; d < Dim; ++d)
  {
    x[d] = 2.0 * u[d] + 0.3 * u[(d + 1) % Dim] - 0.25 * (d + 1) * product + d;
  }
  return x;
}

template <int Dim>
std::array<double, Dim> Affine(const std::array<double, Dim>& u)
{
  std::array<double, Dim> x = u;
  for (int d = 0; d < Dim; ++d)
  {
    x[d] = 2.0 * u[d] + 0.3 * u[(d + 1) % Dim] + d;
  }
  return x;
}

template <int Dim>
double Difference(const Spline<Dim>& a, const Spline<Dim>& b)
{
  return (a.ControlPoints - b.ControlPoints).cwiseAbs().maxCoeff();
}

template <int Dim>
void ExpectReproduction(int degree)
{
  const Spline<Dim> multilinear = cases::GrevilleMap<Dim>(SomeKnots<Dim>(degree), Multilinear<Dim>);
  const auto boundary = MakeCompatible<Dim>(cases::SidesOf<Dim>(multilinear));
  ASSERT_TRUE(boundary) << boundary.Status.Message();
  Spline<Dim> map = MapOfBoundary<Dim>(boundary.Value);
  FillCoons<Dim>(map);
  EXPECT_LE(Difference<Dim>(map, multilinear), 1e-14 * 16); // sums of 26 products of size 3

  const Spline<Dim> affine = cases::GrevilleMap<Dim>(SomeKnots<Dim>(degree), Affine<Dim>);
  const auto sides = MakeCompatible<Dim>(cases::SidesOf<Dim>(affine));
  ASSERT_TRUE(sides) << sides.Status.Message();
  map = MapOfBoundary<Dim>(sides.Value);
  EXPECT_GT(Difference<Dim>(map, affine), 0.1); // the inner points are not there yet
  ASSERT_TRUE(FillHarmonic<Dim>(map));
  EXPECT_LE(Difference<Dim>(map, affine), 1e-10); // condition of the bending energy
}

TEST(InitialMaps, CoonsReproducesMultilinearAndHarmonicAffineMaps_ExactOracle)
{
  for (int degree = 1; degree <= 4; ++degree)
  {
    SCOPED_TRACE("degree " + std::to_string(degree));
    ExpectReproduction<2>(degree);
  }
  ExpectReproduction<3>(1);
  ExpectReproduction<3>(2);
  ExpectReproduction<3>(3);
}

namespace
{
/// Products of parameters are harmonic, so among all maps with their boundary they have the least
/// int grad . grad, in any space that contains them.
template <int Dim>
void ExpectHarmonicOnRefined(int degree)
{
  const Spline<Dim> exact = cases::GrevilleMap<Dim>(SomeKnots<Dim>(degree), Multilinear<Dim>);
  RefinementParams params;
  params.Extension = 1;
  auto space = RefineElements<Dim>(exact.Space, { 0, 5 }, params).Value;
  space = RefineElements<Dim>(space, { space->NumElements() - 1 }, params).Value;
  const auto refined = TransferToRefined<Dim>(exact, space);
  ASSERT_TRUE(refined) << refined.Status.Message();
  ASSERT_EQ(space->Kind, SpaceKind::Hierarchical);
  GluedMap<Dim> map = SingleMap<Dim>(refined.Value);
  int moved = 0;
  for (std::size_t i = 0; i < map.Fixed.size(); ++i)
  {
    if (!map.Fixed[i])
    {
      map.Patches[0].ControlPoints.row(static_cast<Eigen::Index>(i)).array() += 1.0;
      ++moved;
    }
  }
  EXPECT_GT(moved, 10);
  EXPECT_GT(Difference<Dim>(map.Patches[0], refined.Value), 0.9);
  const GluedSystem<Dim> system(map, GluedOperator::Laplacian);
  ASSERT_TRUE(system.Fill(map));
  // rounding of sums over elements and of a factorization, condition some thousands
  EXPECT_LE(Difference<Dim>(map.Patches[0], refined.Value), 1e-11);
}
}

TEST(InitialMaps, HarmonicOnRefinedSpacesReproducesMultilinearMaps_ExactOracle)
{
  for (int degree = 2; degree <= 3; ++degree)
  {
    SCOPED_TRACE(degree);
    ExpectHarmonicOnRefined<2>(degree);
    ExpectHarmonicOnRefined<3>(degree);
  }
}

TEST(InitialMaps, SpringPointsAreMeansOfTheirNeighbours_PropertyOracle)
{
  const auto boundary = MakeCompatible<2>(cases::AnnulusSector());
  Spline<2> map = MapOfBoundary<2>(boundary.Value);
  map = InsertKnots<2>(map, 0, { 0.25, 0.5, 0.75 }).Value;
  map = InsertKnots<2>(map, 1, { 0.5 }).Value;
  ASSERT_TRUE(FillSpring<2>(map));
  const int n = map.Space->Knots[0].NumFunctions();
  const int m = map.Space->Knots[1].NumFunctions();
  for (int j = 1; j + 1 < m; ++j)
  {
    for (int i = 1; i + 1 < n; ++i)
    {
      const auto& p = map.ControlPoints;
      const int k = i + n * j;
      EXPECT_LE(
        (4.0 * p.row(k) - p.row(k - 1) - p.row(k + 1) - p.row(k - n) - p.row(k + n)).norm(), 1e-13);
    }
  }
}

TEST(InitialMaps, CoonsOfAnAnnulusSectorIsTheAnnulusSector_ExactOracle)
{
  const auto boundary = MakeCompatible<2>(cases::AnnulusSector());
  ASSERT_TRUE(boundary) << boundary.Status.Message();
  Spline<2> map = MapOfBoundary<2>(boundary.Value);
  FillWeights<2>(map);
  FillCoons<2>(map);
  oracle::Random random(3);
  for (int i = 0; i < 100; ++i)
  {
    const std::array<double, 2> u{ random.Unit(), random.Unit() };
    const auto x = oracle::Evaluate<2>(map, u);
    EXPECT_NEAR(std::hypot(x[0], x[1]), 1.0 + u[0], 1e-14 * 8);
  }
}

TEST(InitialMaps, BoundaryRowsAreTheSidesBits_ExactOracle)
{
  const auto boundary = MakeCompatible<2>(cases::AnnulusSector());
  Spline<2> map = MapOfBoundary<2>(boundary.Value);
  FillWeights<2>(map);
  FillCoons<2>(map);
  const DomainBoundary<2> sides = cases::SidesOf<2>(map);
  for (std::size_t s = 0; s < 4; ++s)
  {
    EXPECT_TRUE(sides.Sides[s].ControlPoints == boundary->Sides[s].ControlPoints);
    EXPECT_TRUE(sides.Sides[s].Weights == boundary->Sides[s].Weights);
  }
}
}
}
