// SPDX-License-Identifier: BSD-3-Clause
// Trivariate LR B-splines against their plain definition and against exact linear algebra.
#include "LRCases.h"
#include "PrimeField.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/LRDependence.h>
#include <knotwork/SplineCore/LRVolume.h>
#include <knotwork/SplineCore/TensorForm.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
constexpr int NoLimit = std::numeric_limits<int>::max();

std::vector<double> KnotValues(const LRVolumeBasis& basis, int f, int d)
{
  std::vector<double> t;
  for (int i = 0; i < basis.Degree[d] + 2; ++i)
  {
    t.push_back(basis.Knots[d][basis.Local(f, d)[i]]);
  }
  return t;
}

/// The spline by the definition of its functions, and their sum.
std::vector<Real> EvaluatePlainly(const Spline<3>& spline, const double* u, Real& unity)
{
  const LRVolumeBasis& basis = LRVolumeOf(*spline.Space).Basis;
  const PointMatrix points = spline.HomogeneousPoints();
  std::vector<Real> sum(points.cols(), 0);
  unity = 0;
  for (int f = 0; f < basis.NumFunctions(); ++f)
  {
    Real value = basis.Scaling[f];
    for (int d = 0; d < 3 && value != 0; ++d)
    {
      value *= LocalBSpline(KnotValues(basis, f, d), u[d], basis.Knots[d].back());
    }
    unity += value;
    for (Eigen::Index c = 0; c < points.cols(); ++c)
    {
      sum[c] += value * points(f, c);
    }
  }
  return sum;
}

Spline<3> RandomClampedVolume(Random& random, int maxDegree, int elements, bool rational)
{
  std::array<KnotVector, 3> knots;
  for (KnotVector& k : knots)
  {
    const int degree = random.Int(1, maxDegree);
    k = MildKnots(random, degree, random.Int(1, elements), random.Int(1, degree), true);
  }
  return RandomSpline<3>(random, MakeTensorSpace<3>(knots).Value, 2, rational);
}

/// A rectangle across the support of a function on a random element.
LRRectangle RandomRectangle(Random& random, const SplineSpace<3>& space)
{
  const LRVolume& volume = LRVolumeOf(space);
  const int e = random.Int(0, space.NumElements() - 1);
  const auto first = static_cast<int>(volume.AliveStart[e]);
  const auto last = static_cast<int>(volume.AliveStart[e + 1]) - 1;
  const int f = volume.AliveFunctions[random.Int(first, last)];
  const ParametricBox<3>& box = space.Elements[e].Box;
  LRRectangle rectangle;
  const int d = random.Int(0, 2);
  rectangle.Direction = d;
  const double where = random.Unit() < 0.7 ? 0.5 : random.In(0.1, 0.9);
  rectangle.Value = box.Lower[d] + where * (box.Upper[d] - box.Lower[d]);
  if (random.Unit() < 0.3)
  {
    rectangle.Multiplicity = random.Int(1, volume.Basis.Degree[d] + 1);
  }
  const auto across = LRVolumeBasis::Across(d);
  for (int i = 0; i < 2; ++i)
  {
    const std::vector<double> t = KnotValues(volume.Basis, f, across[i]);
    rectangle.Lower[i] = t.front();
    rectangle.Upper[i] = t.back();
  }
  return rectangle;
}

/// A spline with so many rectangles, one after the other, and what was inserted.
Spline<3> Refined(
  Random& random, Spline<3> spline, int count, std::vector<LRRectangle>* inserted = nullptr)
{
  spline = InsertRectangles(spline, {}, NoLimit, 0).Value;
  for (int i = 0; i < count; ++i)
  {
    const LRRectangle rectangle = RandomRectangle(random, *spline.Space);
    auto next = InsertRectangles(spline, { rectangle }, NoLimit, 0);
    EXPECT_TRUE(next) << next.Status.Message(); // across a support: legal
    spline = std::move(next.Value);
    if (inserted)
    {
      inserted->push_back(rectangle);
    }
  }
  return spline;
}

/// Rank modulo the largest prime below 2^31, by rows of a few numbers each.
class SparseRank
{
public:
  using Row = std::map<int, PrimeField::Number>;

  void Add(Row row)
  {
    while (!row.empty())
    {
      const int pivot = row.begin()->first;
      const auto other = this->Rows.find(pivot);
      if (other == this->Rows.end())
      {
        const auto scale = this->Field.Inverse(row.begin()->second);
        for (auto& [column, x] : row)
        {
          x = this->Field.Multiply(x, scale);
        }
        this->Rows.emplace(pivot, std::move(row));
        return;
      }
      const auto factor = row.begin()->second;
      for (const auto& [column, x] : other->second)
      {
        auto& own = row[column];
        own = this->Field.Subtract(own, this->Field.Multiply(factor, x));
        if (own == 0)
        {
          row.erase(column);
        }
      }
    }
  }
  int Rank() const { return static_cast<int>(this->Rows.size()); }

private:
  PrimeField Field;
  std::map<int, Row> Rows;
};

/// B[t] at a residue, for the piece between two of its knots: de Boor's recursion in residues.
PrimeField::Number ModularBSpline(const PrimeField& field, const std::vector<double>& t, int i,
  int p, double low, PrimeField::Number x)
{
  if (p == 0)
  {
    return t[i] <= low && low < t[i + 1] ? 1 : 0;
  }
  PrimeField::Number sum = 0;
  const auto add = [&](double from, double to, bool rises, int next)
  {
    if (from < to)
    {
      const auto length = field.Subtract(field.OfDouble(to), field.OfDouble(from));
      const auto part =
        rises ? field.Subtract(x, field.OfDouble(from)) : field.Subtract(field.OfDouble(to), x);
      sum = field.Add(sum,
        field.Multiply(field.Multiply(part, field.Inverse(length)),
          ModularBSpline(field, t, next, p - 1, low, x)));
    }
  };
  add(t[i], t[i + p], true, i);
  add(t[i + 1], t[i + p + 1], false, i + 1);
  return sum;
}

/// Rank of the functions by their values at enough points of every element, in residues.
int RankOfFunctions(const SplineSpace<3>& space)
{
  const LRVolume& volume = LRVolumeOf(space);
  const PrimeField field;
  SparseRank rank;
  // transposed: a row a function, a column an element and point
  const IntArray<3>& p = volume.Basis.Degree;
  for (int f = 0; f < space.NumFunctions; ++f)
  {
    SparseRank::Row row;
    int column = 0;
    for (int e = 0; e < space.NumElements(); ++e)
    {
      std::array<std::vector<PrimeField::Number>, 3> values;
      for (int d = 0; d < 3; ++d)
      {
        const std::vector<double> t = KnotValues(volume.Basis, f, d);
        const double low = space.Elements[e].Box.Lower[d];
        for (int i = 0; i <= p[d]; ++i)
        {
          values[d].push_back(ModularBSpline(
            field, t, 0, p[d], low, static_cast<PrimeField::Number>(1000003 * (i + 1) + 17 * d)));
        }
      }
      for (const auto w : values[2])
      {
        for (const auto v : values[1])
        {
          for (const auto u : values[0])
          {
            const auto value = field.Multiply(u, field.Multiply(v, w));
            if (value != 0)
            {
              row[column] = value;
            }
            ++column;
          }
        }
      }
    }
    rank.Add(std::move(row));
  }
  return rank.Rank();
}

/// Dimension of all piecewise polynomials on the elements that are as smooth across every face as
/// its multiplicity asks: unknown coefficients minus the rank of the conditions.
int DimensionByCounting(const SplineSpace<3>& space)
{
  const LRVolume& volume = LRVolumeOf(space);
  const LRVolumeBasis& basis = volume.Basis;
  const IntArray<3>& p = basis.Degree;
  const PrimeField field;
  const int n = NumTensorFunctions<3>(p);
  const auto cell = [&](const IntArray<3>& c)
  { return volume.Cells[(c[2] * basis.Spans(1) + c[1]) * basis.Spans(0) + c[0]]; };
  SparseRank rank;
  std::map<std::array<int, 4>, bool> done; // direction, plane, elements on both sides
  for (int d = 0; d < 3; ++d)
  {
    const auto [first, second] = LRVolumeBasis::Across(d);
    for (int k = 1; k < basis.Spans(d); ++k)
    {
      for (int b = 0; b < basis.Spans(second); ++b)
      {
        for (int a = 0; a < basis.Spans(first); ++a)
        {
          IntArray<3> c{};
          c[d] = k;
          c[first] = a;
          c[second] = b;
          const int above = cell(c);
          --c[d];
          const int below = cell(c);
          if (above == below || !done.try_emplace({ d, k, below, above }, true).second)
          {
            continue;
          }
          const int multiplicity = basis.Faces[d][basis.FaceIndex(d, k, a, b)];
          const auto t = field.OfDouble(basis.Knots[d][k]);
          const IntArray<3> stride{ 1, p[0] + 1, (p[0] + 1) * (p[1] + 1) };
          for (int order = 0; order <= p[d] - multiplicity; ++order)
          {
            for (int j = 0; j <= p[second]; ++j)
            {
              for (int i = 0; i <= p[first]; ++i)
              {
                SparseRank::Row row;
                for (int m = order; m <= p[d]; ++m)
                {
                  PrimeField::Number factor = field.Power(t, static_cast<std::uint64_t>(m - order));
                  for (int q = 0; q < order; ++q)
                  {
                    factor = field.Multiply(factor, static_cast<PrimeField::Number>(m - q));
                  }
                  const int place = m * stride[d] + i * stride[first] + j * stride[second];
                  if (factor != 0)
                  {
                    row[above * n + place] = factor;
                    row[below * n + place] = field.Subtract(0, factor);
                  }
                }
                rank.Add(std::move(row));
              }
            }
          }
        }
      }
    }
  }
  return n * space.NumElements() - rank.Rank();
}

Spline<3> UniformVolume(Random& random, int degree, const IntArray<3>& elements)
{
  std::array<KnotVector, 3> knots;
  for (int d = 0; d < 3; ++d)
  {
    knots[d] = KnotVector::Uniform(degree, elements[d]);
  }
  return RandomSpline<3>(random, MakeTensorSpace<3>(knots).Value, 1, false);
}
}

TEST(LRVolume, TheMapStaysAndFunctionsSumToOne_CrossOracle)
{
  for (unsigned seed = 1; seed <= 30; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const Spline<3> tensor = RandomClampedVolume(random, 3, 3, seed % 3 == 0);
    const Spline<3> refined = Refined(random, tensor, 8);
    EXPECT_GT(refined.Space->NumFunctions, tensor.Space->NumFunctions);
    const BezierForm<3> form = MakeBezierForm(refined, 0);
    PointMatrix parameters(40, 3);
    for (Eigen::Index i = 0; i < parameters.size(); ++i)
    {
      parameters.data()[i] = random.Parameter(refined.Space->Knots[i % 3]);
    }
    const Spline<3> before = InsertRectangles(tensor, {}, NoLimit, 0).Value;
    for (Eigen::Index i = 0; i < parameters.rows(); ++i)
    {
      const double* u = &parameters(i, 0);
      Real unity = 0;
      const std::vector<Real> old = EvaluatePlainly(before, u, unity);
      EXPECT_NEAR(static_cast<double>(unity), 1.0, 1e-13);
      const std::vector<Real> now = EvaluatePlainly(refined, u, unity);
      EXPECT_NEAR(static_cast<double>(unity), 1.0, 1e-13);
      double local[3];
      const int e = refined.Space->Locate(u, local);
      ASSERT_GE(e, 0);
      for (std::size_t c = 0; c < old.size(); ++c)
      {
        // sums of terms of size 10, some hundred splits deep
        EXPECT_NEAR(static_cast<double>(now[c]), static_cast<double>(old[c]), 1e-11);
      }
      for (int d = 0; d < 3; ++d)
      {
        const ParametricBox<3>& box = refined.Space->Elements[e].Box;
        EXPECT_NEAR(box.Lower[d] + local[d] * (box.Upper[d] - box.Lower[d]), u[d], 1e-13 * 10);
      }
      const Eigen::MatrixXd extraction = refined.Space->ExtractionOperator(e);
      const std::vector<int> alive = refined.Space->AliveFunctions(e);
      const PointMatrix points = refined.HomogeneousPoints();
      const IntArray<3>& p = refined.Space->Elements[e].Degree;
      for (std::size_t c = 0; c < now.size(); ++c)
      {
        Real sum = 0;
        for (std::size_t f = 0; f < alive.size(); ++f)
        {
          int b = 0;
          for (int k = 0; k <= p[2]; ++k)
          {
            for (int j = 0; j <= p[1]; ++j)
            {
              for (int i2 = 0; i2 <= p[0]; ++i2, ++b)
              {
                sum += points(alive[f], c) * extraction(f, b) *
                  oracle::Bernstein(p[0], i2, local[0]) * oracle::Bernstein(p[1], j, local[1]) *
                  oracle::Bernstein(p[2], k, local[2]);
              }
            }
          }
        }
        EXPECT_NEAR(static_cast<double>(sum), static_cast<double>(now[c]), 1e-11);
      }
    }
    const auto read = MakeLRVolumeSpace(LRVolumeOf(*refined.Space).Basis, 1);
    ASSERT_TRUE(read) << read.Status.Message(); // minimal support, order, sum
  }
}

/// 1,000 orders of rectangles with multiplicities make the space that they make one by one.
TEST(LRVolume, EveryOrderMakesTheSameSpace_PropertyOracle)
{
  int numOrders = 0;
  for (unsigned seed = 1; seed <= 50; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const Spline<3> tensor = RandomClampedVolume(random, 2, 2, seed % 4 == 0);
    std::vector<LRRectangle> rectangles;
    const Spline<3> ordered = Refined(random, tensor, 5, &rectangles);
    const LRVolumeBasis& expected = LRVolumeOf(*ordered.Space).Basis;
    const auto first = InsertRectangles(tensor, rectangles, NoLimit, 0);
    ASSERT_TRUE(first) << first.Status.Message();
    const LRVolumeBasis& found = LRVolumeOf(*first->Space).Basis;
    EXPECT_EQ(found.Knots, expected.Knots);
    EXPECT_EQ(found.Faces, expected.Faces);
    ASSERT_EQ(found.LocalKnots, expected.LocalKnots);
    for (std::size_t f = 0; f < expected.Scaling.size(); ++f)
    {
      EXPECT_NEAR(found.Scaling[f], expected.Scaling[f], 1e-12 * expected.Scaling[f]);
    }
    for (int order = 0; order < 20; ++order, ++numOrders)
    {
      for (std::size_t i = rectangles.size(); i-- > 1;)
      {
        std::swap(rectangles[i], rectangles[random.Int(0, static_cast<int>(i))]);
      }
      const auto other = InsertRectangles(tensor, rectangles, NoLimit, 1);
      ASSERT_TRUE(other) << other.Status.Message();
      EXPECT_TRUE(LRVolumeOf(*other->Space).Basis == found);
      EXPECT_EQ(other->ControlPoints, first->ControlPoints);
      EXPECT_EQ(other->Weights, first->Weights);
    }
  }
  EXPECT_EQ(numOrders, 1000);
}

/// The rank of the functions and the dimension of all smooth piecewise polynomials on the mesh,
/// both in residues modulo a prime and by other algorithms than the kernel's.
TEST(LRVolume, DimensionAndIndependence_ExactOracle)
{
  int full = 0;
  constexpr unsigned NumCases = 100;
  for (unsigned seed = 1; seed <= NumCases; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const int degree = seed % 3 == 0 ? 2 : 1;
    const IntArray<3> elements{ random.Int(1, 2), random.Int(1, 2), random.Int(1, 2) };
    const Spline<3> volume = Refined(random, UniformVolume(random, degree, elements), 8);
    const SplineSpace<3>& space = *volume.Space;
    const auto decided = DecideDependence(space);
    ASSERT_TRUE(decided) << decided.Status.Message();
    ASSERT_NE(decided->Verdict, LRVerdict::Undecided);
    const int rank = RankOfFunctions(space);
    EXPECT_EQ(space.NumFunctions - decided->Defect, rank);
    EXPECT_EQ(decided->Verdict == LRVerdict::Independent, rank == space.NumFunctions);
    const int dimension = DimensionByCounting(space);
    EXPECT_LE(rank, dimension);
    full += rank == dimension;
  }
  EXPECT_EQ(full, static_cast<int>(NumCases)); // rectangles across supports: nothing is missing
}

/// A relation of a surface times functions of a third parameter is one of the volume.
TEST(LRVolume, DependenceOfASweptSurface_GoldenOracle)
{
  const auto knots = [](std::vector<double> inner, double end)
  {
    std::vector<double> t{ 0, 0, 0 };
    t.insert(t.end(), inner.begin(), inner.end());
    t.insert(t.end(), 3, end);
    return KnotVector::Create(2, t).Value;
  };
  Random random(9);
  const auto tensor = MakeTensorSpace<3>(
    { knots({ 1, 2, 3, 6, 8, 9 }, 10), knots({ 1, 2, 4, 6, 7 }, 8), KnotVector::Uniform(1, 1) })
                        .Value;
  std::vector<LRRectangle> rectangles;
  for (const LRSegment& segment : KnownSegments())
  {
    rectangles.push_back(
      { segment.Direction, segment.Value, { segment.Start, 0.0 }, { segment.End, 1.0 } });
  }
  const auto volume =
    InsertRectangles(RandomSpline<3>(random, tensor, 1, false), rectangles, NoLimit, 0);
  ASSERT_TRUE(volume) << volume.Status.Message();
  EXPECT_EQ(volume->Space->NumFunctions, 2 * 82); // those of the surface, times two
  const auto decided = DecideDependence(*volume->Space);
  EXPECT_EQ(decided->Verdict, LRVerdict::Dependent);
  EXPECT_EQ(decided->Defect, 2);
  EXPECT_EQ(decided->Unpeeled.size(), 16U);
  EXPECT_EQ(RankOfFunctions(*volume->Space), 162);
  // the relation is zero at any point
  const LRVolumeBasis& basis = LRVolumeOf(*volume->Space).Basis;
  for (int i = 0; i < 100; ++i)
  {
    const std::array<double, 3> u{ random.In(0, 10), random.In(0, 8), random.Unit() };
    Real sum = 0;
    for (std::size_t k = 0; k < decided->Functions.size(); ++k)
    {
      const int f = decided->Functions[k];
      Real value = basis.Scaling[f] * decided->Coefficients[k];
      for (int d = 0; d < 3; ++d)
      {
        value *= LocalBSpline(KnotValues(basis, f, d), u[d], basis.Knots[d].back());
      }
      sum += value;
    }
    EXPECT_LE(std::fabs(static_cast<double>(sum)), 1e-14);
  }
}

TEST(LRVolume, StrategiesHalveTheMarkedElements_PropertyOracle)
{
  for (const LRStrategy strategy : { LRStrategy::FullSpan, LRStrategy::MinimumSpan,
         LRStrategy::StructuredMesh, LRStrategy::RestrictedMesh })
  {
    Random random(5);
    Spline<3> volume = UniformVolume(random, 2, { 3, 2, 2 });
    LRVolumeStrategyParams params;
    params.Strategy = strategy;
    for (int step = 0; step < 3; ++step)
    {
      const int marked = random.Int(0, volume.Space->NumElements() - 1);
      const ParametricBox<3> box = volume.Space->Elements[marked].Box;
      const auto refined = RefineMarkedLRVolume(volume, { marked }, params);
      ASSERT_TRUE(refined) << refined.Status.Message();
      int parts = 0;
      for (std::size_t e = 0; e < refined->Parents.size(); ++e)
      {
        const ParametricBox<3>& part = refined->Value.Space->Elements[e].Box;
        const ParametricBox<3>& whole = volume.Space->Elements[refined->Parents[e]].Box;
        parts += refined->Parents[e] == marked;
        for (int d = 0; d < 3; ++d)
        {
          EXPECT_GE(part.Lower[d], whole.Lower[d]);
          EXPECT_LE(part.Upper[d], whole.Upper[d]);
        }
      }
      EXPECT_EQ(parts, 8);
      EXPECT_EQ(box.Lower[0], volume.Space->Elements[marked].Box.Lower[0]);
      EXPECT_TRUE(MakeLRVolumeSpace(LRVolumeOf(*refined->Value.Space).Basis, 0));
      volume = refined->Value;
    }
    // as a tensor product it is the same map
    const auto tensor = ToTensor(volume, 0);
    ASSERT_TRUE(tensor) << tensor.Status.Message();
    const Spline<3> again = InsertRectangles(tensor.Value, {}, NoLimit, 0).Value;
    for (int i = 0; i < 20; ++i)
    {
      const std::array<double, 3> u{ random.Unit(), random.Unit(), random.Unit() };
      Real unity = 0;
      EXPECT_NEAR(static_cast<double>(EvaluatePlainly(volume, u.data(), unity)[0]),
        static_cast<double>(EvaluatePlainly(again, u.data(), unity)[0]), 1e-12 * 10);
    }
  }
}

TEST(LRVolume, EveryFailureIsReachable_ExactOracle)
{
  Random random(2);
  const Spline<3> volume = UniformVolume(random, 2, { 4, 4, 4 });
  const LRRectangle legal{ 0, 0.375, { 0.0, 0.0 }, { 0.75, 0.75 }, 1 };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  struct Failure
  {
    LRRectangle Rectangle;
    ErrorCode Code;
  };
  for (const Failure& failure : {
         Failure{ { 3, 0.375, { 0.0, 0.0 }, { 0.75, 0.75 }, 1 }, ErrorCode::InvalidParameter },
         Failure{ { 0, 0.375, { 0.0, 0.0 }, { 0.75, 0.75 }, 0 }, ErrorCode::InvalidParameter },
         Failure{ { 0, 0.375, { 0.0, 0.0 }, { 0.75, 0.75 }, 4 }, ErrorCode::InvalidParameter },
         Failure{ { 0, 0.375, { 0.0, 0.5 }, { 0.75, 0.5 }, 1 }, ErrorCode::InvalidParameter },
         Failure{ { 0, nan, { 0.0, 0.0 }, { 0.75, 0.75 }, 1 }, ErrorCode::NonFiniteInput },
         Failure{ { 0, 1.5, { 0.0, 0.0 }, { 0.75, 0.75 }, 1 }, ErrorCode::OutsideDomain },
         Failure{ { 1, 0.3, { 0.0, 0.0 }, { 0.7, 0.75 }, 1 }, ErrorCode::InvalidTopology },
         Failure{ { 0, 0.3, { 0.5, 0.5 }, { 0.75, 0.75 }, 1 }, ErrorCode::InvalidTopology },
       })
  {
    const auto found = InsertRectangles(volume, { legal, failure.Rectangle }, NoLimit, 0);
    EXPECT_EQ(found.Status.Code, failure.Code) << found.Status.Message();
    EXPECT_EQ(found.Status.Detail.find("rectangle 1: "), 0U) << found.Status.Message();
  }
  // two rectangles that end inside elements: the second plane stops at the first, which is short
  const auto broken =
    InsertRectangles(volume, { legal, { 1, 0.4, { 0.375, 0.0 }, { 1.0, 1.0 }, 1 } }, NoLimit, 0);
  EXPECT_EQ(broken.Status.Code, ErrorCode::InvalidTopology) << broken.Status.Message();
  EXPECT_NE(broken.Status.Detail.find("ends inside an element"), std::string::npos);
  EXPECT_EQ(InsertRectangles(volume, { legal }, volume.Space->NumFunctions, 0).Status.Code,
    ErrorCode::TooLarge);
  const auto hierarchical = RefineMarkedElements(volume, { 5 });
  EXPECT_EQ(InsertRectangles(hierarchical->Value, { legal }, NoLimit, 0).Status.Code,
    ErrorCode::DimensionMismatch);
  EXPECT_EQ(DecideDependence(*volume.Space).Status.Code, ErrorCode::DimensionMismatch);
  EXPECT_EQ(RectanglesForElements(*volume.Space, { 0 }).Status.Code, ErrorCode::DimensionMismatch);
  const Spline<3> lr = InsertRectangles(volume, { legal }, NoLimit, 0).Value;
  EXPECT_EQ(RectanglesForElements(*lr.Space, { -1 }).Status.Code, ErrorCode::InvalidParameter);

  const LRVolumeBasis good = LRVolumeOf(*lr.Space).Basis;
  const auto code = [&good](auto&& change)
  {
    LRVolumeBasis basis = good;
    change(basis);
    return MakeLRVolumeSpace(std::move(basis), 0).Status.Code;
  };
  EXPECT_EQ(code([](LRVolumeBasis&) {}), ErrorCode::Ok);
  EXPECT_EQ(code([](LRVolumeBasis& b) { b.Degree[1] = 0; }), ErrorCode::InvalidDegree);
  EXPECT_EQ(code([](LRVolumeBasis& b) { b.Knots[1][1] = b.Knots[1][2]; }), ErrorCode::InvalidKnots);
  EXPECT_EQ(code([](LRVolumeBasis& b) { b.Knots[0].resize(1); }), ErrorCode::InvalidKnots);
  EXPECT_EQ(code([](LRVolumeBasis& b) { b.Faces[2].pop_back(); }), ErrorCode::SizeMismatch);
  EXPECT_EQ(code([](LRVolumeBasis& b) { b.Faces[2][0] = 1; }), ErrorCode::InvalidTopology);
  EXPECT_EQ(code([](LRVolumeBasis& b) { b.Faces[0][b.FaceIndex(0, 1, 0, 0)] = 9; }),
    ErrorCode::InvalidTopology);
  EXPECT_EQ(code([](LRVolumeBasis& b) { b.Faces[0][b.FaceIndex(0, 2, 0, 0)] = 0; }),
    ErrorCode::InvalidTopology);
  EXPECT_EQ(code([](LRVolumeBasis& b) { b.Scaling.pop_back(); }), ErrorCode::SizeMismatch);
  EXPECT_EQ(code([](LRVolumeBasis& b) { b.Scaling[3] = -1.0; }), ErrorCode::InvalidParameter);
  EXPECT_EQ(code([](LRVolumeBasis& b) { b.Scaling[3] = 0.5; }), ErrorCode::InvalidTopology);
  EXPECT_EQ(code([](LRVolumeBasis& b) { std::swap(b.LocalKnots[0], b.LocalKnots[3]); }),
    ErrorCode::InvalidTopology);
  EXPECT_EQ(code(
              [](LRVolumeBasis& b)
              {
                const auto n = b.Stride();
                std::swap_ranges(
                  b.LocalKnots.begin(), b.LocalKnots.begin() + n, b.LocalKnots.begin() + n);
              }),
    ErrorCode::InvalidTopology);
  EXPECT_EQ(
    code([](LRVolumeBasis& b)
      { std::copy_n(b.LocalKnots.begin(), b.Stride(), b.LocalKnots.begin() + b.Stride()); }),
    ErrorCode::InvalidTopology);
  EXPECT_EQ(code(
              [](LRVolumeBasis& b)
              {
                for (auto& knots : b.Knots)
                {
                  for (int i = 0; i < 600; ++i)
                  {
                    knots.push_back(2.0 + i);
                  }
                }
              }),
    ErrorCode::TooLarge);
}

TEST(LRVolume, ThreadsDoNotMatter_ExactOracle)
{
  Random random(3);
  const Spline<3> volume = Refined(random, UniformVolume(random, 2, { 3, 3, 3 }), 12);
  const auto one = MakeLRVolumeSpace(LRVolumeOf(*volume.Space).Basis, 1).Value;
  const auto many = MakeLRVolumeSpace(LRVolumeOf(*volume.Space).Basis, 4).Value;
  EXPECT_TRUE(one->RowStart == many->RowStart);
  EXPECT_TRUE(one->RowFunction == many->RowFunction);
  EXPECT_TRUE(one->RowCoefficient == many->RowCoefficient);
}
