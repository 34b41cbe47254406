// SPDX-License-Identifier: BSD-3-Clause
#include "SmoothnessOracle.h"
#include <knotwork/SplineCore/SheetRefinement.h>

#include <gtest/gtest.h>

using namespace knotwork;
using namespace meshes;

namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// What the random cases have had.
struct Seen
{
  int Halved = 0;
  int Crossing = 0; ///< sheets that cross themselves
  int Refused = 0;
};

/// Values of the halved spline at random places of the given one's cells.
template <int Dim>
void ExpectSameMap(Random& random, const Spline<Dim>& spline, const RefinedSpline<Dim>& refined,
  const std::vector<int>& halved)
{
  std::vector<int> firstChild(halved.size(), -1);
  for (std::size_t e = refined.Parents.size(); e-- > 0;)
  {
    firstChild[At(refined.Parents[e])] = static_cast<int>(e);
  }
  const int count = 60;
  PointMatrix local(count, Dim);
  PointMatrix fineLocal(count, Dim);
  std::vector<int> elements;
  std::vector<int> fineElements;
  for (int i = 0; i < count; ++i)
  {
    const int cell = random.Int(0, spline.Space->NumElements() - 1);
    int child = 0;
    int stride = 1;
    for (int d = 0; d < Dim; ++d)
    {
      local(i, d) = fineLocal(i, d) = random.Unit();
      if ((halved[At(cell)] >> d & 1) != 0)
      {
        const int upper = local(i, d) >= 0.5 ? 1 : 0;
        fineLocal(i, d) = 2.0 * local(i, d) - upper;
        child += stride * upper;
        stride *= 2;
      }
    }
    elements.push_back(cell);
    fineElements.push_back(firstChild[At(cell)] + child);
  }
  EvaluationBatch a;
  EvaluationBatch b;
  ASSERT_TRUE(EvaluateElements<Dim>(MakeBezierForm(spline, 1), elements, local, {}, a));
  ASSERT_TRUE(
    EvaluateElements<Dim>(MakeBezierForm(refined.Value, 1), fineElements, fineLocal, {}, b));
  // coefficients below 2, averaged some dozen times
  EXPECT_LE((a.Values - b.Values).cwiseAbs().maxCoeff(), 1e-13);
}

/// The halved spline is the same map, in the space of all splines of its continuities.
template <int Dim>
void TrySheets(unsigned seed, int mostDegree, int mostCells, Seen& seen)
{
  SCOPED_TRACE("seed " + std::to_string(seed));
  Random random(seed);
  std::vector<int> lengths;
  const Spline<Dim> spline = oracle::RandomSpline<Dim>(random, mostDegree, mostCells, lengths);
  const auto all = MeshTopology<Dim>::Make(MeshOf(*spline.Space)).Value.FindSheets();
  std::vector<int> sheets;
  for (int n = random.Int(1, 3); n > 0; --n)
  {
    sheets.push_back(random.Int(0, all.Count - 1));
  }
  const auto refined = HalveSheets(spline, sheets);
  if (!refined)
  {
    EXPECT_EQ(refined.Status.Code, ErrorCode::NotInSpace) << refined.Status.Message();
    EXPECT_NE(refined.Status.Detail.find("cell"), std::string::npos);
    ++seen.Refused;
    return;
  }
  ++seen.Halved;
  std::vector<int> halved(At(spline.Space->NumElements()), 0);
  for (std::size_t i = 0; i < all.Of.size(); ++i)
  {
    const bool isIn = std::find(sheets.begin(), sheets.end(), all.Of[i]) != sheets.end();
    halved[i / Dim] |= isIn ? 1 << i % Dim : 0;
    seen.Crossing += isIn && i % Dim > 0 && all.Of[i] == all.Of[i - 1] ? 1 : 0;
  }
  const SplineSpace<Dim>& fine = *refined->Value.Space;
  const std::vector<int> continuity = ContinuityOf(*spline.Space);
  const std::vector<int> fineContinuity = ContinuityOf(fine);
  std::vector<int> fineLengths; // twice what they are
  int e = 0;
  for (int c = 0; c < spline.Space->NumElements(); ++c)
  {
    for (int child = 0; child < (1 << Dim); ++child)
    {
      if ((child & ~halved[At(c)]) != 0)
      {
        continue;
      }
      ASSERT_LT(e, fine.NumElements());
      ASSERT_EQ(refined->Parents[At(e)], c);
      for (int side = 0; side < 2 * Dim; ++side)
      {
        const bool isInside =
          (halved[At(c)] >> (side / 2) & 1) != 0 && (child >> (side / 2) & 1) != side % 2;
        EXPECT_EQ(fineContinuity[At(e * 2 * Dim + side)],
          isInside ? fine.Elements[0].Degree[0] - 1 : continuity[At(c * 2 * Dim + side)]);
      }
      for (int d = 0; d < Dim; ++d)
      {
        fineLengths.push_back(lengths[At(c * Dim + d)] * ((halved[At(c)] >> d & 1) != 0 ? 1 : 2));
      }
      ++e;
    }
  }
  ASSERT_EQ(e, fine.NumElements());
  ExpectSameMap<Dim>(random, spline, refined.Value, halved);
  oracle::ExpectBasis<Dim>(fine, fineLengths, random);
}
}

TEST(SheetRefinement, KeepsTheMapAndNestsSpaces_ExactOracle)
{
  Seen surfaces;
  for (unsigned seed = 1; seed <= 150; ++seed)
  {
    TrySheets<2>(seed, 4, 30, surfaces);
  }
  Seen volumes;
  for (unsigned seed = 1; seed <= 25; ++seed)
  {
    TrySheets<3>(seed, 2, 12, volumes);
  }
  EXPECT_GE(surfaces.Crossing, 1);
  EXPECT_EQ(surfaces.Halved, 150);
  EXPECT_EQ(volumes.Halved, 25);
}

TEST(SheetRefinement, OneSheetOfAGrid_ExactOracle)
{
  Random random(1);
  UnstructuredParams params;
  params.Degree = 2;
  const auto made = MakeUnstructuredSpace<2>(Grid<2>({ 4, 3 }), params);
  const Spline<2> spline = oracle::RandomMap<2>(random, made->Space, true);
  ASSERT_EQ(made->Space->NumFunctions, 6 * 5);
  const auto column = HalveSheets(spline, { 0 }); // of the first edge: three cells
  ASSERT_TRUE(column) << column.Status.Message();
  EXPECT_EQ(column->Value.Space->NumElements(), 15);
  EXPECT_EQ(column->Value.Space->NumFunctions, 7 * 5);
  EXPECT_EQ(column->Parents, (std::vector<int>{ 0, 0, 1, 2, 3, 4, 4, 5, 6, 7, 8, 8, 9, 10, 11 }));
  // the sheets through a cell
  const auto cross = RefineMarkedElements(spline, { 5 });
  ASSERT_TRUE(cross) << cross.Status.Message();
  EXPECT_EQ(cross->Value.Space->NumFunctions, 7 * 6);
  EXPECT_TRUE(cross->Value.IsRational());
  const auto none = HalveSheets(spline, {});
  ASSERT_TRUE(none);
  EXPECT_EQ(none->Value.Space, spline.Space);
  EXPECT_EQ(none->Parents.size(), 12u);
}

TEST(SheetRefinement, EveryFailureIsReachable_ExactOracle)
{
  Random random(2);
  const auto made = MakeUnstructuredSpace<2>(Grid<2>({ 2, 2 }), UnstructuredParams());
  Spline<2> spline = oracle::RandomMap<2>(random, made->Space, false);
  const auto unknown = HalveSheets(spline, { 4 });
  EXPECT_EQ(unknown.Status.Code, ErrorCode::InvalidParameter);
  EXPECT_NE(unknown.Status.Detail.find("no sheet 4"), std::string::npos);
  EXPECT_EQ(HalveSheets(spline, { -1 }).Status.Code, ErrorCode::InvalidParameter);
  spline.ControlPoints.conservativeResize(3, 3);
  EXPECT_EQ(HalveSheets(spline, { 0 }).Status.Code, ErrorCode::SizeMismatch);
  spline.Space = MakeTensorSpace<2>({ KnotVector::Uniform(2, 2), KnotVector::Uniform(2, 2) }).Value;
  EXPECT_EQ(HalveSheets(spline, { 0 }).Status.Code, ErrorCode::DimensionMismatch);
  spline.Space = nullptr;
  EXPECT_EQ(HalveSheets(spline, { 0 }).Status.Code, ErrorCode::DimensionMismatch);
}
