// SPDX-License-Identifier: BSD-3-Clause
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/BezierSpace.h>
#include <knotwork/SplineCore/ControlNet.h>
#include <knotwork/SplineCore/Refinement.h>
#include <knotwork/SplineCore/Shapes.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

using namespace knotwork;

namespace
{
/// 128 random points in every element and their values, with the parent's values at the same place.
template <int Dim>
double WorstDifference(const Spline<Dim>& coarse, const Spline<Dim>& fine)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const auto domain = coarse.Space->Domain();
  PointMatrix parameters(2000, Dim);
  for (Eigen::Index i = 0; i < parameters.rows(); ++i)
  {
    for (std::size_t d = 0; d < Dim; ++d)
    {
      parameters(i, static_cast<Eigen::Index>(d)) =
        domain.Lower[d] + (domain.Upper[d] - domain.Lower[d]) * uniform(random);
    }
  }
  EvaluationBatch a;
  EvaluationBatch b;
  EXPECT_TRUE(EvaluateParameters(MakeBezierForm(coarse), parameters, {}, a));
  EXPECT_TRUE(EvaluateParameters(MakeBezierForm(fine), parameters, {}, b));
  return (a.Values - b.Values).cwiseAbs().maxCoeff();
}

/// The rational sector of a ball: every direction rational.
Spline<3> Sector(std::array<int, 3> elements)
{
  ShapeParams params;
  params.Kind = ShapeKind::BallSector;
  params.Elements = elements;
  return std::get<Spline<3>>(MakeShape(params).Value[0]);
}

Spline<2> Annulus()
{
  ShapeParams params;
  params.Kind = ShapeKind::AnnulusSector;
  params.Angle = 200.0;
  params.Degree = 3;
  params.Elements = { 2, 2, 1 };
  return std::get<Spline<2>>(MakeShape(params).Value[0]);
}

/// The Bezier elements of a tensor-product spline without interior continuity above 0, glued where
/// the tensor product shares control points.
template <int Dim>
Spline<Dim> AsBezier(const Spline<Dim>& spline)
{
  const SplineSpace<Dim>& space = *spline.Space;
  std::vector<IntArray<Dim>> degrees;
  std::vector<int> ids;
  for (int e = 0; e < space.NumElements(); ++e)
  {
    const auto& degree = space.Elements[static_cast<std::size_t>(e)].Degree;
    degrees.push_back(degree);
    const int* first = space.LocalFunctions(e);
    ids.insert(ids.end(), first, first + NumTensorFunctions<Dim>(degree));
  }
  Spline<Dim> result = spline;
  result.Space = MakeBezierSpace<Dim>(degrees, ids, space.NumFunctions).Value;
  return result;
}

/// Largest difference between the pieces that RefineAllElements makes of Bezier elements and their
/// parents.
template <int Dim>
double WorstPiece(const Spline<Dim>& coarse, const RefinedSpline<Dim>& fine)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const int n = fine.Value.Space->NumElements();
  PointMatrix local(n * 20, Dim);
  PointMatrix parentLocal(n * 20, Dim);
  std::vector<int> elements;
  std::vector<int> parents;
  for (Eigen::Index i = 0; i < local.rows(); ++i)
  {
    const int e = static_cast<int>(i / 20);
    elements.push_back(e);
    parents.push_back(fine.Parents[static_cast<std::size_t>(e)]);
    for (int d = 0; d < Dim; ++d)
    {
      local(i, d) = uniform(random);
      parentLocal(i, d) = 0.5 * (local(i, d) + (e >> d & 1));
    }
  }
  EvaluationBatch a;
  EvaluationBatch b;
  EXPECT_TRUE(EvaluateElements(MakeBezierForm(fine.Value), elements, local, {}, a));
  EXPECT_TRUE(EvaluateElements(MakeBezierForm(coarse), parents, parentLocal, {}, b));
  return (a.Values - b.Values).cwiseAbs().maxCoeff();
}

/// Two triquadratic bricks with a common face, the second one turned and mirrored in its own
/// numbering by `order` (direction) and `flips` (bit a direction).
Spline<3> TwoBricks(const std::array<int, 3>& order, int flips)
{
  const auto latticeId = [](int i, int j, int k) { return i + 5 * (j + 3 * k); };
  std::vector<int> ids;
  for (int brick = 0; brick < 2; ++brick)
  {
    for (int n = 0; n < 27; ++n)
    {
      const std::array<int, 3> x{ n % 3, n / 3 % 3, n / 9 };
      std::array<int, 3> y = x;
      for (std::size_t d = 0; brick == 1 && d < 3; ++d)
      {
        const int v = x[static_cast<std::size_t>(order[d])];
        y[d] = (flips >> d & 1) != 0 ? 2 - v : v;
      }
      ids.push_back(latticeId(y[0] + 2 * brick, y[1], y[2]));
    }
  }
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-0.1, 0.1);
  Spline<3> spline;
  spline.Space = MakeBezierSpace<3>({ { 2, 2, 2 }, { 2, 2, 2 } }, ids, 45).Value;
  spline.ControlPoints.resize(45, 3);
  spline.Weights.resize(45);
  for (int i = 0; i < 45; ++i)
  {
    spline.ControlPoints.row(i) << i % 5 + uniform(random), i / 5 % 3 + uniform(random),
      i / 15 + uniform(random);
    spline.Weights[i] = 1.0 + uniform(random);
  }
  return spline;
}
}

TEST(Refinement, TensorSplineKeepsItsMap_CrossOracle)
{
  const Spline<2> annulus = Annulus();
  const auto fine = RefineAllElements(annulus);
  ASSERT_TRUE(fine) << fine.Status.Message();
  EXPECT_EQ(fine->Value.Space->Kind, SpaceKind::Tensor);
  EXPECT_EQ(fine->Value.Space->NumElements(), 4 * annulus.Space->NumElements());
  EXPECT_LE(WorstDifference(annulus, fine->Value), 1e-14);
  const Spline<3> sector = Sector({ 1, 2, 1 });
  EXPECT_LE(WorstDifference(sector, RefineAllElements(sector)->Value), 1e-14);
}

TEST(Refinement, ParentsHoldTheirChildren_PropertyOracle)
{
  const Spline<2> annulus = Annulus();
  const auto fine = RefineAllElements(annulus);
  std::vector<int> children(annulus.Space->Elements.size(), 0);
  for (std::size_t e = 0; e < fine->Parents.size(); ++e)
  {
    const int parent = fine->Parents[e];
    ++children[static_cast<std::size_t>(parent)];
    for (std::size_t d = 0; d < 2; ++d)
    {
      EXPECT_LE(annulus.Space->Elements[static_cast<std::size_t>(parent)].Box.Lower[d],
        fine->Value.Space->Elements[e].Box.Lower[d]);
      EXPECT_GE(annulus.Space->Elements[static_cast<std::size_t>(parent)].Box.Upper[d],
        fine->Value.Space->Elements[e].Box.Upper[d]);
    }
  }
  EXPECT_EQ(std::set<int>(children.begin(), children.end()), std::set<int>{ 4 });
}

TEST(Refinement, MarkedElementsOnly_CrossOracle)
{
  const Spline<2> annulus = Annulus();
  RefinementParams params;
  params.Extension = 2;
  const auto fine = RefineMarkedElements(annulus, { 5 }, params);
  ASSERT_TRUE(fine) << fine.Status.Message();
  EXPECT_EQ(fine->Value.Space->Kind, SpaceKind::Hierarchical);
  EXPECT_GT(fine->Value.Space->NumElements(), annulus.Space->NumElements());
  EXPECT_LT(fine->Value.Space->NumElements(), 4 * annulus.Space->NumElements());
  EXPECT_LE(WorstDifference(annulus, fine->Value), 1e-14);
  // a hierarchical spline refines further, everywhere
  const auto finer = RefineAllElements(fine->Value);
  ASSERT_TRUE(finer) << finer.Status.Message();
  EXPECT_EQ(finer->Value.Space->NumElements(), 4 * fine->Value.Space->NumElements());
  EXPECT_LE(WorstDifference(annulus, finer->Value), 2e-14);
  // nothing marked: nothing happens
  EXPECT_EQ(RefineMarkedElements(annulus, {})->Value.Space, annulus.Space);
}

TEST(Refinement, SplitBezierElementsStayGlued_GoldenOracle)
{
  std::array<int, 3> order{ 0, 1, 2 };
  do
  {
    for (int flips = 0; flips < 8; ++flips)
    {
      const Spline<3> bricks = TwoBricks(order, flips);
      const auto fine = RefineAllElements(bricks);
      ASSERT_TRUE(fine) << fine.Status.Message();
      EXPECT_EQ(fine->Value.Space->NumElements(), 16);
      EXPECT_EQ(fine->Value.Space->NumFunctions, 9 * 5 * 5); // lattice of both bricks
      EXPECT_LE(WorstPiece(bricks, fine.Value), 1e-14);
      const auto elevated = ElevateAllDegrees(bricks, 2);
      ASSERT_TRUE(elevated) << elevated.Status.Message();
      EXPECT_EQ(elevated->Space->NumFunctions, 9 * 5 * 5);
    }
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(Refinement, SplitBezierSurfaceKeepsItsMap_CrossOracle)
{
  ShapeParams params;
  params.Kind = ShapeKind::AnnulusSector;
  params.Angle = 360.0; // four spans, C^0 in between: control points are Bezier points
  const Spline<2> bezier = AsBezier(std::get<Spline<2>>(MakeShape(params).Value[0]));
  const auto fine = RefineAllElements(bezier);
  ASSERT_TRUE(fine) << fine.Status.Message();
  EXPECT_EQ(fine->Value.Space->NumFunctions, 3 * 17);
  EXPECT_LE(WorstPiece(bezier, fine.Value), 1e-14);
}

TEST(Refinement, ElevationKeepsTheMap_CrossOracle)
{
  const Spline<2> annulus = Annulus();
  const auto elevated = ElevateAllDegrees(annulus, 2);
  ASSERT_TRUE(elevated) << elevated.Status.Message();
  EXPECT_EQ(elevated->Space->Knots[0].Degree(), 5);
  EXPECT_LE(WorstDifference(annulus, *elevated.operator->()), 2e-14);
}

TEST(Refinement, EveryFailureIsReachable)
{
  const Spline<2> annulus = Annulus();
  const Spline<3> bricks = TwoBricks({ 0, 1, 2 }, 0);
  EXPECT_EQ(RefineMarkedElements(bricks, { 0 }).Status.Code, ErrorCode::DimensionMismatch);
  EXPECT_EQ(RefineMarkedElements(annulus, { 1000 }).Status.Code, ErrorCode::InvalidParameter);
  EXPECT_EQ(ElevateAllDegrees(annulus, 7).Status.Code, ErrorCode::InvalidDegree);
  EXPECT_EQ(ElevateAllDegrees(annulus, -1).Status.Code, ErrorCode::InvalidParameter);
  const auto local = RefineMarkedElements(annulus, { 0 });
  EXPECT_EQ(ElevateAllDegrees(local->Value, 1).Status.Code, ErrorCode::DimensionMismatch);
  Spline<2> broken = annulus;
  broken.ControlPoints(3, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(RefineAllElements(broken).Status.Code, ErrorCode::NonFiniteInput);
  Spline<1> twice;
  twice.Space = MakeBezierSpace<1>({ { 2 } }, { 0, 1, 0 }, 2).Value;
  twice.ControlPoints.setZero(2, 3);
  EXPECT_EQ(RefineAllElements(twice).Status.Code, ErrorCode::InvalidTopology);
}

TEST(ControlNet, LinesOfAGrid_GoldenOracle)
{
  const auto space =
    MakeTensorSpace<2>({ KnotVector::Uniform(2, 2), KnotVector::Uniform(3, 2) }).Value; // 4 x 5
  const auto edges = ControlNetEdges(*space);
  EXPECT_EQ(edges.size(), 3u * 5 + 4 * 4);
  std::set<std::array<int, 3>> expected; // function i + 4 j to its right and its upper neighbour
  for (int f = 0; f < 20; ++f)
  {
    if (f % 4 < 3)
    {
      expected.insert({ f, f + 1, 0 });
    }
    if (f / 4 < 4)
    {
      expected.insert({ f, f + 4, 1 });
    }
  }
  std::set<std::array<int, 3>> found;
  for (const NetEdge& edge : edges)
  {
    found.insert({ static_cast<int>(edge.Begin), static_cast<int>(edge.End), edge.Direction });
  }
  EXPECT_EQ(found, expected);
}

TEST(ControlNet, BezierLinesAreFoundOnce_GoldenOracle)
{
  // the lattice of 5 x 3 x 3 points has 4 * 9 + 2 * 15 + 2 * 15 lines
  EXPECT_EQ(ControlNetEdges(*TwoBricks({ 2, 0, 1 }, 5).Space).size(), 96u);
}

TEST(ControlNet, LevelsHaveTheirOwnNets_PropertyOracle)
{
  const auto space = MakeTensorSpace<2>({ KnotVector::Uniform(2, 8), KnotVector::Uniform(2, 8) });
  RefinementParams params;
  params.Extension = 2;
  const auto refined = RefineElements<2>(space.Value, { 0, 1, 9 }, params);
  ASSERT_TRUE(refined) << refined.Status.Message();
  const auto infos = DescribeFunctions(*refined.Value);
  std::set<int> levels;
  for (const NetEdge& edge : ControlNetEdges(*refined.Value))
  {
    const auto& a = infos[static_cast<std::size_t>(edge.Begin)];
    const auto& b = infos[static_cast<std::size_t>(edge.End)];
    const auto d = static_cast<std::size_t>(edge.Direction);
    EXPECT_EQ(a.Level, b.Level);
    EXPECT_EQ(a.Index[d] + 1, b.Index[d]);
    EXPECT_EQ(a.Index[1 - d], b.Index[1 - d]);
    levels.insert(a.Level);
  }
  EXPECT_EQ(levels, (std::set<int>{ 0, 1 }));
}
