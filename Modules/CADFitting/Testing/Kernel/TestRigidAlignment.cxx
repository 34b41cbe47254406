// SPDX-License-Identifier: BSD-3-Clause
// Scans at places that are known: parts of OpenCASCADE, moved by seeded rotations and shifts.
#include "AlignmentCases.h"
#include "AlignmentSteps.h"
#include "FitCases.h"

#include <gtest/gtest.h>

#include <iostream>
#include <limits>

using namespace knotwork;
using namespace alignment;

namespace
{
const double BracketSize = std::sqrt(20.0 * 20.0 + 12.0 * 12.0 + 8.0 * 8.0);

/// How far points are from where they were.
double Error(const RigidMotion& found, const RigidMotion& moved, const PointMatrix& points)
{
  return ((found * moved).Move(points) - points).rowwise().norm().maxCoeff();
}

/// Standard deviation of the shift of the point that shifts most, by the covariance of least
/// squares.
double ExpectedError(
  const FitTarget& target, const PointMatrix& cloud, double noise, const PointMatrix& points)
{
  TargetPoints feet;
  EXPECT_TRUE(FindOnTarget(target, cloud, feet));
  const Eigen::VectorXd weights = (DistancesOf(cloud, feet).array() < 4.0 * noise).cast<double>();
  const MotionEquations equations = EquationsOf(cloud, feet, weights, 0.0, 1.0);
  const Eigen::Matrix<double, 6, 6> covariance = noise * noise * equations.Matrix.inverse();
  double largest = 0.0;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    const Eigen::Vector3d arm = (points.row(i).transpose() - equations.Middle) / equations.Radius;
    Eigen::Matrix<double, 3, 6> shift = Eigen::Matrix<double, 3, 6>::Zero();
    for (int d = 0; d < 3; ++d)
    {
      shift.col(d) = Eigen::Vector3d::Unit(d).cross(arm);
      shift(d, 3 + d) = 1.0;
    }
    largest = std::max(largest, (shift * covariance * shift.transpose()).trace());
  }
  return std::sqrt(largest);
}

TriangleMesh Moved(TriangleMesh mesh, const RigidMotion& motion)
{
  mesh.Points = motion.Move(mesh.Points);
  return mesh;
}

/// Faces without an area.
class PointTarget : public FitTarget
{
public:
  PointTarget() { this->FaceCount = 1; }
  Status Find(
    const TargetPart&, const PointMatrixView& queries, TargetPoints& result) const override
  {
    result.Points.setZero(queries.rows(), 3);
    result.Normals.setZero(queries.rows(), 3);
    result.Faces.assign(static_cast<std::size_t>(queries.rows()), 0);
    return {};
  }
  TargetSamples Samples(int) const override
  {
    return { PointMatrix::Zero(10, 3), Eigen::VectorXd::Zero(10), std::vector<int>(10, 0) };
  }
};

RigidAlignment Aligned(
  const TriangleMesh& scan, const FitTarget& target, const AlignmentParams& params = {})
{
  const auto found = AlignToTarget(scan, target, params);
  EXPECT_TRUE(found) << found.Status.Message();
  return found.Value;
}
}

TEST(RigidAlignment, MeshOfAPartComesBack_ExactOracle)
{
  const FitTargetPtr target = TargetOf(Bracket());
  const TriangleMesh mesh = MeshOf(Bracket(), 0.02);
  for (unsigned seed = 1; seed <= 6; ++seed)
  {
    SCOPED_TRACE(seed);
    const RigidMotion motion = Seeded(seed).Motion(100.0);
    const RigidAlignment found = Aligned(Moved(mesh, motion), *target);
    EXPECT_LE(Error(found.Motion, motion, mesh.Points), 1e-6 * BracketSize);
    EXPECT_TRUE(found.Converged);
    EXPECT_EQ(found.EqualPoses, 1);
    EXPECT_EQ(found.FreeMotions, 0);
    EXPECT_EQ(found.NumInliers, mesh.Points.rows());
    EXPECT_LE(found.Profile.Rms, 1e-6 * BracketSize);
    EXPECT_NEAR(found.Motion.Rotation.determinant(), 1.0, 1e-12);
  }
}

TEST(RigidAlignment, NoiseAndOutliersAreBorne_StatisticalOracle)
{
  const FitTargetPtr target = TargetOf(Bracket());
  constexpr int count = 6000;
  const double noise = 2e-3 * BracketSize;
  for (unsigned seed = 1; seed <= 6; ++seed)
  {
    SCOPED_TRACE(seed);
    Seeded random(seed);
    const PointMatrix cloud = CloudOn(*target, count, noise, 0.2, random);
    const RigidMotion motion = random.Motion(100.0);
    const RigidAlignment found = Aligned({ motion.Move(cloud), {} }, *target);
    const PointMatrix corners = MeshOf(Bracket(), 0.1).Points;
    const double error = Error(found.Motion, motion, corners);
    const double expected = ExpectedError(*target, cloud, noise, corners);
    EXPECT_LE(error, 3.5 * expected);
    EXPECT_LE(error, 20.0 * noise / std::sqrt(0.8 * count)); // an axis is held by few of the points
    std::cout << "error " << error / expected << " of the expected one, "
              << error / noise * std::sqrt(0.8 * count) << " noise / sqrt(n)\n";
    EXPECT_TRUE(found.Converged);
    EXPECT_EQ(found.EqualPoses, 1);
    EXPECT_NEAR(found.InlierRms, noise, 0.2 * noise);
    EXPECT_NEAR(found.NumInliers, 0.8 * count, 0.08 * count); // outliers may lie near the part
  }
}

/// Points of the room behind the part.
TEST(RigidAlignment, FarPointsAreBorne_ExactOracle)
{
  const FitTargetPtr target = TargetOf(Bracket());
  Seeded random(11);
  PointMatrix cloud = CloudOn(*target, 5000, 0.0, 0.0, random);
  for (Eigen::Index i = 0; i < cloud.rows(); i += 20)
  {
    cloud.row(i) = 300.0 * Eigen::RowVector3d(1.0, random.In(-1.0, 1.0), random.In(-1.0, 1.0));
  }
  const RigidMotion motion = random.Motion(40.0);
  const RigidAlignment found = Aligned({ motion.Move(cloud), {} }, *target);
  EXPECT_LE(Error(found.Motion, motion, MeshOf(Bracket(), 0.1).Points), 1e-6 * BracketSize);
  EXPECT_EQ(found.NumInliers, cloud.rows() - cloud.rows() / 20);
}

TEST(RigidAlignment, SymmetricPartsAreAmbiguous_ExactOracle)
{
  const auto poses = [](const TopoDS_Shape& shape, unsigned seed)
  {
    const RigidMotion motion = Seeded(seed).Motion(10.0);
    const RigidAlignment found = Aligned(Moved(MeshOf(shape, 0.01), motion), *TargetOf(shape));
    EXPECT_LE(found.Profile.Rms, 1e-6);
    return std::array<int, 2>{ found.EqualPoses, found.FreeMotions };
  };
  EXPECT_EQ(poses(BRepPrimAPI_MakeBox(3.0, 2.0, 1.0).Shape(), 1), (std::array<int, 2>{ 4, 0 }));
  EXPECT_EQ(poses(BRepPrimAPI_MakeBox(2.0, 2.0, 1.0).Shape(), 2), (std::array<int, 2>{ 8, 0 }));
  EXPECT_EQ(poses(BRepPrimAPI_MakeBox(2.0, 2.0, 2.0).Shape(), 3), (std::array<int, 2>{ 24, 0 }));
  EXPECT_EQ(poses(BRepPrimAPI_MakeCylinder(1.0, 3.0).Shape(), 4), (std::array<int, 2>{ 0, 1 }));
  EXPECT_EQ(poses(BRepPrimAPI_MakeSphere(2.0).Shape(), 5), (std::array<int, 2>{ 0, 3 }));
  // a small hole beside the middle tells them apart
  const TopoDS_Shape hole =
    BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0.5, 0.5, -1), gp_Dir(0, 0, 1)), 0.1, 4.0).Shape();
  EXPECT_EQ(poses(BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(3.0, 2.0, 1.0).Shape(), hole).Shape(), 6),
    (std::array<int, 2>{ 1, 0 }));
}

TEST(RigidAlignment, NoisySymmetricCloudIsAmbiguous_ExactOracle)
{
  const FitTargetPtr target = TargetOf(BRepPrimAPI_MakeBox(3.0, 2.0, 1.0).Shape());
  Seeded random(3);
  const PointMatrix cloud = CloudOn(*target, 5000, 5e-3, 0.1, random);
  EXPECT_EQ(Aligned({ random.Motion(5.0).Move(cloud), {} }, *target).EqualPoses, 4);
}

TEST(RigidAlignment, MirroredAndShearedScansDoNotFit_PropertyOracle)
{
  const FitTargetPtr target = TargetOf(Bracket());
  const TriangleMesh mesh = MeshOf(Bracket(), 0.05);
  Eigen::Matrix3d mirror = Eigen::Vector3d(-1.0, 1.0, 1.0).asDiagonal();
  Eigen::Matrix3d shear = Eigen::Matrix3d::Identity();
  shear(0, 1) = 0.2;
  for (const Eigen::Matrix3d& change : { mirror, shear })
  {
    TriangleMesh scan = mesh;
    scan.Points = scan.Points * change.transpose();
    scan.Points = Seeded(4).Motion(30.0).Move(scan.Points);
    EXPECT_GE(Aligned(scan, *target).Profile.Rms, 5e-3 * BracketSize);
  }
}

TEST(RigidAlignment, PartOfAScanFindsItsPlace_ExactOracle)
{
  const FitTargetPtr target = TargetOf(Bracket());
  Seeded random(5);
  const PointMatrix all = CloudOn(*target, 8000, 0.0, 0.0, random);
  for (int side = 0; side < 3; ++side)
  {
    SCOPED_TRACE(side);
    PointMatrix part(all.rows(), 3);
    Eigen::Index count = 0;
    for (Eigen::Index i = 0; i < all.rows(); ++i)
    {
      if (side == 0 ? all(i, 0) > 6.0 : side == 1 ? all(i, 1) < 9.0 : all(i, 2) > 1.0)
      {
        part.row(count++) = all.row(i);
      }
    }
    part.conservativeResize(count, 3);
    const RigidMotion motion = random.Motion(50.0);
    const RigidAlignment found = Aligned({ motion.Move(part), {} }, *target);
    EXPECT_LE(Error(found.Motion, motion, part), 1e-6 * BracketSize);
  }
}

TEST(RigidAlignment, MeshOntoMesh_ExactOracle)
{
  const TriangleMesh mesh = MeshOf(Bracket(), 0.05);
  const auto target = MakeMeshTarget(mesh);
  ASSERT_TRUE(target);
  const RigidMotion motion = Seeded(6).Motion(30.0);
  const RigidAlignment found = Aligned(Moved(mesh, motion), *target.Value);
  EXPECT_LE(Error(found.Motion, motion, mesh.Points), 1e-6 * BracketSize);
  EXPECT_EQ(found.EqualPoses, 1);
}

/// A scan in inches lies well anywhere on a part in millimetres: its size tells.
TEST(RigidAlignment, SizeOfTheScanIsTold_ExactOracle)
{
  const FitTargetPtr target = TargetOf(Bracket());
  TriangleMesh mesh = MeshOf(Bracket(), 0.05);
  EXPECT_NEAR(Aligned(mesh, *target).SizeRatio, 1.0, 0.05);
  mesh.Points /= 25.4;
  EXPECT_NEAR(Aligned(mesh, *target).SizeRatio * 25.4, 1.0, 0.05);
}

/// The scan's own place, a bit off, is found without a search, and by all rules.
TEST(RigidAlignment, RulesOfOutliers_ExactOracle)
{
  const FitTargetPtr target = TargetOf(Bracket());
  const TriangleMesh mesh = MeshOf(Bracket(), 0.02);
  RigidMotion motion;
  motion.Rotation =
    Eigen::AngleAxisd(0.1, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  motion.Translation = { 0.5, -0.3, 0.2 };
  AlignmentParams params;
  params.Coarse = false;
  for (const OutlierRule rule : { OutlierRule::Tukey, OutlierRule::Trimmed, OutlierRule::None })
  {
    params.Outliers = rule;
    const RigidAlignment found = Aligned(Moved(mesh, motion), *target, params);
    EXPECT_LE(Error(found.Motion, motion, mesh.Points), 1e-6 * BracketSize);
    EXPECT_EQ(found.EqualPoses, 1);
  }
  // with outliers the mean is drawn away, the others are not
  Seeded random(7);
  const PointMatrix cloud = CloudOn(*target, 5000, 0.0, 0.1, random);
  const auto error = [&](OutlierRule rule)
  {
    params.Outliers = rule;
    return Error(Aligned({ motion.Move(cloud), {} }, *target, params).Motion, motion, mesh.Points);
  };
  EXPECT_LE(error(OutlierRule::Tukey), 1e-6 * BracketSize);
  EXPECT_LE(error(OutlierRule::Trimmed), 1e-6 * BracketSize);
  EXPECT_GE(error(OutlierRule::None), 1e-4 * BracketSize);
}

TEST(RigidAlignment, SameForAnyNumberOfThreads_ExactOracle)
{
  const FitTargetPtr target = TargetOf(Bracket());
  Seeded random(8);
  const TriangleMesh scan{ random.Motion(9.0).Move(CloudOn(*target, 3000, 0.02, 0.1, random)), {} };
  AlignmentParams params;
  params.Threads = 1;
  const RigidAlignment one = Aligned(scan, *target, params);
  params.Threads = 3;
  const RigidAlignment three = Aligned(scan, *target, params);
  EXPECT_EQ(one.Motion.Matrix(), three.Motion.Matrix());
  EXPECT_EQ(one.Deviation.Distances, three.Deviation.Distances);
}

TEST(RigidAlignment, IterationsThatDoNotSettleAreReported)
{
  const FitTargetPtr target = TargetOf(Bracket());
  AlignmentParams params;
  params.MaxIterations = 2;
  const RigidAlignment found =
    Aligned(Moved(MeshOf(Bracket(), 0.02), Seeded(9).Motion(9.0)), *target, params);
  EXPECT_FALSE(found.Converged);
  EXPECT_EQ(found.Iterations, 2);
  EXPECT_GT(found.LastStep, 0.0);
}

TEST(RigidAlignment, EveryFailureIsReachable)
{
  const FitTargetPtr target = MakeMeshTarget(fits::BoxTriangles(4)).Value;
  const TriangleMesh box = fits::BoxTriangles(4);
  const auto code = [&](const TriangleMesh& scan, const AlignmentParams& params = {})
  { return AlignToTarget(scan, *target, params).Status.Code; };
  EXPECT_EQ(code({ PointMatrix(0, 3), {} }), ErrorCode::EmptyInput);
  EXPECT_EQ(code({ PointMatrix::Zero(2, 3), {} }), ErrorCode::SingularSystem);
  PointMatrix line(50, 3);
  line.col(0).setLinSpaced(0.0, 1.0);
  line.col(1) = line.col(2) = line.col(0);
  const auto onLine = AlignToTarget({ line, {} }, *target);
  EXPECT_EQ(onLine.Status.Code, ErrorCode::SingularSystem);
  EXPECT_NE(onLine.Status.Detail.find("one line"), std::string::npos);
  TriangleMesh bad = box;
  bad.Points(5, 1) = std::numeric_limits<double>::quiet_NaN();
  const auto notFinite = AlignToTarget(bad, *target);
  EXPECT_EQ(notFinite.Status.Code, ErrorCode::NonFiniteInput);
  EXPECT_NE(notFinite.Status.Detail.find("point 5"), std::string::npos);
  bad = box;
  bad.Triangles[3][1] = 100000;
  EXPECT_EQ(code(bad), ErrorCode::InvalidTopology);
  bad = box;
  bad.Points *= 25.4;
  const auto inches = AlignToTarget(bad, *target);
  EXPECT_EQ(inches.Status.Code, ErrorCode::InvalidParameter);
  EXPECT_NE(inches.Status.Detail.find("25.4 times as large"), std::string::npos);
  AlignmentParams params;
  params.TrimmedShare = 0.95;
  EXPECT_EQ(code(box, params), ErrorCode::InvalidParameter);
  params = {};
  params.MaxIterations = 0;
  EXPECT_EQ(code(box, params), ErrorCode::InvalidParameter);
  params = {};
  params.Tolerance = 0.0;
  EXPECT_EQ(code(box, params), ErrorCode::InvalidParameter);
  params = {};
  params.Progress = [](double) { return false; };
  EXPECT_EQ(code(box, params), ErrorCode::Aborted);
  // far away, and not told to search
  params = {};
  params.Coarse = false;
  bad = box;
  bad.Points.array() += 50.0;
  EXPECT_EQ(code(bad, params), ErrorCode::NotConverged);
  const auto curve = [](double x)
  {
    Spline<1> segment;
    segment.Space =
      MakeTensorSpace<1>({ KnotVector::Create(1, { 0.0, 0.0, 1.0, 1.0 }).Value }).Value;
    segment.ControlPoints.resize(2, 3);
    segment.ControlPoints << 0, 0, 0, x, 1, 1;
    return segment;
  };
  const auto curves = MakeCurveTarget({ curve(1.0) });
  ASSERT_TRUE(curves);
  EXPECT_EQ(AlignToTarget(box, *curves.Value).Status.Code, ErrorCode::EmptyInput);
  const auto nothing = AlignToTarget(box, PointTarget());
  EXPECT_EQ(nothing.Status.Code, ErrorCode::EmptyInput);
  EXPECT_NE(nothing.Status.Detail.find("no extent"), std::string::npos);
}

TEST(TargetDistances, SignsAtFacesEdgesAndCornersOfABox_ExactOracle)
{
  for (const bool isTurned : { false, true })
  {
    TriangleMesh box = fits::BoxTriangles(3);
    for (auto& triangle : box.Triangles)
    {
      if (isTurned)
      {
        std::swap(triangle[0], triangle[1]);
      }
    }
    const auto target = MakeMeshTarget(box);
    ASSERT_TRUE(target);
    const auto sides = SidesOf(*target.Value);
    ASSERT_TRUE(sides);
    EXPECT_EQ(sides->Outward, isTurned ? -1.0 : 1.0);
    Seeded random(1);
    PointMatrix queries(2000, 3);
    for (Eigen::Index i = 0; i < queries.size(); ++i)
    {
      queries.data()[i] = random.In(-0.5, 1.5);
    }
    const auto measured = MeasureTargetDistances(*target.Value, queries, sides.Value);
    ASSERT_TRUE(measured);
    for (Eigen::Index i = 0; i < queries.rows(); ++i)
    {
      const Eigen::Array3d x = queries.row(i).transpose().array();
      const Eigen::Array3d out = (x - 0.5).abs() - 0.5;
      const double expected = out.maxCoeff() > 0.0 ? out.max(0.0).matrix().norm() : out.maxCoeff();
      ASSERT_NEAR(measured->Distances[i], expected, 1e-12) << i;
    }
  }
}

/// A thin wedge: next to its edge normals of one side say the wrong thing. Signs of a point are the
/// same by itself, among others and beside a stray one.
TEST(TargetDistances, SignsAtAnAcuteEdge_ExactOracle)
{
  TriangleMesh wedge;
  wedge.Points.resize(6, 3);
  wedge.Points << 0, 0, 0, 2, -0.2, 0, 2, 0.2, 0, 0, 0, 1, 2, -0.2, 1, 2, 0.2, 1;
  wedge.Triangles = { { 0, 2, 1 }, { 3, 4, 5 }, { 0, 1, 4 }, { 0, 4, 3 }, { 1, 2, 5 }, { 1, 5, 4 },
    { 2, 0, 3 }, { 2, 3, 5 } };
  const auto target = MakeMeshTarget(wedge);
  ASSERT_TRUE(target);
  PointMatrix queries(5, 3);
  queries << -0.5, 0.2, 0.5, -0.5, -0.2, 0.5, 1.0, 0.0, 0.5, -0.5, 0.2, 1.5, 1e6, 0.0, 0.0;
  const TargetSides sides = SidesOf(*target.Value).Value;
  EXPECT_NEAR(sides.Size, std::sqrt(2.0 * 2.0 + 0.4 * 0.4 + 1.0), 0.1);
  const auto together = MeasureTargetDistances(*target.Value, queries, sides);
  ASSERT_TRUE(together);
  const Eigen::VectorXd& distances = together->Distances;
  EXPECT_NEAR(distances[0], std::hypot(0.5, 0.2), 1e-12);
  EXPECT_NEAR(distances[1], std::hypot(0.5, 0.2), 1e-12);
  EXPECT_NEAR(distances[2], -0.1 * 2.0 / std::hypot(2.0, 0.2), 1e-12);
  EXPECT_NEAR(distances[3], std::sqrt(0.25 + 0.04 + 0.25), 1e-12);
  EXPECT_NEAR(distances[4], 1e6 - 2.0, 1e-6);
  for (Eigen::Index i = 0; i < queries.rows(); ++i)
  {
    const auto alone = MeasureTargetDistances(*target.Value, queries.middleRows(i, 1), sides);
    ASSERT_TRUE(alone);
    EXPECT_EQ(alone->Distances[0], distances[i]) << i;
    PointMatrix pair(2, 3);
    pair << queries.row(i), queries.row(4);
    EXPECT_EQ(MeasureTargetDistances(*target.Value, pair, sides)->Distances[0], distances[i]) << i;
  }
}

/// An open roof whose slopes meet at an acute angle, too, has one sign a query.
TEST(TargetDistances, SignsAtAnEdgeOfAnOpenTarget_ExactOracle)
{
  TriangleMesh roof;
  roof.Points.resize(6, 3);
  roof.Points << 0, 0, 0, 2, -0.2, 0, 2, 0.2, 0, 0, 0, 1, 2, -0.2, 1, 2, 0.2, 1;
  roof.Triangles = { { 0, 1, 4 }, { 0, 4, 3 }, { 2, 0, 3 }, { 2, 3, 5 } };
  const auto target = MakeMeshTarget(roof);
  ASSERT_TRUE(target);
  const TargetSides sides = SidesOf(*target.Value).Value;
  EXPECT_EQ(sides.Outward, 1.0);
  for (const double y : { 0.2, -0.2 })
  {
    const PointMatrix query = Eigen::RowVector3d(-0.5, y, 0.5);
    const auto measured = MeasureTargetDistances(*target.Value, query, sides);
    EXPECT_NEAR(measured->Distances[0], std::hypot(0.5, 0.2), 1e-12);
  }
}

/// So far away that rounding leaves the closest point open.
TEST(TargetDistances, FarPointsAreOutside_ExactOracle)
{
  const auto target = MakeMeshTarget(fits::BoxTriangles(3));
  const TargetSides sides = SidesOf(*target.Value).Value;
  PointMatrix queries(6, 3);
  queries << 0, 0, 1e50, 0, 0, -1e50, 1e50, 0, 0, -1e50, 0, 0, 0.5, 0.5, 1e12, -1e18, 0.3, 0.2;
  const auto measured = MeasureTargetDistances(*target.Value, queries, sides);
  ASSERT_TRUE(measured);
  for (Eigen::Index i = 0; i < queries.rows(); ++i)
  {
    EXPECT_NEAR(measured->Distances[i] / queries.row(i).norm(), 1.0, 1e-9) << i;
  }
}

TEST(TargetDistances, SameForAnyNumberOfThreads_ExactOracle)
{
  const FitTargetPtr target = TargetOf(Bracket());
  Seeded random(12);
  const PointMatrix cloud = CloudOn(*target, 3000, 0.5, 0.1, random);
  TargetDistanceParams params;
  params.Threads = 1;
  const auto one = MeasureTargetDistances(*target, cloud, SidesOf(*target, params).Value, params);
  params.Threads = 3;
  const auto three = MeasureTargetDistances(*target, cloud, SidesOf(*target, params).Value, params);
  ASSERT_TRUE(one && three);
  EXPECT_EQ(one->Distances, three->Distances);
  EXPECT_EQ(one->Feet.Points, three->Feet.Points);
}

/// Both loops can be stopped.
TEST(TargetDistances, StopsWhereverItIsAsked)
{
  const auto target = MakeMeshTarget(fits::BoxTriangles(3));
  const PointMatrix queries = PointMatrix::Constant(20000, 3, 0.4);
  const TargetSides sides = SidesOf(*target.Value).Value;
  for (const double last : { 0.0, 0.3, 0.5, 0.8 })
  {
    TargetDistanceParams params;
    params.Progress = [last](double share) { return share <= last; };
    const auto measured = MeasureTargetDistances(*target.Value, queries, sides, params);
    EXPECT_EQ(measured.Status.Code, ErrorCode::Aborted) << last;
  }
}

TEST(TargetDistances, Profile_ExactOracle)
{
  Eigen::VectorXd distances(1000);
  for (int i = 0; i < 1000; ++i)
  {
    distances[i] = (i % 2 == 0 ? 1.0 : -1.0) * (1000 - i); // 1 to 1000 in absolute value
  }
  const DistanceProfile profile = ProfileOf(distances);
  EXPECT_EQ(profile.NumPoints, 1000);
  EXPECT_EQ(
    profile.Percentiles, (std::array<double, 6>{ 500.0, 900.0, 950.0, 990.0, 999.0, 1000.0 }));
  EXPECT_EQ(profile.Max, 1000.0);
  EXPECT_EQ(profile.Min, -999.0);
  EXPECT_NEAR(profile.MeanAbsolute, 500.5, 1e-10);
  EXPECT_NEAR(profile.Rms, std::sqrt(1001.0 * 2001.0 / 6.0), 1e-9);
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(1000);
  weights[999] = 3.0; // of distance 1
  weights[0] = 1.0;
  EXPECT_EQ(ProfileOf(distances, weights).Percentiles[0], 1.0);
  EXPECT_EQ(ProfileOf(distances, weights).Percentiles[1], 1000.0);
  EXPECT_EQ(ProfileOf(Eigen::VectorXd()).NumPoints, 0);
}
