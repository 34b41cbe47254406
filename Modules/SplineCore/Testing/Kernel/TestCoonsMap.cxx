// SPDX-License-Identifier: BSD-3-Clause
#include "MeshCases.h"
#include <knotwork/SplineCore/CoonsMap.h>
#include <knotwork/SplineCore/SplitIntoPatches.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <gtest/gtest.h>

using namespace knotwork;
using namespace meshes;

namespace
{
/// Sums of 2^Dim 3^Dim products of numbers of size 1.
constexpr double Tolerance = 1e-13;

PointMatrix RandomPoints(Random& random, Eigen::Index rows, Eigen::Index columns = 3)
{
  PointMatrix points(rows, columns);
  for (Eigen::Index i = 0; i < points.size(); ++i)
  {
    points.data()[i] = random.In(-1.0, 1.0);
  }
  return points;
}

template <int Dim>
SplineSpacePtr<Dim> RandomSpace(Random& random)
{
  std::array<KnotVector, Dim> knots;
  for (KnotVector& k : knots)
  {
    const int p = random.Int(1, 4);
    std::vector<double> values(static_cast<std::size_t>(p + 1), -0.5);
    for (int i = random.Int(1, 5); i > 0; --i)
    {
      values.push_back(values.back() + random.In(0.1, 2.0));
    }
    values.insert(values.end(), static_cast<std::size_t>(p), values.back());
    k = KnotVector::Create(p, values).Value;
  }
  return MakeTensorSpace<Dim>(knots).Value;
}

template <int Dim>
Eigen::Index RowOf(const BoxAbscissae<Dim>& a, const std::array<Eigen::Index, Dim>& index)
{
  Eigen::Index row = 0;
  for (std::size_t d = Dim; d-- > 0;)
  {
    row = row * a[d].size() + index[d];
  }
  return row;
}

template <int Dim>
bool IsInside(const BoxAbscissae<Dim>& a, Eigen::Index row)
{
  bool inside = true;
  for (const Eigen::VectorXd& list : a)
  {
    const Eigen::Index i = row % list.size();
    row /= list.size();
    inside = inside && i > 0 && i < list.size() - 1;
  }
  return inside;
}

template <int Dim>
void ForgetInside(const BoxAbscissae<Dim>& a, PointMatrix& points)
{
  for (Eigen::Index row = 0; row < points.rows(); ++row)
  {
    if (IsInside<Dim>(a, row))
    {
      points.row(row).setConstant(17.0);
    }
  }
}

/// The printed formula of surfaces.
Eigen::RowVectorXd Printed(
  const BoxAbscissae<2>& s, const PointMatrix& points, Eigen::Index i, Eigen::Index j)
{
  const auto at = [&](Eigen::Index k, Eigen::Index l) {
    return Eigen::RowVectorXd(points.row(RowOf<2>(s, { k, l })));
  };
  const Eigen::Index m = s[0].size() - 1;
  const Eigen::Index n = s[1].size() - 1;
  const double a = s[0][i];
  const double b = s[1][j];
  return (1 - b) * at(i, 0) + b * at(i, n) + (1 - a) * at(0, j) + a * at(m, j) -
    ((1 - a) * (1 - b) * at(0, 0) + a * (1 - b) * at(m, 0) + (1 - a) * b * at(0, n) +
      a * b * at(m, n));
}

/// Of volumes: I - (I - L_0)(I - L_1)(I - L_2), one direction after the other.
PointMatrix SumByDirections(const BoxAbscissae<3>& s, const PointMatrix& points)
{
  PointMatrix rest = points; // its inner values do not matter: they cancel
  for (std::size_t d = 0; d < 3; ++d)
  {
    PointMatrix next = rest;
    for (Eigen::Index i = 0; i < s[0].size(); ++i)
    {
      for (Eigen::Index j = 0; j < s[1].size(); ++j)
      {
        for (Eigen::Index k = 0; k < s[2].size(); ++k)
        {
          const std::array<Eigen::Index, 3> at{ i, j, k };
          std::array<Eigen::Index, 3> low = at;
          std::array<Eigen::Index, 3> high = at;
          low[d] = 0;
          high[d] = s[d].size() - 1;
          const double t = s[d][at[d]];
          next.row(RowOf<3>(s, at)) -=
            (1 - t) * rest.row(RowOf<3>(s, low)) + t * rest.row(RowOf<3>(s, high));
        }
      }
    }
    rest = next;
  }
  return points - rest;
}

template <int Dim>
void ExpectMultilinear(Random& random)
{
  const auto s = GrevilleAbscissae<Dim>(*RandomSpace<Dim>(random));
  PointMatrix corners = RandomPoints(random, 1 << Dim);
  const bool isAffine = random.Unit() < 0.5;
  if (isAffine)
  {
    const PointMatrix map = RandomPoints(random, Dim + 1);
    for (Eigen::Index c = 0; c < corners.rows(); ++c)
    {
      corners.row(c) = map.row(Dim);
      for (int d = 0; d < Dim; ++d)
      {
        corners.row(c) += (c >> d & 1) * map.row(d);
      }
    }
  }
  const PointMatrix exact = MultilinearPoints<Dim>(s, corners);
  PointMatrix coons = exact;
  ForgetInside<Dim>(s, coons);
  const auto shape = ShapeOfBoundary<Dim>(s, coons, 1e-12);
  ASSERT_TRUE(FillInside<Dim>(s, coons));
  EXPECT_LE((coons - exact).cwiseAbs().maxCoeff(), Tolerance);
  ASSERT_TRUE(shape);
  EXPECT_EQ(shape->Shape, isAffine ? BoundaryShape::Affine : BoundaryShape::Multilinear);
  EXPECT_LE((shape->Points - exact).cwiseAbs().maxCoeff(), Tolerance);

  coons(0, 1) += 1e-3; // a corner: multilinear when there is nothing between the corners, else none
  const auto moved = ShapeOfBoundary<Dim>(s, coons, 1e-6);
  bool onlyCorners = true;
  for (const auto& list : s)
  {
    onlyCorners = onlyCorners && list.size() == 2;
  }
  EXPECT_EQ(moved->Shape, onlyCorners ? BoundaryShape::Multilinear : BoundaryShape::General);
  EXPECT_GT(onlyCorners ? 1.0 : moved->Distance, 1e-5);
  EXPECT_EQ(ShapeOfBoundary<Dim>(s, coons, 1e-2)->Shape == BoundaryShape::General, false);
}

template <int Dim>
Spline<Dim> RandomSpline(Random& random, const CellMesh<Dim>& mesh, int degree, CreasePolicy policy)
{
  UnstructuredParams params;
  params.Degree = degree;
  params.Policy = policy;
  params.Lengths.resize(
    static_cast<std::size_t>(MeshTopology<Dim>::Make(mesh)->FindSheets().Count));
  for (double& length : params.Lengths)
  {
    length = random.Int(1, 3);
  }
  Spline<Dim> spline;
  spline.Space = MakeUnstructuredSpace<Dim>(mesh, params)->Space;
  spline.ControlPoints = RandomPoints(random, spline.Space->NumFunctions);
  return spline;
}

/// The patches of the result are the Coons maps of the given spline's patches.
template <int Dim>
void ExpectCoonsOfPatches(const Spline<Dim>& spline, bool facesToo)
{
  CoonsParams params;
  params.FacesFromEdges = facesToo;
  const auto coons = CoonsMap(spline, params);
  ASSERT_TRUE(coons) << coons.Status.Message();
  const auto before = SplitIntoPatches(spline);
  const auto after = SplitIntoPatches(coons.Value);
  for (std::size_t k = 0; k < after->Patches.size(); ++k)
  {
    const auto s = GrevilleAbscissae<Dim>(*after->Patches[k].Space);
    const PointMatrix& points = after->Patches[k].ControlPoints;
    const PointMatrix& given = before->Patches[k].ControlPoints;
    if constexpr (Dim == 2)
    {
      for (Eigen::Index i = 0; i < s[0].size(); ++i)
      {
        for (Eigen::Index j = 0; j < s[1].size(); ++j)
        {
          const Eigen::Index row = RowOf<2>(s, { i, j });
          const Eigen::RowVectorXd expected =
            IsInside<2>(s, row) ? Printed(s, given, i, j) : Eigen::RowVectorXd(given.row(row));
          // 1e-10: the patches' points are recovered from Bezier form
          EXPECT_LE((points.row(row) - expected).cwiseAbs().maxCoeff(), 1e-10);
        }
      }
    }
    else
    {
      const PointMatrix expected = SumByDirections(s, points);
      EXPECT_LE((points - expected).cwiseAbs().maxCoeff(), 1e-10);
      for (Eigen::Index row = 0; row < points.rows(); ++row)
      {
        int ends = 0;
        std::array<Eigen::Index, 3> index;
        Eigen::Index rest = row;
        for (std::size_t d = 0; d < 3; ++d)
        {
          index[d] = rest % s[d].size();
          rest /= s[d].size();
          ends += index[d] == 0 || index[d] == s[d].size() - 1 ? 1 : 0;
        }
        if (ends >= (facesToo ? 2 : 1))
        {
          EXPECT_LE((points.row(row) - given.row(row)).cwiseAbs().maxCoeff(), 1e-10);
        }
        else if (ends == 1 && index[2] == 0)
        {
          PointMatrix face(s[0].size() * s[1].size(), 3);
          face = given.topRows(face.rows());
          const BoxAbscissae<2> own{ s[0], s[1] };
          EXPECT_LE(
            (points.row(row) - Printed(own, face, index[0], index[1])).cwiseAbs().maxCoeff(),
            1e-10);
        }
      }
    }
  }
}
}

TEST(CoonsMap, MultilinearMapsAreReproducedAndRecognized_ExactOracle)
{
  for (unsigned seed = 1; seed <= 50; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    ExpectMultilinear<2>(random);
    ExpectMultilinear<3>(random);
  }
}

TEST(CoonsMap, BooleanSumOfAnyBoundary_CrossOracle)
{
  for (unsigned seed = 1; seed <= 20; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto s2 = GrevilleAbscissae<2>(*RandomSpace<2>(random));
    PointMatrix surface = RandomPoints(random, s2[0].size() * s2[1].size());
    ASSERT_TRUE(FillInside<2>(s2, surface));
    for (Eigen::Index i = 1; i + 1 < s2[0].size(); ++i)
    {
      for (Eigen::Index j = 1; j + 1 < s2[1].size(); ++j)
      {
        EXPECT_LE(
          (surface.row(RowOf<2>(s2, { i, j })) - Printed(s2, surface, i, j)).cwiseAbs().maxCoeff(),
          Tolerance);
      }
    }
    const auto s3 = GrevilleAbscissae<3>(*RandomSpace<3>(random));
    PointMatrix volume = RandomPoints(random, s3[0].size() * s3[1].size() * s3[2].size());
    ASSERT_TRUE(FillInside<3>(s3, volume));
    EXPECT_LE((volume - SumByDirections(s3, volume)).cwiseAbs().maxCoeff(), Tolerance);
  }
}

TEST(CoonsMap, PatchesOfUnstructuredSplines_CrossOracle)
{
  for (unsigned seed = 1; seed <= 4; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const int degree = static_cast<int>(seed);
    ExpectCoonsOfPatches<2>(
      RandomSpline<2>(random, Shuffled<2>(random, Star(5, 3)), degree, CreasePolicy::Full), false);
    const auto volume = RandomSpline<3>(
      random, Shuffled<3>(random, Sweep(Star(3, 2), 3)), degree, CreasePolicy::Full);
    ExpectCoonsOfPatches<3>(volume, false);
    ExpectCoonsOfPatches<3>(volume, true);
  }
}

TEST(CoonsMap, EqualWeightsChangeNothing_PropertyOracle)
{
  Random random(3);
  Spline<2> spline = RandomSpline<2>(random, Star(5, 3), 3, CreasePolicy::Full);
  const auto polynomial = CoonsMap(spline);
  spline.Weights.setConstant(spline.Space->NumFunctions, 2.0);
  const auto rational = CoonsMap(spline);
  EXPECT_LE((polynomial->ControlPoints - rational->ControlPoints).cwiseAbs().maxCoeff(), Tolerance);
  EXPECT_LE((rational->Weights.array() - 2.0).abs().maxCoeff(), Tolerance);
}

TEST(CoonsMap, EveryFailureIsReachable)
{
  Random random(1);
  EXPECT_EQ(CoonsMap(Spline<2>{}).Status.Code, ErrorCode::EmptyInput);
  Spline<2> tensor;
  tensor.Space = RandomSpace<2>(random);
  tensor.ControlPoints = RandomPoints(random, tensor.Space->NumFunctions);
  EXPECT_EQ(CoonsMap(tensor).Status.Code, ErrorCode::DimensionMismatch);
  Spline<2> spline = RandomSpline<2>(random, Star(5, 4), 3, CreasePolicy::Full);
  spline.ControlPoints.conservativeResize(3, 3);
  EXPECT_EQ(CoonsMap(spline).Status.Code, ErrorCode::SizeMismatch);
  const auto minimal = CoonsMap(RandomSpline<2>(random, Star(5, 6), 3, CreasePolicy::Minimal));
  EXPECT_EQ(minimal.Status.Code, ErrorCode::NotInSpace);
  EXPECT_NE(minimal.Status.Message().find("patch"), std::string::npos);

  int withTJoints = 0;
  for (unsigned seed = 1; seed <= 20; ++seed)
  {
    Random own(seed);
    const auto mesh = RandomMesh<2>(own, 80);
    const auto tracks = RandomSpline<2>(own, mesh, 2, CreasePolicy::Motorcycle);
    if (!FindSpacePatches(*tracks.Space).TJoints.empty())
    {
      ++withTJoints;
      EXPECT_EQ(CoonsMap(tracks).Status.Code, ErrorCode::NotInSpace) << seed;
    }
  }
  EXPECT_GT(withTJoints, 0);

  spline = RandomSpline<2>(random, Star(5, 4), 3, CreasePolicy::Full);
  spline.Weights.setConstant(spline.Space->NumFunctions, 1.0);
  bool isNegative = false;
  for (Eigen::Index i = 0; i < spline.Weights.size(); ++i)
  {
    Spline<2> heavy = spline;
    heavy.Weights.setConstant(1.0);
    heavy.Weights[i] = 1000.0;
    isNegative = isNegative || CoonsMap(heavy).Status.Code == ErrorCode::InvalidWeight;
  }
  EXPECT_TRUE(isNegative);

  const auto s = GrevilleAbscissae<2>(*tensor.Space);
  PointMatrix few(3, 2);
  EXPECT_EQ(FillInside<2>(s, few).Code, ErrorCode::SizeMismatch);
  EXPECT_EQ(ShapeOfBoundary<2>(s, few, 1e-6).Status.Code, ErrorCode::SizeMismatch);
  EXPECT_EQ(
    ShapeOfBoundary<2>(s, tensor.ControlPoints, -1.0).Status.Code, ErrorCode::InvalidParameter);
}
