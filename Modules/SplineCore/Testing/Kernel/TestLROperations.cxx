// SPDX-License-Identifier: BSD-3-Clause
#include "LRCases.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/LROperations.h>

#include <gtest/gtest.h>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
constexpr double Tolerance = 1e-13 * 10; // coefficients are at most 10

Spline<2> RandomSurface(unsigned seed)
{
  Random random(seed);
  const Spline<2> tensor = RandomClampedSurface(random, 4, 4, 2, seed % 3 == 0);
  const auto surface =
    InsertSegments(tensor, RandomSegments(random, tensor.Space, random.Int(1, 10)), 0);
  EXPECT_TRUE(surface) << surface.Status.Message();
  return surface.Value;
}

PointMatrix Values(const Spline<2>& spline, const PointMatrix& points)
{
  EvaluationBatch batch;
  const Status status = EvaluateParameters(MakeBezierForm(spline), points, {}, batch);
  EXPECT_TRUE(status) << status.Message();
  return batch.Values;
}

/// Parameters inside elements, where the values on both sides of a line do not matter.
PointMatrix InnerParameters(Random& random, const SplineSpace<2>& space, int n)
{
  PointMatrix points(n, 2);
  const ParametricBox<2> domain = space.Domain();
  for (Eigen::Index i = 0; i < points.size(); ++i)
  {
    points.data()[i] = random.In(domain.Lower[i % 2], domain.Upper[i % 2]);
  }
  return points;
}

double Distance(const PointMatrix& a, const PointMatrix& b)
{
  return (a - b).cwiseAbs().maxCoeff();
}
}

TEST(LROperations, ExpansionIsTheSameMap_CrossOracle)
{
  for (unsigned seed = 1; seed <= 30; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Spline<2> surface = RandomSurface(seed);
    const auto tensor = ExpandToTensor(surface, 0);
    ASSERT_TRUE(tensor) << tensor.Status.Message();
    EXPECT_EQ(tensor->Space->Kind, SpaceKind::Tensor);
    ASSERT_TRUE(tensor->Check());
    Random random(seed);
    const PointMatrix points = InnerParameters(random, *surface.Space, 50);
    EXPECT_LE(Distance(Values(surface, points), Values(*tensor.operator->(), points)), Tolerance);
  }
}

TEST(LROperations, SwapAndReversal_ExactOracle)
{
  for (unsigned seed = 1; seed <= 30; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Spline<2> surface = RandomSurface(seed);
    Random random(seed);
    const PointMatrix points = InnerParameters(random, *surface.Space, 50);
    const PointMatrix values = Values(surface, points);
    const auto swapped = SwapParameters(surface, 0);
    ASSERT_TRUE(swapped) << swapped.Status.Message();
    EXPECT_LE(Distance(Values(swapped.Value, points.rowwise().reverse()), values), Tolerance);
    const auto twice = SwapParameters(swapped.Value, 0);
    EXPECT_TRUE(twice->Space->LocallyRefined->Basis == surface.Space->LocallyRefined->Basis);
    EXPECT_EQ(twice->ControlPoints, surface.ControlPoints);
    const ParametricBox<2> domain = surface.Space->Domain();
    for (int d = 0; d < 2; ++d)
    {
      const auto reversed = ReverseParameter(surface, d, 0);
      ASSERT_TRUE(reversed) << reversed.Status.Message();
      PointMatrix mirrored = points;
      mirrored.col(d).array() = domain.Lower[d] + domain.Upper[d] - points.col(d).array();
      EXPECT_LE(Distance(Values(reversed.Value, mirrored), values), 10 * Tolerance);
    }
  }
}

/// The ends are exact, also of domains whose length is no multiple of that of the old one; the
/// domain of its own changes no bit.
TEST(LROperations, MovedDomainIsTheSameMap_ExactOracle)
{
  for (unsigned seed = 1; seed <= 30; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Spline<2> surface = RandomSurface(seed);
    const ParametricBox<2> old = surface.Space->Domain();
    Random random(seed);
    ParametricBox<2> domain;
    for (int d = 0; d < 2; ++d)
    {
      domain.Lower[d] = random.In(-50.0, 50.0);
      domain.Upper[d] = domain.Lower[d] + random.In(0.01, 70.0);
    }
    const auto moved = MoveDomain(surface, domain, 0);
    ASSERT_TRUE(moved) << moved.Status.Message();
    EXPECT_EQ(moved->Space->Domain().Lower, domain.Lower);
    EXPECT_EQ(moved->Space->Domain().Upper, domain.Upper);
    EXPECT_EQ(moved->ControlPoints, surface.ControlPoints);
    const PointMatrix points = InnerParameters(random, *surface.Space, 50);
    PointMatrix there = points;
    for (int d = 0; d < 2; ++d)
    {
      const double scale = (domain.Upper[d] - domain.Lower[d]) / (old.Upper[d] - old.Lower[d]);
      there.col(d).array() = domain.Lower[d] + (points.col(d).array() - old.Lower[d]) * scale;
    }
    // parameters of size 100 in domains of length 0.01: 1e-12 of the length
    EXPECT_LE(Distance(Values(moved.Value, there), Values(surface, points)), 1e-9);
    const auto same = MoveDomain(surface, old, 0);
    EXPECT_TRUE(same->Space->LocallyRefined->Basis == surface.Space->LocallyRefined->Basis);
  }
}

TEST(LROperations, RestrictionIsTheSameMap_CrossOracle)
{
  for (unsigned seed = 1; seed <= 30; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Spline<2> surface = RandomSurface(seed);
    const ParametricBox<2> domain = surface.Space->Domain();
    Random random(seed);
    ParametricBox<2> box;
    for (int d = 0; d < 2; ++d)
    {
      const double length = domain.Upper[d] - domain.Lower[d];
      const auto& knots = surface.Space->LocallyRefined->Basis.Knots[d];
      box.Lower[d] = random.Unit() < 0.3 ? knots[0] : domain.Lower[d] + length * random.In(0, 0.4);
      box.Upper[d] =
        random.Unit() < 0.3 ? knots.back() : domain.Upper[d] - length * random.In(0, 0.4);
    }
    const auto part = RestrictToBox(surface, box, 0);
    ASSERT_TRUE(part) << part.Status.Message();
    EXPECT_EQ(part->Space->Domain().Lower, box.Lower);
    EXPECT_EQ(part->Space->Domain().Upper, box.Upper);
    const PointMatrix points = InnerParameters(random, *part->Space, 50);
    EXPECT_LE(Distance(Values(surface, points), Values(part.Value, points)), Tolerance);
  }
}

TEST(LROperations, IsoCurvesLieOnTheSurface_CrossOracle)
{
  for (unsigned seed = 1; seed <= 30; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Spline<2> surface = RandomSurface(seed);
    const ParametricBox<2> domain = surface.Space->Domain();
    Random random(seed);
    for (int turn = 0; turn < 6; ++turn)
    {
      const int d = turn % 2;
      const auto& knots = surface.Space->LocallyRefined->Basis.Knots[d];
      const double value = turn < 2 ? random.In(domain.Lower[d], domain.Upper[d])
        : turn < 4                  ? knots[random.Int(0, static_cast<int>(knots.size()) - 1)]
                                    : domain.Upper[d];
      const auto curve = IsoCurve(surface, d, value, 0);
      ASSERT_TRUE(curve) << curve.Status.Message();
      PointMatrix points = InnerParameters(random, *surface.Space, 20);
      points.col(d).setConstant(value);
      EvaluationBatch batch;
      ASSERT_TRUE(EvaluateParameters<1>(MakeBezierForm(curve.Value), points.col(1 - d), {}, batch));
      // a blossom reaches over the function's support: elements that differ in length by up to 50
      EXPECT_LE(Distance(batch.Values, Values(surface, points)), 1e-10);
    }
  }
}

TEST(LROperations, EveryFailureIsReachable_ExactOracle)
{
  Random random(1);
  const Spline<2> tensor = RandomClampedSurface(random, 2, 3, 2, false);
  const Spline<2> surface = InsertSegments(tensor, {}, 0).Value;
  const ParametricBox<2> domain = surface.Space->Domain();
  EXPECT_EQ(ExpandToTensor(tensor, 0).Status.Code, ErrorCode::DimensionMismatch);
  EXPECT_EQ(SwapParameters(tensor, 0).Status.Code, ErrorCode::DimensionMismatch);
  EXPECT_EQ(ReverseParameter(tensor, 0, 0).Status.Code, ErrorCode::DimensionMismatch);
  EXPECT_EQ(ReverseParameter(surface, 2, 0).Status.Code, ErrorCode::InvalidParameter);
  ParametricBox<2> box = domain;
  box.Upper[1] = box.Lower[1];
  EXPECT_EQ(RestrictToBox(surface, box, 0).Status.Code, ErrorCode::OutsideDomain);
  box.Upper[1] = domain.Upper[1] + 1.0;
  EXPECT_EQ(RestrictToBox(surface, box, 0).Status.Code, ErrorCode::OutsideDomain);
  EXPECT_EQ(MoveDomain(tensor, domain, 0).Status.Code, ErrorCode::DimensionMismatch);
  const auto moved = [&](double low, double high) {
    return MoveDomain(surface, { { 0.0, low }, { 1.0, high } }, 0).Status;
  };
  for (const auto& [low, high] : { std::pair(1.0, 1.0), std::pair(1.0, 0.0),
         std::pair(0.0, std::numeric_limits<double>::infinity()),
         std::pair(std::numeric_limits<double>::quiet_NaN(), 1.0) })
  {
    EXPECT_EQ(moved(low, high).Code, ErrorCode::InvalidParameter) << low << " " << high;
  }
  EXPECT_EQ(moved(1e16, 1e16 + 2.0).Code, ErrorCode::InvalidKnots); // two doubles of length
  EXPECT_EQ(IsoCurve(surface, -1, domain.Lower[0], 0).Status.Code, ErrorCode::InvalidParameter);
  EXPECT_EQ(IsoCurve(surface, 0, domain.Upper[0] + 1.0, 0).Status.Code, ErrorCode::OutsideDomain);
}
