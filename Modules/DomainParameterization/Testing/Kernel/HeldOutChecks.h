// SPDX-License-Identifier: BSD-3-Clause
// What must hold of a random domain.
#pragma once
#include "HeldOutDomains.h"
#include <knotwork/DomainParameterization/DomainParameterization.h>

#include <ctime>
#include <gtest/gtest.h>

namespace knotwork::cases
{
/// Counts over many domains.
struct HeldOutSums
{
  int Domains = 0;
  int Valid = 0;               ///< regular and one-to-one
  double LongestSeconds = 0.0; ///< of the processor
  double MostWork = 0.0;
};

template <int Dim, typename Run>
Result<DomainParameterization<Dim>> Timed(
  HeldOutSums& sums, const DomainBoundary<Dim>& boundary, const Run& check)
{
  DomainParams params;
  params.Threads = 1;
  const std::clock_t start = std::clock();
  auto result = ParameterizeDomain<Dim>(boundary, params);
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  EXPECT_LT(seconds, 10.0);
  ++sums.Domains;
  sums.LongestSeconds = std::max(sums.LongestSeconds, seconds);
  EXPECT_TRUE(result) << result.Status.Message();
  if (result)
  {
    sums.MostWork = std::max(sums.MostWork, result->Work);
    check(result.Value);
  }
  return result;
}

/// A domain with a known valid map ends with one, and the second verifier agrees.
template <int Dim>
void ExpectFound(const HeldOut<Dim>& domain, HeldOutSums& sums)
{
  SCOPED_TRACE(domain.Kind);
  ASSERT_TRUE(domain.Possible()) << "the generator has no valid map";
  Timed<Dim>(sums, domain.Boundary,
    [&](const DomainParameterization<Dim>& result)
    {
      EXPECT_EQ(result.Certificate.Verdict, Verdict::Valid)
        << (result.Messages.empty() ? "" : result.Messages.front());
      EXPECT_FALSE(result.IsImpossible()) << result.Messages.front();
      EXPECT_TRUE(result.IsValid()) << ToString(result.Injectivity.Reason);
      sums.Valid += result.IsValid();
      EXPECT_EQ(result.IsValid(), result.Messages.empty());
      const CertificateCheck check = VerifyCertificate(
        MakeBernsteinCells<Dim>(MakeBezierForm<Dim>(result.Map, 1)), result.Certificate, 200);
      EXPECT_EQ(check.Refuted, 0) << check.FirstRefuted;
    });
}

/// An impossible one names a place, and is not called valid.
template <int Dim>
void ExpectNamed(const Impossible<Dim>& domain, HeldOutSums& sums)
{
  SCOPED_TRACE(domain.Kind);
  Timed<Dim>(sums, domain.Boundary,
    [&](const DomainParameterization<Dim>& result)
    {
      EXPECT_FALSE(result.IsValid());
      EXPECT_TRUE(result.IsImpossible());
      EXPECT_EQ(domain.Crosses ? result.Crossings.empty() : result.Folds.empty(), false);
      ASSERT_FALSE(result.Messages.empty());
      EXPECT_NE(result.Messages.front().find(" at ("), std::string::npos)
        << result.Messages.front();
    });
}

inline void Print(const char* name, const HeldOutSums& sums)
{
  std::printf("%s: %d domains, %d valid, at most %.2f s of the processor, work %.2g\n", name,
    sums.Domains, sums.Valid, sums.LongestSeconds, sums.MostWork);
}

/// Seeds from first to end - 1.
inline void ExpectPlanesFound(unsigned first, unsigned end)
{
  HeldOutSums sums;
  for (unsigned seed = first; seed < end; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    ExpectFound<2>(RandomPlane(seed), sums);
  }
  Print("planes", sums);
}

inline void ExpectSolidsFound(unsigned first, unsigned end)
{
  HeldOutSums sums;
  for (unsigned seed = first; seed < end; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    ExpectFound<3>(RandomSolid(seed), sums);
  }
  Print("solids", sums);
}

inline void ExpectAllNamed(unsigned first, unsigned end)
{
  HeldOutSums sums;
  for (unsigned seed = first; seed < end; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    ExpectNamed<2>(ImpossiblePlane(seed), sums);
    ExpectNamed<3>(ImpossibleSolid(seed), sums);
  }
  Print("impossible", sums);
}
}
