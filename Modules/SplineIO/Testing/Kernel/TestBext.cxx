// SPDX-License-Identifier: BSD-3-Clause
// Files of Bezier extraction operators, text and JSON.
#include "FamilyCases.h"
#include "FileCases.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/ExplicitSpace.h>
#include <knotwork/SplineCore/SpaceFamily.h>
#include <knotwork/SplineIO/BextFile.h>

#include <clocale>
#include <sstream>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
/// Two elements of degrees 2 and 1, C^1 across their common side, that map element and place (s, t)
/// to (element + s, t, (element + s) t).
const std::string HandWritten = TextOfData("by_hand.bext");
const std::string HandWrittenJson = TextOfData("by_hand_bext.json");

/// The parabolas of the knots 0 0 0 1 2 2 2, the second element's by sparse vectors.
const std::string Sparse = "B E X T 2.0\n1 4 2 6 0\n0 0 0 1\n.5 0 0 1\n1.5 0 0 1\n2 0 0 1\n1\n"
                           "1 2 3 3 2\n1 2 3\n1 2 3\n2 3 4\n4 6 5\n1 2\n3 3\n2 1\n1 2\n"
                           "1 0 0\n0 1 .5\n0 0 .5\n1\n.5\n3\n1\n2 1\n1 .5\n";

/// A title 2.1 leaves patch and sparse blocks out, and has the elements' boxes.
const std::string Transform =
  "BASIS TRANSFORM 2.1 THB\n4 2 6 0\n0. 0. 0. 1.\n.5 0. 0. 1.\n1.5 0. 0. 1.\n2. 0. 0. 1.\n1\n"
  "1 2 3 3 2\n$ el_id: 0\n0.0 1.0\n1 2 3\n1 2 3\n$ el_id: 1\n1.0 2.0\n2 3 4\n4 5 6\n1\n6 3\n"
  "1. 0. 0.\n0. 1. .5\n0. 0. .5\n.5 0. 0.\n.5 1. 0.\n0. 0. 1.\n";

template <int Dim>
PointMatrix Values(const Spline<Dim>& spline, unsigned seed)
{
  Random random(seed);
  std::vector<int> elements;
  PointMatrix local(200, Dim);
  for (Eigen::Index i = 0; i < local.rows(); ++i)
  {
    elements.push_back(random.Int(0, spline.Space->NumElements() - 1));
    for (int d = 0; d < Dim; ++d)
    {
      local(i, d) = random.Unit();
    }
  }
  EvaluationBatch batch;
  EXPECT_TRUE(EvaluateElements<Dim>(MakeBezierForm(spline), elements, local, {}, batch));
  return batch.Values;
}

/// The same numbers: control points, weights, ids and coefficients.
template <int Dim>
void ExpectSameNumbers(const Spline<Dim>& a, const AnySpline& any)
{
  ASSERT_EQ(any.index() + 1, static_cast<std::size_t>(Dim));
  const auto& b = std::get<Spline<Dim>>(any);
  EXPECT_EQ(b.Space->Kind, SpaceKind::Explicit);
  EXPECT_EQ(a.ControlPoints, b.ControlPoints);
  EXPECT_EQ(a.Weights, b.Weights);
  EXPECT_TRUE(ExtractionOf(*a.Space) == ExtractionOf(*b.Space));
}

template <int Dim>
void CheckRoundTrips(unsigned seed)
{
  Random random(seed);
  for (const SplineSpacePtr<Dim>& space : SpacesOfAllFamilies<Dim>(random))
  {
    SCOPED_TRACE(FamilyOf(*space).Name());
    SplineFile file;
    const Spline<Dim> spline = RandomSpline<Dim>(random, space, 3, random.Int(0, 1) > 0);
    file.Splines = { spline };
    file.Ids = { random.Int(0, 99999999) };
    const Result<std::string> text = WriteBext(file);
    const Result<std::string> json = WriteBextJson(file);
    ASSERT_TRUE(text) << text.Status.Message();
    ASSERT_TRUE(json) << json.Status.Message();
    const Result<SplineFile> ofText = ReadBext(text.Value);
    const Result<SplineFile> ofJson = ReadBext(json.Value);
    ASSERT_TRUE(ofText) << ofText.Status.Message();
    ASSERT_TRUE(ofJson) << ofJson.Status.Message();
    ExpectSameNumbers(spline, ofText->Splines.front());
    ExpectSameNumbers(spline, ofJson->Splines.front());
    EXPECT_EQ(ofText->Ids, file.Ids);
    EXPECT_EQ(ofJson->Ids, file.Ids);
    EXPECT_TRUE(SameSplines(ofText->Splines, ofJson->Splines));
    EXPECT_EQ(WriteBext(ofJson.Value).Value, text.Value); // also from one form to the other
    EXPECT_EQ(WriteBext(ofText.Value).Value, text.Value);
    // 1e-13 of the size 10, quotients by weights above 0.5
    const auto& again = std::get<Spline<Dim>>(ofText->Splines.front());
    EXPECT_LE((Values(spline, seed) - Values(again, seed)).cwiseAbs().maxCoeff(), 2e-12);
  }
}

/// Places of the numbers between two parts of a text.
std::vector<std::size_t> NumbersBetween(
  const std::string& text, const std::string& from, const std::string& to)
{
  std::vector<std::size_t> places;
  const std::string digits = "0123456789.E+-";
  const std::size_t end = text.find(to, text.find(from));
  for (std::size_t at = text.find(from) + from.size(); at < std::min(end, text.size());)
  {
    const std::size_t begin = text.find_first_of("0123456789", at);
    if (begin >= end)
    {
      break;
    }
    places.push_back(begin);
    at = text.find_first_not_of(digits, begin);
  }
  return places;
}

std::string WithNumber(const std::string& text, std::size_t at, const std::string& number)
{
  const std::size_t end = text.find_first_not_of("0123456789.E+-", at);
  return text.substr(0, at) + number + text.substr(end);
}

struct BadCase
{
  const char* Name;
  std::string Text;
  ErrorCode Code;
  std::vector<std::string> Words;
};

std::string With(std::string text, const std::string& part, const std::string& replacement)
{
  const std::size_t at = text.find(part);
  EXPECT_NE(at, std::string::npos) << part;
  return at == std::string::npos ? text : text.replace(at, part.size(), replacement);
}

void ExpectAllRefused(const std::vector<BadCase>& cases)
{
  for (const BadCase& bad : cases)
  {
    const Result<SplineFile> file = ReadBext(bad.Text);
    EXPECT_EQ(file.Status.Code, bad.Code) << bad.Name << ": " << file.Status.Message();
    for (const std::string& word : bad.Words)
    {
      EXPECT_NE(file.Status.Detail.find(word), std::string::npos)
        << bad.Name << ": " << file.Status.Message();
    }
  }
}
}

TEST(Bext, HandWrittenFiles_GoldenOracle)
{
  for (const std::string* text : { &HandWritten, &HandWrittenJson })
  {
    const Result<SplineFile> file = ReadBext(*text);
    ASSERT_TRUE(file) << file.Status.Message();
    ASSERT_EQ(file->Splines.size(), 1U);
    EXPECT_EQ(file->Ids, (std::vector<int>{ 7 }));
    EXPECT_TRUE(file->Warnings.empty());
    const auto& spline = std::get<Spline<2>>(file->Splines.front());
    EXPECT_EQ(spline.Space->NumElements(), 2);
    EXPECT_EQ(spline.Space->NumFunctions, 8);
    EXPECT_FALSE(spline.IsRational());
    EXPECT_EQ(spline.Space->Extraction->Functions,
      (std::vector<int>{ 0, 1, 2, 4, 5, 6, 1, 2, 3, 5, 6, 7 }));
    EvaluationBatch batch;
    PointMatrix local(3, 2);
    local << 0.25, 0.5, 0.5, 0.25, 1.0, 1.0;
    ASSERT_TRUE(EvaluateElements<2>(MakeBezierForm(spline), { 0, 1, 1 }, local, {}, batch));
    PointMatrix expected(3, 3);
    expected << 0.25, 0.5, 0.125, 1.5, 0.25, 0.375, 2.0, 1.0, 2.0;
    EXPECT_LE((batch.Values - expected).cwiseAbs().maxCoeff(), 1e-15); // a few roundings
  }
  EXPECT_EQ(
    WriteBext(ReadBext(HandWritten).Value).Value, WriteBext(ReadBext(HandWrittenJson).Value).Value);
}

/// What is written is the file that was written by hand, but for its comments.
TEST(Bext, WrittenText_GoldenOracle)
{
  std::istringstream lines(HandWritten);
  std::string expected;
  for (std::string line; std::getline(lines, line);)
  {
    expected += line.empty() || line[0] == '$' ? "" : line + "\n";
  }
  EXPECT_EQ(WriteBext(ReadBext(HandWritten).Value).Value, expected);
}

TEST(Bext, WrittenJson_GoldenOracle)
{
  const Result<std::string> text = WriteBextJson(ReadBext(Sparse).Value);
  ASSERT_TRUE(text) << text.Status.Message();
  EXPECT_EQ(text.Value,
    R"({"dim":1,"is_rational":false,"patch_id":1,"num_nodes":4,"num_vertices":3,"num_elems":2,)"
    R"("num_coeff_vecs":6,"block_elem_map":[{"block_name":"patch 1","block_id":1,"elem_ids":[0,1]}],)"
    R"("elements":{"element_block_info":[{"num_elems":2,"deg_s":2,"deg_t":-1,"deg_u":-1}],)"
    R"("element_blocks":[{"us_cid":0,"node_ids":[0,1,2],"coeff_vector_ids":[0,1,2]},)"
    R"({"us_cid":1,"node_ids":[1,2,3],"coeff_vector_ids":[3,4,5]}]},)"
    R"("coefficients":{"num_dense_coeff_blocks":1,)"
    R"("dense_vector_info":[{"num_coeff_vecs":6,"num_components":3}],)"
    R"("dense_coefficient_vectors":[{"components":[1.0,0.0,0.0]},{"components":[0.0,1.0,0.5]},)"
    R"({"components":[0.0,0.0,0.5]},{"components":[0.5,0.0,0.0]},{"components":[0.5,1.0,0.0]},)"
    R"({"components":[0.0,0.0,1.0]}],"num_sparse_coeff_blocks":0,"sparse_vector_info":[],)"
    R"("sparse_coefficient_vectors":[]},"vertex_connectivity":[[0,1],[1,2]],)"
    R"("nodes":[[0.0,0.0,0.0,1.0],[0.5,0.0,0.0,1.0],[1.5,0.0,0.0,1.0],[2.0,0.0,0.0,1.0]]})"
    "\n");
}

TEST(Bext, SparseVectorsAndTitles21AreTheSameParabolas_CrossOracle)
{
  const Result<SplineFile> sparse = ReadBext(Sparse);
  const Result<SplineFile> transform = ReadBext(Transform);
  ASSERT_TRUE(sparse) << sparse.Status.Message();
  ASSERT_TRUE(transform) << transform.Status.Message();
  EXPECT_TRUE(SameSplines(sparse->Splines, transform->Splines));
  const Result<SplineFile> other =
    ReadBext(With(Transform, "BASIS TRANSFORM 2.1 THB", "B E X T 2.1"));
  ASSERT_TRUE(other) << other.Status.Message();
  EXPECT_TRUE(SameSplines(sparse->Splines, other->Splines));
  const Result<SplineFile> named = ReadBext(With(Transform, "THB\n4 2 6 0", "THB\n9 4 2 6 0"));
  ASSERT_TRUE(named) << named.Status.Message();
  EXPECT_EQ(named->Ids, (std::vector<int>{ 9 }));
}

/// Numbers of 8 digits, and of 24 places, stand side by side.
TEST(Bext, FullColumnsAreToldApart_ExactOracle)
{
  const std::string wide =
    With(With(Sparse, "1 4 2 6 0", "1234567" + std::string("80000000400000002       6       0")),
      ".5 0 0 1",
      "-5.0000000000000000E-001-0.0000000000000000E-000 0.0000000000000000E+000 "
      "1.0000000000000000E+000");
  const Result<SplineFile> file = ReadBext(wide);
  ASSERT_TRUE(file) << file.Status.Message();
  EXPECT_EQ(file->Ids, (std::vector<int>{ 12345678 }));
  EXPECT_EQ(std::get<Spline<1>>(file->Splines.front()).ControlPoints(1, 0), -0.5);
  const Result<SplineFile> digits =
    ReadBext(With(Sparse, ".5 0 0 1", "0.70710678118654752440084436210485 0 0 1"));
  ASSERT_TRUE(digits) << digits.Status.Message();
  EXPECT_EQ(std::get<Spline<1>>(digits->Splines.front()).ControlPoints(1, 0), std::sqrt(0.5));
}

TEST(Bext, RoundTripsOfEveryFamilyAreExact_CrossOracle)
{
  for (unsigned seed = 1; seed <= 8; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    CheckRoundTrips<1>(seed);
    CheckRoundTrips<2>(seed);
    CheckRoundTrips<3>(seed);
  }
}

TEST(Bext, WildNumbersComeBack_ExactOracle)
{
  const char* locale = std::setlocale(LC_ALL, "de_DE.UTF-8"); // where there is one: a decimal comma
  for (unsigned seed = 1; seed <= 20; ++seed)
  {
    Random random(seed);
    Result<SplineFile> file = ReadBext(HandWritten);
    auto& spline = std::get<Spline<2>>(file->Splines.front());
    for (double& x : spline.ControlPoints.reshaped())
    {
      x = WildNumber(random, 190);
    }
    spline.Weights.resize(8);
    for (double& w : spline.Weights)
    {
      w = std::abs(WildNumber(random, 90));
    }
    for (const auto& text : { WriteBext(file.Value), WriteBextJson(file.Value) })
    {
      ASSERT_TRUE(text) << text.Status.Message();
      const Result<SplineFile> again = ReadBext(text.Value);
      ASSERT_TRUE(again) << again.Status.Message();
      EXPECT_TRUE(SameSplines(again->Splines, file->Splines)) << "seed " << seed;
    }
  }
  if (locale)
  {
    std::setlocale(LC_ALL, "C");
  }
}

/// Control points and elements of the second follow those of the first; vectors are shared.
TEST(Bext, SeveralPatchesFollowEachOther_ExactOracle)
{
  Random random(3);
  SplineFile file;
  const Result<SplineFile> hand = ReadBext(HandWritten);
  auto first = std::get<Spline<2>>(hand->Splines.front());
  auto second = RandomSpline<2>(random, first.Space, 3, true);
  file.Splines = { first, second };
  file.Ids = { 4, 9 };
  for (const auto& text : { WriteBext(file), WriteBextJson(file) })
  {
    const Result<SplineFile> again = ReadBext(text.Value);
    ASSERT_TRUE(again) << again.Status.Message();
    EXPECT_EQ(again->Ids, (std::vector<int>{ 4 }));
    const auto& both = std::get<Spline<2>>(again->Splines.front());
    EXPECT_EQ(both.Space->NumElements(), 4);
    EXPECT_EQ(both.Space->Extraction->NumVectors(), first.Space->Extraction->NumVectors());
    EXPECT_EQ(both.ControlPoints.topRows(8), first.ControlPoints);
    EXPECT_EQ(both.ControlPoints.bottomRows(8), second.ControlPoints);
    EXPECT_EQ(both.Weights.head(8), Eigen::VectorXd::Ones(8));
    EXPECT_EQ(both.Weights.tail(8), second.Weights);
    EXPECT_EQ(both.Space->Extraction->Functions[12], 8);
  }
  EXPECT_NE(
    WriteBextJson(file).Value.find(R"("block_name":"patch 9","block_id":9,"elem_ids":[2,3])"),
    std::string::npos);
}

/// Coefficients of degree 2 in two elements: 0 becomes 0.001, all others change by a thousandth.
TEST(Bext, EveryChangedCoefficientIsRefusedByItsElement_ExactOracle)
{
  const std::string json = HandWrittenJson;
  struct Form
  {
    const std::string& Text;
    std::vector<std::size_t> Places;
    const char* First;
    const char* Second;
  };
  const Form forms[] = { { HandWritten, NumbersBetween(HandWritten, "12       6\n", "nothing"),
                           "element 1:", "element 2:" },
    { json, NumbersBetween(json, "dense_coefficient_vectors", "dense_vector_info"),
      "element 0:", "element 1:" } };
  for (const Form& form : forms)
  {
    ASSERT_EQ(form.Places.size(), 72U);
    for (std::size_t i = 0; i < form.Places.size(); ++i)
    {
      const double value = std::stod(form.Text.substr(form.Places[i]));
      for (const double factor : { 1.001, 0.999, 1.0 + 1e-6 })
      {
        std::ostringstream number;
        number.precision(17);
        number << (value == 0.0 ? factor - 1.0 : value * factor);
        if (value == 0.0 && factor < 1.0)
        {
          continue; // the sign of what follows stands before the number
        }
        const Result<SplineFile> bad =
          ReadBext(WithNumber(form.Text, form.Places[i], number.str()));
        EXPECT_EQ(bad.Status.Code, ErrorCode::NotInSpace) << i << ": " << bad.Status.Message();
        EXPECT_NE(bad.Status.Detail.find(i < 36 ? form.First : form.Second), std::string::npos)
          << i << ": " << bad.Status.Message();
      }
    }
  }
}

TEST(Bext, WeightsCountWhereTheFlagSaysSo_ExactOracle)
{
  const Result<SplineFile> plain = ReadBext(With(Sparse, "0 0 0 1\n", "0 0 0 2\n"));
  ASSERT_TRUE(plain) << plain.Status.Message();
  EXPECT_FALSE(std::get<Spline<1>>(plain->Splines.front()).IsRational());
  ASSERT_EQ(plain->Warnings.size(), 1U);
  EXPECT_NE(plain->Warnings[0].find("not rational"), std::string::npos);
  const Result<SplineFile> rational =
    ReadBext(With(With(Sparse, "0 0 0 1\n", "0 0 0 2\n"), "2 6 0\n", "2 6 1\n"));
  ASSERT_TRUE(rational) << rational.Status.Message();
  EXPECT_TRUE(rational->Warnings.empty());
  EXPECT_EQ(
    std::get<Spline<1>>(rational->Splines.front()).Weights, Eigen::Vector4d(2.0, 1.0, 1.0, 1.0));
}

TEST(Bext, EveryFailureOfTextIsReachable)
{
  const auto format = ErrorCode::InvalidFormat;
  const auto sizes = ErrorCode::SizeMismatch;
  const auto topology = ErrorCode::InvalidTopology;
  const std::string& good = Sparse;
  ExpectAllRefused({
    { "Empty", "", format, { "the title is missing" } },
    { "Comments", "$# nothing\n\n", format, { "the title is missing" } },
    { "OtherTitle", "solid\n1 2", format, { "line 1", "'solid'", "B E X T 2.0" } },
    { "OtherVersion", With(good, "2.0", "3.0"), format, { "line 1", "3.0" } },
    { "NoCounts", "B E X T 2.0\n", format, { "line of counts", "truncated" } },
    { "FewCounts", With(good, "1 4 2 6 0", "4 2 6 0"), format, { "line 2", "4 numbers" } },
    { "ManyCounts", With(good, "1 4 2 6 0", "1 4 2 6 0 0"), format, { "line 2", "one word more" } },
    { "NoCount", With(good, "1 4 2 6 0", "1 4 two 6 0"), format, { "line 2", "'two'" } },
    { "HugeNodes", With(good, "1 4 2 6 0", "1 99999999 2 6 0"), format,
      { "line 2", "99999999 control points do not fit" } },
    { "NegativeElements", With(good, "1 4 2 6 0", "1 4 -2 6 0"), format, { "-2 elements" } },
    { "NoNumber", With(good, ".5 0 0 1", ".5 0 x 1"), format,
      { "line 4", "control point 2", "'x' is not a number" } },
    { "ShortPoint", With(good, ".5 0 0 1", ".5 0 0"), format,
      { "line 4", "control point 2 is missing" } },
    { "LongPoint", With(good, ".5 0 0 1", ".5 0 0 1 1"), format, { "line 4", "one word more" } },
    { "NaN", With(good, ".5 0 0 1", ".5 nan 0 1"), ErrorCode::NonFiniteInput,
      { "line 4", "'nan'" } },
    { "NoBlocks", With(good, "\n1\n1 2 3 3 2", "\n0\n1 2 3 3 2"), sizes, { "0 elements" } },
    { "HugeBlocks", With(good, "\n1\n1 2 3 3 2", "\n99999999\n1 2 3 3 2"), format,
      { "number of element blocks is 99999999" } },
    { "Triangles", With(good, "1 2 3 3 2\n", "2 2 3 3 2\n"), format,
      { "line 8", "element block 1 has elements of type 2" } },
    { "NoDegree", With(good, "1 2 3 3 2\n", "1 2 3 3\n"), format, { "degree is missing" } },
    { "FewVectors", With(good, "1 2 3 3 2\n", "1 2 3 2 2\n"), sizes, { "belong together" } },
    { "OtherElements", With(good, "1 2 3 3 2\n", "1 3 3 3 2\n"), sizes,
      { "the blocks have 3 elements, the file 2" } },
    { "Degree0", With(good, "1 2 3 3 2\n", "1 2 3 3 0\n"), ErrorCode::InvalidDegree,
      { "line 8", "element block 1 has degree 0" } },
    { "Degree10", With(good, "1 2 3 3 2\n", "1 2 3 3 10\n"), ErrorCode::InvalidDegree,
      { "line 8", "element block 1 has degree 10" } },
    { "MixedDimensions", With(good, "\n1\n1 2 3 3 2", "\n2\n1 1 3 3 2\n1 1 3 3 2 1"),
      ErrorCode::DimensionMismatch, { "line 9", "files of their own" } },
    { "NodeTwice", With(good, "\n2 3 4\n4 6 5", "\n2 3 3\n4 6 5"), topology,
      { "element 2 has control point 3 twice" } },
    { "NodeOutside", With(good, "\n2 3 4\n4 6 5", "\n2 3 5\n4 6 5"), topology,
      { "element 2 has control point 5, there are 4" } },
    { "NodeZero", With(good, "\n2 3 4\n4 6 5", "\n0 3 4\n4 6 5"), format,
      { "line 11", "element 2, control points", "'0'" } },
    { "ManyNodes", With(good, "\n2 3 4\n4 6 5", "\n2 3 4 4\n4 6 5"), format,
      { "line 11", "'4' is one word more" } },
    { "VectorOutside", With(good, "\n2 3 4\n4 6 5", "\n2 3 4\n4 6 7"), topology,
      { "element 2 has coefficient vector 7, there are 6" } },
    { "OtherVectors", With(good, "\n1 2\n3 3\n", "\n1 2\n4 3\n"), sizes,
      { "the blocks have 7 coefficient vectors, the file 6" } },
    { "LongVectors", With(good, "\n1 2\n3 3\n", "\n1 2\n3 1001\n"), format,
      { "coefficient block 1, coefficients", "'1001'" } },
    { "ShortVectors",
      With(
        With(good, "\n1 2\n3 3\n", "\n1 2\n3 2\n"), "1 0 0\n0 1 .5\n0 0 .5\n", "1 0\n0 1\n0 0\n"),
      sizes, { "element 1 has 3 Bernstein polynomials", "vector 1 has 2 coefficients" } },
    { "PlaceOutside", With(good, "\n3\n1\n", "\n4\n1\n"), topology,
      { "coefficient vector 5 has place 4, its element 3" } },
    { "PlaceTwice", With(good, "\n2 1\n1 .5", "\n2 2\n1 .5"), topology,
      { "coefficient vector 6 has a place twice" } },
    { "NoCoefficient", With(good, "0 1 .5\n", "0 1 half\n"), format,
      { "coefficient vector 2", "'half'" } },
    { "CutOff", good.substr(0, good.size() - 5), format, { "coefficient vector 6", "truncated" } },
    { "MoreBehind", good + good, format, { "behind the last coefficient", "one file a patch" } },
    { "Negative", With(good, "0 1 .5\n0 0 .5\n", "0 1 1.5\n0 0 -.5\n"), ErrorCode::NotInSpace,
      { "element 1: its functions are not positive", "coefficient 3 of vector 3 is -0.5" } },
    { "Dependent", With(good, "0 1 .5\n0 0 .5\n", "0 .5 .5\n0 .5 .5\n"), ErrorCode::NotInSpace,
      { "element 1: its 3 functions do not span" } },
    { "ZeroWeight", With(With(good, "0 0 0 1\n", "0 0 0 0\n"), "2 6 0\n", "2 6 1\n"),
      ErrorCode::InvalidWeight, { "control point 1 has the weight 0" } },
    { "Huge", With(good, ".5 0 0 1", ".5 -1e61 0 1"), ErrorCode::TooLarge,
      { "control point 2: a value is larger" } },
  });
}

TEST(Bext, EveryFailureOfJsonIsReachable)
{
  const auto format = ErrorCode::InvalidFormat;
  const auto sizes = ErrorCode::SizeMismatch;
  const std::string& good = HandWrittenJson;
  ExpectAllRefused({
    { "CutOff", good.substr(0, 400), format, { "not a JSON object" } },
    { "NoNodes", With(good, "\"nodes\"", "\"knots\""), format, { "\"nodes\" is missing" } },
    { "NodesNoList", With(good, "\"nodes\": [[", "\"nodes\": 3, \"x\": [["), format,
      { "\"nodes\" is not a list" } },
    { "OtherNumNodes", With(good, "\"num_nodes\": 8", "\"num_nodes\": 9"), sizes,
      { "\"num_nodes\" is 9, the file has 8" } },
    { "OtherNumElems", With(good, "\"num_elems\": 2, \"num_n", "\"num_elems\": 3, \"num_n"), sizes,
      { "\"num_elems\" is 3" } },
    { "OtherNumVectors", With(good, "\"num_coeff_vecs\": 12", "\"num_coeff_vecs\": 1e3"), format,
      { "\"num_coeff_vecs\" is not a whole number" } },
    { "ShortNode", With(good, "[0.5, 0, 0.0, 1]", "[0.5, 0, 0.0]"), format,
      { "control point 1 is not a list" } },
    { "NoNumber", With(good, "[0.5, 0, 0.0, 1]", "[0.5, \"0\", 0.0, 1]"), format,
      { "control point 1 is not a number" } },
    { "NoElements", With(good, "\"elements\"", "\"elephants\""), format,
      { "\"elements\" is missing" } },
    { "NoInfo", With(good, "\"element_block_info\"", "\"info\""), format,
      { "\"element_block_info\" is missing" } },
    { "FewElements",
      With(good, "\"deg_u\": -1, \"num_elems\": 2", "\"deg_u\": -1, \"num_elems\": 1"), sizes,
      { "the blocks have 1 elements, the file 2" } },
    { "ManyElements",
      With(good, "\"deg_u\": -1, \"num_elems\": 2", "\"deg_u\": -1, \"num_elems\": 3"), sizes,
      { "have 3 elements, the file 2" } },
    { "OtherDimension", With(good, "\"dim\": 2", "\"dim\": 3"), ErrorCode::DimensionMismatch,
      { "element block 0 has elements of 2 parameters, the file 3" } },
    { "NoDegree", With(good, "\"deg_s\": 2, \"deg_t\": 1", "\"deg_s\": 0"),
      ErrorCode::InvalidDegree, { "element block 0 has no degree" } },
    { "FewVectors", With(good, "[0, 1, 2, 3, 4, 5], \"node", "[0, 1, 2, 3, 4], \"node"), sizes,
      { "element 0 has 6 control points and 5 coefficient vectors" } },
    { "NodeOutside", With(good, "[1, 2, 3, 5, 6, 7]", "[1, 2, 3, 5, 6, 8]"),
      ErrorCode::InvalidTopology, { "element 1 has control point 8, there are 8" } },
    { "NegativeNode", With(good, "[1, 2, 3, 5, 6, 7]", "[-1, 2, 3, 5, 6, 7]"), format,
      { "element 1, control point is not a whole number" } },
    { "HugeNode", With(good, "[1, 2, 3, 5, 6, 7]", "[1, 2, 3, 5, 6, 18446744073709551615]"), format,
      { "element 1, control point is not a whole number" } },
    { "NoVectors", With(good, "\"dense_coefficient_vectors\"", "\"dense\""), format,
      { "\"dense_coefficient_vectors\" is missing" } },
    { "NoComponents", With(good, "{\"components\": [1,", "{\"values\": [1,"), format,
      { "coefficient vector 0: \"components\" is missing" } },
    { "NoCoefficient", With(good, "[0, 1, 0.5, 0, 0, 0]", "[0, 1, null, 0, 0, 0]"), format,
      { "coefficient vector 1 is not a number" } },
    { "Sparse",
      With(good, "\"sparse_coefficient_vectors\": []", "\"sparse_coefficient_vectors\": [{}]"),
      format, { "not documented" } },
    { "Negative",
      With(With(good, "[0, 1, 0.5, 0, 0, 0]", "[0, 1, 1.5, 0, 0, 0]"), "[0, 0, 0.5, 0, 0, 0]",
        "[0, 0, -0.5, 0, 0, 0]"),
      ErrorCode::NotInSpace, { "element 0: its functions are not positive", "vector 2" } },
  });
}

TEST(Bext, FailuresOfWritingAreReachable)
{
  Random random(5);
  EXPECT_EQ(WriteBext({}).Status.Code, ErrorCode::EmptyInput);
  EXPECT_EQ(WriteBextJson({}).Status.Code, ErrorCode::EmptyInput);
  SplineFile file;
  const auto surface = RandomTensorSpace<2>(random, 2, 2);
  file.Splines = { RandomSpline<2>(random, surface, 4, false) };
  EXPECT_EQ(WriteBext(file).Status.Code, ErrorCode::DimensionMismatch);
  file.Splines = { RandomSpline<2>(random, surface, 2, false),
    RandomSpline<1>(random, RandomTensorSpace<1>(random, 2, 2), 3, false) };
  const Status mixed = WriteBext(file).Status;
  EXPECT_EQ(mixed.Code, ErrorCode::DimensionMismatch);
  EXPECT_NE(mixed.Detail.find("patch 1 has 1 parameters"), std::string::npos) << mixed.Message();
  file.Splines.pop_back();
  EXPECT_TRUE(WriteBext(file)); // two coordinates: z is 0
  file.Ids = { 100000000 };
  EXPECT_EQ(WriteBext(file).Status.Code, ErrorCode::TooLarge);
  EXPECT_TRUE(WriteBextJson(file));
  std::get<Spline<2>>(file.Splines.front()).ControlPoints(0, 0) =
    std::numeric_limits<double>::infinity();
  EXPECT_EQ(WriteBext(file).Status.Code, ErrorCode::NonFiniteInput);
}

TEST(Bext, BeginningsAreKnown_ExactOracle)
{
  EXPECT_TRUE(LooksLikeBext(HandWritten.substr(0, 30)));
  EXPECT_TRUE(LooksLikeBext(Transform.substr(0, 30)));
  EXPECT_TRUE(LooksLikeBext(HandWrittenJson.substr(0, 100)));
  EXPECT_TRUE(LooksLikeBextJson(WriteBextJson(ReadBext(Sparse).Value).Value.substr(0, 100)));
  EXPECT_FALSE(LooksLikeBext(""));
  EXPECT_FALSE(LooksLikeBext("100 1 0 0"));
  EXPECT_FALSE(LooksLikeBext("{\"curves\": [{\"degree\": 2}]}"));
  EXPECT_FALSE(LooksLikeBextJson(HandWritten));
}
