// SPDX-License-Identifier: BSD-3-Clause
#include "FoldRemoval.h"
#include "MapCases.h"
#include <knotwork/TemplateMapping/Regularity.h>

#include <gtest/gtest.h>

using namespace knotwork;

namespace
{
template <int Dim>
void ExpectUnfolded(double size, unsigned seed)
{
  SCOPED_TRACE("seed " + std::to_string(seed));
  Spline<Dim> map = cases::IdentityMap<Dim>(2, 4);
  cases::Shake(map, size, seed, false);
  ASSERT_FALSE(MeasureRegularity(MakeBezierForm(map), 1.0, 100000, 0)->IsRegular());
  const auto unfolded = RemoveFolds(map, 0);
  ASSERT_TRUE(unfolded) << unfolded.Status.Message();
  EXPECT_TRUE(MeasureRegularity(MakeBezierForm(unfolded.Value), 1.0, 100000, 0)->IsRegular());
  EXPECT_EQ(unfolded->Space, map.Space);
  const PointMatrix places = GrevillePoints(*map.Space);
  for (Eigen::Index i = 0; i < places.rows(); ++i)
  {
    if (places.row(i).minCoeff() == 0.0 || places.row(i).maxCoeff() == 1.0)
    {
      EXPECT_EQ(unfolded->ControlPoints.row(i), map.ControlPoints.row(i)) << i;
    }
  }
}
}

TEST(FoldRemoval, InnerFoldsGoAndTheBoundaryStays_PropertyOracle)
{
  for (unsigned seed = 1; seed <= 3; ++seed)
  {
    ExpectUnfolded<2>(0.3, seed);
    ExpectUnfolded<3>(0.25, seed);
  }
}

TEST(FoldRemoval, FoldsOfTheBoundaryAreRefused)
{
  Spline<2> map = cases::IdentityMap<2>(2, 4);
  map.ControlPoints(2, 0) = -0.5; // a side that turns back
  const auto unfolded = RemoveFolds(map, 0);
  EXPECT_EQ(unfolded.Status.Code, ErrorCode::InvalidParameter);
  EXPECT_NE(unfolded.Status.Detail.find("folds"), std::string::npos);
  map = cases::IdentityMap<2>(2, 4);
  map.ControlPoints.col(0) *= -1.0; // mirrored
  EXPECT_EQ(RemoveFolds(map, 0).Status.Code, ErrorCode::InvalidParameter);
}
