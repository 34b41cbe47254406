// SPDX-License-Identifier: BSD-3-Clause
#include "TrimCases.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SurfaceTrimming/FaceCertificate.h>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace knotwork
{
namespace
{
using testing::Monomials;
using testing::Polygon;

FaceCertificate Certify(const TrimmedFace& face, const FaceCertificateParams& params = {})
{
  auto certificate = CertifyFace(face, params);
  EXPECT_TRUE(certificate) << certificate.Status.Message();
  return certificate.Value;
}

TrimmedFace Face(const Spline<2>& surface, const std::vector<TrimmedLoop>& loops = {})
{
  TrimmedFace face;
  face.Surface = surface;
  face.Loops = loops;
  return face;
}

double NormalLength(const Spline<2>& surface, const RealArray<2>& u)
{
  const BezierForm<2> form = MakeBezierForm<2>(surface, 1);
  PointMatrix at(1, 2);
  at << u[0], u[1];
  EvaluationBatch batch;
  EXPECT_TRUE(EvaluateParameters<2>(form, at, { 1, 1 }, batch));
  const Eigen::RowVector3d su = batch.First.row(0).head<3>();
  const Eigen::RowVector3d sv = batch.First.row(0).tail<3>();
  return su.cross(sv).norm();
}

/// The reached bound may be below the least value by the gap of a half.
void ExpectBoundOf(double bound, double least)
{
  EXPECT_LE(bound, least);
  EXPECT_GE(bound, 0.5 * least * (1.0 - 1e-9));
}

TEST(CertifyFace, Plane_ExactOracle)
{
  // (2 u + v, 3 v, u - v) has the normal (-3, 3, 6); parameters of any scale
  for (int n : { 1, 7 })
  {
    const Spline<2> plane = testing::PolynomialSurface(3,
      { Monomials{ { 0.0, 1.0 }, { 2.0 } }, Monomials{ { 0.0, 3.0 } },
        Monomials{ { 0.0, -1.0 }, { 1.0 } } },
      { 10.0, -5.0 }, { 10.01, 400.0 }, n);
    const FaceCertificate certificate = Certify(Face(plane));
    EXPECT_EQ(certificate.Verdict, Verdict::Valid);
    EXPECT_FALSE(certificate.HasWitness);
    EXPECT_EQ(certificate.NumPieces, n * n);
    ExpectBoundOf(certificate.MinNormal, std::sqrt(54.0));
  }
}

TEST(CertifyFace, ParaboloidOverRing_ExactOracle)
{
  // the least value on the ring is that of its inner circle, on the whole surface that of 0
  for (int n : { 1, 2, 5, 40 })
  {
    const Spline<2> surface = testing::Paraboloid({ -8.0, -8.0 }, { 8.0, 8.0 }, n);
    ExpectBoundOf(Certify(Face(surface)).MinNormal, 1.0);
    const FaceCertificate ring = Certify(Face(
      surface, { testing::CircleLoop(0.0, 0.0, 7.0), testing::CircleLoop(0.0, 0.0, 3.0, false) }));
    EXPECT_EQ(ring.Verdict, Verdict::Valid);
    ExpectBoundOf(ring.MinNormal, std::sqrt(1.0 + 4.0 * 9.0));
  }
}

TEST(CertifyFace, FoldOutsideTheRegion_ExactOracle)
{
  // ((u - 0.3)^2, v, 0) is folded along u = 0.3
  const auto fold = [](std::size_t plane, int n)
  {
    std::array<Monomials, 3> coordinates;
    coordinates[plane] = { { 2.5 } }; // in any coordinate plane, not through the origin
    coordinates[(plane + 1) % 3] = { { 0.09 }, { -0.6 }, { 1.0 } };
    coordinates[(plane + 2) % 3] = { { 0.0, 1.0 } };
    return testing::PolynomialSurface(2, coordinates, { -1.0, 0.0 }, { 1.0, 1.0 }, n);
  };
  for (std::size_t plane = 0; plane < 3; ++plane)
  {
    for (int n : { 1, 3, 16 })
    {
      const Spline<2> surface = fold(plane, n);
      const FaceCertificate whole = Certify(Face(surface));
      EXPECT_EQ(whole.Verdict, Verdict::Invalid) << plane << " " << n;
      ASSERT_TRUE(whole.HasWitness);
      EXPECT_LE(whole.MinNormal, 0.0);

      const auto right = testing::RectangleLoop(0.31, 0.9, 0.1, 0.9);
      const FaceCertificate trimmed = Certify(Face(surface, { right }));
      EXPECT_EQ(trimmed.Verdict, Verdict::Valid) << plane << " " << n;
      // pieces around the loop reach out by up to 2 / 2^8
      EXPECT_LE(trimmed.MinNormal, 0.02);
      EXPECT_GE(trimmed.MinNormal, 0.5 * (0.02 - 2.0 * 2.0 / 256));
      EXPECT_FALSE(trimmed.HasWitness);

      // on the other side the normal is the opposite one
      const FaceCertificate left =
        Certify(Face(surface, { testing::RectangleLoop(-0.9, 0.25, 0.1, 0.9) }));
      EXPECT_EQ(left.Verdict, Verdict::Valid) << plane << " " << n;
      ExpectBoundOf(left.MinNormal, 0.1);

      // across the fold: the witness lies in the region
      const FaceCertificate across = Certify(Face(surface, { testing::CircleLoop(0.4, 0.5, 0.3) }));
      EXPECT_EQ(across.Verdict, Verdict::Invalid) << plane << " " << n;
      ASSERT_TRUE(across.HasWitness);
      EXPECT_LT(std::hypot(across.Witness[0] - 0.4, across.Witness[1] - 0.5), 0.3);
    }
  }
}

TEST(CertifyFace, CollapsedSideOutsideTheRegion_ExactOracle)
{
  // (u v, v, v^2): the side v = 0 is a point
  const Spline<2> surface = testing::PolynomialSurface(2,
    { Monomials{ {}, { 0.0, 1.0 } }, Monomials{ { 0.0, 1.0 } }, Monomials{ { 0.0, 0.0, 1.0 } } },
    { 0.0, 0.0 }, { 1.0, 1.0 }, 1);
  const FaceCertificate whole = Certify(Face(surface));
  EXPECT_EQ(whole.Verdict, Verdict::Invalid);
  ASSERT_TRUE(whole.HasWitness);
  EXPECT_EQ(NormalLength(surface, whole.Witness), 0.0);
  const FaceCertificate trimmed =
    Certify(Face(surface, { testing::RectangleLoop(0.1, 0.9, 0.05, 0.95) }));
  EXPECT_EQ(trimmed.Verdict, Verdict::Valid);
  ExpectBoundOf(trimmed.MinNormal, 0.05 * std::sqrt(1.0 + 4.0 * 0.05 * 0.05));
}

TEST(CertifyFace, CuspInSpace_ExactOracle)
{
  // (u, v^2, v^3) has a cusp along v = 0, which no dyadic cut of [-1, 2] meets: not provable,
  // not valid either
  const Spline<2> surface = testing::PolynomialSurface(3,
    { Monomials{ {}, { 1.0 } }, Monomials{ { 0.0, 0.0, 1.0 } },
      Monomials{ { 0.0, 0.0, 0.0, 1.0 } } },
    { 0.0, -1.0 }, { 1.0, 2.0 }, 1);
  const FaceCertificate whole = Certify(Face(surface));
  EXPECT_EQ(whole.Verdict, Verdict::Undecided);
  EXPECT_TRUE(whole.HasWitness);
  EXPECT_LE(whole.MinNormal, 0.0);
  const FaceCertificate trimmed =
    Certify(Face(surface, { testing::RectangleLoop(0.1, 0.9, 0.1, 1.9) }));
  EXPECT_EQ(trimmed.Verdict, Verdict::Valid);
  ExpectBoundOf(trimmed.MinNormal, std::sqrt(4.0 * 0.01 + 9.0 * 1e-4));
  // a loop nearer to the cusp than the halvings separate
  EXPECT_EQ(
    Certify(Face(surface, { testing::RectangleLoop(0.1, 0.9, 0.1, 1.9) }), { 2, 0, {} }).Verdict,
    Verdict::Undecided);
}

TEST(CertifyFace, QuarterCylinder_CrossOracle)
{
  const Spline<2> surface = testing::QuarterCylinder();
  const auto least = [&](double u0, double u1)
  {
    double value = 1e300;
    for (int k = 0; k <= 1000; ++k)
    {
      value = std::min(value, NormalLength(surface, { u0 + (u1 - u0) * k / 1000, 0.5 }));
    }
    return value;
  };
  const FaceCertificate whole = Certify(Face(surface));
  EXPECT_EQ(whole.Verdict, Verdict::Valid);
  // rounding of the samples; the truth is at an end or in the middle, which are samples
  ExpectBoundOf(whole.MinNormal / (1.0 + 1e-12), least(0.0, 1.0));
  const FaceCertificate part =
    Certify(Face(surface, { testing::RectangleLoop(0.375, 0.625, 0.25, 0.75) }));
  EXPECT_EQ(part.Verdict, Verdict::Valid);
  ExpectBoundOf(part.MinNormal / (1.0 + 1e-12), least(0.375, 0.625));
}

TEST(CertifyFace, RandomSurfacesAndStars_PropertyOracle)
{
  oracle::Random random(5);
  int valid = 0;
  for (int run = 0; run < 30; ++run)
  {
    const int degree = random.Int(1, 4);
    Spline<2> surface =
      testing::Paraboloid({ 0.0, 0.0 }, { 1.0, 2.0 }, random.Int(1, 6), std::max(degree, 2));
    const double size = random.In(0.0, 0.12);
    for (Eigen::Index i = 0; i < surface.ControlPoints.size(); ++i)
    {
      surface.ControlPoints.data()[i] += random.In(-size, size);
    }
    if (run % 3 == 0)
    {
      surface.Weights.resize(surface.ControlPoints.rows());
      for (double& w : surface.Weights)
      {
        w = random.In(0.8, 1.25);
      }
    }
    const Polygon star = testing::StarPolygon(random, 12, 0.5, 1.0, 0.1, 0.45);
    const FaceCertificate certificate = Certify(Face(surface, { testing::PolygonLoop(star) }));
    if (certificate.Verdict != Verdict::Valid)
    {
      EXPECT_TRUE(certificate.HasWitness);
      continue;
    }
    ++valid;
    double least = 1e300;
    for (int k = 0; k < 2000; ++k)
    {
      const RealArray<2> u{ random.Unit(), 2.0 * random.Unit() };
      if (testing::IsInside(star, u))
      {
        least = std::min(least, NormalLength(surface, u));
      }
    }
    EXPECT_LE(certificate.MinNormal, least);
    EXPECT_GE(certificate.MinNormal, 0.35 * least); // samples miss the least value
  }
  EXPECT_GE(valid, 15);
}

TEST(CertifyFace, ThreadsDoNotMatter_PropertyOracle)
{
  oracle::Random random(6);
  Spline<2> surface = testing::Paraboloid({ 0.0, 0.0 }, { 1.0, 1.0 }, 30, 3);
  for (Eigen::Index i = 0; i < surface.ControlPoints.size(); ++i)
  {
    surface.ControlPoints.data()[i] += random.In(-0.01, 0.01);
  }
  const TrimmedFace face = Face(surface, { testing::CircleLoop(0.5, 0.5, 0.4) });
  const FaceCertificate one = Certify(face, { 8, 1, {} });
  for (int threads : { 0, 2, 3 })
  {
    const FaceCertificate other = Certify(face, { 8, threads, {} });
    EXPECT_EQ(other.Verdict, one.Verdict);
    EXPECT_EQ(other.MinNormal, one.MinNormal);
    EXPECT_EQ(other.NumPieces, one.NumPieces);
    EXPECT_EQ(other.Witness, one.Witness);
  }
}

TEST(CertifyFace, Errors_ExactOracle)
{
  const Spline<2> surface = testing::Paraboloid({ 0.0, 0.0 }, { 1.0, 1.0 }, 2);
  EXPECT_EQ(CertifyFace({}).Status.Code, ErrorCode::EmptyInput);
  TrimmedFace face = Face(surface);
  face.Surface.ControlPoints(1, 1) = std::nan("");
  EXPECT_EQ(CertifyFace(face).Status.Code, ErrorCode::NonFiniteInput);
  face = Face(surface);
  face.Surface.ControlPoints.conservativeResize(Eigen::NoChange, 2);
  EXPECT_EQ(CertifyFace(face).Status.Code, ErrorCode::DimensionMismatch);
  EXPECT_EQ(CertifyFace(Face(surface), { 21, 0, {} }).Status.Code, ErrorCode::InvalidParameter);
  EXPECT_EQ(CertifyFace(Face(surface), { -1, 0, {} }).Status.Code, ErrorCode::InvalidParameter);
  EXPECT_EQ(CertifyFace(Face(surface), { 8, -1, {} }).Status.Code, ErrorCode::InvalidParameter);
  EXPECT_EQ(CertifyFace(Face(surface), { 8, 0, [](double) { return false; } }).Status.Code,
    ErrorCode::Aborted);
  EXPECT_EQ(CertifyFace(Face(surface, { testing::RectangleLoop(2, 3, 2, 3) })).Status.Code,
    ErrorCode::EmptyInput);
  EXPECT_EQ(CertifyFace(Face(surface, { {} })).Status.Code, ErrorCode::EmptyInput);
  // near a singular side of the surface, but outside
  const Spline<2> cone = testing::PolynomialSurface(1,
    { Monomials{ {}, { 0.0, 1.0 } }, Monomials{ { 0.0, 1.0 } }, Monomials{ { 0.0, 1.0 } } },
    { 0.0, 0.0 }, { 1.0, 1.0 }, 1);
  EXPECT_EQ(CertifyFace(Face(cone, { testing::RectangleLoop(0.1, 0.9, -1.0, -0.01) })).Status.Code,
    ErrorCode::EmptyInput);
}

/// A chart over triangles in the plane with points x(u, v).
ChartMesh Chart(const std::vector<RealArray<2>>& uv, std::vector<std::array<int, 3>> triangles,
  const std::function<RealArray<3>(double, double)>& x)
{
  ChartMesh chart;
  const auto n = static_cast<Eigen::Index>(uv.size());
  chart.UV.resize(n, 2);
  chart.Points.resize(n, 3);
  for (Eigen::Index i = 0; i < n; ++i)
  {
    const RealArray<2>& u = uv[static_cast<std::size_t>(i)];
    const RealArray<3> point = x(u[0], u[1]);
    chart.UV.row(i) << u[0], u[1];
    chart.Points.row(i) << point[0], point[1], point[2];
  }
  chart.Triangles = std::move(triangles);
  return chart;
}

/// n x n cells of two triangles each over a rectangle, inner points moved about.
ChartMesh GridChart(int n, const RealArray<2>& lower, const RealArray<2>& upper, double jitter,
  const std::function<RealArray<3>(double, double)>& x)
{
  oracle::Random random(11);
  std::vector<RealArray<2>> uv;
  std::vector<std::array<int, 3>> triangles;
  for (int j = 0; j <= n; ++j)
  {
    for (int i = 0; i <= n; ++i)
    {
      const double a = i + (i > 0 && i < n ? random.In(-jitter, jitter) : 0.0);
      const double b = j + (j > 0 && j < n ? random.In(-jitter, jitter) : 0.0);
      uv.push_back(
        { lower[0] + (upper[0] - lower[0]) * a / n, lower[1] + (upper[1] - lower[1]) * b / n });
      if (i < n && j < n)
      {
        const int k = i + j * (n + 1);
        triangles.push_back({ k, k + 1, k + n + 2 });
        triangles.push_back({ k, k + n + 2, k + n + 1 });
      }
    }
  }
  return Chart(uv, std::move(triangles), x);
}

ChartDeviation Deviate(
  const ChartMesh& chart, const Spline<2>& surface, const DeviationParams& params = {})
{
  auto deviation = BoundDeviation(chart, surface, params);
  EXPECT_TRUE(deviation) << deviation.Status.Message();
  return deviation.Value;
}

/// Largest |S - X| of points of a triangle, corners and sides included.
double SampledDeviation(const ChartMesh& chart, std::size_t t, const Spline<2>& surface, int n)
{
  const BezierForm<2> form = MakeBezierForm<2>(surface, 1);
  PointMatrix weights((n + 1) * (n + 2) / 2, 3);
  Eigen::Index row = 0;
  for (int j = 0; j <= n; ++j)
  {
    for (int i = 0; i + j <= n; ++i)
    {
      weights.row(row++) << static_cast<double>(n - i - j) / n, static_cast<double>(i) / n,
        static_cast<double>(j) / n;
    }
  }
  PointMatrix uv(3, 2);
  PointMatrix points(3, 3);
  for (int c = 0; c < 3; ++c)
  {
    uv.row(c) = chart.UV.row(chart.Triangles[t][static_cast<std::size_t>(c)]);
    points.row(c) = chart.Points.row(chart.Triangles[t][static_cast<std::size_t>(c)]);
  }
  const PointMatrix at = weights * uv;
  EvaluationBatch batch;
  EXPECT_TRUE(EvaluateParameters<2>(form, at, { 0, 1 }, batch));
  return (batch.Values - weights * points).rowwise().norm().maxCoeff();
}

TEST(BoundDeviation, Plane_ExactOracle)
{
  const auto x = [](double u, double v) { return RealArray<3>{ 2.0 * u, v, u - v }; };
  const Spline<2> plane = testing::PolynomialSurface(3,
    { Monomials{ {}, { 2.0 } }, Monomials{ { 0.0, 1.0 } }, Monomials{ { 0.0, -1.0 }, { 1.0 } } },
    { -1.0, -1.0 }, { 1.0, 1.0 }, 9);
  const ChartMesh chart = GridChart(7, { -1.0, -1.0 }, { 1.0, 1.0 }, 0.3, x);
  const ChartDeviation deviation = Deviate(chart, plane);
  EXPECT_LT(deviation.MaxFound, 1e-15 * 4); // a few roundings of numbers up to 2
  EXPECT_LT(deviation.MaxBound, 1e-12);     // the honest allowance for rounding
  EXPECT_GE(deviation.MaxBound, deviation.MaxFound);
  // the normal (-1, 4, 2) / ... of two by two in the plane: |(2, 0, 1) x (0, 1, -1)| = 3
  EXPECT_NEAR(deviation.Area, 12.0, 1e-12);
  EXPECT_NEAR(deviation.MeshArea, 12.0, 1e-12);
  // a mesh that is moved away from the plane by the length 0.25
  ChartMesh moved = chart;
  moved.Points.col(1).array() += 0.25;
  const ChartDeviation away = Deviate(moved, plane);
  EXPECT_NEAR(away.MaxFound, 0.25, 1e-14);
  EXPECT_NEAR(away.Rms, 0.25, 1e-14);
  EXPECT_LT(away.TriangleBound.maxCoeff(), 0.25 + 1e-12);
  EXPECT_GE(away.TriangleBound.minCoeff(), 0.25);
  EXPECT_NEAR(away.PointDeviation.minCoeff(), 0.25, 1e-14);
}

TEST(BoundDeviation, ParaboloidAndOneTriangle_ExactOracle)
{
  // X - S over a triangle is the power of the point with respect to the circumcircle, upwards:
  // at most R^2 at the centre of an acute triangle, a quarter of the squared longest side else.
  const auto x = [](double u, double v) { return RealArray<3>{ u, v, u * u + v * v }; };
  oracle::Random random(21);
  for (int run = 0; run < 60; ++run)
  {
    const Spline<2> surface =
      testing::Paraboloid({ -1.0, -1.0 }, { 1.0, 1.0 }, random.Int(1, 12), random.Int(2, 5));
    const double size = std::pow(10.0, random.In(-3.0, 0.0));
    RealArray<2> corners[3];
    double twice = 0.0;
    while (twice < 0.1 * size * size)
    {
      for (auto& corner : corners)
      {
        corner = { size * random.In(-1.0, 1.0), size * random.In(-1.0, 1.0) };
      }
      twice = (corners[1][0] - corners[0][0]) * (corners[2][1] - corners[0][1]) -
        (corners[1][1] - corners[0][1]) * (corners[2][0] - corners[0][0]);
    }
    const ChartMesh chart = Chart({ corners[0], corners[1], corners[2] }, { { 0, 1, 2 } }, x);
    double squares[3];
    for (std::size_t k = 0; k < 3; ++k)
    {
      const RealArray<2>& a = corners[(k + 1) % 3];
      const RealArray<2>& b = corners[(k + 2) % 3];
      squares[k] = (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]);
    }
    std::sort(squares, squares + 3);
    const double largest = squares[2] >= squares[0] + squares[1]
      ? 0.25 * squares[2]
      : squares[0] * squares[1] * squares[2] / (4.0 * twice * twice);
    const ChartDeviation deviation = Deviate(chart, surface);
    EXPECT_GE(deviation.MaxBound, largest);
    EXPECT_LE(deviation.MaxBound, 1.05 * largest + 1e-12);
    EXPECT_LE(deviation.MaxFound, largest + 1e-13); // rounding of what is on the triangle
    EXPECT_GE(deviation.MaxFound, largest / 1.06);
    // mean of (sum_{i<j} l_i l_j d_ij)^2: the means of l_i^2 l_j^2 and l_i^2 l_j l_k are 1/90,
    // 1/180
    double mean = 0.0;
    for (int i = 0; i < 3; ++i)
    {
      for (int j = 0; j < 3; ++j)
      {
        mean += squares[i] * squares[j] / (i == j ? 90.0 : 180.0);
      }
    }
    EXPECT_NEAR(deviation.Rms, std::sqrt(mean), 1e-9 * largest + 1e-14);
  }
}

TEST(BoundDeviation, RandomSurfaces_CrossOracle)
{
  oracle::Random random(22);
  for (int run = 0; run < 12; ++run)
  {
    const bool rational = run % 3 == 2;
    const int degree = random.Int(1, rational ? 9 : 5);
    Spline<2> surface = random.Spline<2>({ KnotVector::Uniform(degree, random.Int(1, 5)),
                                           KnotVector::Uniform(degree, random.Int(1, 5)) },
      3, rational);
    const double scale = run % 2 == 0 ? 1.0 : 0.05; // mesh finer and coarser than the elements
    const ChartMesh chart = GridChart(4, { 0.5 - 0.5 * scale, 0.5 - 0.5 * scale },
      { 0.5 + 0.5 * scale, 0.5 + 0.5 * scale }, 0.3,
      [&](double u, double v)
      {
        const auto p = oracle::Evaluate<2>(surface, { u, v });
        return RealArray<3>{ p[0] + random.In(-0.01, 0.01) * scale, p[1], p[2] };
      });
    DeviationParams params;
    params.RelativeGap = 0.05;
    const ChartDeviation deviation = Deviate(chart, surface, params);
    for (std::size_t t = 0; t < chart.Triangles.size(); ++t)
    {
      const double sampled = SampledDeviation(chart, t, surface, 40);
      const double bound = deviation.TriangleBound[static_cast<Eigen::Index>(t)];
      ASSERT_LE(sampled, bound);
      // samples miss the largest value by a few percent at the most
      ASSERT_LE(bound, 1.05 * 1.06 * sampled + 1e-12) << run << " " << t;
    }
    EXPECT_LE(deviation.MaxFound, deviation.MaxBound);
    EXPECT_GE(deviation.MaxFound * 1.05 + 1e-12, deviation.MaxBound);
  }
}

TEST(BoundDeviation, QuarterCylinderArea_ExactOracle)
{
  const Spline<2> surface = testing::QuarterCylinder();
  const ChartMesh chart = GridChart(6, { 0.0, 0.0 }, { 1.0, 1.0 }, 0.3,
    [&](double u, double v)
    {
      const auto p = oracle::Evaluate<2>(surface, { u, v });
      return RealArray<3>{ p[0], p[1], p[2] };
    });
  const ChartDeviation deviation = Deviate(chart, surface);
  EXPECT_NEAR(deviation.Area, 3.0 * M_PI, 1e-6); // quadrature of degree 4 on sixths
  EXPECT_LT(deviation.MeshArea, deviation.Area);
  EXPECT_NEAR(deviation.MeshArea, 3.0 * M_PI, 0.05); // chords of a sixth of a quarter
  EXPECT_LT(deviation.PointDeviation.maxCoeff(), 1e-15 * 8);
  for (std::size_t t = 0; t < chart.Triangles.size(); ++t)
  {
    const double sampled = SampledDeviation(chart, t, surface, 40);
    ASSERT_LE(sampled, deviation.TriangleBound[static_cast<Eigen::Index>(t)]);
    ASSERT_LE(deviation.TriangleBound[static_cast<Eigen::Index>(t)], 1.08 * sampled);
  }
}

TEST(BoundDeviation, UnequalWeights_ExactOracle)
{
  // (u, v, 1 / w) with w = 1 - 2.5 u (1 - u) over the plane z = 0: at most 8 / 3, at u = 1/2; the
  // linear part of w knows nothing of that
  Spline<2> surface;
  surface.Space =
    MakeTensorSpace<2>({ KnotVector::Uniform(3, 1), KnotVector::Uniform(1, 1) }).Value;
  surface.ControlPoints.resize(8, 3);
  surface.ControlPoints << 0, 0, 1, 2, 0, 6, -1, 0, 6, 1, 0, 1, 0, 1, 1, 2, 1, 6, -1, 1, 6, 1, 1, 1;
  surface.Weights.resize(8);
  surface.Weights << 1, 1.0 / 6, 1.0 / 6, 1, 1, 1.0 / 6, 1.0 / 6, 1;
  const ChartMesh chart = Chart({ { 0.01, 0.0 }, { 1.0, 0.1 }, { 0.47, 0.99 } }, { { 0, 1, 2 } },
    [](double u, double v) {
      return RealArray<3>{ u, v, 0.0 };
    });
  const ChartDeviation deviation = Deviate(chart, surface);
  EXPECT_GE(deviation.MaxBound, 8.0 / 3.0);
  EXPECT_LE(deviation.MaxBound, 1.05 * 8.0 / 3.0 + 1e-12);
  EXPECT_LE(deviation.MaxFound, 8.0 / 3.0 + 1e-12);
}

TEST(BoundDeviation, CoarseTriangleOnFineNet_CrossOracle)
{
  // one triangle over some hundred elements, of a wave: quadrature has to follow the elements
  const int n = 24;
  Spline<2> surface = testing::Paraboloid({ 0.0, 0.0 }, { 1.0, 1.0 }, n, 3);
  for (int j = 0; j < n + 3; ++j)
  {
    for (int i = 0; i < n + 3; ++i)
    {
      surface.ControlPoints(i + j * (n + 3), 2) = 0.1 * std::sin(0.9 * i) * std::cos(0.7 * j);
    }
  }
  const ChartMesh chart = Chart({ { 0, 0 }, { 1, 0 }, { 0.2, 1 } }, { { 0, 1, 2 } },
    [](double u, double v) {
      return RealArray<3>{ u, v, 0.0 };
    });
  const ChartDeviation deviation = Deviate(chart, surface);
  EXPECT_GE(deviation.MaxBound, SampledDeviation(chart, 0, surface, 400));
  EXPECT_LE(deviation.MaxBound, 1.06 * SampledDeviation(chart, 0, surface, 400));
  // a midpoint sum over 600^2 cells of the triangle: its own error is far below a percent
  const BezierForm<2> form = MakeBezierForm<2>(surface, 1);
  double square = 0.0;
  double area = 0.0;
  int count = 0;
  PointMatrix at(600, 2);
  EvaluationBatch batch;
  for (int j = 0; j < 600; ++j)
  {
    const double v = (j + 0.5) / 600;
    for (int i = 0; i < 600; ++i)
    {
      at.row(i) << 0.2 * v + (i + 0.5) / 600 * (1.0 - v), v;
    }
    ASSERT_TRUE(EvaluateParameters<2>(form, at, { 1, 1 }, batch));
    for (int i = 0; i < 600; ++i, ++count)
    {
      const Eigen::RowVector3d x(at(i, 0), at(i, 1), 0.0);
      const Eigen::RowVector3d su = batch.First.row(i).head<3>();
      const Eigen::RowVector3d sv = batch.First.row(i).tail<3>();
      square += (1.0 - v) / 360000.0 * (batch.Values.row(i) - x).squaredNorm();
      area += (1.0 - v) / 360000.0 * su.cross(sv).norm();
    }
  }
  EXPECT_NEAR(deviation.Rms, std::sqrt(square / 0.5), 0.01 * deviation.Rms);
  EXPECT_NEAR(deviation.Area, area, 0.01 * area);
}

TEST(BoundDeviation, ThinTrianglesFarAway_PropertyOracle)
{
  // coordinates of 1e6 and triangles 1e4 times as long as wide: bounds stay bounds and near
  const double far = 1e6;
  const Spline<2> surface = testing::PolynomialSurface(2,
    { Monomials{ { far }, { 1.0 } }, Monomials{ { -far, 1.0 } },
      Monomials{ { 0.0, 0.0, 1.0 }, {}, { 1.0 } } },
    { -1.0, -1.0 }, { 1.0, 1.0 }, 3);
  const ChartMesh chart = Chart({ { -0.5, 0.0 }, { 0.5, 0.0 }, { 0.1, 1e-4 } }, { { 0, 1, 2 } },
    [&](double u, double v) {
      return RealArray<3>{ far + u, v - far, u * u + v * v };
    });
  const ChartDeviation deviation = Deviate(chart, surface);
  EXPECT_GE(deviation.MaxBound, 0.25);
  EXPECT_LE(deviation.MaxBound, 0.25 * 1.05 + 1e-4); // the area is known to about 1e-12 / 1e-4
}

TEST(BoundDeviation, EnoughIsEnough_PropertyOracle)
{
  const auto x = [](double u, double v) { return RealArray<3>{ u, v, u * u + v * v }; };
  const Spline<2> surface = testing::Paraboloid({ 0.0, 0.0 }, { 1.0, 1.0 }, 4);
  const ChartMesh chart = GridChart(20, { 0.0, 0.0 }, { 1.0, 1.0 }, 0.3, x);
  DeviationParams params;
  params.Enough = 0.01; // deviations are about 0.05^2 / 2
  const ChartDeviation loose = Deviate(chart, surface, params);
  const ChartDeviation tight = Deviate(chart, surface);
  EXPECT_LE(loose.MaxBound, 0.01);
  for (Eigen::Index t = 0; t < tight.TriangleBound.size(); ++t)
  {
    EXPECT_GE(loose.TriangleBound[t] * 1.05 + 1e-12, tight.TriangleBound[t]);
  }
  EXPECT_GT(loose.TriangleBound.sum(), 1.05 * tight.TriangleBound.sum());
}

TEST(BoundDeviation, ThreadsDoNotMatter_PropertyOracle)
{
  oracle::Random random(23);
  const auto x = [&](double u, double v) {
    return RealArray<3>{ u, v, u * u + v * v + random.In(-1e-3, 1e-3) };
  };
  const Spline<2> surface = testing::Paraboloid({ 0.0, 0.0 }, { 1.0, 1.0 }, 10, 3);
  const ChartMesh chart = GridChart(40, { 0.0, 0.0 }, { 1.0, 1.0 }, 0.3, x);
  DeviationParams params;
  params.Threads = 1;
  const ChartDeviation one = Deviate(chart, surface, params);
  for (int threads : { 0, 2, 3 })
  {
    params.Threads = threads;
    const ChartDeviation other = Deviate(chart, surface, params);
    EXPECT_EQ(other.TriangleBound, one.TriangleBound);
    EXPECT_EQ(other.PointDeviation, one.PointDeviation);
    EXPECT_EQ(other.Rms, one.Rms);
    EXPECT_EQ(other.Area, one.Area);
    EXPECT_EQ(other.MaxFound, one.MaxFound);
  }
}

TEST(BoundDeviation, Errors_ExactOracle)
{
  const auto x = [](double u, double v) { return RealArray<3>{ u, v, 0.0 }; };
  const Spline<2> surface = testing::Paraboloid({ 0.0, 0.0 }, { 1.0, 1.0 }, 2);
  const ChartMesh chart = GridChart(3, { 0.0, 0.0 }, { 1.0, 1.0 }, 0.0, x);
  const auto code = [](const auto& c, const auto& s, const DeviationParams& p = {})
  { return BoundDeviation(c, s, p).Status.Code; };
  EXPECT_EQ(code(chart, surface), ErrorCode::Ok);
  EXPECT_EQ(code(ChartMesh(), surface), ErrorCode::EmptyInput);
  EXPECT_EQ(code(chart, Spline<2>()), ErrorCode::EmptyInput);
  ChartMesh flipped = chart;
  std::swap(flipped.Triangles[3][0], flipped.Triangles[3][1]);
  EXPECT_EQ(code(flipped, surface), ErrorCode::InvalidTopology);
  ChartMesh outside = chart;
  outside.UV.col(0).array() += 0.5;
  EXPECT_EQ(code(outside, surface), ErrorCode::OutsideDomain);
  Spline<2> planar = surface;
  planar.ControlPoints.conservativeResize(Eigen::NoChange, 2);
  EXPECT_EQ(code(chart, planar), ErrorCode::DimensionMismatch);
  Spline<2> bad = surface;
  bad.ControlPoints(0, 0) = std::nan("");
  EXPECT_EQ(code(chart, bad), ErrorCode::NonFiniteInput);
  DeviationParams params;
  for (double gap : { 0.0, -1.0, 1.5, std::nan("") })
  {
    params.RelativeGap = gap;
    EXPECT_EQ(code(chart, surface, params), ErrorCode::InvalidParameter);
  }
  params = {};
  for (double enough : { -1.0, std::nan("") })
  {
    params.Enough = enough;
    EXPECT_EQ(code(chart, surface, params), ErrorCode::InvalidParameter);
  }
  params = {};
  params.Threads = -1;
  EXPECT_EQ(code(chart, surface, params), ErrorCode::InvalidParameter);
  params = {};
  params.Progress = [](double) { return false; };
  EXPECT_EQ(code(chart, surface, params), ErrorCode::Aborted);
}
}
}
