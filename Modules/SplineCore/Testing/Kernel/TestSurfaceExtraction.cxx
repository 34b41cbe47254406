// SPDX-License-Identifier: BSD-3-Clause
#include "LRCases.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/HierarchicalSpace.h>
#include <knotwork/SplineCore/SurfaceExtraction.h>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
/// A surface and its parameters (u, v) in terms of those of what was extracted.
template <int Dim, typename Parameters>
double WorstDifference(
  const Spline<2>& surface, const Spline<Dim>& extracted, Parameters&& parameters)
{
  Random random(1);
  const auto domain = extracted.Space->Domain();
  PointMatrix mine(200, Dim);
  PointMatrix theirs(200, 2);
  for (Eigen::Index i = 0; i < mine.rows(); ++i)
  {
    for (int d = 0; d < Dim; ++d)
    {
      mine(i, d) = random.In(domain.Lower[d], domain.Upper[d]);
    }
    const std::array<double, 2> uv = parameters(mine.row(i).data());
    theirs.row(i) << uv[0], uv[1];
  }
  EvaluationBatch a, b;
  EXPECT_TRUE(EvaluateParameters(MakeBezierForm(extracted), mine, {}, a));
  EXPECT_TRUE(EvaluateParameters(MakeBezierForm(surface), theirs, {}, b));
  return (a.Values - b.Values).cwiseAbs().maxCoeff();
}

/// Random surfaces, tensor-product and locally refined, polynomial and rational.
std::vector<Spline<2>> Surfaces()
{
  std::vector<Spline<2>> surfaces;
  for (unsigned seed = 1; seed <= 12; ++seed)
  {
    Random random(seed);
    surfaces.push_back(RandomClampedSurface(random, 4, 4, 3, seed % 2 == 0));
    if (seed % 3 != 0)
    {
      const auto segments = RandomSegments(random, surfaces.back().Space, 5);
      surfaces.back() = InsertSegments(surfaces.back(), segments, 0).Value;
    }
  }
  return surfaces;
}
}

TEST(ExtractFromSurface, StepsInTheirOrder_PropertyOracle)
{
  for (const Spline<2>& surface : Surfaces())
  {
    const auto domain = surface.Space->Domain();
    ExtractionParams params;
    params.Restrict = true;
    for (std::size_t d = 0; d < 2; ++d)
    {
      const double size = domain.Upper[d] - domain.Lower[d];
      params.Box.Lower[d] = domain.Lower[d] + 0.17 * size;
      params.Box.Upper[d] = domain.Lower[d] + 0.83 * size;
    }
    params.Swap = true;
    params.Reverse = { true, false };
    // the first parameter is the second one, reversed in the box
    const auto parameters = [&](const double* t) {
      return std::array<double, 2>{ t[1], params.Box.Lower[1] + params.Box.Upper[1] - t[0] };
    };
    const auto part = ExtractFromSurface(surface, params);
    ASSERT_TRUE(part) << part.Status.Message();
    const auto& extracted = std::get<Spline<2>>(part.Value);
    EXPECT_EQ(extracted.Space->Kind, surface.Space->Kind);
    // points up to 10, a few dozen insertions
    EXPECT_LE(WorstDifference(surface, extracted, parameters), 1e-12);

    params.ExpandToTensor = true;
    const auto tensor = ExtractFromSurface(surface, params);
    ASSERT_TRUE(tensor) << tensor.Status.Message();
    EXPECT_EQ(std::get<Spline<2>>(tensor.Value).Space->Kind, SpaceKind::Tensor);
    EXPECT_LE(WorstDifference(surface, std::get<Spline<2>>(tensor.Value), parameters), 1e-12);

    ExtractionParams moved = params;
    moved.MoveDomain = true;
    moved.Domain = { { 10.0, -3.0 }, { 10.5, 4.0 } };
    const auto elsewhere = ExtractFromSurface(surface, moved);
    ASSERT_TRUE(elsewhere) << elsewhere.Status.Message();
    const auto back = [&](const double* t)
    {
      double old[2];
      for (std::size_t d = 0; d < 2; ++d) // parameters are exchanged
      {
        const double share =
          (t[d] - moved.Domain.Lower[d]) / (moved.Domain.Upper[d] - moved.Domain.Lower[d]);
        old[d] =
          params.Box.Lower[1 - d] + share * (params.Box.Upper[1 - d] - params.Box.Lower[1 - d]);
      }
      return parameters(old);
    };
    EXPECT_LE(WorstDifference(surface, std::get<Spline<2>>(elsewhere.Value), back), 1e-11);

    params.IsoDirection = 1;
    params.IsoValue = 0.4 * params.Box.Lower[0] + 0.6 * params.Box.Upper[0];
    const auto curve = ExtractFromSurface(surface, params);
    ASSERT_TRUE(curve) << curve.Status.Message();
    EXPECT_LE(WorstDifference(surface, std::get<Spline<1>>(curve.Value),
                [&](const double* t)
                {
                  const double both[2] = { t[0], params.IsoValue };
                  return parameters(both);
                }),
      1e-12);
  }
}

TEST(ExtractFromSurface, NothingToDoChangesNothing_ExactOracle)
{
  for (const Spline<2>& surface : Surfaces())
  {
    const auto same = ExtractFromSurface(surface, {});
    ASSERT_TRUE(same) << same.Status.Message();
    const auto& spline = std::get<Spline<2>>(same.Value);
    EXPECT_EQ(spline.Space->Kind, surface.Space->Kind);
    EXPECT_EQ(spline.ControlPoints, surface.ControlPoints);
    EXPECT_EQ(spline.Weights, surface.Weights);
  }
}

TEST(ExtractFromSurface, Failures_ExactOracle)
{
  const Spline<2> surface = Surfaces()[2]; // a tensor product
  const auto code = [](const Spline<2>& spline, const ExtractionParams& params)
  { return ExtractFromSurface(spline, params).Status.Code; };
  ExtractionParams params;
  params.Restrict = true; // to a box without an area
  EXPECT_EQ(code(surface, params), ErrorCode::OutsideDomain);
  params = {};
  params.IsoDirection = 2;
  EXPECT_EQ(code(surface, params), ErrorCode::InvalidParameter);
  params.IsoDirection = 0;
  params.IsoValue = surface.Space->Domain().Upper[0] + 1.0;
  EXPECT_EQ(code(surface, params), ErrorCode::OutsideDomain);
  Spline<2> hierarchical = surface;
  hierarchical.Space = RefineElements<2>(surface.Space, { 0 }, {}).Value;
  hierarchical.ControlPoints = PointMatrix::Ones(hierarchical.Space->NumFunctions, 3);
  hierarchical.Weights.resize(0);
  EXPECT_EQ(code(hierarchical, {}), ErrorCode::DimensionMismatch);
}

TEST(ExtractFromSurface, SameForAnyNumberOfThreads_PropertyOracle)
{
  Random random(4);
  const Spline<2> tensor = RandomClampedSurface(random, 3, 6, 3, true);
  const auto surface = InsertSegments(tensor, RandomSegments(random, tensor.Space, 20), 0);
  ASSERT_TRUE(surface) << surface.Status.Message();
  const ParametricBox<2> domain = tensor.Space->Domain();
  ExtractionParams params;
  params.Restrict = params.Swap = params.ExpandToTensor = true;
  params.Reverse = { true, true };
  for (std::size_t d = 0; d < 2; ++d)
  {
    const double length = domain.Upper[d] - domain.Lower[d];
    params.Box.Lower[d] = domain.Lower[d] + 0.2 * length;
    params.Box.Upper[d] = domain.Lower[d] + 0.9 * length;
  }
  std::vector<Spline<2>> results;
  for (const int threads : { 0, 1, 3 })
  {
    params.Threads = threads;
    const auto result = ExtractFromSurface(surface.Value, params);
    ASSERT_TRUE(result) << result.Status.Message();
    results.push_back(std::get<Spline<2>>(result.Value));
    EXPECT_EQ(results.back().ControlPoints, results.front().ControlPoints);
    EXPECT_EQ(results.back().Weights, results.front().Weights);
    EXPECT_EQ(results.back().Space->Knots, results.front().Space->Knots);
  }
}
