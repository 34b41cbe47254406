// SPDX-License-Identifier: BSD-3-Clause
#include <knotwork/SplineCore/TensorForm.h>

#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/Refinement.h>
#include <knotwork/SplineCore/Shapes.h>

#include <gtest/gtest.h>

#include <random>

using namespace knotwork;

namespace
{
/// A shape with random elements split, several times.
template <int Dim>
Spline<Dim> Refined(ShapeKind kind, unsigned seed, bool locallyRefined)
{
  ShapeParams shape;
  shape.Kind = kind;
  shape.Degree = 2 + static_cast<int>(seed % 2);
  shape.Elements = { 2, 3, 2 };
  auto spline = std::get<Spline<Dim>>(MakeShape(shape).Value[0]);
  std::mt19937 random(seed);
  for (int round = 0; round < 2; ++round)
  {
    std::vector<int> marked;
    for (int e = 0; e < spline.Space->NumElements(); ++e)
    {
      if (random() % 5 == 0)
      {
        marked.push_back(e);
      }
    }
    marked.push_back(0);
    RefinementParams params;
    params.Extension = 1;
    if constexpr (Dim == 2)
    {
      if (locallyRefined)
      {
        spline = RefineMarkedLR(spline, marked).Value.Value;
        continue;
      }
    }
    spline = RefineMarkedElements(spline, marked, params).Value.Value;
  }
  return spline;
}

template <int Dim>
void ExpectSameMap(const Spline<Dim>& a, const Spline<Dim>& b)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const auto domain = a.Space->Domain();
  PointMatrix parameters(1000, Dim);
  for (Eigen::Index i = 0; i < parameters.rows(); ++i)
  {
    for (std::size_t d = 0; d < Dim; ++d)
    {
      parameters(i, static_cast<Eigen::Index>(d)) =
        domain.Lower[d] + (domain.Upper[d] - domain.Lower[d]) * uniform(random);
    }
  }
  EvaluationBatch first;
  EvaluationBatch second;
  ASSERT_TRUE(EvaluateParameters(MakeBezierForm(a), parameters, {}, first));
  ASSERT_TRUE(EvaluateParameters(MakeBezierForm(b), parameters, {}, second));
  // sums of convex combinations of points of size 1, a few levels deep
  EXPECT_LE((first.Values - second.Values).cwiseAbs().maxCoeff(), 1e-13);
}

template <int Dim>
void ExpectExact(ShapeKind kind, bool locallyRefined)
{
  int refusals = 0;
  for (unsigned seed = 1; seed <= 6; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Spline<Dim> spline = Refined<Dim>(kind, seed, locallyRefined);
    ASSERT_NE(spline.Space->Kind, SpaceKind::Tensor);
    const auto tensor = ToTensor(spline, 1);
    ASSERT_TRUE(tensor) << tensor.Status.Message();
    EXPECT_EQ(tensor.Value.Space->Kind, SpaceKind::Tensor);
    EXPECT_EQ(tensor.Value.IsRational(), spline.IsRational());
    int functions = 1;
    for (const KnotVector& knots : tensor.Value.Space->Knots)
    {
      functions *= knots.NumFunctions();
    }
    EXPECT_EQ(tensor.Value.Space->NumFunctions, functions);
    ExpectSameMap(spline, tensor.Value);

    if (functions > spline.Space->NumFunctions) // what there is already is no matter of limits
    {
      const auto refused = ToTensor(spline, 1, functions - 1);
      EXPECT_EQ(refused.Status.Code, ErrorCode::TooLarge);
      EXPECT_NE(refused.Status.Detail.find(std::to_string(functions)), std::string::npos);
      ++refusals;
    }
  }
  EXPECT_GT(refusals, 0);
}
}

TEST(TensorForm, HierarchicalSplinesKeepTheirMap_PropertyOracle)
{
  ExpectExact<1>(ShapeKind::Arc, false);
  ExpectExact<2>(ShapeKind::AnnulusSector, false);
  ExpectExact<3>(ShapeKind::BallSector, false);
}

TEST(TensorForm, LRSplinesKeepTheirMap_PropertyOracle)
{
  ExpectExact<2>(ShapeKind::AnnulusSector, true);
}

TEST(TensorForm, TensorProductsStayAndBezierElementsAreRefused)
{
  ShapeParams shape;
  const auto square = std::get<Spline<2>>(MakeShape(shape).Value[0]);
  const auto same = ToTensor(square, 1, 1); // what is there already is no matter of limits
  ASSERT_TRUE(same);
  EXPECT_EQ(same.Value.Space, square.Space);
}

TEST(SizeLimit, FunctionsOfUniformRefinementAreCounted_ExactOracle)
{
  for (int elevation = 0; elevation <= 2; ++elevation)
  {
    for (int refinements = 0; refinements <= 3; ++refinements)
    {
      ShapeParams shape;
      shape.Kind = ShapeKind::Cube;
      shape.Degree = 2;
      shape.Elements = { 1, 2, 3 };
      auto spline = std::get<Spline<3>>(MakeShape(shape).Value[0]);
      const double expected = FunctionsAfterRefinement(*spline.Space, elevation, refinements);
      spline = ElevateAllDegrees(spline, elevation).Value;
      for (int round = 0; round < refinements; ++round)
      {
        spline = RefineAllElements(spline).Value.Value;
      }
      EXPECT_EQ(expected, spline.Space->NumFunctions) << elevation << " " << refinements;
    }
  }
}

TEST(SizeLimit, ShapesAreRefusedBeforeTheyAreMade)
{
  ShapeParams shape;
  shape.Kind = ShapeKind::SolidTube;
  shape.Sectors = 4;
  shape.Degree = 1;
  shape.Elements = { 10, 10, 10 };
  const auto patches = MakeShape(shape);
  ASSERT_TRUE(patches);
  int functions = 0;
  for (const AnySpline& patch : patches.Value)
  {
    functions += std::get<Spline<3>>(patch).Space->NumFunctions;
  }
  shape.MaxFunctions = functions; // all patches together
  EXPECT_TRUE(MakeShape(shape));
  shape.MaxFunctions = functions - 1;
  EXPECT_EQ(MakeShape(shape).Status.Code, ErrorCode::TooLarge);
}
