// SPDX-License-Identifier: BSD-3-Clause
#include "MeshCases.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/Refinement.h>
#include <knotwork/SplineCore/SplitIntoPatches.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <gtest/gtest.h>

using namespace knotwork;
using namespace meshes;

namespace
{
template <int Dim>
Spline<Dim> RandomSpline(
  Random& random, const CellMesh<Dim>& mesh, int degree, CreasePolicy policy, double features = 0.0)
{
  UnstructuredParams params;
  params.Degree = degree;
  params.Policy = policy;
  if (random.Unit() < features)
  {
    params.Features = RandomFacets<Dim>(random, mesh);
  }
  if (random.Unit() < 0.5)
  {
    params.Lengths.resize(
      static_cast<std::size_t>(MeshTopology<Dim>::Make(mesh)->FindSheets().Count));
    for (double& length : params.Lengths)
    {
      length = random.Int(1, 3);
    }
  }
  auto made = MakeUnstructuredSpace<Dim>(mesh, params);
  EXPECT_TRUE(made) << made.Status.Message();
  Spline<Dim> spline;
  spline.Space = made->Space;
  spline.ControlPoints.resize(spline.Space->NumFunctions, 3);
  for (Eigen::Index i = 0; i < spline.ControlPoints.size(); ++i)
  {
    spline.ControlPoints.data()[i] = random.In(-1.0, 1.0);
  }
  spline.Weights.resize(random.Unit() < 0.3 ? spline.Space->NumFunctions : 0);
  for (double& w : spline.Weights)
  {
    w = random.In(0.5, 2.0);
  }
  return spline;
}

/// Dual functionals of graded spaces and degree 4 amplify rounding by some thousand.
constexpr double Tolerance = 1e-10;

/// Every patch is the map of its cells.
template <int Dim>
void ExpectSameMap(Random& random, const Spline<Dim>& spline, const MultiPatch<Dim>& split,
  const MeshPatches<Dim>& layout)
{
  const BezierForm<Dim> form = MakeBezierForm(spline, 1);
  for (std::size_t p = 0; p < split.Patches.size(); ++p)
  {
    const std::vector<int>& cells = layout.Patches[p].Cells;
    ASSERT_EQ(split.Patches[p].Space->NumElements(), static_cast<int>(cells.size()));
    std::vector<int> elements;
    PointMatrix local(static_cast<Eigen::Index>(cells.size()), Dim);
    PointMatrix own = local;
    for (std::size_t i = 0; i < cells.size(); ++i)
    {
      elements.push_back(static_cast<int>(i));
      for (std::size_t d = 0; d < Dim; ++d)
      {
        const int ahead = layout.AheadOf[static_cast<std::size_t>(cells[i])][d];
        const double t = random.Unit();
        local(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(d)) = t;
        own(static_cast<Eigen::Index>(i), ahead / 2) = ahead % 2 == 1 ? t : 1.0 - t;
      }
    }
    EvaluationBatch a;
    EvaluationBatch b;
    ASSERT_TRUE(EvaluateElements<Dim>(MakeBezierForm(split.Patches[p], 1), elements, local, {}, a));
    ASSERT_TRUE(EvaluateElements<Dim>(form, cells, own, {}, b));
    EXPECT_LE((a.Values - b.Values).cwiseAbs().maxCoeff(), Tolerance);
  }
}

template <int Dim>
void ExpectSmooth(const MultiPatch<Dim>& split)
{
  for (const Spline<Dim>& patch : split.Patches)
  {
    for (const KnotVector& knots : patch.Space->Knots)
    {
      for (int b = 1; b < knots.NumElements(); ++b)
      {
        EXPECT_LE(knots.Multiplicity(b), knots.Degree() - 1);
      }
    }
  }
}

/// Values at a parameter of a side of a patch; of a direction each.
template <int Dim>
Eigen::RowVectorXd ValueOnSide(
  const Spline<Dim>& patch, int side, const std::array<double, 2>& parameter)
{
  const ParametricBox<Dim> domain = patch.Space->Domain();
  PointMatrix at(1, Dim);
  at(0, side / 2) = SideValue<Dim>(domain, side);
  std::size_t k = 0;
  for (const std::size_t d : SideDirections<Dim>(side))
  {
    at(0, static_cast<Eigen::Index>(d)) = parameter[k++];
  }
  EvaluationBatch batch;
  EXPECT_TRUE(EvaluateParameters<Dim>(MakeBezierForm(patch, 1), at, {}, batch));
  return batch.Values.row(0);
}

/// Stated sides are one, and every side is stated over its length.
template <int Dim>
void ExpectTopology(Random& random, const MultiPatch<Dim>& split, bool partial)
{
  ASSERT_TRUE(CheckTopology(split.Topology, static_cast<int>(split.Patches.size()), Dim));
  std::map<PatchSide, double> stated;
  for (const PatchSide& side : split.Topology.Boundary)
  {
    stated[side] += 1.0;
  }
  for (const PatchInterface& interface : split.Topology.Interfaces)
  {
    EXPECT_TRUE(partial || !interface.Partial);
    std::array<ParametricBox<2>, 2> parts = interface.Parts;
    for (std::size_t s = 0; s < 2; ++s)
    {
      const PatchSide& side = interface.Sides[s];
      const auto domain = split.Patches[static_cast<std::size_t>(side.Patch)].Space->Domain();
      double share = 1.0;
      std::size_t k = 0;
      for (const std::size_t d : SideDirections<Dim>(side.Side))
      {
        if (!interface.Partial)
        {
          parts[s].Lower[k] = domain.Lower[d];
          parts[s].Upper[k] = domain.Upper[d];
        }
        share *= (parts[s].Upper[k] - parts[s].Lower[k]) / (domain.Upper[d] - domain.Lower[d]);
        ++k;
      }
      stated[side] += share;
    }
    for (int i = 0; i < 5; ++i)
    {
      std::array<double, 2> on{};    // of side 0
      std::array<double, 2> other{}; // of side 1
      for (std::size_t k = 0; k + 1 < Dim; ++k)
      {
        const std::size_t axis = static_cast<std::size_t>(interface.Orientation.Axis[k]);
        const double t = random.Unit();
        const double u = interface.Orientation.Reversed[k] ? 1.0 - t : t;
        other[k] = (1.0 - t) * parts[1].Lower[k] + t * parts[1].Upper[k];
        on[axis] = (1.0 - u) * parts[0].Lower[axis] + u * parts[0].Upper[axis];
      }
      const auto& [a, b] = interface.Sides;
      EXPECT_LE((ValueOnSide<Dim>(split.Patches[static_cast<std::size_t>(a.Patch)], a.Side, on) -
                  ValueOnSide<Dim>(split.Patches[static_cast<std::size_t>(b.Patch)], b.Side, other))
                  .cwiseAbs()
                  .maxCoeff(),
        Tolerance);
    }
  }
  for (std::size_t p = 0; p < split.Patches.size(); ++p)
  {
    for (int s = 0; s < 2 * Dim; ++s)
    {
      const double share = stated[{ static_cast<int>(p), s }];
      EXPECT_LE(share, 1.0 + 1e-12);
      if (!partial)
      {
        EXPECT_NEAR(share, 1.0, 1e-12) << "side " << s << " of patch " << p;
      }
    }
  }
}

template <int Dim>
void ExpectSplit(Random& random, const CellMesh<Dim>& mesh, int degree, CreasePolicy policy)
{
  const Spline<Dim> spline = RandomSpline<Dim>(random, mesh, degree, policy, 0.3);
  MeshPatches<Dim> layout;
  const auto split = SplitIntoPatches(spline, 1, &layout);
  ASSERT_TRUE(split) << split.Status.Message();
  ExpectSameMap<Dim>(random, spline, split.Value, layout);
  if (degree > 1)
  {
    ExpectSmooth<Dim>(split.Value);
  }
  ExpectTopology<Dim>(random, split.Value, policy != CreasePolicy::Full);
}
}

TEST(SplitIntoPatches, RandomSplinesKeepTheirMap_PropertyOracle)
{
  for (unsigned seed = 1; seed <= 300; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto policy = static_cast<CreasePolicy>(1 + seed % 3);
    ExpectSplit<2>(random, RandomMesh<2>(random, 60), random.Int(1, 4), policy);
    if (policy != CreasePolicy::Motorcycle)
    {
      ExpectSplit<3>(random, RandomMesh<3>(random, 20), random.Int(1, 3), policy);
    }
  }
}

TEST(SplitIntoPatches, KnownMeshes_ExactOracle)
{
  Random random(1);
  const auto count = [&](const CellMesh<2>& mesh, CreasePolicy policy)
  { return SplitIntoPatches(RandomSpline<2>(random, mesh, 3, policy), 1)->Patches.size(); };
  EXPECT_EQ(count(CubeSphere(4), CreasePolicy::Full), 6U);
  EXPECT_EQ(count(Star(7, 4), CreasePolicy::Full), 7U);
  EXPECT_EQ(count(Grid<2>({ 5, 3 }), CreasePolicy::Full), 1U);
  // a torus is one patch that meets itself
  const auto torus = SplitIntoPatches(
    RandomSpline<2>(random, Grid<2>({ 6, 5 }, { true, true }), 3, CreasePolicy::Full), 1);
  ASSERT_EQ(torus->Patches.size(), 1U);
  ASSERT_EQ(torus->Topology.Interfaces.size(), 2U);
  EXPECT_EQ(torus->Topology.Interfaces[0].Sides[1], (PatchSide{ 0, 1 }));
  // refined or of a higher degree it has the same patches
  const Spline<2> sphere = RandomSpline<2>(random, CubeSphere(3), 2, CreasePolicy::Full);
  const auto fine = RefineAllElements(sphere);
  const auto elevated = ElevateAllDegrees(sphere, 1);
  EXPECT_EQ(SplitIntoPatches(fine->Value, 1)->Patches.size(), 6U);
  EXPECT_EQ(SplitIntoPatches(elevated.Value, 1)->Patches.size(), 6U);
  // smooth across cuts at no extraordinary point: all of it is recovered
  EXPECT_EQ(
    SplitIntoPatches(RandomSpline<3>(random, Sweep(Star(5, 2), 3, true), 2, CreasePolicy::Full), 1)
      ->Patches.size(),
    5U);
}

TEST(SplitIntoPatches, EveryFailureIsReachable_ExactOracle)
{
  Random random(1);
  EXPECT_EQ(SplitIntoPatches(Spline<2>(), 1).Status.Code, ErrorCode::EmptyInput);
  const KnotVector knots = KnotVector::Uniform(2, 3);
  Spline<2> tensor;
  tensor.Space = MakeTensorSpace<2>({ knots, knots }).Value;
  EXPECT_EQ(SplitIntoPatches(tensor, 1).Status.Code, ErrorCode::DimensionMismatch);
  Spline<2> spline = RandomSpline<2>(random, Star(5, 2), 2, CreasePolicy::Full);
  spline.ControlPoints.conservativeResize(3, 3);
  EXPECT_EQ(SplitIntoPatches(spline, 1).Status.Code, ErrorCode::SizeMismatch);
}
