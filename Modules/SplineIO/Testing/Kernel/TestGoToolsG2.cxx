// SPDX-License-Identifier: BSD-3-Clause
#include "FileCases.h"
#include "TextWords.h"
#include <knotwork/SplineIO/GoToolsG2.h>

#include <clocale>
#include <limits>

using namespace knotwork;
using namespace knotwork::testing;

TEST(GoToolsG2, HandWrittenFile_GoldenOracle)
{
  const Result<SplineFile> file = ReadG2(HandWrittenG2);
  ASSERT_TRUE(file) << file.Status.Message();
  ASSERT_EQ(file->Splines.size(), 2u);
  EXPECT_EQ(file->Ids, (std::vector<int>{ 0, 1 }));
  const auto& arc = std::get<Spline<1>>(file->Splines[0]);
  EXPECT_EQ(arc.Space->Knots[0].Degree(), 2);
  EXPECT_EQ(arc.Space->Knots[0].Knots(), (std::vector<double>{ 0, 0, 0, 1, 1, 1 }));
  PointMatrix points(3, 3);
  points << 1, 0, 0, 1, 1, 0, 0, 1, 0; // rows divided by the weights 1, 1/2, 2
  EXPECT_EQ(arc.ControlPoints, points);
  EXPECT_EQ(arc.Weights, Eigen::Vector3d(1, 0.5, 2));

  const auto& surface = std::get<Spline<2>>(file->Splines[1]);
  EXPECT_EQ(surface.Space->Knots[0].Degree(), 1);
  EXPECT_EQ(surface.Space->Knots[1].Degree(), 1);
  EXPECT_EQ(surface.Space->Knots[1].Knots(), (std::vector<double>{ -1, -1, 0.5, 2, 2 }));
  PointMatrix net(6, 2); // u fastest
  net << 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12;
  EXPECT_EQ(surface.ControlPoints, net);
  EXPECT_FALSE(surface.IsRational());
}

TEST(GoToolsG2, WrittenFile_GoldenOracle)
{
  Spline<1> line;
  line.Space = MakeTensorSpace<1>({ KnotVector::Uniform(1, 1) }).Value;
  line.ControlPoints = PointMatrix(2, 2);
  line.ControlPoints << 0.1, -2.5, 1e50, 3;
  const Result<std::string> text = WriteG2({ line });
  ASSERT_TRUE(text) << text.Status.Message();
  EXPECT_EQ(text.Value, "100 1 0 0\n2 0\n2 2\n0 0 1 1\n0.1 -2.5\n1e+50 3\n\n");
}

TEST(GoToolsG2, ForeignRationalTextIsKeptAsItIs_ExactOracle)
{
  // 15 digits, as GoTools writes: products that were rounded before they were divided
  const std::string text = "100 1 0 0\n3 1\n3 3\n0 0 0 1 1 1\n1 0 0 1\n"
                           "0.707106781186548 0.235702260395516 0 0.707106781186548\n"
                           "0.123456789012345 0.333333333333333 1e-07 0.3\n\n";
  const Result<SplineFile> file = ReadG2(text);
  ASSERT_TRUE(file) << file.Status.Message();
  EXPECT_EQ(WriteG2(file->Splines).Value, text);
}

TEST(GoToolsG2, RoundTripsAreExact_PropertyOracle)
{
  for (unsigned seed = 1; seed <= 60; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const SplineFile file = RandomFile(seed, false);
    const Result<std::string> text = WriteG2(file.Splines);
    ASSERT_TRUE(text) << text.Status.Message();
    const Result<SplineFile> again = ReadG2(text.Value);
    ASSERT_TRUE(again) << again.Status.Message();
    ASSERT_TRUE(SameSplines(file.Splines, again->Splines));
    ASSERT_EQ(WriteG2(again->Splines).Value, text.Value);
  }
}

TEST(GoToolsG2, ExtremeNumbersComeBack_ExactOracle)
{
  using Limits = std::numeric_limits<double>;
  Spline<1> curve;
  curve.Space = MakeTensorSpace<1>({ KnotVector::Uniform(1, 5) }).Value;
  curve.ControlPoints = PointMatrix(6, 1);
  curve.ControlPoints << 1e60, -1e60, Limits::min(), Limits::denorm_min(), -0.0,
    1.0 + Limits::epsilon();
  for (double weight : { 0.0, 3.0, 1.0 / 3.0 })
  {
    curve.Weights = Eigen::VectorXd::Constant(weight > 0.0 ? 6 : 0, weight);
    const Result<SplineFile> again = ReadG2(WriteG2({ curve }).Value);
    ASSERT_TRUE(again) << again.Status.Message();
    const auto& read = std::get<Spline<1>>(again->Splines[0]);
    EXPECT_TRUE(SameSpline(curve, read)) << "weight " << weight;
    EXPECT_TRUE(std::signbit(read.ControlPoints(4, 0)));
  }
}

TEST(GoToolsG2, ProductsDivideIntoEveryDouble_PropertyOracle)
{
  Random random(7);
  for (int i = 0; i < 100000; ++i)
  {
    const double value = WildNumber(random, 30);
    const double weight = std::fabs(WildNumber(random, 6));
    std::string text;
    AppendProduct(text, value, weight);
    long double product = 0.0L;
    ASSERT_TRUE(ParseReal(text, product)) << text;
    ASSERT_EQ(Quotient(product, weight), value) << text << " / " << weight;
    const std::string mantissa = text.substr(0, text.find('e'));
    ASSERT_LE(mantissa.find_last_of("0123456789") + 1, 23u) << text; // -0.000 and 17 digits
  }
}

TEST(GoToolsG2, LocaleDoesNotMatter_PropertyOracle)
{
  const std::string before = std::setlocale(LC_ALL, nullptr);
  for (const char* locale : { "de_DE.UTF-8", "fr_FR.UTF-8", "C.UTF-8" }) // where installed
  {
    std::setlocale(LC_ALL, locale);
    const SplineFile file = RandomFile(3, false);
    const std::string text = WriteG2(file.Splines).Value;
    EXPECT_EQ(text.find(','), std::string::npos);
    EXPECT_TRUE(SameSplines(file.Splines, ReadG2(text)->Splines)) << locale;
  }
  std::setlocale(LC_ALL, before.c_str());
}

TEST(GoToolsG2, WhatTheFormatHasNotIsRefused_ExactOracle)
{
  EXPECT_EQ(WriteG2({}).Status.Code, ErrorCode::EmptyInput);
  EXPECT_EQ(ReadG2("").Status.Code, ErrorCode::EmptyInput);
  EXPECT_EQ(ReadG2(" \n\n").Status.Code, ErrorCode::EmptyInput);
  Random random(5);
  const auto space = RandomHierarchicalSpace<2>(random, 2, 3, 2);
  const auto result = WriteG2({ RandomSpline(random, space, 3, false) });
  EXPECT_EQ(result.Status.Code, ErrorCode::InvalidParameter);
  EXPECT_NE(result.Status.Detail.find("XML"), std::string::npos);
  auto broken = RandomSpline(random, RandomTensorSpace<1>(random, 2, 2), 3, false);
  broken.ControlPoints(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(WriteG2({ broken }).Status.Code, ErrorCode::NonFiniteInput);
}
