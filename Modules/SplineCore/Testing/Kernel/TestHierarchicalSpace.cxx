// SPDX-License-Identifier: BSD-3-Clause
#include "DenseHierarchy.h"
#include <knotwork/SplineCore/Bernstein.h>
#include <knotwork/SplineCore/HierarchicalSpace.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <string>

using namespace knotwork;
using knotwork::testing::DenseHierarchy;
using knotwork::testing::HierarchyProblem;

namespace
{
using Random = std::mt19937;

int RandomInt(Random& random, int first, int last)
{
  return std::uniform_int_distribution<int>(first, last)(random);
}

double RandomReal(Random& random, double lower, double upper)
{
  return std::uniform_real_distribution<double>(lower, upper)(random);
}

/// Non-uniform knots, some of them repeated, ends clamped or not.
KnotVector RandomKnots(Random& random, int degree, int elements)
{
  std::vector<double> breaks(1, RandomReal(random, -1.0, 1.0));
  for (int e = 0; e < elements; ++e)
  {
    breaks.push_back(breaks.back() + RandomReal(random, 0.3, 1.5));
  }
  std::vector<double> knots;
  const bool clamped = RandomInt(random, 0, 2) > 0;
  for (int k = degree; k > 0; --k)
  {
    knots.push_back(breaks.front() - (clamped ? 0.0 : 0.4 * k));
  }
  for (int b = 0; b <= elements; ++b)
  {
    const bool inside = b > 0 && b < elements;
    const bool repeated = inside && RandomInt(random, 0, 3) == 0;
    knots.insert(knots.end(), repeated ? RandomInt(random, 1, degree + 1) : 1, breaks[b]);
  }
  for (int k = 1; k <= degree; ++k)
  {
    knots.push_back(breaks.back() + (clamped ? 0.0 : 0.7 * k));
  }
  auto result = KnotVector::Create(degree, knots);
  EXPECT_TRUE(result) << result.Status.Message();
  return result.Value;
}

template <int Dim>
using Problem = HierarchyProblem<Dim>;

template <int Dim>
HierarchyBox<Dim> RandomBox(Random& random, const std::array<KnotVector, Dim>& knots, int level)
{
  HierarchyBox<Dim> box;
  box.Level = level;
  for (int d = 0; d < Dim; ++d)
  {
    const int cells = knots[d].NumElements() << level;
    box.Lower[d] = RandomInt(random, 0, cells - 1);
    box.Upper[d] = RandomInt(random, static_cast<int>(box.Lower[d]) + 1, cells);
  }
  return box;
}

/// Overlapping boxes in any order; their number varies from none to three.
template <int Dim>
Problem<Dim> RandomProblem(Random& random, int maxDegree, int maxElements, int maxLevel)
{
  Problem<Dim> problem;
  for (auto& knots : problem.Knots)
  {
    knots = RandomKnots(random, RandomInt(random, 1, maxDegree), RandomInt(random, 1, maxElements));
  }
  const int boxes = RandomInt(random, 0, 3);
  for (int i = 0; i < boxes; ++i)
  {
    problem.Boxes.push_back(RandomBox<Dim>(random, problem.Knots, RandomInt(random, 1, maxLevel)));
  }
  return problem;
}

template <int Dim>
SplineSpacePtr<Dim> Make(const Problem<Dim>& problem)
{
  auto space = MakeHierarchicalSpace<Dim>(problem.Knots, problem.Boxes);
  EXPECT_TRUE(space) << space.Status.Message();
  return space.Value;
}

template <int Dim>
RealArray<Dim> RandomPoint(Random& random, const SplineSpace<Dim>& space)
{
  const auto domain = space.Domain();
  RealArray<Dim> u;
  for (int d = 0; d < Dim; ++d)
  {
    u[d] = RandomReal(random, domain.Lower[d], domain.Upper[d]);
  }
  return u;
}

/// Values of all functions of a space at a point.
template <int Dim>
Eigen::VectorXd FunctionValues(const SplineSpace<Dim>& space, const double* u)
{
  RealArray<Dim> local;
  const int e = space.Locate(u, local.data());
  EXPECT_GE(e, 0);
  const auto& degree = space.Elements[e].Degree;
  Eigen::VectorXd bernstein = Eigen::VectorXd::Ones(NumTensorFunctions<Dim>(degree));
  int stride = 1;
  for (int d = 0; d < Dim; ++d)
  {
    double values[MaxDegree + 1];
    BernsteinValues(degree[d], local[d], values);
    for (int i = 0; i < bernstein.size(); ++i)
    {
      bernstein[i] *= values[i / stride % (degree[d] + 1)];
    }
    stride *= degree[d] + 1;
  }
  const Eigen::VectorXd alive = space.ExtractionOperator(e) * bernstein;
  const std::vector<int> ids = space.AliveFunctions(e);
  Eigen::VectorXd values = Eigen::VectorXd::Zero(space.NumFunctions);
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    values[ids[i]] = alive[static_cast<Eigen::Index>(i)];
  }
  return values;
}

template <int Dim>
PointMatrix Evaluate(const Spline<Dim>& spline, const double* u)
{
  return FunctionValues(*spline.Space, u).transpose() * spline.HomogeneousPoints();
}

template <int Dim>
Spline<Dim> RandomSpline(Random& random, const SplineSpacePtr<Dim>& space, bool rational)
{
  Spline<Dim> spline;
  spline.Space = space;
  spline.ControlPoints.resize(space->NumFunctions, 3);
  for (Eigen::Index i = 0; i < spline.ControlPoints.size(); ++i)
  {
    spline.ControlPoints.data()[i] = RandomReal(random, -1.0, 1.0);
  }
  if (rational)
  {
    spline.Weights.resize(space->NumFunctions);
    for (Eigen::Index i = 0; i < spline.Weights.size(); ++i)
    {
      spline.Weights[i] = RandomReal(random, 0.5, 2.0);
    }
  }
  return spline;
}

template <int Dim>
void CompareWithDefinition(unsigned seeds, int maxDegree, int maxElements, int maxLevel)
{
  for (unsigned seed = 1; seed <= seeds; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto problem = RandomProblem<Dim>(random, maxDegree, maxElements, maxLevel);
    const auto space = Make(problem);
    const DenseHierarchy<Dim> dense(problem);
    const auto info = DescribeFunctions(*space);
    ASSERT_EQ(space->NumFunctions, static_cast<int>(dense.Level.size()));
    ASSERT_EQ(info.size(), dense.Level.size());
    for (std::size_t i = 0; i < info.size(); ++i)
    {
      ASSERT_EQ(info[i].Level, dense.Level[i]);
      ASSERT_EQ(info[i].Index, dense.Index[i]);
    }
    for (int k = 0; k < 20; ++k)
    {
      const auto u = RandomPoint(random, *space);
      // values are at most 1; the interpolation behind the oracle loses some digits
      ASSERT_LT((FunctionValues(*space, u.data()) - dense.Values(u)).cwiseAbs().maxCoeff(), 1e-10);
    }
  }
}

/// Space equality in every array that an algorithm can see.
template <int Dim>
void ExpectSame(const SplineSpace<Dim>& a, const SplineSpace<Dim>& b)
{
  ASSERT_EQ(a.NumElements(), b.NumElements());
  for (int e = 0; e < a.NumElements(); ++e)
  {
    ASSERT_EQ(a.Elements[e].Level, b.Elements[e].Level);
    ASSERT_EQ(a.Elements[e].Box.Lower, b.Elements[e].Box.Lower);
    ASSERT_EQ(a.Elements[e].Box.Upper, b.Elements[e].Box.Upper);
  }
  EXPECT_EQ(a.NumFunctions, b.NumFunctions);
  EXPECT_EQ(a.LocalFunctionIds, b.LocalFunctionIds);
  EXPECT_EQ(a.RowStart, b.RowStart);
  EXPECT_EQ(a.RowFunction, b.RowFunction);
  EXPECT_EQ(a.RowCoefficient, b.RowCoefficient);
  EXPECT_EQ(a.RootCells, b.RootCells);
  EXPECT_EQ(a.Tree, b.Tree);
}

template <int Dim>
int MaxLevelsAlive(const SplineSpace<Dim>& space)
{
  const auto info = DescribeFunctions(space);
  int most = 0;
  for (int e = 0; e < space.NumElements(); ++e)
  {
    int lowest = 99, highest = 0;
    for (int f : space.AliveFunctions(e))
    {
      lowest = std::min(lowest, info[f].Level);
      highest = std::max(highest, info[f].Level);
    }
    most = std::max(most, highest - lowest + 1);
  }
  return most;
}

/// Calls the function template for each dimension.
#define FOR_EACH_DIM(Call)                                                                         \
  {                                                                                                \
    SCOPED_TRACE("Dim 1");                                                                         \
    Call<1>(40, 5, 5, 4);                                                                          \
  }                                                                                                \
  {                                                                                                \
    SCOPED_TRACE("Dim 2");                                                                         \
    Call<2>(25, 4, 4, 3);                                                                          \
  }                                                                                                \
  {                                                                                                \
    SCOPED_TRACE("Dim 3");                                                                         \
    Call<3>(10, 3, 3, 2);                                                                          \
  }

template <int Dim>
void CheckRows(unsigned seeds, int maxDegree, int maxElements, int maxLevel)
{
  for (unsigned seed = 1; seed <= seeds; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto space = Make(RandomProblem<Dim>(random, maxDegree, maxElements, maxLevel));
    if (space->IsIdentityMap())
    {
      EXPECT_EQ(space->NumLocalFunctions, space->NumFunctions);
      continue;
    }
    ASSERT_EQ(space->RowStart.size(), static_cast<std::size_t>(space->NumLocalFunctions) + 1);
    std::set<int> unitRows;
    for (int j = 0; j < space->NumLocalFunctions; ++j)
    {
      double sum = 0.0;
      const std::size_t begin = space->RowStart[j], end = space->RowStart[j + 1];
      ASSERT_LT(begin, end);
      for (std::size_t k = begin; k < end; ++k)
      {
        ASSERT_GT(space->RowCoefficient[k], 0.0);
        ASSERT_TRUE(k == begin || space->RowFunction[k - 1] < space->RowFunction[k]);
        sum += space->RowCoefficient[k];
      }
      if (end - begin == 1 && space->RowCoefficient[begin] == 1.0)
      {
        unitRows.insert(space->RowFunction[begin]);
      }
      // each level adds a rounded convex combination of at most (p + 1)^Dim rows
      ASSERT_NEAR(sum, 1.0, 1e-13);
    }
    // The B-splines alive on an element are independent there, so T P = 0 for the zero spline; T
    // contains the unit row of every function, so P = 0: the functions are independent.
    EXPECT_EQ(static_cast<int>(unitRows.size()), space->NumFunctions);
    const std::set<int> used(space->LocalFunctionIds.begin(), space->LocalFunctionIds.end());
    EXPECT_EQ(static_cast<int>(used.size()), space->NumLocalFunctions);
  }
}

template <int Dim>
void CheckTransfer(unsigned seeds, int maxDegree, int maxElements, int maxLevel)
{
  for (unsigned seed = 1; seed <= seeds; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto problem = RandomProblem<Dim>(random, maxDegree, maxElements, maxLevel);
    Spline<Dim> spline = RandomSpline<Dim>(random,
      seed % 4 == 0 ? MakeTensorSpace<Dim>(problem.Knots).Value : Make(problem), seed % 2 == 0);
    for (int step = 0; step < 3; ++step)
    {
      RefinementParams params;
      params.Extension = RandomInt(random, 0, 2);
      params.MaxLevel = maxLevel + 1;
      params.AdmissibleClass = step == 2 ? 2 : 0;
      std::vector<int> marked;
      for (int k = 0; k < 2; ++k)
      {
        marked.push_back(RandomInt(random, 0, spline.Space->NumElements() - 1));
      }
      const auto refined = RefineElements<Dim>(spline.Space, marked, params);
      ASSERT_TRUE(refined) << refined.Status.Message();
      const auto result = TransferToRefined<Dim>(spline, refined.Value);
      ASSERT_TRUE(result) << result.Status.Message();
      ASSERT_TRUE(result->Check()) << result->Check().Message();
      EXPECT_EQ(result->IsRational(), spline.IsRational());
      for (int k = 0; k < 20; ++k)
      {
        const auto u = RandomPoint(random, *spline.Space);
        // coordinates and weights are at most 2
        ASSERT_LT((Evaluate(spline, u.data()) - Evaluate(result.Value, u.data())).norm(), 1e-13);
      }
      // Preservation of coefficients: a function that is active in both spaces keeps its point.
      std::map<std::pair<int, std::array<std::int64_t, Dim>>, int> ids;
      const auto before = DescribeFunctions(*spline.Space);
      for (std::size_t i = 0; i < before.size(); ++i)
      {
        ids[{ before[i].Level, before[i].Index }] = static_cast<int>(i);
      }
      const auto after = DescribeFunctions(*refined.Value);
      for (std::size_t i = 0; i < after.size(); ++i)
      {
        const auto old = ids.find({ after[i].Level, after[i].Index });
        if (old != ids.end())
        {
          ASSERT_LT((result->ControlPoints.row(static_cast<Eigen::Index>(i)) -
                      spline.ControlPoints.row(old->second))
                      .norm(),
            4e-16 * 4);
        }
      }
      spline = result.Value;
    }
  }
}

template <int Dim>
void CheckGreville(unsigned seeds, int maxDegree, int maxElements, int maxLevel)
{
  for (unsigned seed = 1; seed <= seeds; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto space = Make(RandomProblem<Dim>(random, maxDegree, maxElements, maxLevel));
    const auto info = DescribeFunctions(*space);
    for (int k = 0; k < 20; ++k)
    {
      const auto u = RandomPoint(random, *space);
      const Eigen::VectorXd values = FunctionValues(*space, u.data());
      for (int d = 0; d < Dim; ++d)
      {
        double sum = 0.0;
        for (int f = 0; f < space->NumFunctions; ++f)
        {
          sum += values[f] * info[f].Greville[d];
        }
        ASSERT_NEAR(sum, u[d], 1e-13 * 10.0); // parameters are below 10
      }
    }
  }
}

template <int Dim>
void CheckBoxes(unsigned seeds, int maxDegree, int maxElements, int maxLevel)
{
  for (unsigned seed = 1; seed <= seeds; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto problem = RandomProblem<Dim>(random, maxDegree, maxElements, maxLevel);
    const auto space = Make(problem);
    auto boxes = HierarchyBoxes(*space);
    std::map<int, double> volume, volumeOfElements;
    for (const auto& box : boxes)
    {
      double cells = 1.0;
      for (int d = 0; d < Dim; ++d)
      {
        cells *= static_cast<double>(box.Upper[d] - box.Lower[d]);
        EXPECT_TRUE(box.Lower[d] % 2 == 0 && box.Upper[d] % 2 == 0);
      }
      volume[box.Level] += cells;
    }
    for (const auto& element : space->Elements)
    {
      for (int l = 1; l <= element.Level; ++l)
      {
        volumeOfElements[l] += std::pow(0.5, Dim * (element.Level - l));
      }
    }
    EXPECT_EQ(volume, volumeOfElements); // so the boxes of a level are disjoint
    std::shuffle(boxes.begin(), boxes.end(), random);
    const auto again = MakeHierarchicalSpace<Dim>(problem.Knots, boxes);
    ASSERT_TRUE(again) << again.Status.Message();
    ExpectSame(*space, *again.Value);
  }
}

template <int Dim>
void CheckLocate(unsigned seeds, int maxDegree, int maxElements, int maxLevel)
{
  for (unsigned seed = 1; seed <= seeds; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto space = Make(RandomProblem<Dim>(random, maxDegree, maxElements, maxLevel));
    double volume = 0.0, domainVolume = 1.0;
    for (int d = 0; d < Dim; ++d)
    {
      domainVolume *= space->Domain().Upper[d] - space->Domain().Lower[d];
    }
    for (int e = 0; e < space->NumElements(); ++e)
    {
      const auto& box = space->Elements[e].Box;
      RealArray<Dim> u, t, local;
      double size = 1.0;
      for (int d = 0; d < Dim; ++d)
      {
        t[d] = RandomReal(random, 0.01, 0.99);
        u[d] = box.Lower[d] + t[d] * (box.Upper[d] - box.Lower[d]);
        size *= box.Upper[d] - box.Lower[d];
      }
      volume += size;
      ASSERT_EQ(space->Locate(u.data(), local.data()), e);
      for (int d = 0; d < Dim; ++d)
      {
        ASSERT_NEAR(local[d], t[d], 1e-12);
      }
    }
    EXPECT_NEAR(volume, domainVolume, 1e-12 * domainVolume);
  }
}

template <int Dim>
void CheckAdmissible(unsigned seeds, int maxDegree, int maxElements, int maxLevel)
{
  int mostUngraded = 0;
  for (unsigned seed = 1; seed <= seeds; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto problem = RandomProblem<Dim>(random, maxDegree, maxElements, maxLevel);
    const auto tensor = MakeTensorSpace<Dim>(problem.Knots).Value;
    const std::vector<HierarchyBox<Dim>> boxes = { RandomBox<Dim>(
      random, problem.Knots, maxLevel) };
    const auto ungraded = RefineBoxes<Dim>(tensor, boxes);
    ASSERT_TRUE(ungraded) << ungraded.Status.Message();
    mostUngraded = std::max(mostUngraded, MaxLevelsAlive(*ungraded.Value));
    for (int m : { 2, 3 })
    {
      RefinementParams params;
      params.AdmissibleClass = m;
      const auto graded = RefineBoxes<Dim>(tensor, boxes, params);
      ASSERT_TRUE(graded) << graded.Status.Message();
      EXPECT_LE(MaxLevelsAlive(*graded.Value), m);
      EXPECT_GE(graded.Value->NumElements(), ungraded.Value->NumElements());
      // a graded space is closed: grading it again changes nothing and gives the same object
      const auto again = RefineBoxes<Dim>(graded.Value, {}, params);
      ASSERT_TRUE(again);
      EXPECT_EQ(again.Value, graded.Value);
      // a space that was refined without grading is graded as a whole
      const auto later = RefineElements<Dim>(ungraded.Value, {}, params);
      ASSERT_TRUE(later);
      ExpectSame(*later.Value, *graded.Value);
    }
  }
  EXPECT_GT(mostUngraded, 2); // the grading had something to do
}

template <int Dim>
std::array<KnotVector, Dim> UniformKnots(int degree, int elements)
{
  std::array<KnotVector, Dim> knots;
  knots.fill(KnotVector::Uniform(degree, elements));
  return knots;
}

template <int Dim>
std::vector<int> FunctionsPerLevel(const SplineSpace<Dim>& space)
{
  std::vector<int> counts;
  for (const auto& info : DescribeFunctions(space))
  {
    counts.resize(std::max<std::size_t>(counts.size(), info.Level + 1));
    ++counts[info.Level];
  }
  return counts;
}
}

TEST(HierarchicalSpace, TruncatedFunctionsFollowTheirDefinition_CrossOracle)
{
  CompareWithDefinition<1>(60, 5, 5, 4);
  CompareWithDefinition<2>(25, 4, 3, 2);
  CompareWithDefinition<3>(10, 2, 2, 2);
}

TEST(HierarchicalSpace,
  RowsArePartitionOfUnityAndContainIdentity_PropertyOracle){ FOR_EACH_DIM(CheckRows) }

TEST(HierarchicalSpace,
  RefinementKeepsMapAndCoefficients_PropertyOracle){ FOR_EACH_DIM(CheckTransfer) }

TEST(HierarchicalSpace,
  GrevillePointsReproduceParameters_PropertyOracle){ FOR_EACH_DIM(CheckGreville) }

TEST(HierarchicalSpace, BoxesDescribeTheSameSpace_CrossOracle){ FOR_EACH_DIM(CheckBoxes) }

TEST(HierarchicalSpace, LocateFindsEveryElement_CrossOracle){ FOR_EACH_DIM(CheckLocate) }

TEST(HierarchicalSpace, AdmissibleClassLimitsLevels_PropertyOracle){ FOR_EACH_DIM(CheckAdmissible) }

// Bicubic, 16 x 16 elements, refined along the diagonal: counts of two independent libraries.
TEST(HierarchicalSpace, DiagonalToLevelSix_GoldenOracle)
{
  auto space = MakeTensorSpace<2>(UniformKnots<2>(3, 16)).Value;
  RefinementParams params;
  params.Extension = 2;
  for (int l = 0; l < 6; ++l)
  {
    std::vector<int> marked;
    for (int i = 0; i < 16 << l; ++i)
    {
      const double u = (i + 0.5) / (16 << l);
      RealArray<2> local;
      marked.push_back(space->Locate(RealArray<2>{ u, u }.data(), local.data()));
    }
    space = RefineElements<2>(space, marked, params).Value;
    ASSERT_NE(space, nullptr);
  }
  EXPECT_EQ(space->NumFunctions, 8551);
  EXPECT_EQ(FunctionsPerLevel(*space), (std::vector<int>{ 343, 149, 277, 533, 1045, 2069, 4135 }));
}

// Tricubic, 8^3 elements, refined where cells and their neighbours meet a sphere.
TEST(HierarchicalSpace, SphereToLevelThree_GoldenOracle)
{
  const auto knots = UniformKnots<3>(3, 8);
  std::vector<HierarchyBox<3>> boxes;
  const std::array<int, 3> expected = { 4247, 11555, 40295 };
  for (int l = 0; l < 3; ++l)
  {
    const int n = 8 << l;
    for (int c = 0; c < n * n * n; ++c)
    {
      const std::array<int, 3> cell = { c % n, c / n % n, c / n / n };
      double nearest = 0.0, farthest = 0.0;
      HierarchyBox<3> box;
      box.Level = l + 1;
      for (int d = 0; d < 3; ++d)
      {
        const double lower = static_cast<double>(cell[d]) / n - 0.5, upper = lower + 1.0 / n;
        nearest += std::pow(std::max({ lower, -upper, 0.0 }), 2);
        farthest += std::pow(std::max(-lower, upper), 2);
        box.Lower[d] = std::max(0, 2 * (cell[d] - 1));
        box.Upper[d] = std::min(2 * n, 2 * (cell[d] + 2));
      }
      if (std::sqrt(nearest) <= 0.35 && std::sqrt(farthest) >= 0.35)
      {
        boxes.push_back(box);
      }
    }
    const auto space = MakeHierarchicalSpace<3>(knots, boxes);
    ASSERT_TRUE(space) << space.Status.Message();
    EXPECT_EQ(space.Value->NumFunctions, expected[l]);
  }
}

// A refined rectangle of a x b level-0 cells away from the boundary removes the functions with
// support inside, (a - p)(b - p), and adds the level-1 functions inside, (2a - p)(2b - p).
TEST(HierarchicalSpace, RectangleHasFormulaDimension_ExactOracle)
{
  for (int p = 1; p <= 5; ++p)
  {
    for (int a = 1; a <= 8; ++a)
    {
      for (int b = 1; b <= 8; ++b)
      {
        const int elements = 12 + 2 * p, offset = p + 1;
        HierarchyBox<2> box{ 1, { 2 * offset, 2 * offset },
          { 2 * (offset + a), 2 * (offset + b) } };
        const auto space = MakeHierarchicalSpace<2>(UniformKnots<2>(p, elements), { box }).Value;
        const int removed = std::max(0, a - p) * std::max(0, b - p);
        const int added = std::max(0, 2 * a - p) * std::max(0, 2 * b - p);
        EXPECT_EQ(space->NumFunctions, (elements + p) * (elements + p) - removed + added);
        EXPECT_EQ(space->NumElements(), elements * elements + 3 * a * b);
      }
    }
  }
}

// One element of a 1D mesh: [2i - ext, 2i + 2 + ext) grown to whole parents and clipped.
TEST(HierarchicalSpace, ExtensionCountsNewCells_GoldenOracle)
{
  const auto tensor = MakeTensorSpace<1>(UniformKnots<1>(2, 8)).Value;
  const auto refined = [&](int element, int extension)
  {
    RefinementParams params;
    params.Extension = extension;
    const auto boxes = HierarchyBoxes(*RefineElements<1>(tensor, { element }, params).Value);
    EXPECT_EQ(boxes.size(), 1u);
    return std::array<std::int64_t, 2>{ boxes[0].Lower[0], boxes[0].Upper[0] };
  };
  EXPECT_EQ(refined(3, 0), (std::array<std::int64_t, 2>{ 6, 8 }));
  EXPECT_EQ(refined(3, 1), (std::array<std::int64_t, 2>{ 4, 10 })); // [5, 9) in whole parents
  EXPECT_EQ(refined(3, 2), (std::array<std::int64_t, 2>{ 4, 10 }));
  EXPECT_EQ(refined(3, 3), (std::array<std::int64_t, 2>{ 2, 12 }));
  EXPECT_EQ(refined(0, 2), (std::array<std::int64_t, 2>{ 0, 4 }));
  EXPECT_EQ(refined(7, 1), (std::array<std::int64_t, 2>{ 12, 16 }));
  EXPECT_EQ(refined(3, 100), (std::array<std::int64_t, 2>{ 0, 16 }));
}

TEST(HierarchicalSpace, MaxLevelStopsRefinement_ExactOracle)
{
  const auto tensor = MakeTensorSpace<2>(UniformKnots<2>(2, 4)).Value;
  RefinementParams params;
  params.MaxLevel = 0;
  EXPECT_EQ(RefineElements<2>(tensor, { 5 }, params).Value, tensor);
  EXPECT_EQ(RefineElements<2>(tensor, {}).Value, tensor);
  params.MaxLevel = 2;
  const HierarchyBox<2> deep{ 5, { 33, 1 }, { 34, 2 } };
  const auto space = RefineBoxes<2>(tensor, { deep }, params).Value;
  // level-5 cell (33, 1) lies in level-1 cell (2, 0), the finest that may be refined
  const auto same = MakeHierarchicalSpace<2>(tensor->Knots, { { 2, { 4, 0 }, { 6, 2 } } }).Value;
  ExpectSame(*space, *same);
  EXPECT_EQ(RefineBoxes<2>(space, { deep }, params).Value, space);
}

// The finest level, where no array over the level's grid could exist, in a corner and inside.
TEST(HierarchicalSpace, DeepestLevel_PropertyOracle)
{
  auto knots = KnotVector::Create(3, { 0, 0, 0, 0, 0.3, 1.1, 1.1, 2, 2, 2, 2 }).Value;
  const RealArray<2> target = { 0.3, 1.1 };
  Random random(7);
  auto spline = RandomSpline<2>(random, MakeTensorSpace<2>({ knots, knots }).Value, true);
  const Spline<2> start = spline;
  RefinementParams params;
  params.Extension = 2;
  params.AdmissibleClass = 3;
  for (int l = 0; l < 30; ++l)
  {
    std::vector<int> marked;
    RealArray<2> local;
    marked.push_back(spline.Space->Locate(target.data(), local.data()));
    marked.push_back(spline.Space->Locate(RealArray<2>{ 2.0, 2.0 }.data(), local.data()));
    const auto refined = RefineElements<2>(spline.Space, marked, params);
    ASSERT_TRUE(refined) << refined.Status.Message();
    const auto result = TransferToRefined<2>(spline, refined.Value);
    ASSERT_TRUE(result) << result.Status.Message();
    spline = result.Value;
  }
  RealArray<2> local;
  const int e = spline.Space->Locate(target.data(), local.data());
  EXPECT_EQ(spline.Space->Elements[e].Level, 24);
  EXPECT_EQ(spline.Space->Elements[e].Box.Lower, target);
  EXPECT_EQ(spline.Space->Elements[e].Box.Upper[0], 0.3 + std::ldexp(1.1 - 0.3, -24));
  EXPECT_EQ(spline.Space->Elements.back().Box.Upper, (RealArray<2>{ 2.0, 2.0 }));
  EXPECT_LE(MaxLevelsAlive(*spline.Space), 3);
  for (int k = 0; k < 200; ++k)
  {
    // points at all distances from the target; coordinates and weights are at most 2
    const double h = std::ldexp(0.5, -(k % 26));
    const RealArray<2> u = { target[0] + h * RandomReal(random, -0.5, 1.0),
      target[1] + h * RandomReal(random, -1.0, 1.0) };
    ASSERT_LT((Evaluate(start, u.data()) - Evaluate(spline, u.data())).norm(), 1e-13);
  }
}

TEST(HierarchicalSpace, EveryFailureIsReachable_GoldenOracle)
{
  const auto knots = UniformKnots<2>(2, 4);
  const auto code = [&](HierarchyBox<2> box)
  { return MakeHierarchicalSpace<2>(knots, { box }).Status.Code; };
  EXPECT_EQ(code({ 0, { 0, 0 }, { 1, 1 } }), ErrorCode::InvalidTopology);
  EXPECT_EQ(code({ 25, { 0, 0 }, { 1, 1 } }), ErrorCode::InvalidTopology);
  EXPECT_EQ(code({ 1, { -1, 0 }, { 1, 1 } }), ErrorCode::InvalidTopology);
  EXPECT_EQ(code({ 1, { 0, 0 }, { 9, 1 } }), ErrorCode::InvalidTopology);
  EXPECT_EQ(code({ 1, { 3, 0 }, { 2, 1 } }), ErrorCode::InvalidTopology);
  EXPECT_EQ(code({ 1, { 3, 0 }, { 3, 1 } }), ErrorCode::Ok); // empty
  EXPECT_EQ(code({ 24, { 0, 0 }, { 4 << 24, 4 << 24 } }), ErrorCode::TooLarge);

  const auto tensor = MakeTensorSpace<2>(knots).Value;
  EXPECT_EQ(RefineElements<2>(tensor, { -1 }).Status.Code, ErrorCode::InvalidParameter);
  EXPECT_EQ(RefineElements<2>(tensor, { 16 }).Status.Code, ErrorCode::InvalidParameter);
  EXPECT_EQ(RefineElements<2>(nullptr, {}).Status.Code, ErrorCode::EmptyInput);
  EXPECT_EQ(RefineBoxes<2>(nullptr, {}).Status.Code, ErrorCode::EmptyInput);
  EXPECT_EQ(
    RefineBoxes<2>(tensor, { { 1, { 0, 0 }, { 9, 1 } } }).Status.Code, ErrorCode::InvalidTopology);
  EXPECT_EQ(
    RefineElements<2>(tensor, { 0 }, { -1, 0, 24 }).Status.Code, ErrorCode::InvalidParameter);
  EXPECT_EQ(
    RefineElements<2>(tensor, { 0 }, { 0, 1, 24 }).Status.Code, ErrorCode::InvalidParameter);
  EXPECT_EQ(RefineBoxes<2>(tensor, {}, { 0, 0, 25 }).Status.Code, ErrorCode::InvalidParameter);
  auto bezier = std::make_shared<SplineSpace<2>>();
  bezier->Kind = SpaceKind::Bezier;
  EXPECT_EQ(RefineElements<2>(bezier, {}).Status.Code, ErrorCode::DimensionMismatch);

  Random random(1);
  const auto left = RefineElements<2>(tensor, { 0 }).Value;
  const auto right = RefineElements<2>(tensor, { 15 }).Value;
  const auto spline = RandomSpline<2>(random, left, false);
  EXPECT_EQ(TransferToRefined<2>(spline, right).Status.Code, ErrorCode::InvalidTopology);
  EXPECT_EQ(TransferToRefined<2>(spline, tensor).Status.Code, ErrorCode::InvalidTopology);
  EXPECT_EQ(TransferToRefined<2>(spline, nullptr).Status.Code, ErrorCode::EmptyInput);
  EXPECT_EQ(TransferToRefined<2>(spline, bezier).Status.Code, ErrorCode::DimensionMismatch);
  EXPECT_EQ(
    TransferToRefined<2>(spline, MakeTensorSpace<2>(UniformKnots<2>(2, 5)).Value).Status.Code,
    ErrorCode::DimensionMismatch);
  auto broken = spline;
  broken.ControlPoints.conservativeResize(3, 3);
  EXPECT_EQ(TransferToRefined<2>(broken, left).Status.Code, ErrorCode::SizeMismatch);
  EXPECT_TRUE(HierarchyBoxes(*tensor).empty());
}
