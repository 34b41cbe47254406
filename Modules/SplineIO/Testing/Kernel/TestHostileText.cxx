// SPDX-License-Identifier: BSD-3-Clause
// Text that is damaged or meant to do harm: one clear error, in bounded time and memory.
#include "FileCases.h"
#include <knotwork/SplineIO/GismoXml.h>
#include <knotwork/SplineIO/GoToolsG2.h>

#include <chrono>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
using Reader = Result<SplineFile> (*)(std::string_view);

struct HostileCase
{
  const char* Name;
  Reader Read;
  std::string Text;
  ErrorCode Code;
  std::vector<std::string> Words; ///< that the message must have
};

/// The text with one part replaced.
std::string With(std::string text, const std::string& part, const std::string& replacement)
{
  const std::size_t at = text.find(part);
  EXPECT_NE(at, std::string::npos) << part;
  return at == std::string::npos ? text : text.replace(at, part.size(), replacement);
}

std::string Repeated(const std::string& part, int times)
{
  std::string text;
  for (int i = 0; i < times; ++i)
  {
    text += part;
  }
  return text;
}

std::vector<HostileCase> G2Cases()
{
  const std::string& good = HandWrittenG2;
  const auto format = ErrorCode::InvalidFormat;
  return {
    { "NotG2", ReadG2, "hello world", format, { "line 1", "word 1", "'hello'" } },
    { "Binary", ReadG2,
      std::string("\x7f"
                  "ELF\0\1\2\3",
        8),
      format, { "line 1" } },
    { "OtherClass", ReadG2, "290 1 0 0\n", format, { "290", "Torus", "100" } },
    { "UnknownClass", ReadG2, "42 1 0 0\n", format,
      { "42", "point clouds (400) and volumes (700)" } },
    { "NegativeClass", ReadG2, "-1 1 0 0\n", format, { "'-1'" } },
    { "HugeAuxiliary", ReadG2, "100 1 0 1000000000\n 1 2 3", format, { "truncated" } },
    { "HugeFunctions", ReadG2, "100 1 0 0 3 0 1000000000000000000 4 0 0", format,
      { "word 7", "1000000000000000000" } },
    { "ManyFunctions", ReadG2, "100 1 0 0 3 0 2000000000 4 0 0", format, { "truncated" } },
    { "HugeProduct", ReadG2,
      "700 1 0 0 3 0\n" +
        Repeated(
          "1000 2\n0 " +
            []
            {
              std::string knots;
              for (int i = 0; i <= 1000; ++i)
              {
                knots += std::to_string(i) + " ";
              }
              return knots + "\n";
            }(),
          3),
      format, { "too short" } },
    { "HugeDimension", ReadG2, With(good, "3 1\n", "999999999 1\n"), format, { "line 2", "64" } },
    { "NegativeDimension", ReadG2, With(good, "3 1\n", "-3 1\n"), format, { "line 2", "'-3'" } },
    { "RationalFlag", ReadG2, With(good, "3 1\n", "3 7\n"), format, { "rational" } },
    { "OrderOne", ReadG2, With(good, "3 3\n", "3 1\n"), ErrorCode::InvalidDegree, { "line 3" } },
    { "NegativeOrder", ReadG2, With(good, "3 3\n", "3 -3\n"), ErrorCode::InvalidDegree,
      { "line 3", "'-3'" } },
    { "HighOrder", ReadG2, With(good, "3 3\n", "30 11\n"), ErrorCode::InvalidDegree, { "11" } },
    { "FewFunctions", ReadG2, With(good, "3 3\n", "2 3\n"), format, { "as many as the order" } },
    { "DecreasingKnots", ReadG2, With(good, "0 0 0 1 1 1", "0 0 1 0 1 1"), ErrorCode::InvalidKnots,
      { "line 4" } },
    { "EqualKnots", ReadG2, With(good, "0 0 0 1 1 1", "1 1 1 1 1 1"), ErrorCode::InvalidKnots,
      { "line 4" } },
    { "NaN", ReadG2, With(good, "1 0 0 1\n", "1 nan 0 1\n"), ErrorCode::NonFiniteInput,
      { "line 5", "'nan'" } },
    { "Infinity", ReadG2, With(good, "1 0 0 1\n", "1 0 0 inf\n"), ErrorCode::NonFiniteInput,
      { "line 5", "'inf'" } },
    { "OutOfRange", ReadG2, With(good, "2e0", "2e999"), format, { "'2e999'" } },
    { "Letters", ReadG2, With(good, "0.5 0.5 0 0.5", "N10 0.5 0 0.5"), format, { "'N10'" } },
    { "NaNAtTheEnd", ReadG2, "100 1 0 0 1 1 2 2 0 0 1 1 0 1 0 nan", ErrorCode::NonFiniteInput,
      { "word 16" } },
    { "Comma", ReadG2, With(good, "0.5 0.5 0 0.5", "0,5 0,5 0 0,5"), format, { "'0,5'" } },
    { "WrongToken", ReadG2, With(good, "0.5 0.5 0 0.5", "0.5 0.5 zero 0.5"), format,
      { "line 6", "'zero'" } },
    { "ZeroWeight", ReadG2, With(good, "0.5 0.5 0 0.5", "0.5 0.5 0 0"), ErrorCode::InvalidWeight,
      { "line 6" } },
    { "NegativeWeight", ReadG2, With(good, "0.5 0.5 0 0.5", "0.5 0.5 0 -1"),
      ErrorCode::InvalidWeight, { "line 6" } },
    { "TinyWeight", ReadG2, With(good, "0 2 0 2", "0 1e300 0 1e-300"), ErrorCode::NonFiniteInput,
      { "line 7" } },
    { "TooLarge", ReadG2, With(good, "5 6 7 8", "5 6 7e60 8"), ErrorCode::TooLarge, { "1e+60" } },
    { "Surplus", ReadG2, good + "13 14\n", format, { "13", "classes" } },
  };
}

std::vector<HostileCase> XmlCases()
{
  const std::string& good = HandWrittenXml;
  const auto format = ErrorCode::InvalidFormat;
  const std::string knots = "<KnotVector degree=\"1\">0 0 1 1 </KnotVector>";
  const std::string thb = "<box level=\"1\">0 0 2 2</box>";
  const std::string points = "1 0 2 0 1 1 2 1";
  return {
    { "Empty", ReadGismoXml, "", ErrorCode::EmptyInput, {} },
    { "NotXml", ReadGismoXml, "hello world", format, { "line 1" } },
    { "OtherXml", ReadGismoXml, "<VTKFile type=\"X\"></VTKFile>", format,
      { "<VTKFile>", "<xml>" } },
    { "NoGeometry", ReadGismoXml, "<xml><Function/></xml>", ErrorCode::EmptyInput, { "Geometry" } },
    { "OnlyOthers", ReadGismoXml, "<xml><Geometry type=\"Mesh\"/></xml>", ErrorCode::EmptyInput,
      { "'Mesh'", "THBSpline" } },
    { "Nesting", ReadGismoXml, "<xml>" + Repeated("<a>", 1000000) + Repeated("</a>", 1000000),
      format, { "well-formed" } },
    { "ClosedNesting", ReadGismoXml,
      "<xml>" + Repeated("<Basis>", 300000) + Repeated("</Basis>", 300000) + "</xml>",
      ErrorCode::EmptyInput, {} },
    { "NestedBases", ReadGismoXml,
      "<xml><Geometry type=\"TensorBSpline2\">" + Repeated("<Basis>", 100000) +
        Repeated("</Basis>", 100000) + "<coefs geoDim=\"2\">1 2</coefs></Geometry></xml>",
      format, { "<Basis>" } },
    { "Entities", ReadGismoXml,
      "<!DOCTYPE x [<!ENTITY a \"aaaa\"><!ENTITY b \"&a;&a;\">]><xml><Geometry type=\"BSpline\">"
      "<Basis><KnotVector degree=\"1\">&b;</KnotVector></Basis><coefs geoDim=\"1\">1 "
      "2</coefs></Geometry></xml>",
      format, { "'&b;'" } },
    { "NoBasis", ReadGismoXml, "<xml>\n<Geometry type=\"BSpline\"/></xml>", format,
      { "line 2", "<Basis>" } },
    { "NoCoefficients", ReadGismoXml,
      "<xml><Geometry type=\"BSpline\"><Basis>" + knots + "</Basis></Geometry></xml>", format,
      { "<coefs>" } },
    { "NoKnots", ReadGismoXml, With(good, knots, ""), format, { "line 6", "<KnotVector>" } },
    { "OneBasis", ReadGismoXml,
      With(good, "<Basis type=\"BSplineBasis\" index=\"1\">" + knots + "</Basis>", ""), format,
      { "line 5", "1 elements <Basis>", "2 parameters" } },
    { "NegativeDegree", ReadGismoXml, With(good, "degree=\"1\"", "degree=\"-1\""),
      ErrorCode::InvalidDegree, { "line 6", "<KnotVector>", "'-1'" } },
    { "HighDegree", ReadGismoXml, With(good, "degree=\"1\"", "degree=\"10\""),
      ErrorCode::InvalidDegree, { "line 6", "'10'" } },
    { "NoDegree", ReadGismoXml, With(good, "degree=\"1\"", ""), format, { "line 6", "degree" } },
    { "WordAsDegree", ReadGismoXml, With(good, "degree=\"1\"", "degree=\"one\""),
      ErrorCode::InvalidDegree, { "'one'" } },
    { "FewKnots", ReadGismoXml, With(good, ">0 0 1 1 <", ">0 0 1<"), ErrorCode::InvalidKnots,
      { "line 6" } },
    { "NaNKnot", ReadGismoXml, With(good, ">0 0 1 1 <", ">0 0 nan 1<"), ErrorCode::NonFiniteInput,
      { "line 6", "number 3", "'nan'" } },
    { "ElementInNumbers", ReadGismoXml, With(good, ">0 0 1 1 <", ">0 <b/> 1 1<"), format,
      { "<b>" } },
    { "Periodic", ReadGismoXml, With(good, "index=\"0\"", "index=\"0\" periodic=\"1\""), format,
      { "periodic" } },
    { "BinaryData", ReadGismoXml, With(good, "geoDim=\"2\"", "geoDim=\"2\" format=\"B64Float64\""),
      format, { "'B64Float64'", "ASCII" } },
    { "NoGeoDim", ReadGismoXml, With(good, "geoDim=\"2\"", ""), format, { "geoDim" } },
    { "HugeGeoDim", ReadGismoXml, With(good, "geoDim=\"2\"", "geoDim=\"1000000000000000000\""),
      format, { "geoDim", "64" } },
    { "ZeroGeoDim", ReadGismoXml, With(good, "geoDim=\"2\"", "geoDim=\"0\""), format,
      { "geoDim" } },
    { "WrongGeoDim", ReadGismoXml, With(good, "geoDim=\"2\"", "geoDim=\"3\""),
      ErrorCode::SizeMismatch, { "8 numbers", "4 functions", "3 coordinates" } },
    { "MissingNumber", ReadGismoXml, With(good, points, "1 0 2 0 1 1 2"), ErrorCode::SizeMismatch,
      { "line 19", "7 numbers" } },
    { "SurplusNumber", ReadGismoXml, With(good, points, points + " 5"), ErrorCode::SizeMismatch,
      { "9 numbers" } },
    { "WrongToken", ReadGismoXml, With(good, "\n0 1 <!--", "\n0 x <!--"), format,
      { "line 11", "<coefs>", "number 6", "'x'" } },
    { "TooLarge", ReadGismoXml, With(good, "\n0 1 <!--", "\n0 1e61 <!--"), ErrorCode::TooLarge,
      { "line 4", "1e+60" } },
    { "NoWeights", ReadGismoXml, With(good, "<weights>1 0.5 2</weights>", ""), format,
      { "<weights>" } },
    { "FewWeights", ReadGismoXml, With(good, "1 0.5 2<", "1 0.5<"), ErrorCode::SizeMismatch,
      { "2 weights for 3" } },
    { "NegativeWeight", ReadGismoXml, With(good, "1 0.5 2<", "1 -0.5 2<"), ErrorCode::InvalidWeight,
      { "<weights>", "number 2" } },
    { "SameIds", ReadGismoXml, With(good, "id=\"7\"", "id=\"4\""), format, { "id 4" } },
    { "WordAsId", ReadGismoXml, With(good, "id=\"7\"", "id=\"seven\""), format, { "'seven'" } },
    { "BoxOfThree", ReadGismoXml, With(good, thb, "<box level=\"1\">0 0 2</box>"), format,
      { "3 numbers", "4" } },
    { "BoxWithoutLevel", ReadGismoXml, With(good, thb, "<box>0 0 2 2</box>"), format, { "level" } },
    { "NegativeBox", ReadGismoXml, With(good, thb, "<box level=\"1\">-1 0 2 2</box>"), format,
      { "'-1'" } },
    { "BoxOutside", ReadGismoXml, With(good, thb, "<box level=\"1\">0 0 2 3</box>"),
      ErrorCode::InvalidTopology, { "0 0 2 3", "level 1" } },
    { "DeepLevel", ReadGismoXml, With(good, thb, "<box level=\"25\">0 0 2 2</box>"),
      ErrorCode::InvalidTopology, { "level 25" } },
    { "HugeLevel", ReadGismoXml,
      With(good, thb, "<box level=\"1000000000000000000\">0 0 2 2</box>"),
      ErrorCode::InvalidTopology, { "level" } },
    { "HugeBox", ReadGismoXml, With(good, thb, "<box level=\"24\">0 0 33554432 16777216</box>"),
      ErrorCode::TooLarge, { "more cells" } },
    { "ThinBox", ReadGismoXml, With(good, thb, "<box level=\"24\">0 0 33554432 2</box>"),
      ErrorCode::TooLarge, { "more cells" } },
    { "ReversedBox", ReadGismoXml, With(good, thb, "<box level=\"1\">2 0 0 2</box>"),
      ErrorCode::InvalidTopology, { "2 0 0 2" } },
    { "HugeLevelZero", ReadGismoXml,
      []
      {
        std::string line;
        for (int i = 0; i <= 5000; ++i)
        {
          line += std::to_string(i) + " ";
        }
        const std::string basis =
          "<Basis><KnotVector degree=\"1\">" + line + "</KnotVector></Basis>";
        return "<xml><Geometry type=\"THBSpline3\"><Basis><Basis>" + basis + basis + basis +
          "</Basis></Basis><coefs geoDim=\"1\">1 2 3</coefs></Geometry></xml>";
      }(),
      ErrorCode::TooLarge, { "more cells" } },
    { "HugeRange", ReadGismoXml,
      With(good, "<patches type=\"id_index\">4 7<", "<patches type=\"id_range\">0 2147483647<"),
      format, { "<patches>", "range" } },
    { "UnknownPatch", ReadGismoXml, With(good, ">4 7<", ">4 8<"), format, { "id 8" } },
    { "PatchOfOtherDimension", ReadGismoXml, With(good, ">4 7<", ">4 0<"), format, { "id 0" } },
    { "PatchTwice", ReadGismoXml, With(good, ">4 7<", ">4 4<"), format, { "twice" } },
    { "HugeDimension", ReadGismoXml, With(good, "parDim=\"2\"", "parDim=\"2147483647\""), format,
      { "id 4" } },
    { "ShortInterface", ReadGismoXml, With(good, "4 2 7 1 0 1 1 1", "4 2 7 1 0 1 1"), format,
      { "<interfaces>", "7 numbers" } },
    { "SideFive", ReadGismoXml, With(good, "4 2 7 1 0 1 1 1", "4 5 7 1 0 1 1 1"), format,
      { "side 5" } },
    { "BadDirections", ReadGismoXml, With(good, "4 2 7 1 0 1 1 1", "4 2 7 1 1 1 1 1"), format,
      { "interface 0", "permutation" } },
    { "OddBoundary", ReadGismoXml, With(good, "<boundary>4 1", "<boundary>4 1 4"), format,
      { "<boundary>", "13 numbers" } },
  };
}

void ExpectRefused(const HostileCase& hostile)
{
  SCOPED_TRACE(hostile.Name);
  const auto begin = std::chrono::steady_clock::now();
  // a copy of exactly this length, so that a checker of memory sees every step too far
  const std::vector<char> exact(hostile.Text.begin(), hostile.Text.end());
  const Result<SplineFile> file = hostile.Read({ exact.data(), exact.size() });
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  EXPECT_EQ(file.Status.Code, hostile.Code) << file.Status.Message();
  EXPECT_TRUE(file->Splines.empty());
  EXPECT_EQ(file.Status.Detail.find('\n'), std::string::npos) << file.Status.Detail;
  EXPECT_LT(file.Status.Detail.size(), 300u) << file.Status.Detail;
  EXPECT_GT(file.Status.Detail.size(), 15u) << file.Status.Detail;
  for (const std::string& word : hostile.Words)
  {
    EXPECT_NE(file.Status.Detail.find(word), std::string::npos)
      << "'" << word << "' in: " << file.Status.Detail;
  }
  EXPECT_LT(seconds.count(), 5.0); // some need milliseconds; an attack would need hours
}
}

TEST(HostileText, G2IsRefusedWithOneClearError_ExactOracle)
{
  for (const HostileCase& hostile : G2Cases())
  {
    ExpectRefused(hostile);
  }
}

TEST(HostileText, XmlIsRefusedWithOneClearError_ExactOracle)
{
  for (const HostileCase& hostile : XmlCases())
  {
    ExpectRefused(hostile);
  }
}

TEST(HostileText, TruncationAtEveryByteIsErrorOrSuccess_PropertyOracle)
{
  for (const auto& [text, read] : { std::pair<std::string, Reader>{ HandWrittenG2, ReadG2 },
         std::pair<std::string, Reader>{ HandWrittenXml, ReadGismoXml } })
  {
    int successes = 0;
    for (std::size_t length = 0; length < text.size(); ++length)
    {
      // a copy of exactly this length, so that a checker of memory sees every step too far
      const std::vector<char> part(
        text.begin(), text.begin() + static_cast<std::ptrdiff_t>(length));
      const Result<SplineFile> file = read({ part.data(), part.size() });
      successes += file ? 1 : 0;
      EXPECT_TRUE(file || !file.Status.Detail.empty()) << "length " << length;
    }
    // g2: after the first object, with less of the last number, without the last line break
    EXPECT_LE(successes, 8);
  }
}

TEST(HostileText, ChangesOfSingleBytesAreErrorOrSuccess_PropertyOracle)
{
  Random random(11);
  const std::string alphabet = std::string("0123456789.-+eE \n<>/\"=&x", 24) + '\0' + '\xff';
  for (const auto& [good, read] : { std::pair<std::string, Reader>{ HandWrittenG2, ReadG2 },
         std::pair<std::string, Reader>{ HandWrittenXml, ReadGismoXml } })
  {
    for (int i = 0; i < 20000; ++i)
    {
      std::string text = good;
      for (int change = random.Int(1, 3); change > 0; --change)
      {
        text[static_cast<std::size_t>(random.Int(0, static_cast<int>(text.size()) - 1))] =
          alphabet[static_cast<std::size_t>(random.Int(0, static_cast<int>(alphabet.size()) - 1))];
      }
      const Result<SplineFile> file = read(text);
      ASSERT_EQ(file.Status.Code == ErrorCode::Ok, !file->Splines.empty()) << text;
    }
  }
}
