// SPDX-License-Identifier: BSD-3-Clause
#include <knotwork/SplineIO/BoundaryJson.h>

#include <gtest/gtest.h>

#include <string>

using namespace knotwork;

namespace
{
const std::string Arc = R"({"name": "x", "curves": [{"side": "west", "degree": 2,
  "knots": [0, 0, 0, 1, 1, 1], "weights": [1, 0.5, 1], "control_points": [[1, 0], [1, 0.1], [0, 1]]}]})";
const std::string Face = R"({"faces": [{"degrees": [1, 1], "knots": [[0, 0, 1, 1], [0, 0, 2, 2]],
  "weights": [1, 1, 1, 1], "control_points": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 5]]}]})";
}

TEST(BoundaryJson, HandWrittenSides_GoldenOracle)
{
  const auto curves = ReadBoundaryJson(Arc);
  ASSERT_TRUE(curves) << curves.Status.Message();
  ASSERT_EQ(curves->Splines.size(), 1u);
  const auto& arc = std::get<Spline<1>>(curves->Splines[0]);
  EXPECT_EQ(arc.Space->Knots[0].Knots(), (std::vector<double>{ 0, 0, 0, 1, 1, 1 }));
  EXPECT_EQ(arc.Weights(1), 0.5);
  EXPECT_EQ(arc.ControlPoints(1, 1), 0.1); // the double nearest to the text

  const auto faces = ReadBoundaryJson(Face);
  ASSERT_TRUE(faces) << faces.Status.Message();
  const auto& face = std::get<Spline<2>>(faces->Splines[0]);
  EXPECT_EQ(face.Space->Knots[1].End(), 2.0);
  EXPECT_FALSE(face.IsRational());          // weights that are all one
  EXPECT_EQ(face.ControlPoints(1, 0), 1.0); // the first direction is the fastest
  EXPECT_EQ(face.ControlPoints(3, 2), 5.0);
}

TEST(BoundaryJson, EveryTruncationIsOneError_PropertyOracle)
{
  for (const std::string& text : { Arc, Face })
  {
    for (std::size_t n = 0; n < text.size(); ++n)
    {
      const auto read = ReadBoundaryJson(std::string_view(text).substr(0, n));
      EXPECT_EQ(read.Status.Code, ErrorCode::InvalidFormat) << n;
    }
  }
}

TEST(BoundaryJson, ErrorsNameSideAndKey_ExactOracle)
{
  const auto expect = [](std::string text, const std::string& from, const std::string& to,
                        ErrorCode code, const std::string& words)
  {
    text.replace(text.find(from), from.size(), to);
    const auto read = ReadBoundaryJson(text);
    EXPECT_EQ(read.Status.Code, code) << to;
    EXPECT_NE(read.Status.Detail.find(words), std::string::npos) << read.Status.Detail;
  };
  expect(Arc, "\"degree\"", "\"power\"", ErrorCode::InvalidFormat, "side 0 ('west'): \"degree\"");
  expect(Arc, "2,", "1.5,", ErrorCode::InvalidFormat, "\"degree\"");
  expect(Arc, "2,", "1000000000000,", ErrorCode::InvalidDegree, "side 0 ('west')");
  expect(Arc, "[0, 0, 0, 1, 1, 1]", "[0, 0, 1, 0, 1, 1]", ErrorCode::InvalidKnots, "side 0");
  expect(Arc, "[0, 0, 0, 1, 1, 1]", "3", ErrorCode::InvalidFormat, "\"knots\"");
  expect(Arc, "0.5", "-0.5", ErrorCode::InvalidWeight, "side 0");
  expect(Arc, "0.5", "\"a\"", ErrorCode::InvalidFormat, "\"weights\"");
  expect(Arc, "[1, 0.1]", "[1]", ErrorCode::InvalidFormat, "point 1");
  expect(Arc, ", [0, 1]]", "]", ErrorCode::SizeMismatch, "side 0");
  expect(Face, "[1, 1]", "[1]", ErrorCode::InvalidFormat, "\"degrees\"");
  expect(Face, "faces", "sides", ErrorCode::InvalidFormat, "curves");
  // names from the file stay short and in one line
  expect(Arc, "\"west\", \"degree\"", "\"a\\u000ab\", \"power\"", ErrorCode::InvalidFormat,
    "side 0 ('a?b'): \"degree\"");
  EXPECT_EQ(ReadBoundaryJson(R"({"curves": []})").Status.Code, ErrorCode::EmptyInput);
  EXPECT_EQ(ReadBoundaryJson(std::string(200000, '[')).Status.Code, ErrorCode::InvalidFormat);
}

TEST(BoundaryJson, BeginningsAreKnown_ExactOracle)
{
  EXPECT_TRUE(LooksLikeBoundaryJson(" \n{\"curves\""));
  EXPECT_FALSE(LooksLikeBoundaryJson("<xml>"));
  EXPECT_FALSE(LooksLikeBoundaryJson(""));
}
