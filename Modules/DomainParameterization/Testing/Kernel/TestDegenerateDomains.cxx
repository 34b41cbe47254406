// SPDX-License-Identifier: BSD-3-Clause
// Boundaries where derivatives are zero or parallel, refined until only rounding is left of that.
#include "DegenerateDomains.h"
#include "HeldOutChecks.h"
#include <knotwork/JacobianValidation/CellPieces.h>

namespace knotwork
{
namespace
{
/// Every refinement of the boundary of a valid map ends valid, as the boundary itself does.
template <int Dim>
void ExpectValidWhenRefined(const cases::HeldOut<Dim>& domain, unsigned seed)
{
  SCOPED_TRACE(domain.Kind + ", seed " + std::to_string(seed));
  ASSERT_TRUE(cases::IsProvedValid<Dim>(domain.Known));
  for (int refinements = 0; refinements <= 3; ++refinements)
  {
    SCOPED_TRACE("refined " + std::to_string(refinements) + " times");
    const Spline<Dim> map = cases::Roughened<Dim>(domain.Known, seed, refinements);
    DomainParams params;
    params.Threads = 1;
    params.Effort = 0.5;
    const auto result = ParameterizeDomain<Dim>(cases::SidesOf<Dim>(map), params);
    ASSERT_TRUE(result) << result.Status.Message();
    EXPECT_FALSE(result->IsImpossible());
    EXPECT_EQ(result->Certificate.Verdict, Verdict::Valid)
      << (result->Messages.empty() ? "" : result->Messages.front());
    EXPECT_TRUE(result->IsValid()) << ToString(result->Injectivity.Reason);
    const BernsteinCells cells = MakeBernsteinCells<Dim>(MakeBezierForm<Dim>(result->Map, 1));
    if (Dim == 2 || refinements == 1) // the second verifier takes seconds for a solid
    {
      const CertificateCheck check = VerifyCertificate(cells, result->Certificate, 200);
      EXPECT_EQ(check.Refuted, 0) << check.FirstRefuted;
    }
    // points inside of the elements, in plain doubles: none is folded, far above rounding
    double largest = 0.0;
    double least = std::numeric_limits<double>::infinity();
    for (int c = 0; c < cells.NumCells(); ++c)
    {
      for (int k = 0; k < (Dim == 2 ? 25 : 125); ++k)
      {
        const double u[3] = { 0.1 + 0.2 * (k % 5), 0.1 + 0.2 * (k / 5 % 5), 0.1 + 0.2 * (k / 25) };
        const CellPoint point = EvaluateCell(cells, c, u);
        Eigen::Matrix<double, Dim, Dim> derivative;
        for (std::size_t d = 0; d < Dim; ++d)
        {
          for (std::size_t r = 0; r < Dim; ++r)
          {
            derivative(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(d)) =
              point.Derivative[d][r];
          }
        }
        const double det = derivative.determinant();
        largest = std::max(largest, det);
        least = std::min(least, det / derivative.colwise().norm().prod());
      }
    }
    EXPECT_GT(largest, 0.0);
    EXPECT_GT(least, 1e-9);
  }
}

TEST(DegenerateDomains, PlanesEndValidHoweverRefined_PropertyOracle)
{
  for (unsigned seed = 0; seed < 12; ++seed)
  {
    ExpectValidWhenRefined<2>(cases::DegeneratePlane(seed), seed);
  }
}

TEST(DegenerateDomains, SharpBarsEndValidHoweverRefined_PropertyOracle)
{
  for (unsigned seed = 0; seed < 8; seed += 4)
  {
    ExpectValidWhenRefined<3>(cases::DegenerateSolid(seed), seed);
  }
}

TEST(DegenerateDomains, LiftedSectorsEndValidHoweverRefined_PropertyOracle)
{
  for (unsigned seed = 1; seed < 8; seed += 4)
  {
    ExpectValidWhenRefined<3>(cases::DegenerateSolid(seed), seed);
  }
}

TEST(DegenerateDomains, LiftedTurnsEndValidHoweverRefined_PropertyOracle)
{
  for (unsigned seed = 2; seed < 8; seed += 4)
  {
    ExpectValidWhenRefined<3>(cases::DegenerateSolid(seed), seed);
  }
}

TEST(DegenerateDomains, WedgesAndPyramidsEndValidHoweverRefined_PropertyOracle)
{
  for (unsigned seed = 3; seed < 8; seed += 4)
  {
    ExpectValidWhenRefined<3>(cases::DegenerateSolid(seed), seed);
  }
}

TEST(DegenerateDomains, ParallelTangentsOfRoundingAreNamed_PropertyOracle)
{
  // a cylinder between six faces: along its four upright edges faces meet at a straight angle, and
  // turned by any angle only rounding says which way
  int rounded = 0;
  for (unsigned seed = 0; seed < 6; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    cases::Dice dice(seed);
    const cases::HeldOut<3> domain = cases::Lifted(cases::OneDisc(), dice);
    const Spline<3> map = cases::Roughened<3>(domain.Known, seed, 0);
    DomainParams params;
    params.Threads = 1;
    params.Effort = 0.5;
    const auto result = ParameterizeDomain<3>(cases::SidesOf<3>(map), params);
    ASSERT_TRUE(result) << result.Status.Message();
    EXPECT_FALSE(result->IsImpossible());
    EXPECT_EQ(result->Certificate.NumInvalid, 0);
    EXPECT_EQ(result->Refinements, 0);
    if (result->Certificate.Verdict == Verdict::Valid)
    {
      continue;
    }
    ++rounded;
    for (const CellCertificate& cell : result->Certificate.Cells)
    {
      EXPECT_TRUE(cell.Verdict == Verdict::Valid || cell.Limit == JacobianLimit::Rounding);
    }
    ASSERT_EQ(result->Messages.size(), 1u);
    const std::string& message = result->Messages[0];
    EXPECT_NE(message.find("within the rounding of its coordinates"), std::string::npos);
    // the place is an end of such an edge: a corner of the map
    double place[3] = { 0.0, 0.0, 0.0 };
    const std::size_t at = message.find("near (");
    ASSERT_NE(at, std::string::npos) << message;
    ASSERT_EQ(
      std::sscanf(message.c_str() + at, "near (%lf, %lf, %lf)", place, place + 1, place + 2), 3);
    double distance = std::numeric_limits<double>::infinity();
    const Eigen::Index size = map.ControlPoints.rows();
    for (const Eigen::Index corner :
      { 0, 2, 6, 8, int(size) - 9, int(size) - 7, int(size) - 3, int(size) - 1 })
    {
      distance = std::min(distance,
        (map.ControlPoints.row(corner) - Eigen::Map<const Eigen::RowVector3d>(place)).norm());
    }
    EXPECT_LT(distance, 1e-5 * map.ControlPoints.cwiseAbs().maxCoeff()); // of six digits
  }
  EXPECT_GT(rounded, 0);
}

TEST(DegenerateDomains, CoincidentPointsAreJoined_ExactOracle)
{
  const Spline<3> known = cases::RandomSolid(5).Known;
  Spline<3> map = cases::Roughened<3>(known, 1, 0);
  map = RefineAllElements<3>(RefineAllElements<3>(map)->Value)->Value;
  const double coordinate = map.ControlPoints.cwiseAbs().maxCoeff();
  const DomainBoundary<3> given = cases::SidesOf<3>(map);
  const auto boundary = MakeCompatible<3>(given);
  ASSERT_TRUE(boundary) << boundary.Status.Message();
  EXPECT_GT(boundary->LargestGap, 0.0);
  EXPECT_LE(boundary->LargestGap, 0x1p-46 * coordinate);
  BoundaryParams strict;
  strict.GapTolerance = 0.0;
  const auto untouched = MakeCompatible<3>(given, strict);
  ASSERT_TRUE(untouched) << untouched.Status.Message();
  EXPECT_EQ(untouched->LargestGap, 0.0);
  // four faces (all but the bar's ends) have two turns each; a step of a net is far longer
  int near = 0;
  int equal = 0;
  for (std::size_t s = 2; s < 6; ++s)
  {
    const PointMatrix& before = untouched->Sides[s].ControlPoints;
    const PointMatrix& after = boundary->Sides[s].ControlPoints;
    EXPECT_LE((before - after).cwiseAbs().maxCoeff(), boundary->LargestGap);
    const int along = boundary->Knots[0].NumFunctions();
    for (Eigen::Index i = 1; i < before.rows(); ++i)
    {
      if (i % along != 0)
      {
        near += (before.row(i) - before.row(i - 1)).norm() < 1e-9 * coordinate;
        equal += after.row(i) == after.row(i - 1);
      }
    }
  }
  EXPECT_GT(near, 0);
  EXPECT_EQ(equal, near);
}
}
}
