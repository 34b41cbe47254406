// SPDX-License-Identifier: BSD-3-Clause
#include "LRCases.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/HeightField.h>
#include <knotwork/SplineCore/LROperations.h>
#include <knotwork/SplineCore/LocallyRefinedForm.h>
#include <knotwork/SurfaceFitting/StitchTiles.h>

#include <gtest/gtest.h>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
/// A clamped tensor-product spline on a box, its inner knots at random places.
Spline<2> TensorTile(Random& random, const ParametricBox<2>& box, const IntArray<2>& degree,
  int maxElements, int components)
{
  std::array<KnotVector, 2> knots;
  for (int d = 0; d < 2; ++d)
  {
    std::vector<double> t(degree[d] + 1, box.Lower[d]);
    const int elements = random.Int(1, maxElements);
    for (int e = 1; e < elements; ++e)
    {
      const double s = (e + random.In(-0.3, 0.3)) / elements;
      t.push_back(box.Lower[d] + s * (box.Upper[d] - box.Lower[d]));
    }
    t.insert(t.end(), degree[d] + 1, box.Upper[d]);
    knots[d] = KnotVector::Create(degree[d], t).Value;
  }
  return RandomSpline<2>(random, MakeTensorSpace<2>(knots).Value, components, false);
}

/// On [begin, begin + 1] x [0, 1], biquadratic, with these inner knots along its second parameter.
Spline<2> TileWithLines(Random& random, double begin, const std::vector<double>& lines)
{
  std::vector<double> t(3, 0.0);
  t.insert(t.end(), lines.begin(), lines.end());
  t.insert(t.end(), 3, 1.0);
  const auto along = KnotVector::Create(2, std::move(t));
  const auto across = KnotVector::Uniform(2, 2, begin, begin + 1.0);
  return RandomSpline<2>(random, MakeTensorSpace<2>({ across, along.Value }).Value, 1, false);
}

/// The same with random lines inserted, and coefficients that have nothing to do with it.
Spline<2> LocalTile(Random& random, const ParametricBox<2>& box, const IntArray<2>& degree,
  int segments, int components)
{
  const Spline<2> tensor = TensorTile(random, box, degree, 4, components);
  const auto space =
    InsertSegments(tensor.Space, RandomSegments(random, tensor.Space, segments), 0).Value;
  return RandomSpline<2>(random, space, components, false);
}

/// Boxes of a grid of n x m tiles with lines at uneven places.
std::vector<ParametricBox<2>> GridBoxes(int n, int m)
{
  const auto line = [](int i) { return 1.3 * i + 0.17 * (i % 2); };
  std::vector<ParametricBox<2>> boxes;
  for (int j = 0; j < m; ++j)
  {
    for (int i = 0; i < n; ++i)
    {
      boxes.push_back({ { line(i), line(j) }, { line(i + 1), line(j + 1) } });
    }
  }
  return boxes;
}

/// One long tile on the left, two on the right, one of them above both: T-junctions.
std::vector<ParametricBox<2>> JunctionBoxes()
{
  return { { { 0, 0 }, { 1, 2 } }, { { 1, 0 }, { 2.5, 0.7 } }, { { 1, 0.7 }, { 2.5, 2 } },
    { { 0, 2 }, { 2.5, 3 } } };
}

double SideParameter(const Spline<2>& tile, int side)
{
  const ParametricBox<2> box = tile.Space->Domain();
  return side % 2 == 0 ? box.Lower[side / 2] : box.Upper[side / 2];
}

/// Values and first derivatives along a side, by evaluation.
EvaluationBatch AlongEdge(const Spline<2>& tile, int side, const std::vector<double>& where)
{
  PointMatrix points(static_cast<Eigen::Index>(where.size()), 2);
  for (std::size_t i = 0; i < where.size(); ++i)
  {
    points(static_cast<Eigen::Index>(i), side / 2) = SideParameter(tile, side);
    points(static_cast<Eigen::Index>(i), 1 - side / 2) = where[i];
  }
  EvaluationBatch batch;
  EvaluationParams params;
  params.Derivatives = 1;
  EXPECT_TRUE(EvaluateParameters(MakeBezierForm(tile), points, params, batch));
  return batch;
}

PatchInterface Paired(const PatchSide& a, const PatchSide& b, bool reversed)
{
  PatchInterface pair;
  pair.Sides = { a, b };
  pair.Orientation = SideOrientation::Make(reversed ? 1 : 0);
  return pair;
}

/// Largest differences of values and derivatives across at 401 points of an edge.
std::array<double, 2> SampledJumps(const std::vector<Spline<2>>& tiles, const StitchedEdge& edge)
{
  const auto& parts = edge.Interface.Parts;
  std::array<std::vector<double>, 2> where;
  for (int k = 0; k <= 400; ++k)
  {
    const double s = (k + 0.31 * (k % 400 != 0)) / 400.0; // not on knots, where a side may jump
    const double r = edge.Interface.Orientation.Reversed[0] ? 1.0 - s : s;
    where[0].push_back((1 - s) * parts[0].Lower[0] + s * parts[0].Upper[0]);
    where[1].push_back((1 - r) * parts[1].Lower[0] + r * parts[1].Upper[0]);
  }
  const auto& tileA = tiles[edge.Interface.Sides[0].Patch];
  const auto& tileB = tiles[edge.Interface.Sides[1].Patch];
  const EvaluationBatch a = AlongEdge(tileA, edge.Interface.Sides[0].Side, where[0]);
  const EvaluationBatch b = AlongEdge(tileB, edge.Interface.Sides[1].Side, where[1]);
  const int c = tileA.NumComponents();
  const double ratio =
    (parts[1].Upper[0] - parts[1].Lower[0]) / (parts[0].Upper[0] - parts[0].Lower[0]);
  const auto inwards = [&](const EvaluationBatch& batch, int side)
  { return PointMatrix(batch.First.middleCols(side / 2 * c, c) * (side % 2 == 0 ? 1.0 : -1.0)); };
  const PointMatrix slopes =
    inwards(a, edge.Interface.Sides[0].Side) + ratio * inwards(b, edge.Interface.Sides[1].Side);
  return { (a.Values - b.Values).rowwise().norm().maxCoeff(), slopes.rowwise().norm().maxCoeff() };
}

/// Rounding of values of the size of the coefficients, and of derivatives over the shortest span.
std::array<double, 2> RoundingOf(const std::vector<Spline<2>>& tiles)
{
  double size = 0.0;
  double span = 1e300;
  for (const Spline<2>& tile : tiles)
  {
    size = std::max(size, tile.ControlPoints.cwiseAbs().maxCoeff());
    for (const auto& element : tile.Space->Elements)
    {
      span = std::min({ span, element.Box.Upper[0] - element.Box.Lower[0],
        element.Box.Upper[1] - element.Box.Lower[1] });
    }
  }
  const double value = 1000 * oracle::Epsilon * size; // some sums of up to a hundred terms
  return { value, 20 * value / span };
}

void ExpectStitched(
  const std::vector<Spline<2>>& tiles, const StitchedTiles& result, int continuity)
{
  ASSERT_EQ(result.Tiles.size(), tiles.size());
  const auto tolerance = RoundingOf(result.Tiles);
  for (const StitchedEdge& edge : result.Edges)
  {
    SCOPED_TRACE("tiles " + std::to_string(edge.Interface.Sides[0].Patch) + " and " +
      std::to_string(edge.Interface.Sides[1].Patch));
    const auto before = SampledJumps(tiles, edge);
    const auto after = SampledJumps(result.Tiles, edge);
    // bounds hold, and before stitching they are not far above what is there
    EXPECT_GE(edge.JumpBefore, before[0]);
    EXPECT_LE(edge.JumpBefore, 1.2 * before[0]);
    EXPECT_GE(edge.SlopeJumpBefore, before[1] * (1 - 1e-12));
    EXPECT_GE(edge.Jump + 64 * oracle::Epsilon, after[0]);
    EXPECT_LE(edge.Jump, tolerance[0]);
    if (continuity == 1)
    {
      EXPECT_LE(edge.SlopeJump, tolerance[1]);
      EXPECT_LE(after[1], tolerance[1]);
    }
  }
}

/// The result at random points is what the tile was, wherever no function along an edge is alive.
void ExpectUnchangedInside(
  const Spline<2>& tile, const Spline<2>& stitched, Random& random, int* points)
{
  const LRBasis& basis = stitched.Space->LocallyRefined->Basis;
  const auto unstitched = InsertSegments(tile, {}, 0).Value;
  const PointMatrix at = RandomParameters(random, *tile.Space, 60);
  EvaluationBatch before;
  EvaluationBatch after;
  ASSERT_TRUE(EvaluateParameters(MakeBezierForm(unstitched), at, {}, before));
  ASSERT_TRUE(EvaluateParameters(MakeBezierForm(stitched), at, {}, after));
  for (Eigen::Index i = 0; i < at.rows(); ++i)
  {
    bool nearEdge = false;
    for (int f = 0; f < basis.NumFunctions(); ++f)
    {
      bool inside = true;
      bool onSide = false;
      for (int d = 0; d < 2; ++d)
      {
        const auto t = LocalKnotValues(basis, f, d);
        inside = inside && t.front() <= at(i, d) && at(i, d) <= t.back();
        const int p = basis.Degree[d];
        onSide = onSide || std::count(t.begin(), t.end(), basis.Knots[d].front()) >= p ||
          std::count(t.begin(), t.end(), basis.Knots[d].back()) >= p;
      }
      nearEdge = nearEdge || (inside && onSide);
    }
    if (!nearEdge)
    {
      EXPECT_LE((before.Values - after.Values).row(i).cwiseAbs().maxCoeff(), 1e-11);
      ++*points;
    }
  }
}

std::vector<Spline<2>> LocalTiles(Random& random, const std::vector<ParametricBox<2>>& boxes,
  const IntArray<2>& degree, int segments, int components)
{
  std::vector<Spline<2>> tiles;
  for (const auto& box : boxes)
  {
    tiles.push_back(LocalTile(random, box, degree, segments, components));
  }
  return tiles;
}
}

TEST(StitchTiles, GridsBecomeC0AndC1_PropertyOracle)
{
  for (unsigned seed = 1; seed <= 12; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const int continuity = seed % 2;
    const int low = continuity == 1 ? 2 : 1;
    const IntArray<2> degree{ random.Int(low, 4), random.Int(low, 4) };
    const auto tiles = LocalTiles(random, GridBoxes(3, 2), degree, 8, random.Int(1, 3));
    StitchParams params;
    params.Continuity = continuity;
    const auto result = StitchTiles(tiles, params);
    ASSERT_TRUE(result) << result.Status.Message();
    EXPECT_EQ(result->Edges.size(), 7u);
    ExpectStitched(tiles, result.Value, continuity);
    EXPECT_GT(result->MaxJumpBefore, 1.0);
    EXPECT_GT(result->MaxChange, 0.1);
  }
}

TEST(StitchTiles, EdgesThatEndWithinASide_PropertyOracle)
{
  for (unsigned seed = 1; seed <= 12; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const int continuity = seed % 2;
    const int low = continuity == 1 ? 2 : 1;
    const IntArray<2> degree{ random.Int(low, 4), random.Int(low, 4) };
    const auto tiles = LocalTiles(random, JunctionBoxes(), degree, 6, 1);
    StitchParams params;
    params.Continuity = continuity;
    const auto result = StitchTiles(tiles, params);
    ASSERT_TRUE(result) << result.Status.Message();
    EXPECT_EQ(result->Edges.size(), 5u);
    ExpectStitched(tiles, result.Value, continuity);
  }
}

TEST(StitchTiles, SmoothSidesStaySmoothWhereNeighboursMeet_PropertyOracle)
{
  // across the line that halves the long tile's side, value and derivative of the long tile agree
  for (const int continuity : { 0, 1 })
  {
    Random random(7);
    const auto tiles = LocalTiles(random, JunctionBoxes(), { 3, 3 }, 0, 1);
    StitchParams params;
    params.Continuity = continuity;
    const auto result = StitchTiles(tiles, params);
    ASSERT_TRUE(result) << result.Status.Message();
    for (const double x : { 0.2, 0.9, 1.0 })
    {
      PointMatrix at(2, 2);
      at << x, 0.7 - 1e-9, x, 0.7 + 1e-9;
      EvaluationBatch batch;
      EvaluationParams first;
      first.Derivatives = 1;
      ASSERT_TRUE(EvaluateParameters(MakeBezierForm(result->Tiles[0]), at, first, batch));
      EXPECT_LE((batch.First.row(0) - batch.First.row(1)).cwiseAbs().maxCoeff(), 1e-5);
    }
  }
}

TEST(StitchTiles, OutsideTheStripsNothingChanges_PropertyOracle)
{
  int points = 0;
  for (unsigned seed = 1; seed <= 6; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    std::vector<Spline<2>> tiles;
    for (const auto& box : GridBoxes(2, 2))
    {
      const auto space = TensorTile(random, box, { 2, 2 }, 1, 1).Space;
      std::array<KnotVector, 2> knots;
      for (int d = 0; d < 2; ++d)
      {
        knots[d] = KnotVector::Uniform(2, 8 + random.Int(0, 3), box.Lower[d], box.Upper[d]);
      }
      const auto fine = MakeTensorSpace<2>(knots).Value;
      const auto local = InsertSegments(fine, RandomSegments(random, fine, 10), 0).Value;
      tiles.push_back(RandomSpline<2>(random, local, 2, false));
    }
    StitchParams params;
    params.Continuity = static_cast<int>(seed % 2);
    const auto result = StitchTiles(tiles, params);
    ASSERT_TRUE(result) << result.Status.Message();
    for (std::size_t t = 0; t < tiles.size(); ++t)
    {
      ExpectUnchangedInside(tiles[t], result->Tiles[t], random, &points);
    }
  }
  EXPECT_GT(points, 300); // not vacuous
}

TEST(StitchTiles, HeightFieldsAcrossAGapStayHeightFields_PropertyOracle)
{
  Random random(3);
  std::vector<Spline<2>> tiles;
  for (const double left : { 0.0, 1.0 + 1e-4 })
  {
    Spline<2> tile;
    tile.Space = MakeTensorSpace<2>(
      { KnotVector::Uniform(2, 4, left, left + 1), KnotVector::Uniform(3, 3, 0, 1) })
                   .Value;
    tile.ControlPoints.resize(tile.Space->NumFunctions, 3);
    tile.ControlPoints.leftCols(2) = GrevillePoints(*tile.Space);
    for (double& z : tile.ControlPoints.col(2))
    {
      z = random.In(-1, 1);
    }
    tiles.push_back(tile);
  }
  StitchParams params;
  params.Tolerance = 1e-3;
  params.NumMeasured = 3;
  const auto result = StitchTiles(tiles, params);
  ASSERT_TRUE(result) << result.Status.Message();
  ASSERT_EQ(result->Edges.size(), 1u);
  EXPECT_LE(result->MaxJump, RoundingOf(result->Tiles)[0]);
  for (const Spline<2>& tile : result->Tiles)
  {
    const BezierForm<2> form = MakeBezierForm(tile);
    EXPECT_TRUE(IsHeightField(form));
    const PointMatrix at = RandomParameters(random, *tile.Space, 50);
    EvaluationBatch batch;
    ASSERT_TRUE(EvaluateParameters(form, at, {}, batch));
    EXPECT_LE((batch.Values.leftCols(2) - at).cwiseAbs().maxCoeff(), 1e-14);
  }
}

TEST(StitchTiles, PartsOfASmoothSurfaceStay_ExactOracle)
{
  for (unsigned seed = 1; seed <= 4; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const Spline<2> whole = LocalTile(random, { { 0, 0 }, { 4, 4 } }, { 3, 2 }, 10, 2);
    std::vector<Spline<2>> tiles;
    const double cut = random.In(1.1, 2.9);
    for (const auto& box : { ParametricBox<2>{ { 0, 0 }, { cut, 4 } },
           ParametricBox<2>{ { cut, 0 }, { 4, 1.7 } }, ParametricBox<2>{ { cut, 1.7 }, { 4, 4 } } })
    {
      tiles.push_back(RestrictToBox(whole, box, 0).Value);
    }
    const auto result = StitchTiles(tiles, {});
    ASSERT_TRUE(result) << result.Status.Message();
    EXPECT_EQ(result->Edges.size(), 3u); // every two of them meet
    EXPECT_LE(result->MaxJumpBefore, 1e-11);
    EXPECT_LE(result->MaxChange, 1e-10);
    const BezierForm<2> before = MakeBezierForm(whole);
    for (std::size_t t = 0; t < tiles.size(); ++t)
    {
      const PointMatrix at = RandomParameters(random, *tiles[t].Space, 100);
      EvaluationBatch expected;
      EvaluationBatch found;
      ASSERT_TRUE(EvaluateParameters(before, at, {}, expected));
      ASSERT_TRUE(EvaluateParameters(MakeBezierForm(result->Tiles[t]), at, {}, found));
      EXPECT_LE((found.Values - expected.Values).cwiseAbs().maxCoeff(), 1e-10);
    }
    // the same tiles, one of them lifted: it is noticed, and halved between both sides
    tiles[0].ControlPoints.col(1).array() += 1e-3;
    const auto lifted = StitchTiles(tiles, {});
    ASSERT_TRUE(lifted) << lifted.Status.Message();
    EXPECT_NEAR(lifted->MaxJumpBefore, 1e-3, 2e-6);
    EXPECT_LE(lifted->MaxJump, 1e-11);
    EXPECT_GE(lifted->MaxChange, 0.5e-3 - 1e-9);
  }
}

TEST(StitchTiles, TensorAndHierarchicalTiles_PropertyOracle)
{
  for (unsigned seed = 1; seed <= 6; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    std::vector<Spline<2>> tiles;
    for (const auto& box : GridBoxes(3, 1))
    {
      const Spline<2> tensor = TensorTile(random, box, { 2, 3 }, 4, 2);
      SplineSpacePtr<2> space = tensor.Space;
      for (std::size_t step = 0; step < tiles.size(); ++step) // two levels in the last tile
      {
        RefinementParams local;
        local.Extension = 1;
        space = RefineElements<2>(space, { random.Int(0, space->NumElements() - 1) }, local).Value;
      }
      tiles.push_back(RandomSpline<2>(random, space, 2, false));
    }
    StitchParams params;
    params.Continuity = static_cast<int>(seed % 2);
    const auto result = StitchTiles(tiles, params);
    ASSERT_TRUE(result) << result.Status.Message();
    ExpectStitched(tiles, result.Value, params.Continuity);
  }
}

TEST(StitchTiles, PairsInSpace_PropertyOracle)
{
  // a strip of two tiles closed to a ring: sides of other directions, reversed, other lengths
  for (unsigned seed = 1; seed <= 8; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    std::vector<Spline<2>> tiles{ LocalTile(random, { { 0, 0 }, { 1, 1 } }, { 2, 2 }, 6, 3),
      LocalTile(random, { { 5, -1 }, { 8, 1 } }, { 2, 2 }, 6, 3) };
    StitchParams params;
    params.Continuity = static_cast<int>(seed % 2);
    params.Matching = TileMatching::Pairs;
    params.Pairs = { Paired({ 0, 1 }, { 1, 2 }, false), Paired({ 0, 0 }, { 1, 3 }, true) };
    const auto result = StitchTiles(tiles, params);
    ASSERT_TRUE(result) << result.Status.Message();
    ExpectStitched(tiles, result.Value, params.Continuity);
  }
}

TEST(StitchTiles, ATileIsItsOwnNeighbour_PropertyOracle)
{
  Random random(3);
  const std::vector<Spline<2>> tiles{ LocalTile(random, { { 0, 0 }, { 3, 1 } }, { 3, 3 }, 5, 3) };
  StitchParams params;
  params.Matching = TileMatching::Pairs;
  params.Pairs = { Paired({ 0, 0 }, { 0, 1 }, false) };
  const auto result = StitchTiles(tiles, params);
  ASSERT_TRUE(result) << result.Status.Message();
  ExpectStitched(tiles, result.Value, 1);
}

TEST(StitchTiles, GeometryFindsTheSidesThatTheDomainFinds_CrossOracle)
{
  // the graph of a surface over the plane, every tile on a domain of its own
  Random random(5);
  const Spline<2> whole = [&]
  {
    Spline<2> surface = LocalTile(random, { { 0, 0 }, { 4, 4 } }, { 2, 2 }, 10, 3);
    const LRBasis& basis = surface.Space->LocallyRefined->Basis;
    for (int f = 0; f < basis.NumFunctions(); ++f)
    {
      for (int d = 0; d < 2; ++d)
      {
        const auto t = LocalKnotValues(basis, f, d);
        surface.ControlPoints(f, d) = 0.5 * (t[1] + t[2]); // the parameter itself
      }
    }
    return surface;
  }();
  std::vector<Spline<2>> parts;
  std::vector<Spline<2>> moved;
  for (const double x : { 0.0, 2.0 })
  {
    for (const double y : { 0.0, 2.0 })
    {
      parts.push_back(RestrictToBox(whole, { { x, y }, { x + 2, y + 2 } }, 0).Value);
      moved.push_back(ReverseParameter(parts.back(), static_cast<int>(x) / 2, 0).Value);
    }
  }
  StitchParams params;
  const auto byDomain = StitchTiles(parts, params);
  params.Matching = TileMatching::Geometry;
  const auto byGeometry = StitchTiles(moved, params);
  ASSERT_TRUE(byDomain) << byDomain.Status.Message();
  ASSERT_TRUE(byGeometry) << byGeometry.Status.Message();
  EXPECT_EQ(byDomain->Edges.size(), 4u);
  EXPECT_EQ(byGeometry->Edges.size(), 4u);
  EXPECT_LE(byGeometry->MaxJumpBefore, 1e-11);
  EXPECT_LE(byGeometry->MaxSlopeJumpBefore, 1e-9);
}

TEST(StitchTiles, ThreeTilesAroundACorner_PropertyOracle)
{
  Random random(4);
  std::vector<Spline<2>> tiles;
  for (int t = 0; t < 3; ++t)
  {
    tiles.push_back(LocalTile(random, { { 0, 0 }, { 1, 1 } }, { 2, 2 }, 4, 3));
  }
  StitchParams params;
  params.Matching = TileMatching::Pairs;
  params.Pairs = { Paired({ 0, 0 }, { 1, 2 }, false), Paired({ 1, 0 }, { 2, 2 }, false),
    Paired({ 2, 0 }, { 0, 2 }, false) };
  EXPECT_EQ(StitchTiles(tiles, params).Status.Code, ErrorCode::InvalidTopology);
  params.Continuity = 0;
  const auto result = StitchTiles(tiles, params);
  ASSERT_TRUE(result) << result.Status.Message();
  ExpectStitched(tiles, result.Value, 0);
}

TEST(StitchTiles, DomainsThatAlmostFitAreMoved_PropertyOracle)
{
  Random random(6);
  const auto tiles = LocalTiles(
    random, { { { 0, 0 }, { 1 + 2e-8, 1 } }, { { 1, 1e-8 }, { 2, 1 } } }, { 2, 2 }, 3, 1);
  StitchParams params;
  const auto result = StitchTiles(tiles, params);
  ASSERT_TRUE(result) << result.Status.Message();
  EXPECT_EQ(result->Edges.size(), 1u);
  EXPECT_LE(result->MaxSlopeJump, RoundingOf(result->Tiles)[1]);
  params.Tolerance = 1e-9;
  EXPECT_EQ(StitchTiles(tiles, params).Status.Code, ErrorCode::InvalidTopology);
}

TEST(StitchTiles, TheSameForAnyNumberOfThreads_PropertyOracle)
{
  Random random(8);
  const auto tiles = LocalTiles(random, GridBoxes(2, 2), { 2, 3 }, 8, 2);
  StitchParams params;
  params.Threads = 1;
  const auto one = StitchTiles(tiles, params);
  params.Threads = 4;
  const auto four = StitchTiles(tiles, params);
  ASSERT_TRUE(one && four);
  for (std::size_t t = 0; t < tiles.size(); ++t)
  {
    EXPECT_EQ(one->Tiles[t].ControlPoints, four->Tiles[t].ControlPoints);
  }
}

TEST(StitchTiles, EveryFailureIsReachable_ExactOracle)
{
  Random random(9);
  const ParametricBox<2> left{ { 0, 0 }, { 1, 1 } };
  const ParametricBox<2> right{ { 1, 0 }, { 2, 1 } };
  const auto tile = [&](const ParametricBox<2>& box, int p, int components = 1) {
    return TensorTile(random, box, { p, p }, 3, components);
  };
  const auto code = [](const std::vector<Spline<2>>& tiles, const StitchParams& params = {})
  {
    const Status status = StitchTiles(tiles, params).Status;
    EXPECT_FALSE(status.Detail.empty() && status.Code != ErrorCode::Aborted);
    return status.Code;
  };
  const std::vector<Spline<2>> good{ tile(left, 2), tile(right, 2) };
  EXPECT_EQ(StitchTiles(good, {}).Status.Code, ErrorCode::Ok);
  EXPECT_EQ(code({}), ErrorCode::EmptyInput);
  StitchParams params;
  params.Continuity = 2;
  EXPECT_EQ(code(good, params), ErrorCode::InvalidParameter);
  params = {};
  params.Tolerance = std::nan("");
  EXPECT_EQ(code(good, params), ErrorCode::InvalidParameter);
  params = {};
  params.NumMeasured = 2;
  EXPECT_EQ(code(good, params), ErrorCode::InvalidParameter);
  params = {};
  params.Matching = TileMatching::Pairs;
  params.Pairs = { Paired({ 0, 1 }, { 2, 0 }, false) };
  EXPECT_EQ(code(good, params), ErrorCode::InvalidParameter);
  params.Pairs = { Paired({ 0, 1 }, { 1, 4 }, false) };
  EXPECT_EQ(code(good, params), ErrorCode::InvalidParameter);
  params.Pairs = { Paired({ 0, 1 }, { 1, 0 }, false), Paired({ 0, 1 }, { 1, 1 }, false) };
  EXPECT_EQ(code(good, params), ErrorCode::InvalidTopology);
  params.Pairs = {};
  EXPECT_EQ(code(good, params), ErrorCode::InvalidTopology);
  params = {};
  params.Progress = [](double) { return false; };
  EXPECT_EQ(code(good, params), ErrorCode::Aborted);
  EXPECT_EQ(code({ tile(left, 2), tile(right, 2, 2) }), ErrorCode::SizeMismatch);
  EXPECT_EQ(code({ tile(left, 2), tile(right, 3) }), ErrorCode::InvalidDegree);
  EXPECT_EQ(code({ tile(left, 1), tile(right, 1) }), ErrorCode::InvalidDegree);
  EXPECT_EQ(code({ tile(left, 2), tile(left, 2) }), ErrorCode::InvalidTopology);
  EXPECT_EQ(code({ tile(left, 2), tile({ { 3, 3 }, { 4, 4 } }, 2) }), ErrorCode::InvalidTopology);
  std::vector<Spline<2>> bad = good;
  bad[1].ControlPoints(0, 0) = std::nan("");
  EXPECT_EQ(code(bad), ErrorCode::NonFiniteInput);
  EXPECT_NE(StitchTiles(bad, {}).Status.Detail.find("tile 1"), std::string::npos);
  bad = good;
  bad[0].Weights = Eigen::VectorXd::Ones(bad[0].ControlPoints.rows());
  EXPECT_EQ(code(bad), ErrorCode::InvalidWeight);
  // two lines of one tile where the other has one, and no room to tell which it is
  bad = { TileWithLines(random, 0.0, { 0.3 }), TileWithLines(random, 1.0, { 0.3, 0.3 + 1e-13 }) };
  EXPECT_EQ(code(bad), ErrorCode::InvalidKnots);
}

TEST(LocallyRefinedForm, IsTheSameMap_CrossOracle)
{
  for (unsigned seed = 1; seed <= 20; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto space = RandomHierarchicalSpace<2>(random, 4, 5, static_cast<int>(seed % 4));
    const Spline<2> spline = RandomSpline<2>(random, space, 2, seed % 2 == 0);
    const auto local = MakeLocallyRefined(spline, 0);
    ASSERT_TRUE(local) << local.Status.Message();
    EXPECT_EQ(local->Space->Kind, SpaceKind::LocallyRefined);
    PointMatrix at(80, 2);
    for (Eigen::Index i = 0; i < at.size(); ++i)
    {
      at.data()[i] = random.Parameter(space->Knots[i % 2]);
    }
    EvaluationBatch a;
    EvaluationBatch b;
    ASSERT_TRUE(EvaluateParameters(MakeBezierForm(spline), at, {}, a));
    ASSERT_TRUE(EvaluateParameters(MakeBezierForm(local.Value), at, {}, b));
    EXPECT_LE((a.Values - b.Values).cwiseAbs().maxCoeff(), 1e-9); // InSpace times weights' ratio
  }
}
