// SPDX-License-Identifier: BSD-3-Clause
// Boundaries as JSON files with the results of another program, where the environment variable
// KNOTWORK_DOMAIN_CASES names their folder.
#include "DomainFiles.h"
#include <knotwork/DomainParameterization/DomainParameterization.h>
#include <knotwork/SplineCore/BezierForm.h>

#include <gtest/gtest.h>

namespace knotwork
{
namespace
{
using cases::ReadBoundary;
using cases::ReadJson;

/// The certificate against the second verifier, and the metrics against the reference's: the
/// smallest det J / area at least 0.98 times, the largest at most 1.02 times.
template <int Dim>
void ExpectAsGoodAs(const std::string& name, const std::string& method)
{
  const nlohmann::json json = ReadJson(name);
  const nlohmann::json reference = ReadJson("reference_results");
  if (json.is_null() || reference.is_null())
  {
    GTEST_SKIP() << "KNOTWORK_DOMAIN_CASES names no folder with " << name << ".json";
  }
  const auto result = ParameterizeDomain<Dim>(ReadBoundary<Dim>(json));
  ASSERT_TRUE(result) << result.Status.Message();
  EXPECT_EQ(result->Certificate.Verdict, Verdict::Valid);
  EXPECT_FALSE(result->IsImpossible());
  const CertificateCheck check = VerifyCertificate(
    MakeBernsteinCells<Dim>(MakeBezierForm<Dim>(result->Map)), result->Certificate, 200);
  EXPECT_EQ(check.Refuted, 0) << check.FirstRefuted;
  bool found = false;
  for (const auto& row : reference[name])
  {
    if (row["method_name"].get<std::string>().rfind(method, 0) == 0)
    {
      found = true;
      EXPECT_GE(result->Metrics.MinDetOverArea, 0.98 * row["min_det_over_area"].get<double>());
      EXPECT_LE(result->Metrics.MaxDetOverArea, 1.02 * row["max_det_over_area"].get<double>());
      EXPECT_NEAR(result->Metrics.Area, row["area"].get<double>(), 1e-8 * result->Metrics.Area);
      EXPECT_EQ(result->Map.Space->NumFunctions, row["n_cp"].get<int>());
    }
  }
  EXPECT_TRUE(found);
}

TEST(DomainFiles, Male_CrossOracle)
{
  ExpectAsGoodAs<2>("male", "BarrierPatch");
}
TEST(DomainFiles, Rotor_CrossOracle)
{
  ExpectAsGoodAs<2>("rotor", "BarrierPatch");
}
TEST(DomainFiles, Puzzle4_CrossOracle)
{
  ExpectAsGoodAs<2>("puzzle4", "BarrierPatch");
}
TEST(DomainFiles, Duck_CrossOracle)
{
  ExpectAsGoodAs<2>("duck", "BarrierPatch");
}
TEST(DomainFiles, TUDflame_CrossOracle)
{
  ExpectAsGoodAs<2>("tudflame_p2", "BarrierPatch");
}
TEST(DomainFiles, Duck3d_CrossOracle)
{
  ExpectAsGoodAs<3>("duck3d", "PenaltyPatch");
}

TEST(DomainFiles, LakeIsImpossibleAtItsCorner_GoldenOracle)
{
  const nlohmann::json json = ReadJson("lake");
  if (json.is_null())
  {
    GTEST_SKIP() << "KNOTWORK_DOMAIN_CASES names no folder with lake.json";
  }
  const auto result = ParameterizeDomain<2>(ReadBoundary<2>(json));
  ASSERT_TRUE(result) << result.Status.Message();
  EXPECT_EQ(result->Certificate.Verdict, Verdict::Invalid);
  ASSERT_EQ(result->Folds.size(), 1u);
  EXPECT_EQ(result->Folds[0].Parameters[0], 1.0);
  EXPECT_EQ(result->Folds[0].Parameters[1], 0.0);
  EXPECT_NEAR(result->Folds[0].Position[0], -0.2220577, 1e-6);
  EXPECT_NEAR(result->Folds[0].Position[1], 0.0784391, 1e-6);
}
}
}
