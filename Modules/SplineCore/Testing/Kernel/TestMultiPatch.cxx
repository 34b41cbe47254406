// SPDX-License-Identifier: BSD-3-Clause
#include "RandomSplines.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/LROperations.h>
#include <knotwork/SplineCore/MultiPatch.h>
#include <knotwork/SplineCore/SharedEdges.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// A symmetry of the square or cube: direction d of the new patch is direction Axis[d] of the old
/// one, run backwards when Reversed[d].
template <int Dim>
struct Turn
{
  std::array<int, Dim> Axis{};
  std::array<bool, Dim> Reversed{};
};

template <int Dim>
std::vector<Turn<Dim>> AllTurns()
{
  std::vector<Turn<Dim>> all;
  Turn<Dim> turn;
  for (int d = 0; d < Dim; ++d)
  {
    turn.Axis[At(d)] = d;
  }
  do
  {
    for (int flips = 0; flips < (1 << Dim); ++flips)
    {
      for (int d = 0; d < Dim; ++d)
      {
        turn.Reversed[At(d)] = (flips >> d & 1) != 0;
      }
      all.push_back(turn);
    }
  } while (std::next_permutation(turn.Axis.begin(), turn.Axis.end()));
  return all;
}

/// The same map with turned parameters, of a tensor product or hierarchy of dyadic knots.
template <int Dim>
Spline<Dim> Turned(const Spline<Dim>& spline, const Turn<Dim>& turn)
{
  std::array<KnotVector, Dim> knots;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    const KnotVector& old = spline.Space->Knots[At(turn.Axis[d])];
    std::vector<double> values = old.Knots();
    if (turn.Reversed[d])
    {
      std::reverse(values.begin(), values.end());
      for (double& t : values)
      {
        t = old.Begin() + old.End() - t;
      }
    }
    knots[d] = KnotVector::Create(old.Degree(), values).Value;
  }
  std::vector<HierarchyBox<Dim>> boxes = HierarchyBoxes<Dim>(*spline.Space);
  for (HierarchyBox<Dim>& box : boxes)
  {
    const HierarchyBox<Dim> old = box;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      const std::size_t a = At(turn.Axis[d]);
      const std::int64_t n = std::int64_t{ knots[d].NumElements() } << box.Level;
      box.Lower[d] = turn.Reversed[d] ? n - old.Upper[a] : old.Lower[a];
      box.Upper[d] = turn.Reversed[d] ? n - old.Lower[a] : old.Upper[a];
    }
  }
  Spline<Dim> turned = spline;
  turned.Space =
    (boxes.empty() ? MakeTensorSpace<Dim>(knots) : MakeHierarchicalSpace<Dim>(knots, boxes)).Value;
  const auto oldFunctions = DescribeFunctions<Dim>(*spline.Space);
  std::map<std::pair<int, std::array<std::int64_t, Dim>>, Eigen::Index> oldAt;
  for (std::size_t f = 0; f < oldFunctions.size(); ++f)
  {
    oldAt[{ oldFunctions[f].Level, oldFunctions[f].Index }] = static_cast<Eigen::Index>(f);
  }
  const auto functions = DescribeFunctions<Dim>(*turned.Space);
  for (std::size_t f = 0; f < functions.size(); ++f)
  {
    std::array<std::int64_t, Dim> index{};
    for (std::size_t d = 0; d < Dim; ++d)
    {
      const std::int64_t n = knots[d].NumFunctions() +
        std::int64_t{ knots[d].NumElements() } * ((std::int64_t{ 1 } << functions[f].Level) - 1);
      index[At(turn.Axis[d])] =
        turn.Reversed[d] ? n - 1 - functions[f].Index[d] : functions[f].Index[d];
    }
    const Eigen::Index from = oldAt.at({ functions[f].Level, index });
    turned.ControlPoints.row(static_cast<Eigen::Index>(f)) = spline.ControlPoints.row(from);
    if (spline.IsRational())
    {
      turned.Weights[static_cast<Eigen::Index>(f)] = spline.Weights[from];
    }
  }
  return turned;
}

/// The side of the turned patch that is a side of the old one.
template <int Dim>
int TurnedSide(int side, const Turn<Dim>& turn)
{
  for (int d = 0; d < Dim; ++d)
  {
    if (turn.Axis[At(d)] == side / 2)
    {
      return 2 * d + (turn.Reversed[At(d)] ? 1 - side % 2 : side % 2);
    }
  }
  return -1;
}

/// How it lies on the old one.
template <int Dim>
SideOrientation TurnedOrientation(int side, const Turn<Dim>& turn)
{
  const auto old = SideDirections<Dim>(side);
  const auto own = SideDirections<Dim>(TurnedSide<Dim>(side, turn));
  SideOrientation orientation;
  for (std::size_t k = 0; k + 1 < Dim; ++k)
  {
    for (std::size_t l = 0; l + 1 < Dim; ++l)
    {
      if (At(turn.Axis[own[k]]) == old[l])
      {
        orientation.Axis[k] = static_cast<int>(l);
        orientation.Reversed[k] = turn.Reversed[own[k]];
      }
    }
  }
  return orientation;
}

enum class Family
{
  Tensor,
  Hierarchical
};

/// A patch whose sides are unlike each other and without symmetries; degree 2, dyadic knots.
template <int Dim>
Spline<Dim> RandomPatch(Random& random, Family family, bool rational)
{
  std::array<KnotVector, Dim> knots;
  knots.fill(KnotVector::Uniform(2, 4));
  SplineSpacePtr<Dim> space = MakeTensorSpace<Dim>(knots).Value;
  if (family == Family::Hierarchical)
  {
    HierarchyBox<Dim> corner;
    corner.Upper.fill(4);
    corner.Upper[0] = 6;
    space = MakeHierarchicalSpace<Dim>(knots, { corner }).Value;
  }
  return RandomSpline<Dim>(random, space, 3, rational);
}

/// Another patch that has one side in common: all other points are moved away.
template <int Dim>
Spline<Dim> Neighbour(const Spline<Dim>& patch, int side)
{
  Spline<Dim> other = patch;
  std::set<Eigen::Index> kept;
  const auto functions = DescribeFunctions<Dim>(*patch.Space);
  for (std::size_t f = 0; f < functions.size(); ++f)
  {
    const KnotVector& knots = patch.Space->Knots[AcrossSide(side)];
    const std::int64_t n = knots.NumFunctions() +
      std::int64_t{ knots.NumElements() } * ((std::int64_t{ 1 } << functions[f].Level) - 1);
    if (functions[f].Index[AcrossSide(side)] != (side % 2 == 0 ? 0 : n - 1))
    {
      other.ControlPoints.row(static_cast<Eigen::Index>(f)).array() += 40.0;
    }
  }
  return other;
}

/// With one more line, in half of the patch.
Spline<2> LocallyRefined(const Spline<2>& tensor)
{
  return InsertSegments(tensor, { { 0, 0.375, 0.0, 0.5, 1 } }, 1).Value;
}

/// All sides in all turns, with what each must be found to be.
template <int Dim, typename Find>
void CheckAllTurns(Find&& find)
{
  Random random(7);
  for (const Family family : { Family::Tensor, Family::Hierarchical })
  {
    for (const bool rational : { false, true })
    {
      const Spline<Dim> patch = RandomPatch<Dim>(random, family, rational);
      std::set<std::array<int, 3>> seen; // side, its number there, orientation
      for (int side = 0; side < 2 * Dim; ++side)
      {
        for (const Turn<Dim>& turn : AllTurns<Dim>())
        {
          const Spline<Dim> other = Turned<Dim>(Neighbour<Dim>(patch, side), turn);
          const std::vector<PatchInterface> found = find({ patch, other });
          ASSERT_EQ(found.size(), 1u);
          EXPECT_EQ(found[0].Sides[0], (PatchSide{ 0, side }));
          EXPECT_EQ(found[0].Sides[1], (PatchSide{ 1, TurnedSide<Dim>(side, turn) }));
          EXPECT_EQ(found[0].Orientation.Number(), TurnedOrientation<Dim>(side, turn).Number());
          EXPECT_FALSE(found[0].Partial);
          seen.insert({ side, found[0].Sides[1].Side, found[0].Orientation.Number() });
        }
      }
      EXPECT_EQ(seen.size(), Dim == 2 ? 4u * 4u * 2u : 6u * 6u * 8u);
    }
  }
}
}

TEST(PatchSides, NumbersCornersAndSignsAreThoseOfCoordinates_ExactOracle)
{
  // corners of the square and cube by their coordinates
  for (int side = 0; side < 6; ++side)
  {
    const auto along = SideDirections<3>(side);
    Eigen::Matrix3d frame = Eigen::Matrix3d::Zero();
    frame(side / 2, 0) = side % 2 == 0 ? -1.0 : 1.0;
    frame(static_cast<Eigen::Index>(along[0]), 1) = 1.0;
    frame(static_cast<Eigen::Index>(along[1]), 2) = 1.0;
    EXPECT_EQ(frame.determinant(), SideSign(side)) << side;
    for (int corner = 0; corner < 4; ++corner)
    {
      std::array<int, 3> at{};
      at[AcrossSide(side)] = side % 2;
      at[along[0]] = corner & 1;
      at[along[1]] = corner >> 1;
      EXPECT_EQ(PatchCorner<3>(side, corner), at[0] + 2 * at[1] + 4 * at[2]);
    }
  }
  for (int side = 0; side < 4; ++side)
  {
    const std::array<int, 2> corners[4] = { { 0, 2 }, { 1, 3 }, { 0, 1 }, { 2, 3 } };
    EXPECT_EQ(PatchCorner<2>(side, 0), corners[side][0]);
    EXPECT_EQ(PatchCorner<2>(side, 1), corners[side][1]);
    Eigen::Matrix2d frame = Eigen::Matrix2d::Zero();
    frame(side / 2, 0) = side % 2 == 0 ? -1.0 : 1.0;
    frame(1 - side / 2, 1) = 1.0;
    EXPECT_EQ(frame.determinant(), SideSign(side)) << side;
  }
}

TEST(PatchSides, EntitiesOfGridsAreWhereCoordinatesAreFixed_ExactOracle)
{
  const IntArray<3> count{ 3, 2, 4 };
  for (int code = 0; code < 27; ++code)
  {
    const PatchEntity<3> entity{ code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1 };
    std::vector<int> expected;
    int number = 0;
    for (int k = 0; k < count[2]; ++k)
    {
      for (int j = 0; j < count[1]; ++j)
      {
        for (int i = 0; i < count[0]; ++i, ++number)
        {
          const std::array<int, 3> at{ i, j, k };
          bool inside = true;
          for (std::size_t d = 0; d < 3; ++d)
          {
            inside = inside && (entity[d] < 0 || at[d] == (entity[d] == 0 ? 0 : count[d] - 1));
          }
          if (inside)
          {
            expected.push_back(number);
          }
        }
      }
    }
    EXPECT_EQ(EntityIndices<3>(count, entity), expected) << code;
  }
  EXPECT_EQ(EntityOfSide<3>(3), (PatchEntity<3>{ -1, 1, -1 }));
}

TEST(SideOrientation, IsTheSymmetryGroupOfTheSquare_PropertyOracle)
{
  const std::array<std::int64_t, 2> count{ 4, 3 };
  const auto& all = SideOrientations(2);
  ASSERT_EQ(all.size(), 8u);
  EXPECT_EQ(SideOrientations(1).size(), 2u);
  EXPECT_EQ(SideOrientations(0).size(), 1u);
  for (int number = 0; number < 8; ++number)
  {
    const SideOrientation& a = all[At(number)];
    EXPECT_EQ(a.Number(), number);
    EXPECT_EQ(Chained(a, a.Inverse()).Number(), 0);
    EXPECT_EQ(Chained(a.Inverse(), a).Number(), 0);
    std::set<std::array<std::int64_t, 2>> images;
    for (std::int64_t j = 0; j < count[1]; ++j)
    {
      for (std::int64_t i = 0; i < count[0]; ++i)
      {
        const auto other = a.OtherPoint({ i, j }, count);
        images.insert(other);
        EXPECT_EQ(a.OwnPoint(other, count), (std::array<std::int64_t, 2>{ i, j }));
        EXPECT_EQ(a.Inverse().OwnPoint({ i, j }, a.OtherCount(count)), other);
        for (const SideOrientation& b : all)
        {
          EXPECT_EQ(
            Chained(a, b).OtherPoint({ i, j }, count), b.OtherPoint(other, a.OtherCount(count)));
        }
      }
    }
    EXPECT_EQ(images.size(), 12u);
    // corners are the points of a grid of two a direction; the sign is that of the turn
    std::array<Eigen::Vector2d, 4> places;
    for (int corner = 0; corner < 4; ++corner)
    {
      const auto other = a.OtherPoint({ corner & 1, corner >> 1 }, { 2, 2 });
      EXPECT_EQ(a.Corner(corner), other[0] + 2 * other[1]);
      places[At(corner)] = Eigen::Vector2d(other[0], other[1]);
    }
    Eigen::Matrix2d turn;
    turn << places[1] - places[0], places[2] - places[0];
    EXPECT_EQ(turn.determinant(), a.Sign());
    for (const SideOrientation& b : all)
    {
      EXPECT_EQ(Chained(a, b).Sign(), a.Sign() * b.Sign());
    }
  }
}

TEST(FindInterfaces, ControlPointsInEveryTurnOfSquares_ExactOracle)
{
  CheckAllTurns<2>([](const std::vector<Spline<2>>& p) { return FindInterfaces<2>(p); });
}

TEST(FindInterfaces, ControlPointsInEveryTurnOfCubes_ExactOracle)
{
  CheckAllTurns<3>([](const std::vector<Spline<3>>& p) { return FindInterfaces<3>(p); });
}

TEST(FindInterfaces, GeometryInEveryTurnOfSquares_ExactOracle)
{
  CheckAllTurns<2>([](const std::vector<Spline<2>>& p)
    { return FindInterfaces(SampleSides<2>(p, 5, 1).Value, 1e-9); });
}

TEST(FindInterfaces, GeometryInEveryTurnOfCubes_ExactOracle)
{
  CheckAllTurns<3>([](const std::vector<Spline<3>>& p)
    { return FindInterfaces(SampleSides<3>(p, 3, 1).Value, 1e-9); });
}

TEST(FindInterfaces, SharedNumbersInEveryTurn_ExactOracle)
{
  Random random(3);
  for (const bool square : { true, false })
  {
    const std::array<std::int64_t, 2> count{ 4, square ? 3 : 1 };
    std::vector<int> numbers;
    for (int i = 0; i < count[0] * count[1]; ++i)
    {
      numbers.push_back(17 * i % 40);
    }
    for (const SideOrientation& first : SideOrientations(square ? 2 : 1))
    {
      for (const SideOrientation& second : SideOrientations(square ? 2 : 1))
      {
        SharedSides sides;
        const auto add = [&](const PatchSide& side, const SideOrientation& onOriginal)
        {
          // the side that lies so on the original one
          const auto own = onOriginal.Inverse().OtherCount(count);
          std::vector<int> turned;
          for (std::int64_t j = 0; j < own[1]; ++j)
          {
            for (std::int64_t i = 0; i < own[0]; ++i)
            {
              const auto at = onOriginal.OtherPoint({ i, j }, own);
              turned.push_back(numbers[static_cast<std::size_t>(at[0] + count[0] * at[1])]);
            }
          }
          sides.Add(side, own, turned);
        };
        add({ 3, 1 }, first);
        add({ 4, 2 }, second);
        add({ 5, 0 }, first);
        sides.Add({ 6, 0 }, { 2, 1 }, { 0, 17 }); // others
        ASSERT_EQ(sides.Interfaces.size(), 2u);
        EXPECT_EQ(sides.Interfaces[0].Sides[0], (PatchSide{ 3, 1 }));
        EXPECT_EQ(sides.Interfaces[0].Sides[1], (PatchSide{ 4, 2 }));
        EXPECT_EQ(sides.Interfaces[0].Orientation, Chained(second, first.Inverse()));
        EXPECT_EQ(sides.Interfaces[1].Sides[0], (PatchSide{ 3, 1 }));
        EXPECT_EQ(sides.Interfaces[1].Orientation.Number(), 0);
      }
    }
  }
}

TEST(FindInterfaces, RingsAndFoldedSides_ExactOracle)
{
  // u goes once round: sides 0 and 1 are one; side 2 is folded at its middle, side 3 is a point
  Spline<2> ring;
  ring.Space = MakeTensorSpace<2>({ KnotVector::Uniform(1, 4), KnotVector::Uniform(1, 1) }).Value;
  ring.ControlPoints.resize(10, 2);
  ring.ControlPoints << 0, 0, 1, 0, 2, 1, 1, 0, 0, 0, 0, 3, 0, 3, 0, 3, 0, 3, 0, 3;
  const auto sides = SampleSides<2>({ ring }, 9, 1);
  ASSERT_TRUE(sides);
  const auto found = FindInterfaces(sides.Value, 1e-12);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].Sides[0], (PatchSide{ 0, 0 }));
  EXPECT_EQ(found[0].Sides[1], (PatchSide{ 0, 1 }));
  EXPECT_EQ(found[0].Orientation.Number(), 0);
  EXPECT_EQ(found[1].Sides[0], (PatchSide{ 0, 2 }));
  EXPECT_EQ(found[1].Sides[1], (PatchSide{ 0, 2 }));
  EXPECT_EQ(found[1].Orientation.Number(), 1);
  const auto exact = FindInterfaces<2>({ ring });
  ASSERT_EQ(exact.size(), 1u);
  EXPECT_EQ(exact[0].Sides[1], (PatchSide{ 0, 1 }));
}

TEST(FindInterfaces, ToleranceDecides_PropertyOracle)
{
  Random random(11);
  for (int seed = 0; seed < 20; ++seed)
  {
    const Spline<2> patch = RandomPatch<2>(random, Family::Tensor, seed % 2 == 1);
    Spline<2> moved = Neighbour<2>(patch, 1);
    moved.ControlPoints.array().col(0) += 1e-3;
    const auto sides = SampleSides<2>({ patch, moved }, 4, 1);
    EXPECT_EQ(FindInterfaces(sides.Value, 1.01e-3).size(), 1u);
    EXPECT_EQ(FindInterfaces(sides.Value, 0.99e-3).size(), 0u);
    EXPECT_TRUE(FindInterfaces<2>({ patch, moved }).empty());
  }
}

TEST(FindInterfaces, LocallyRefinedSidesByGeometry_ExactOracle)
{
  Random random(5);
  const Spline<2> tensor = RandomPatch<2>(random, Family::Tensor, false);
  const Spline<2> lr = LocallyRefined(tensor);
  for (int side = 0; side < 4; ++side)
  {
    const Spline<2> other = SwapParameters(LocallyRefined(Neighbour<2>(tensor, side)), 1).Value;
    const auto found = FindInterfaces(SampleSides<2>({ lr, other }, 5, 1).Value, 1e-9);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].Sides[0], (PatchSide{ 0, side }));
    EXPECT_EQ(found[0].Sides[1], (PatchSide{ 1, (side + 2) % 4 }));
    EXPECT_EQ(found[0].Orientation.Number(), 0);
  }
}

TEST(FindInterfaces, BoxesMeetWhollyOrInPart_ExactOracle)
{
  // a large box at the left, two small ones at its right side, one that touches at a corner alone
  const std::vector<ParametricBox<2>> boxes{ { { 0, 0 }, { 2, 2 } }, { { 2, 0 }, { 3, 1 } },
    { { 2, 1 }, { 3, 2.5 } }, { { 3, 2.5 }, { 4, 3 } } };
  const auto found = FindInterfaces<2>(boxes);
  ASSERT_EQ(found.size(), 3u);
  const auto check = [&](const PatchInterface& made, PatchSide a, PatchSide b, double lower,
                       double upper, bool partial)
  {
    EXPECT_EQ(made.Sides[0], a);
    EXPECT_EQ(made.Sides[1], b);
    EXPECT_EQ(made.Partial, partial);
    EXPECT_EQ(made.Orientation.Number(), 0);
    for (const ParametricBox<2>& part : made.Parts)
    {
      EXPECT_EQ(part.Lower[0], lower);
      EXPECT_EQ(part.Upper[0], upper);
    }
  };
  check(found[0], { 0, 1 }, { 1, 0 }, 0.0, 1.0, true);
  check(found[1], { 0, 1 }, { 2, 0 }, 1.0, 2.0, true);
  check(found[2], { 1, 3 }, { 2, 2 }, 2.0, 3.0, false);
  // in space: whole, part, an edge alone
  const std::vector<ParametricBox<3>> cubes{ { { 0, 0, 0 }, { 1, 1, 1 } },
    { { 0, 1, 0 }, { 1, 2, 1 } }, { { 0.5, -1, 0.25 }, { 2, 0, 1 } },
    { { 1, 1, 0 }, { 2, 2, 1 } } };
  const auto faces = FindInterfaces<3>(cubes);
  ASSERT_EQ(faces.size(), 3u);
  check(faces[0], { 0, 3 }, { 1, 2 }, 0.0, 1.0, false);
  check(faces[1], { 0, 2 }, { 2, 3 }, 0.5, 1.0, true);
  EXPECT_EQ(faces[1].Parts[0].Lower[1], 0.25);
  EXPECT_EQ(faces[1].Parts[1].Upper[1], 1.0);
  check(faces[2], { 1, 1 }, { 3, 0 }, 1.0, 2.0, false);
}

namespace
{
template <int Dim>
void CheckSides(const Spline<Dim>& patch, const std::string& where)
{
  SCOPED_TRACE(where);
  const BezierForm<Dim> form = MakeBezierForm<Dim>(patch, 1);
  for (int side = 0; side < 2 * Dim; ++side)
  {
    const auto made = SideSpline<Dim>(patch, side);
    ASSERT_TRUE(made) << made.Status.Detail;
    ASSERT_TRUE(made->Check());
    const auto along = SideDirections<Dim>(side);
    const ParametricBox<Dim> domain = patch.Space->Domain();
    PointMatrix own(7, Dim - 1);
    PointMatrix all(7, Dim);
    Random random(static_cast<unsigned>(side) + 1);
    for (Eigen::Index i = 0; i < own.rows(); ++i)
    {
      all(i, side / 2) = SideValue<Dim>(domain, side);
      for (std::size_t k = 0; k + 1 < Dim; ++k)
      {
        const double t = random.In(domain.Lower[along[k]], domain.Upper[along[k]]);
        own(i, static_cast<Eigen::Index>(k)) = t;
        all(i, static_cast<Eigen::Index>(along[k])) = t;
      }
    }
    EvaluationBatch expected, got;
    ASSERT_TRUE(EvaluateParameters<Dim>(form, all, {}, expected));
    ASSERT_TRUE(EvaluateParameters<Dim - 1>(MakeBezierForm<Dim - 1>(made.Value, 1), own, {}, got));
    // rounding of sums of a few dozen terms of size 10
    EXPECT_LE((expected.Values - got.Values).cwiseAbs().maxCoeff(), 1e-12);
    if (patch.Space->Kind == SpaceKind::Tensor)
    {
      const std::vector<int> functions = SideFunctions<Dim>(*patch.Space, side);
      for (std::size_t f = 0; f < functions.size(); ++f)
      {
        EXPECT_EQ(made->ControlPoints.row(static_cast<Eigen::Index>(f)),
          patch.ControlPoints.row(functions[f]));
      }
      for (int corner = 0; corner < (1 << (Dim - 1)); ++corner)
      {
        EXPECT_EQ(made->ControlPoints.row(CornerFunction<Dim - 1>(*made->Space, corner)),
          patch.ControlPoints.row(
            CornerFunction<Dim>(*patch.Space, PatchCorner<Dim>(side, corner))));
      }
    }
  }
}
}

TEST(SideSpline, IsTheMapOnTheSide_CrossOracle)
{
  for (unsigned seed = 1; seed <= 8; ++seed)
  {
    Random random(seed);
    const bool rational = seed % 2 == 0;
    for (const Family family : { Family::Tensor, Family::Hierarchical })
    {
      const Spline<2> surface = RandomPatch<2>(random, family, rational);
      CheckSides<2>(surface, "surface");
      CheckSides<3>(RandomPatch<3>(random, family, rational), "volume");
      if (family == Family::Tensor)
      {
        CheckSides<2>(LocallyRefined(surface), "locally refined");
      }
    }
  }
}

TEST(SideSpline, EveryFailureIsReachable)
{
  Random random(1);
  Spline<2> patch = RandomPatch<2>(random, Family::Tensor, false);
  EXPECT_EQ(SideSpline<2>(patch, 4).Status.Code, ErrorCode::InvalidParameter);
  EXPECT_EQ(SideSpline<2>(patch, -1).Status.Code, ErrorCode::InvalidParameter);
  const KnotVector open = MildKnots(random, 2, 3, 1, false);
  const KnotVector clamped = MildKnots(random, 2, 3, 1, true);
  const Spline<2> half =
    RandomSpline<2>(random, MakeTensorSpace<2>({ open, clamped }).Value, 2, false);
  EXPECT_EQ(SideSpline<2>(half, 0).Status.Code, ErrorCode::InvalidKnots);
  EXPECT_TRUE(SideSpline<2>(half, 2));
  patch.ControlPoints(0, 0) = std::nan("");
  EXPECT_EQ(SideSpline<2>(patch, 0).Status.Code, ErrorCode::NonFiniteInput);
  EXPECT_EQ(SampleSides<2>({ half, patch }, 3, 1).Status.Code, ErrorCode::NonFiniteInput);
  EXPECT_EQ(SampleSides<2>({ half }, 1, 1).Status.Code, ErrorCode::InvalidParameter);
}

TEST(CheckTopology, NamesWhatIsNotThere)
{
  PatchTopology topology;
  PatchInterface made;
  made.Sides = { PatchSide{ 0, 1 }, PatchSide{ 1, 3 } };
  topology.Interfaces = { made };
  topology.Boundary = { { 1, 0 } };
  EXPECT_TRUE(CheckTopology(topology, 2, 2));
  EXPECT_EQ(CheckTopology(topology, 1, 2).Code, ErrorCode::InvalidTopology);
  EXPECT_EQ(CheckTopology(topology, 2, 1).Code, ErrorCode::InvalidTopology);
  topology.Interfaces[0].Orientation = SideOrientation::Make(2);
  EXPECT_EQ(CheckTopology(topology, 2, 2).Code, ErrorCode::InvalidTopology);
  EXPECT_TRUE(CheckTopology(topology, 2, 3));
  topology.Boundary[0].Side = 6;
  EXPECT_EQ(CheckTopology(topology, 2, 3).Code, ErrorCode::InvalidTopology);
}

TEST(SharedEdges, EdgesAlongWholeSidesAtEqualSharesAreInterfaces_ExactOracle)
{
  TrimmedModel model;
  const ParametricBox<2> domains[] = { { { 0, 0 }, { 2, 1 } }, { { 0, -1 }, { 1, 3 } } };
  for (const ParametricBox<2>& domain : domains)
  {
    TrimmedFace face;
    face.Surface.Space =
      MakeTensorSpace<2>({ KnotVector::Uniform(1, 1, domain.Lower[0], domain.Upper[0]),
                           KnotVector::Uniform(1, 1, domain.Lower[1], domain.Upper[1]) })
        .Value;
    face.Surface.ControlPoints = PointMatrix::Zero(4, 3);
    model.Faces.push_back(face);
  }
  const auto addEdge = [&](const PointMatrix& first, const PointMatrix& second)
  {
    for (int f = 0; f < 2; ++f)
    {
      TrimmingCurve use;
      use.Curve.Space = MakeTensorSpace<1>({ KnotVector::Uniform(2, 1) }).Value;
      use.Curve.ControlPoints = PointMatrix::Zero(3, 3);
      use.UV = f == 0 ? first : second;
      use.Edge = model.NumEdges;
      model.Faces[At(f)].Loops.push_back({ { use } });
    }
    ++model.NumEdges;
  };
  PointMatrix upper(3, 2), lower(3, 2), quick(3, 2), part(3, 2), inside(3, 2);
  upper << 2, 0, 2, 0.25, 2, 1;    // u = 2, not at constant speed
  lower << 1, -1, 0.75, -1, 0, -1; // v = -1, at the same shares the other way round
  quick << 1, -1, 0.5, -1, 0, -1;  // at other shares
  part << 1, -1, 0.75, -1, 0.5, -1;
  inside << 1, 0, 0.75, 0, 0, 0;
  addEdge(upper, lower);
  addEdge(upper, quick);
  addEdge(upper, part);
  addEdge(upper, inside);
  const PatchTopology topology = SharedEdges(model);
  ASSERT_EQ(topology.Interfaces.size(), 1u);
  EXPECT_EQ(topology.Interfaces[0].Sides[0], (PatchSide{ 0, 1 }));
  EXPECT_EQ(topology.Interfaces[0].Sides[1], (PatchSide{ 1, 2 }));
  EXPECT_EQ(topology.Interfaces[0].Orientation.Number(), 1);
  EXPECT_FALSE(topology.Interfaces[0].Partial);
}
