// SPDX-License-Identifier: BSD-3-Clause
#include "LRCases.h"
#include <knotwork/SplineCore/BasisEvaluation.h>
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/ControlNet.h>
#include <knotwork/SplineCore/LRStrategies.h>
#include <knotwork/SplineCore/Refinement.h>

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
constexpr double Eps = oracle::Epsilon;

/// Multiplicity of every line over every interval of the other direction, by the definition: the
/// largest of the tensor-product lines and the segments that cover it.
class DenseMesh
{
public:
  DenseMesh(const SplineSpace<2>& tensor, const std::vector<LRSegment>& segments)
  {
    for (int d = 0; d < 2; ++d)
    {
      std::set<double> values(tensor.Knots[d].Breaks().begin(), tensor.Knots[d].Breaks().end());
      for (const LRSegment& s : segments)
      {
        if (s.Direction == d)
        {
          values.insert(s.Value);
        }
      }
      this->Values[d].assign(values.begin(), values.end());
    }
    for (int d = 0; d < 2; ++d)
    {
      const auto& others = this->Values[1 - d];
      for (const double value : this->Values[d])
      {
        const auto& breaks = tensor.Knots[d].Breaks();
        const auto b = std::find(breaks.begin(), breaks.end(), value);
        std::vector<int> line(others.size() - 1,
          b == breaks.end() ? 0
                            : tensor.Knots[d].Multiplicity(static_cast<int>(b - breaks.begin())));
        for (const LRSegment& s : segments)
        {
          for (std::size_t i = 0; i < line.size(); ++i)
          {
            if (s.Direction == d && s.Value == value && s.Start <= others[i] &&
              others[i + 1] <= s.End)
            {
              line[i] = std::max(line[i], s.Multiplicity);
            }
          }
        }
        this->Lines[d].push_back(line);
      }
    }
  }
  /// The mesh of a space equals this one.
  bool Equals(const LRBasis& basis) const
  {
    for (int d = 0; d < 2; ++d)
    {
      if (basis.Knots[d] != this->Values[d])
      {
        return false;
      }
      for (std::size_t k = 0; k < this->Lines[d].size(); ++k)
      {
        for (std::size_t i = 0; i < this->Lines[d][k].size(); ++i)
        {
          const int low = static_cast<int>(i);
          if (LRMultiplicity(basis.Lines[d][k], low, low + 1) != this->Lines[d][k][i])
          {
            return false;
          }
        }
      }
    }
    return true;
  }
  bool HasMinimalSupport(const LRBasis& basis, int f) const
  {
    for (int d = 0; d < 2; ++d)
    {
      const auto t = LocalKnotValues(basis, f, d);
      const auto s = LocalKnotValues(basis, f, 1 - d);
      for (std::size_t k = 0; k < this->Values[d].size(); ++k)
      {
        const double value = this->Values[d][k];
        int least = 99;
        for (std::size_t i = 0; i + 1 < this->Values[1 - d].size(); ++i)
        {
          if (s.front() <= this->Values[1 - d][i] && this->Values[1 - d][i + 1] <= s.back())
          {
            least = std::min(least, this->Lines[d][k][i]);
          }
        }
        const auto has = std::count(t.begin(), t.end(), value);
        const bool inside = t.front() < value && value < t.back();
        if (has > least || (inside && has != least))
        {
          return false;
        }
      }
    }
    return true;
  }

private:
  std::array<std::vector<double>, 2> Values;
  std::array<std::vector<std::vector<int>>, 2> Lines;
};

/// Largest distance from 1 of the row sums of T: the functions' sum in Bernstein form.
double UnityError(const SplineSpace<2>& space)
{
  double worst = 0.0;
  for (std::size_t row = 0; row + 1 < space.RowStart.size(); ++row)
  {
    double sum = 0.0;
    for (std::size_t k = space.RowStart[row]; k < space.RowStart[row + 1]; ++k)
    {
      sum += space.RowCoefficient[k];
    }
    worst = std::max(worst, std::fabs(sum - 1.0));
  }
  return worst;
}

EvaluationBatch Evaluate(const Spline<2>& spline, const PointMatrix& points, int order = 0)
{
  EvaluationBatch batch;
  const Status status =
    EvaluateParameters(MakeBezierForm(spline), points, EvaluationParams{ order, 1 }, batch);
  EXPECT_TRUE(status) << status.Message();
  return batch;
}

double Largest(const PointMatrix& difference)
{
  return difference.size() > 0 ? difference.cwiseAbs().maxCoeff() : 0.0;
}

struct Case
{
  Spline<2> Tensor;
  std::vector<LRSegment> Segments;
  Spline<2> Refined;
};

Case RandomCase(unsigned seed)
{
  Random random(seed);
  Case c;
  const int degree = seed % 7 == 0 ? 9 : 4;
  c.Tensor = RandomClampedSurface(random, degree, 4, 2, seed % 3 == 0);
  c.Segments = RandomSegments(random, c.Tensor.Space, random.Int(1, 14));
  const auto refined = InsertSegments(c.Tensor, c.Segments, 0);
  EXPECT_TRUE(refined) << refined.Status.Message();
  c.Refined = refined.Value;
  return c;
}
}

TEST(LRSpace, BilinearSplit_GoldenOracle)
{
  // u = 1/2 for v in [0, 1] on 2 x 2 unit elements traverses the functions (0,0) and (1,0):
  // B[0,0,1] = B[0,0,1/2] + 1/2 B[0,1/2,1], B[0,1,2] = 1/2 B[0,1/2,1] + B[1/2,1,2]
  Spline<2> spline;
  spline.Space =
    MakeTensorSpace<2>({ KnotVector::Uniform(1, 2, 0, 2), KnotVector::Uniform(1, 2, 0, 2) }).Value;
  spline.ControlPoints = PointMatrix(9, 1);
  spline.ControlPoints << 3, 5, 7, 11, 13, 17, 19, 23, 29;
  const auto refined = InsertSegments(spline, { { 0, 0.5, 0.0, 1.0 } }, 0);
  ASSERT_TRUE(refined) << refined.Status.Message();
  const LRBasis& basis = refined->Space->LocallyRefined->Basis;
  EXPECT_EQ(basis.Knots[0], (std::vector<double>{ 0, 0.5, 1, 2 }));
  EXPECT_EQ(basis.Lines[0][1], (LRLine{ { 0, 1 }, { 1, 0 } }));
  PointMatrix points(10, 1);
  points << 3, 4, 5, 7, 11, 13, 17, 19, 23, 29;
  EXPECT_EQ(refined->ControlPoints, points);
  EXPECT_EQ(basis.Scaling, std::vector<double>(10, 1.0));
  EXPECT_EQ(LocalKnotValues(basis, 1, 0), (std::vector<double>{ 0, 0.5, 1 }));
  EXPECT_EQ(LocalKnotValues(basis, 2, 0), (std::vector<double>{ 0.5, 1, 2 }));
  EXPECT_EQ(refined->Space->NumElements(), 5);
}

TEST(LRSpace, TensorSpaceStaysItself_CrossOracle)
{
  for (unsigned seed = 1; seed <= 20; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const Spline<2> tensor = RandomClampedSurface(random, 5, 5, 3, seed % 2 == 0);
    const auto lr = InsertSegments(tensor, {}, 0);
    ASSERT_TRUE(lr) << lr.Status.Message();
    EXPECT_EQ(lr->ControlPoints, tensor.ControlPoints); // same functions in the same order
    EXPECT_EQ(lr->Space->NumElements(), tensor.Space->NumElements());
    EXPECT_EQ(lr->Space->Knots, tensor.Space->Knots);
    const PointMatrix points = RandomParameters(random, *tensor.Space, 50);
    const auto a = Evaluate(tensor, points, 2);
    const auto b = Evaluate(*lr.operator->(), points, 2);
    EXPECT_EQ(a.Elements, b.Elements);
    EXPECT_LE(Largest(a.Values - b.Values), 64 * Eps * 10);
    EXPECT_LE(Largest(a.First - b.First), 1e-12 * (1 + Largest(a.First)));
    EXPECT_LE(Largest(a.Second - b.Second), 1e-11 * (1 + Largest(a.Second)));
    const auto edges = ControlNetEdges(*tensor.Space);
    const auto others = ControlNetEdges(*lr->Space);
    ASSERT_EQ(edges.size(), others.size());
    for (std::size_t i = 0; i < edges.size(); ++i)
    {
      EXPECT_EQ(edges[i].Begin, others[i].Begin);
      EXPECT_EQ(edges[i].End, others[i].End);
    }
  }
}

TEST(LRSpace, InsertionKeepsTheMap_CrossOracle)
{
  std::size_t inserted = 0;
  for (unsigned seed = 1; seed <= 60; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Case c = RandomCase(seed);
    inserted += c.Segments.size();
    Random random(seed + 1000);
    const PointMatrix points = RandomParameters(random, *c.Refined.Space, 40);
    const auto before = Evaluate(c.Tensor, points, 2);
    const auto after = Evaluate(c.Refined, points, 2);
    // coefficients are at most 10, those of derivatives grow with the lengths of the elements
    EXPECT_LE(Largest(before.Values - after.Values), 1e-13 * 10);
    for (Eigen::Index i = 0; i < points.rows(); ++i)
    {
      const auto plain = LREvaluate(c.Refined, points(i, 0), points(i, 1));
      EXPECT_NEAR(plain[0], after.Values(i, 0), 1e-13 * 10);
      EXPECT_NEAR(plain[1], after.Values(i, 1), 1e-13 * 10);
    }
    if (c.Refined.Space->Elements[0].Degree[0] < 5 && c.Refined.Space->Elements[0].Degree[1] < 5)
    {
      // at interior points of elements, where lines of full multiplicity do not matter
      PointMatrix inside(c.Refined.Space->NumElements(), 2);
      for (Eigen::Index e = 0; e < inside.rows(); ++e)
      {
        const auto& box = c.Refined.Space->Elements[e].Box;
        inside.row(e) << 0.7 * box.Lower[0] + 0.3 * box.Upper[0],
          0.4 * box.Lower[1] + 0.6 * box.Upper[1];
      }
      const auto a = Evaluate(c.Tensor, inside, 2);
      const auto b = Evaluate(c.Refined, inside, 2);
      EXPECT_LE(Largest(a.First - b.First), 1e-10 * (1 + Largest(a.First)));
      EXPECT_LE(Largest(a.Second - b.Second), 1e-7 * (1 + Largest(a.Second)));
    }
  }
  EXPECT_GT(inserted, 250u);
}

TEST(LRSpace, MeshAndMinimalSupportByDefinition_ExactOracle)
{
  for (unsigned seed = 1; seed <= 60; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Case c = RandomCase(seed);
    const LRBasis& basis = c.Refined.Space->LocallyRefined->Basis;
    const DenseMesh mesh(*c.Tensor.Space, c.Segments);
    ASSERT_TRUE(mesh.Equals(basis));
    for (int f = 0; f < basis.NumFunctions(); ++f)
    {
      ASSERT_TRUE(mesh.HasMinimalSupport(basis, f)) << "function " << f;
    }
    // before the last segment some function has not: the check can fail
    const auto fewer =
      InsertSegments(c.Tensor.Space, { c.Segments.begin(), c.Segments.end() - 1 }, 0);
    const LRBasis& old = fewer.Value->LocallyRefined->Basis;
    bool all = true;
    for (int f = 0; f < old.NumFunctions(); ++f)
    {
      all = all && mesh.HasMinimalSupport(old, f);
    }
    const auto last = InsertSegments(fewer.Value, { c.Segments.back() }, 0);
    EXPECT_EQ(all, last.Value->LocallyRefined->Basis == old);
  }
}

TEST(LRSpace, FunctionsSumToOne_PropertyOracle)
{
  for (unsigned seed = 1; seed <= 60; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Case c = RandomCase(seed);
    const SplineSpace<2>& space = *c.Refined.Space;
    EXPECT_LE(UnityError(space), 1e-14);
    Random random(seed);
    const PointMatrix points = RandomParameters(random, space, 20);
    const auto matrix = CollocationMatrix(space, points, 0);
    ASSERT_TRUE(matrix) << matrix.Status.Message();
    for (Eigen::Index i = 0; i < points.rows(); ++i)
    {
      const auto plain = LRFunctions(space.LocallyRefined->Basis, points(i, 0), points(i, 1));
      for (int f = 0; f < space.NumFunctions; ++f)
      {
        EXPECT_NEAR(static_cast<double>(plain[f]), matrix.Value.coeff(i, f), 1e-14);
      }
    }
    for (int e = 0; e < space.NumElements(); ++e)
    {
      const LRData& data = *space.LocallyRefined;
      const std::vector<int> alive(data.AliveFunctions.begin() + data.AliveStart[e],
        data.AliveFunctions.begin() + data.AliveStart[e + 1]);
      EXPECT_EQ(space.AliveFunctions(e), alive);
      EXPECT_GE(
        alive.size(), static_cast<std::size_t>(NumTensorFunctions<2>(space.Elements[e].Degree)));
    }
  }
}

TEST(LRSpace, OrderOfLegalInsertionsDoesNotMatter_PropertyOracle)
{
  int differentOrders = 0;
  for (unsigned seed = 1; seed <= 60; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Case c = RandomCase(seed);
    Random random(seed + 500);
    for (int turn = 0; turn < 3; ++turn)
    {
      // a random order; what is not legal yet waits
      Spline<2> spline = InsertSegments(c.Tensor, {}, 0).Value;
      std::vector<LRSegment> waiting = c.Segments;
      bool progress = true;
      while (!waiting.empty() && progress)
      {
        progress = false;
        std::vector<LRSegment> next;
        while (!waiting.empty())
        {
          const auto at = waiting.begin() + random.Int(0, static_cast<int>(waiting.size()) - 1);
          const LRSegment segment = *at;
          waiting.erase(at);
          auto more = InsertSegments(spline, { segment }, 0);
          if (more)
          {
            spline = more.Value;
            progress = true;
          }
          else
          {
            next.push_back(segment);
          }
        }
        waiting = next;
      }
      if (!waiting.empty())
      {
        continue; // a dead end: some segments are legal in the first order only
      }
      ++differentOrders;
      const LRBasis& a = c.Refined.Space->LocallyRefined->Basis;
      const LRBasis& b = spline.Space->LocallyRefined->Basis;
      ASSERT_EQ(a.Knots, b.Knots);
      ASSERT_EQ(a.Lines, b.Lines);
      ASSERT_EQ(a.LocalKnots, b.LocalKnots);
      for (std::size_t f = 0; f < a.Scaling.size(); ++f)
      {
        EXPECT_NEAR(a.Scaling[f], b.Scaling[f], 1e-13);
      }
      const PointMatrix points = RandomParameters(random, *spline.Space, 10);
      EXPECT_LE(
        Largest(Evaluate(c.Refined, points).Values - Evaluate(spline, points).Values), 1e-12);
    }
  }
  EXPECT_GT(differentOrders, 100);
}

TEST(LRSpace, LocateFindsTheBoxOfEveryPoint_ExactOracle)
{
  for (unsigned seed = 1; seed <= 30; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Case c = RandomCase(seed);
    const SplineSpace<2>& space = *c.Refined.Space;
    Random random(seed);
    const ParametricBox<2> domain = space.Domain();
    for (int i = 0; i < 300; ++i)
    {
      double u[2];
      for (int d = 0; d < 2; ++d)
      {
        const auto& knots = space.LocallyRefined->Basis.Knots[d];
        u[d] = random.Unit() < 0.4 ? knots[random.Int(0, static_cast<int>(knots.size()) - 1)]
                                   : random.In(domain.Lower[d], domain.Upper[d]);
      }
      double local[2];
      const int e = space.Locate(u, local);
      ASSERT_GE(e, 0);
      for (int d = 0; d < 2; ++d)
      {
        const auto& box = space.Elements[e].Box;
        EXPECT_LE(box.Lower[d], u[d]);
        EXPECT_TRUE(u[d] < box.Upper[d] || (u[d] == domain.Upper[d] && u[d] == box.Upper[d]));
        EXPECT_NEAR(box.Lower[d] + local[d] * (box.Upper[d] - box.Lower[d]), u[d], 1e-14);
      }
    }
    double local[2];
    const double outside[2] = { domain.Lower[0] - 1e-6, domain.Lower[1] };
    EXPECT_EQ(space.Locate(outside, local), -1);
    const double nan[2] = { domain.Lower[0], std::numeric_limits<double>::quiet_NaN() };
    EXPECT_EQ(space.Locate(nan, local), -1);
  }
}

TEST(LRSpace, StrategiesAreLegalInAnyOrder_PropertyOracle)
{
  for (unsigned seed = 1; seed <= 30; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    Spline<2> spline = RandomClampedSurface(random, 4, 6, 2, seed % 2 == 0);
    const Spline<2> start = spline;
    spline = InsertSegments(spline, {}, 0).Value;
    for (int step = 0; step < 4; ++step)
    {
      LRStrategyParams params;
      params.Strategy = static_cast<LRStrategy>(random.Int(0, 3));
      const int directions = random.Int(1, 3);
      params.Directions = { (directions & 1) != 0, (directions & 2) != 0 };
      const bool byFunction = random.Unit() < 0.5;
      const int count = byFunction ? spline.Space->NumFunctions : spline.Space->NumElements();
      std::vector<int> marked;
      for (int k = random.Int(1, 4); k > 0; --k)
      {
        marked.push_back(random.Int(0, count - 1));
      }
      auto segments = byFunction ? SegmentsForFunctions(*spline.Space, marked, params)
                                 : SegmentsForElements(*spline.Space, marked, params);
      ASSERT_TRUE(segments) << segments.Status.Message();
      std::reverse(segments.Value.begin(), segments.Value.end());
      const auto refined = InsertSegments(spline, segments.Value, 0);
      ASSERT_TRUE(refined) << refined.Status.Message();
      EXPECT_GT(refined->Space->NumFunctions, spline.Space->NumFunctions);
      spline = refined.Value;
    }
    const PointMatrix points = RandomParameters(random, *spline.Space, 30);
    EXPECT_LE(Largest(Evaluate(start, points).Values - Evaluate(spline, points).Values), 1e-12);
    EXPECT_LE(UnityError(*spline.Space), 1e-14);
  }
}

TEST(LRSpace, RefiningElementsKeepsTheMap_CrossOracle)
{
  for (unsigned seed = 1; seed <= 10; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Case c = RandomCase(seed);
    const int n = c.Refined.Space->NumElements();
    const auto all = RefineAllElements(c.Refined);
    ASSERT_TRUE(all) << all.Status.Message();
    EXPECT_GE(all->Value.Space->NumElements(), 4 * n);
    const auto some = RefineMarkedElements(c.Refined, { 0, n - 1 });
    ASSERT_TRUE(some) << some.Status.Message();
    Random random(seed);
    const PointMatrix points = RandomParameters(random, *c.Refined.Space, 30);
    const PointMatrix before = Evaluate(c.Refined, points).Values;
    EXPECT_LE(Largest(before - Evaluate(all->Value, points).Values), 1e-12);
    EXPECT_LE(Largest(before - Evaluate(some->Value, points).Values), 1e-12);
    for (std::size_t e = 0; e < all->Parents.size(); ++e)
    {
      const auto& parent = c.Refined.Space->Elements[all->Parents[e]].Box;
      EXPECT_GE(all->Value.Space->Elements[e].Box.Lower[0], parent.Lower[0]);
      EXPECT_LE(all->Value.Space->Elements[e].Box.Upper[1], parent.Upper[1]);
    }
  }
}

TEST(LRSpace, EveryFailureIsReachable_ExactOracle)
{
  const auto tensor =
    MakeTensorSpace<2>({ KnotVector::Uniform(2, 4), KnotVector::Uniform(2, 4) }).Value;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto code = [&](const LRSegment& s)
  { return InsertSegments(tensor, { s }, 0).Status.Code; };
  EXPECT_EQ(code({ 0, 0.3, 0.0, 0.75 }), ErrorCode::Ok);
  EXPECT_EQ(code({ 0, 0.3, 0.0, 0.75, 3 }), ErrorCode::Ok);
  EXPECT_EQ(code({ 0, 0.25, 0.0, 0.25 }), ErrorCode::Ok); // is there already
  EXPECT_EQ(code({ 2, 0.3, 0.0, 0.75 }), ErrorCode::InvalidParameter);
  EXPECT_EQ(code({ 0, 0.3, 0.0, 0.75, 0 }), ErrorCode::InvalidParameter);
  EXPECT_EQ(code({ 0, 0.3, 0.0, 0.75, 4 }), ErrorCode::InvalidParameter);
  EXPECT_EQ(code({ 0, 0.3, 0.75, 0.25 }), ErrorCode::InvalidParameter);
  EXPECT_EQ(code({ 0, nan, 0.0, 0.75 }), ErrorCode::NonFiniteInput);
  EXPECT_EQ(code({ 0, 1.5, 0.0, 0.75 }), ErrorCode::OutsideDomain);
  EXPECT_EQ(code({ 0, 0.3, 0.1, 0.75 }), ErrorCode::InvalidTopology);  // starts at no line
  EXPECT_EQ(code({ 0, 0.3, 0.25, 0.75 }), ErrorCode::InvalidTopology); // traverses nothing
  // v = 1/8 is a line for u in [0, 3/4] only: a segment cannot start on it at u = 0.9
  const auto part = InsertSegments(tensor, { { 1, 0.125, 0.0, 0.75 } }, 0);
  ASSERT_TRUE(part) << part.Status.Message();
  const auto hanging = InsertSegments(part.Value, { { 0, 0.9, 0.125, 1.0 } }, 0);
  EXPECT_EQ(hanging.Status.Code, ErrorCode::InvalidTopology);
  EXPECT_NE(hanging.Status.Detail.find("inside an element"), std::string::npos);
  EXPECT_NE(hanging.Status.Detail.find("segment 0"), std::string::npos);

  const auto open = KnotVector::Create(2, { 0, 1, 2, 3, 4, 5 }).Value;
  EXPECT_EQ(InsertSegments(MakeTensorSpace<2>({ open, open }).Value, {}, 0).Status.Code,
    ErrorCode::InvalidKnots);
  const auto hierarchy = MakeHierarchicalSpace<2>(tensor->Knots, { { 1, { 0, 0 }, { 4, 4 } } });
  EXPECT_EQ(InsertSegments(hierarchy.Value, {}, 0).Status.Code, ErrorCode::DimensionMismatch);

  // definitions that are none
  const LRBasis good = LRBasisOfTensor(*tensor).Value;
  const auto made = [](const LRBasis& basis) { return MakeLRSpace(basis, 0).Status.Code; };
  EXPECT_EQ(made(good), ErrorCode::Ok);
  LRBasis bad = good;
  bad.Degree[0] = 10;
  EXPECT_EQ(made(bad), ErrorCode::InvalidDegree);
  bad = good;
  bad.Knots[1][2] = bad.Knots[1][1];
  EXPECT_EQ(made(bad), ErrorCode::InvalidKnots);
  bad = good;
  bad.Lines[0].pop_back();
  EXPECT_EQ(made(bad), ErrorCode::SizeMismatch);
  bad = good;
  bad.Lines[0][2] = { { 0, 1 }, { 2, 0 } };
  EXPECT_EQ(made(bad), ErrorCode::InvalidTopology);
  bad = good;
  bad.Scaling[3] = 0.0;
  EXPECT_EQ(made(bad), ErrorCode::InvalidParameter);
  bad.Scaling[3] = 1.1; // the sum is not 1
  EXPECT_EQ(made(bad), ErrorCode::InvalidTopology);
  bad = good;
  std::swap_ranges(bad.LocalKnots.begin(), bad.LocalKnots.begin() + 8, bad.LocalKnots.begin() + 8);
  EXPECT_EQ(made(bad), ErrorCode::InvalidTopology);

  EXPECT_EQ(SegmentsForElements(*tensor, { 0 }).Status.Code, ErrorCode::DimensionMismatch);
  const auto lr = InsertSegments(tensor, {}, 0).Value;
  EXPECT_EQ(SegmentsForElements(*lr, { 16 }).Status.Code, ErrorCode::InvalidParameter);
  EXPECT_EQ(SegmentsForFunctions(*lr, { -1 }).Status.Code, ErrorCode::InvalidParameter);
}

TEST(LRSpace, FailedInsertionChangesNothing_PropertyOracle)
{
  const auto tensor =
    MakeTensorSpace<2>({ KnotVector::Uniform(3, 6), KnotVector::Uniform(2, 5) }).Value;
  const auto lr = InsertSegments(tensor, {}, 0).Value;
  LRRefinement refinement(*lr, PointMatrix(lr->NumFunctions, 0));
  EXPECT_FALSE(refinement.Insert({ 0, 0.3, 0.2, 0.4 }));
  const auto after = refinement.Finish(nullptr, 0);
  ASSERT_TRUE(after) << after.Status.Message();
  EXPECT_TRUE(after.Value->LocallyRefined->Basis == lr->LocallyRefined->Basis);
}

TEST(LRSpace, ThreadsChangeNothing_PropertyOracle)
{
  const auto tensor =
    MakeTensorSpace<2>({ KnotVector::Uniform(3, 40), KnotVector::Uniform(2, 40) }).Value;
  auto lr = InsertSegments(tensor, {}, 0).Value;
  for (int step = 0; step < 3; ++step)
  {
    // around a diagonal, so that elements of several sizes meet
    std::vector<int> chosen;
    for (int e = 0; e < lr->NumElements(); ++e)
    {
      const auto& box = lr->Elements[static_cast<std::size_t>(e)].Box;
      if (box.Lower[0] < box.Upper[1] && box.Lower[1] < box.Upper[0])
      {
        chosen.push_back(e);
      }
    }
    lr = InsertSegments(lr, SegmentsForElements(*lr, chosen).Value, 0).Value;
  }
  const auto one = MakeLRSpace(lr->LocallyRefined->Basis, 1).Value;
  const auto many = MakeLRSpace(lr->LocallyRefined->Basis, 4).Value;
  ASSERT_GT(one->NumFunctions, 2000);
  EXPECT_EQ(one->LocallyRefined->AliveStart, many->LocallyRefined->AliveStart);
  EXPECT_EQ(one->LocallyRefined->AliveFunctions, many->LocallyRefined->AliveFunctions);
  EXPECT_EQ(one->RowStart, many->RowStart);
  EXPECT_EQ(one->RowFunction, many->RowFunction);
  EXPECT_EQ(one->RowCoefficient, many->RowCoefficient);
  const PointMatrix points = PointMatrix::Random(one->NumFunctions, 3);
  EXPECT_EQ(one->LocalCoefficients(points, 1), many->LocalCoefficients(points, 4));
}

/// The 1000 segments of the reference implementation's benchmark, in the folder that the
/// environment variable names.
TEST(LRSpace, ReplayHasTheReferencesFunctions_GoldenOracle)
{
  const char* folder = std::getenv("KNOTWORK_LR_CASES");
  std::ifstream file(std::string(folder ? folder : "") + "/refine_segments_1000.txt");
  if (!file)
  {
    GTEST_SKIP() << "KNOTWORK_LR_CASES does not name the folder of the LR cases";
  }
  std::vector<LRSegment> segments;
  for (std::string line; std::getline(file, line);)
  {
    LRSegment s;
    if (std::istringstream(line) >> s.Direction >> s.Value >> s.Start >> s.End >> s.Multiplicity)
    {
      segments.push_back(s);
    }
  }
  ASSERT_EQ(segments.size(), 1000u);
  const auto tensor =
    MakeTensorSpace<2>({ KnotVector::Uniform(3, 29), KnotVector::Uniform(3, 29) }).Value;
  const auto space = InsertSegments(tensor, segments, 0);
  ASSERT_TRUE(space) << space.Status.Message();
  EXPECT_EQ(space.Value->NumFunctions, 3428);
  EXPECT_LE(UnityError(*space.Value), 1e-14);
}
