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

TEST(HeldOutDomains, SharpTurnsEndValidWhenRefined_PropertyOracle)
{
  // refined, the derivatives that were zero are what rounding leaves of them
  for (unsigned seed = 5; seed < 20; seed += 9)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    cases::HeldOut<3> domain = cases::RandomSolid(seed);
    ASSERT_TRUE(domain.Possible());
    Eigen::Matrix3d turn;
    turn << std::cos(0.3), std::sin(0.3), 0.0, -std::sin(0.3), std::cos(0.3), 0.0, 0.0, 0.0, 1.0;
    Spline<3> once = domain.Known;
    once.ControlPoints = (once.ControlPoints * turn).eval();
    once = InsertKnots<3>(once, 0, { 0.1, 0.3, 0.37, 0.66, 0.71, 0.9 }).Value;
    once = RefineAllElements<3>(once)->Value;
    domain.Boundary = cases::SidesOf<3>(once);
    cases::HeldOutSums sums;
    cases::ExpectFound<3>(domain, sums);
  }
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
