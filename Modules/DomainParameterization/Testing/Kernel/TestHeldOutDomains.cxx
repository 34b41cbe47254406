// SPDX-License-Identifier: BSD-3-Clause
// A sample; TestManyHeldOutDomains has the rest.
#include "HeldOutChecks.h"
#include <knotwork/SplineCore/Refinement.h>

namespace knotwork
{
namespace
{
TEST(HeldOutDomains, PlanesWithAKnownMapEndValid_PropertyOracle)
{
  cases::ExpectPlanesFound(0, 20);
}

TEST(HeldOutDomains, SolidsWithAKnownMapEndValid_PropertyOracle)
{
  cases::ExpectSolidsFound(0, 18);
}

TEST(HeldOutDomains, ImpossibleOnesNameThePlace_PropertyOracle)
{
  cases::ExpectAllNamed(0, 6);
}

TEST(HeldOutDomains, SharpTurnsStayRegularWhenRefined_PropertyOracle)
{
  // refined, the derivatives that were zero are what rounding leaves of them
  int rounded = 0;
  for (unsigned seed = 5; seed < 20; seed += 9)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const cases::HeldOut<3> domain = cases::RandomSolid(seed);
    ASSERT_TRUE(domain.Possible());
    Eigen::Matrix3d turn;
    turn << std::cos(0.3), std::sin(0.3), 0.0, -std::sin(0.3), std::cos(0.3), 0.0, 0.0, 0.0, 1.0;
    Spline<3> once = domain.Known;
    once.ControlPoints = (once.ControlPoints * turn).eval();
    once = InsertKnots<3>(once, 0, { 0.1, 0.3, 0.37, 0.66, 0.71, 0.9 }).Value;
    once = RefineAllElements<3>(once)->Value;
    DomainParams params;
    params.Threads = 1;
    const auto result = ParameterizeDomain<3>(cases::SidesOf<3>(once), params);
    ASSERT_TRUE(result) << result.Status.Message();
    EXPECT_FALSE(result->IsImpossible());
    EXPECT_EQ(result->Certificate.NumInvalid, 0);
    EXPECT_EQ(result->Refinements, 0);
    if (result->Certificate.Verdict != Verdict::Valid)
    {
      ++rounded;
      for (const CellCertificate& cell : result->Certificate.Cells)
      {
        EXPECT_TRUE(cell.Verdict == Verdict::Valid || cell.Limit == JacobianLimit::Rounding);
      }
      ASSERT_EQ(result->Messages.size(), 1u);
      const std::string& message = result->Messages[0];
      EXPECT_NE(message.find("within the rounding of its coordinates"), std::string::npos);
      // the place is on a turn: the outer or the inner side of one, where the boundary stands still
      double place[3] = { 0.0, 0.0, 0.0 };
      const std::size_t at = message.find("near (");
      ASSERT_NE(at, std::string::npos) << message;
      ASSERT_EQ(
        std::sscanf(message.c_str() + at, "near (%lf, %lf, %lf)", place, place + 1, place + 2), 3);
      double distance = 1.0;
      const PointMatrix& points = domain.Known.ControlPoints;
      for (Eigen::Index i = 0; i + 1 < points.rows(); ++i)
      {
        if (points.row(i) == points.row(i + 1))
        {
          const Eigen::RowVector3d turned = points.row(i).head<2>().eval() *
            turn.topLeftCorner<2, 2>().eval() * Eigen::Matrix<double, 2, 3>::Identity();
          distance = std::min(distance, std::hypot(place[0] - turned[0], place[1] - turned[1]));
        }
      }
      EXPECT_LT(distance, 1e-5); // of six digits
    }
  }
  EXPECT_GT(rounded, 0);
}

TEST(HeldOutDomains, DentedCubesKeepTheirFirstMap_PropertyOracle)
{
  // the first map of a dented cube is the known one, exactly: linear from bottom to top
  int dented = 0;
  for (unsigned seed = 0; seed < 60; ++seed)
  {
    const cases::HeldOut<3> domain = cases::RandomSolid(seed);
    if (domain.Kind != "dented cube")
    {
      continue;
    }
    ++dented;
    SCOPED_TRACE("seed " + std::to_string(seed));
    DomainParams params;
    params.Threads = 1;
    // however little may be done, what was valid stays so
    for (const double effort : { 1e-6, 1e-4, 1e-3, 4.0 })
    {
      params.Effort = effort;
      const auto result = ParameterizeDomain<3>(domain.Boundary, params);
      ASSERT_TRUE(result) << result.Status.Message();
      EXPECT_EQ(result->Certificate.Verdict, Verdict::Valid) << "effort " << effort;
      EXPECT_EQ(result->Refinements, 0);
    }
  }
  EXPECT_GE(dented, 6);
}
}
}
