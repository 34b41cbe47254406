// SPDX-License-Identifier: BSD-3-Clause
// Derivatives from either side of knots: those of the polynomial pieces, written out.
#include <knotwork/SplineCore/OneSidedLocation.h>

#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/HierarchicalSpace.h>
#include <knotwork/SplineCore/LRRefinement.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <gtest/gtest.h>

using namespace knotwork;

namespace
{
template <int Dim>
EvaluationBatch At(const Spline<Dim>& spline, const RealArray<Dim>& u,
  const std::array<bool, static_cast<std::size_t>(Dim)>& fromBelow)
{
  PointMatrix local(1, Dim);
  const int e = LocateOneSided<Dim>(*spline.Space, u.data(), fromBelow, local.data());
  EXPECT_GE(e, 0);
  EvaluationParams params;
  params.Derivatives = 2;
  EvaluationBatch batch;
  EXPECT_TRUE(EvaluateElements<Dim>(MakeBezierForm<Dim>(spline), { e }, local, params, batch));
  return batch;
}

/// |u - 1| + 2 |v - 2| + u v over [0, 3] x [0, 4], bilinear with unit knots.
Spline<2> Roof()
{
  Spline<2> roof;
  roof.Space =
    MakeTensorSpace<2>({ KnotVector::Uniform(1, 3, 0.0, 3.0), KnotVector::Uniform(1, 4, 0.0, 4.0) })
      .Value;
  roof.ControlPoints.resize(20, 1);
  for (int i = 0; i < 20; ++i)
  {
    const double u = i % 4;
    const double v = i / 4;
    roof.ControlPoints(i, 0) = std::fabs(u - 1.0) + 2.0 * std::fabs(v - 2.0) + u * v;
  }
  return roof;
}
}

TEST(OneSidedLocation, SecondDerivativesOfAQuadraticBSpline_ExactOracle)
{
  // N on 0, 1, 2, 3: t^2 / 2, (-2 t^2 + 6 t - 3) / 2, (3 - t)^2 / 2
  Spline<1> spline;
  const auto knots = KnotVector::Create(2, { -2.0, -2.0, -2.0, 0.0, 1.0, 2.0, 3.0, 5.0, 5.0, 5.0 });
  ASSERT_TRUE(knots);
  spline.Space = MakeTensorSpace<1>({ knots.Value }).Value;
  spline.ControlPoints = PointMatrix::Zero(7, 1);
  spline.ControlPoints(3, 0) = 1.0;
  const double second[] = { 0.0, 1.0, -2.0, 1.0, 0.0 };
  const double first[] = { 0.0, 1.0, -1.0, 0.0 };
  for (int knot = 0; knot <= 3; ++knot)
  {
    const EvaluationBatch below = At<1>(spline, { 1.0 * knot }, { true });
    const EvaluationBatch above = At<1>(spline, { 1.0 * knot }, { false });
    EXPECT_NEAR(below.Second(0, 0), second[knot], 1e-14);
    EXPECT_NEAR(above.Second(0, 0), second[knot + 1], 1e-14);
    EXPECT_NEAR(below.First(0, 0), first[knot], 1e-14);
    EXPECT_NEAR(above.First(0, 0), first[knot], 1e-14);
  }
  // between knots and at the lower end of the domain there is one derivative
  EXPECT_NEAR(At<1>(spline, { 1.5 }, { true }).Second(0, 0), -2.0, 1e-14);
  EXPECT_NEAR(At<1>(spline, { -2.0 }, { true }).Second(0, 0), 0.0, 1e-14);
  double local = 0.0;
  const double outside = 5.5;
  EXPECT_EQ(LocateOneSided<1>(*spline.Space, &outside, { true }, &local), -1);
}

TEST(OneSidedLocation, FoldsOfARoofInAllFamilies_ExactOracle)
{
  const Spline<2> tensor = Roof();
  // lines that end in the middle of the domain, at and beside the folds
  auto lines = InsertSegments(
    tensor, { { 0, 0.5, 0.0, 2.0, 1 }, { 1, 1.5, 0.0, 1.0, 1 }, { 0, 1.5, 2.0, 4.0, 1 } }, 1);
  ASSERT_TRUE(lines) << lines.Status.Message();
  RefinementParams params;
  const auto fine = RefineElements<2>(tensor.Space, { 4, 7 }, params);
  ASSERT_TRUE(fine);
  const auto levels = TransferToRefined<2>(tensor, fine.Value);
  ASSERT_TRUE(levels);
  for (const Spline<2>& spline : { tensor, lines.Value, levels.Value })
  {
    for (const bool below : { false, true })
    {
      for (const bool left : { false, true })
      {
        // on both folds, on one of them each, on none
        for (const RealArray<2> u :
          { RealArray<2>{ 1.0, 2.0 }, { 1.0, 0.7 }, { 2.3, 2.0 }, { 1.3, 1.1 }, { 2.0, 3.0 } })
        {
          const EvaluationBatch batch = At<2>(spline, u, { left, below });
          const double du = (u[0] > 1.0 || (u[0] == 1.0 && !left) ? 1.0 : -1.0) + u[1];
          const double dv = (u[1] > 2.0 || (u[1] == 2.0 && !below) ? 2.0 : -2.0) + u[0];
          EXPECT_NEAR(batch.First(0, 0), du, 1e-13);
          EXPECT_NEAR(batch.First(0, 1), dv, 1e-13);
          EXPECT_NEAR(batch.Values(0, 0),
            std::fabs(u[0] - 1.0) + 2.0 * std::fabs(u[1] - 2.0) + u[0] * u[1], 1e-13);
        }
      }
    }
  }
}

TEST(OneSidedLocation, JumpsOfVolumes_ExactOracle)
{
  // degree 1 with a double knot at w = 1: values jump from 3 to 7
  const KnotVector line = KnotVector::Uniform(1, 1);
  const auto jump = KnotVector::Create(1, { 0.0, 0.0, 1.0, 1.0, 2.0, 2.0 });
  ASSERT_TRUE(jump);
  Spline<3> spline;
  spline.Space = MakeTensorSpace<3>({ line, line, jump.Value }).Value;
  spline.ControlPoints.resize(16, 1);
  const double heights[] = { 1.0, 3.0, 7.0, 8.0 };
  for (int i = 0; i < 16; ++i)
  {
    spline.ControlPoints(i, 0) = heights[i / 4];
  }
  const EvaluationBatch below = At<3>(spline, { 0.5, 0.25, 1.0 }, { false, false, true });
  const EvaluationBatch above = At<3>(spline, { 0.5, 0.25, 1.0 }, { true, true, false });
  EXPECT_NEAR(below.Values(0, 0), 3.0, 1e-14);
  EXPECT_NEAR(above.Values(0, 0), 7.0, 1e-14);
  EXPECT_NEAR(below.First(0, 2), 2.0, 1e-14);
  EXPECT_NEAR(above.First(0, 2), 1.0, 1e-14);
}

TEST(OneSidedLocation, KnotsFarFromTheOrigin_ExactOracle)
{
  Spline<2> roof = Roof();
  roof.Space = MakeTensorSpace<2>(
    { KnotVector::Uniform(1, 3, 5e6, 5e6 + 0.3), KnotVector::Uniform(1, 4, -7e5, -7e5 + 0.04) })
                 .Value;
  const RealArray<2> at{ roof.Space->Knots[0].Knots()[2], roof.Space->Knots[1].Knots()[3] };
  const EvaluationBatch below = At<2>(roof, at, { true, true });
  const EvaluationBatch above = At<2>(roof, at, { false, false });
  // steps of 0.1 and 0.01 are known to 1e-9 and 1e-10 there
  EXPECT_NEAR(above.First(0, 0) - below.First(0, 0), 20.0, 1e-5);
  EXPECT_NEAR(above.First(0, 1) - below.First(0, 1), 400.0, 1e-4);
}
