// SPDX-License-Identifier: BSD-3-Clause
// The maps that the iterations begin with: a Tikhonov weight beyond all others keeps them.
#include "SurfaceCases.h"
#include "TemplateCases.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/QualityFunctionals.h>
#include <knotwork/TemplateMapping/TemplateMap.h>

#include <gtest/gtest.h>

#include <limits>
#include <random>

using namespace knotwork;

namespace
{
template <int Dim>
Result<TemplateMapResult<Dim>> First(const Skeleton<Dim>& skeleton, const Skeleton<Dim>& target,
  TemplateInitialMap start, double weight, bool guard)
{
  TemplateMapParams<Dim> params;
  params.Method = TemplateMapMethod::Fixed;
  params.InnerKnots.fill(3);
  params.Iterations = 1;
  params.TikhonovWeight = 1e20;
  params.Guard = guard;
  params.Start = start;
  params.InitialUniformityWeight = weight;
  params.Domain.emplace();
  params.Domain->Lower.fill(0.0);
  params.Domain->Upper.fill(1.0);
  return MapTemplate(skeleton, target, params);
}

/// x -> A x + b, det A > 0.
template <int Dim>
Skeleton<Dim> Affine(Skeleton<Dim> skeleton, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> real(-0.3, 0.3);
  Eigen::MatrixXd a = Eigen::MatrixXd::Identity(Dim, Dim);
  Eigen::RowVectorXd b(Dim);
  for (int i = 0; i < Dim; ++i)
  {
    for (int j = 0; j < Dim; ++j)
    {
      a(i, j) += real(random);
    }
    b(i) = 20.0 * real(random);
  }
  for (SkeletonPatch<Dim>& patch : skeleton)
  {
    patch.Points = ((patch.Points * a.transpose()).rowwise() + b).eval();
  }
  return skeleton;
}

/// Fixed parameters: the samples are the points of the template themselves.
template <int Dim>
void ExpectAffineMapsAreReproduced(const Skeleton<Dim>& skeleton)
{
  for (const unsigned seed : { 1u, 2u, 3u })
  {
    for (const double weight : { 1e-4, 1e-2, 10.0 })
    {
      const Skeleton<Dim> target = Affine(skeleton, seed);
      const auto quadratic = First(skeleton, target, TemplateInitialMap::Quadratic, weight, true);
      ASSERT_TRUE(quadratic) << quadratic.Status.Message();
      // The least proximal term is 1e-9 of the uniformity's; displacements are below 10.
      EXPECT_LT(quadratic->History[0].MaxError, 1e-6) << weight;
      const auto lumped = First(skeleton, target, TemplateInitialMap::Moved, weight, true);
      ASSERT_TRUE(lumped);
      EXPECT_GT(lumped->History[0].MaxError, 1e-3);
    }
  }
}

Skeleton<2> Target()
{
  return cases::LobedTarget({ 0.15, 5, 0.1, 0.0 }, 101);
}
}

TEST(InitialTemplateMap, AffineMapsAreReproduced_ExactOracle)
{
  ExpectAffineMapsAreReproduced<2>(cases::CircleTemplate(101));
  ExpectAffineMapsAreReproduced<3>({ cases::GridPatch(12,
    [](double u, double v)
    { return Eigen::RowVector3d(0.2 + 0.6 * u, 0.2 + 0.6 * v, 0.3 + 0.4 * u * v); }) });
}

// The functional itself, by evaluation and quadrature: no direction leads down.
TEST(InitialTemplateMap, NoDirectionLowersTheQuadraticFunctional_PropertyOracle)
{
  const double weight = 3e-3;
  const Skeleton<2> skeleton = cases::CircleTemplate(101);
  const Skeleton<2> target = Target();
  const auto result = First<2>(skeleton, target, TemplateInitialMap::Quadratic, weight, false);
  ASSERT_TRUE(result) << result.Status.Message();
  const Spline<2>& map = result->Map;
  const auto functional = [&](const PointMatrix& points)
  {
    Spline<2> moved = map;
    moved.ControlPoints = points;
    const BezierForm<2> form = MakeBezierForm(moved);
    double sum = weight * QualityValue(form, QualityKind::Uniformity);
    for (std::size_t k = 0; k < target.size(); ++k)
    {
      EvaluationBatch batch;
      EXPECT_TRUE(EvaluateParameters(form, skeleton[k].Points, {}, batch));
      sum += (batch.Values - target[k].Points).squaredNorm();
    }
    return sum;
  };
  const double least = functional(map.ControlPoints);
  std::mt19937 random(7);
  std::normal_distribution<double> real;
  for (int trial = 0; trial < 20; ++trial)
  {
    PointMatrix direction = map.ControlPoints;
    for (double& value : direction.reshaped())
    {
      value = 1e-2 * real(random);
    }
    const double up = functional(map.ControlPoints + direction) - least;
    const double down = functional(map.ControlPoints - direction) - least;
    EXPECT_GT(up, 0.0);
    EXPECT_GT(down, 0.0);
    EXPECT_LT(std::abs(up - down), 1e-6 * (up + down)); // quadratic, its gradient vanishes
  }
  // Nearer to the target than what the row sums give, once it may bend.
  const auto lumped = First<2>(skeleton, target, TemplateInitialMap::Moved, weight, false);
  const auto bent = First<2>(skeleton, target, TemplateInitialMap::Quadratic, 1e-6, false);
  ASSERT_TRUE(lumped);
  ASSERT_TRUE(bent);
  EXPECT_LT(bent->History[0].SquaredError, 0.5 * lumped->History[0].SquaredError);
}

TEST(InitialTemplateMap, LargerWeightsBendLess_PropertyOracle)
{
  double before = std::numeric_limits<double>::infinity();
  for (const double weight : { 1e-6, 1e-3, 1.0 })
  {
    const auto result =
      First<2>(cases::CircleTemplate(101), Target(), TemplateInitialMap::Quadratic, weight, false);
    ASSERT_TRUE(result);
    const double bending = QualityValue(MakeBezierForm(result->Map), QualityKind::Uniformity);
    EXPECT_LT(bending, before);
    before = bending;
  }
}

TEST(InitialTemplateMap, TheGuardShortensTheWayToFolds_PropertyOracle)
{
  const Skeleton<2> folding = cases::LobedTarget({ 0.3, 6, 0.8, 0.3 }, 101);
  for (const auto start : { TemplateInitialMap::Moved, TemplateInitialMap::Quadratic })
  {
    const auto plain = First<2>(cases::CircleTemplate(101), folding, start, 1e-5, false);
    const auto guarded = First<2>(cases::CircleTemplate(101), folding, start, 1e-5, true);
    ASSERT_TRUE(plain);
    ASSERT_TRUE(guarded);
    EXPECT_GT(guarded->MinJacobianBound, 0.0);
    if (start == TemplateInitialMap::Quadratic)
    {
      EXPECT_LT(plain->MinJacobianBound, 0.0);
    }
  }
}
