// SPDX-License-Identifier: BSD-3-Clause
#include <knotwork/SplineIO/MeshFiles.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <random>

using namespace knotwork;

namespace
{
using Reader = Result<PointFile> (*)(std::string_view);

const std::string Off = "OFF # a pyramid without its base\n5 4 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
                        "0.5 0.5 0.1\n\n3 0 1 4\n3 1 2 4 255 0 0\n3 2 3 4\n3 3 0 4\n";
const std::string Obj = "# a pyramid\no it\nv 0 0 0\nv 1 0 0\nv 1 1 0 # corner\nv 0 1 0\n"
                        "v 0.5 0.5 0.1\ns off\nf 1 2 5\nf 2 3 -1\nf 3 \\\n 4 5\nf 4//1 1//1 5//1\n";
const std::string Stl = []
{
  const char* corners[4][3] = { { "0 0 0", "1 0 0", "0.5 0.5 0.1" },
    { "1 0 0", "1 1 0", "0.5 0.5 0.1" }, { "1 1 0", "0 1 0", "0.5 0.5 0.1" },
    { "0 1 0", "-0 0 0", "0.5 0.5 0.1" } };
  std::string text = "solid a name with words\n";
  for (const auto& facet : corners)
  {
    text += "FACET normal 0 0 1\n outer loop\n";
    for (const char* corner : facet)
    {
      text += std::string("  vertex ") + corner + "\n";
    }
    text += " endloop\nendfacet\n";
  }
  return text + "endsolid a name with words";
}();

std::string With(std::string text, const std::string& part, const std::string& replacement)
{
  const std::size_t at = text.find(part);
  EXPECT_NE(at, std::string::npos) << part;
  return text.replace(at, part.size(), replacement);
}

template <typename T>
void Append(std::string& text, T value)
{
  char bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof(T));
  text.append(bytes, sizeof(T));
}

std::string BinaryStl(
  const std::vector<std::array<std::array<float, 3>, 3>>& facets, const std::string& head)
{
  std::string text = head;
  text.resize(80, ' ');
  Append(text, static_cast<std::uint32_t>(facets.size()));
  for (const auto& facet : facets)
  {
    text.append(12, '\0');
    for (const auto& corner : facet)
    {
      for (float c : corner)
      {
        Append(text, c);
      }
    }
    text.append(2, '\0');
  }
  return text;
}

/// Coordinates of the corners, face by face.
std::vector<std::vector<std::array<double, 3>>> Faces(const PointFile& file)
{
  std::vector<std::vector<std::array<double, 3>>> faces;
  for (const std::vector<int>& polygon : file.Polygons)
  {
    auto& face = faces.emplace_back();
    for (int corner : polygon)
    {
      const auto row = file.Points.row(corner);
      face.push_back({ row[0], row[1], row[2] });
    }
  }
  return faces;
}

struct Damage
{
  std::string Text;
  ErrorCode Code;
  const char* Words;
};

void ExpectRefused(Reader read, const std::vector<Damage>& damages)
{
  for (const Damage& damage : damages)
  {
    SCOPED_TRACE(damage.Text);
    const auto file = read(damage.Text);
    EXPECT_EQ(file.Status.Code, damage.Code) << file.Status.Detail;
    EXPECT_NE(file.Status.Detail.find(damage.Words), std::string::npos) << file.Status.Detail;
    EXPECT_EQ(file.Status.Detail.find('\n'), std::string::npos);
  }
}
}

TEST(MeshFiles, OneMeshInThreeFormats_GoldenOracle)
{
  const std::vector<std::vector<std::array<double, 3>>> pyramid = {
    { { 0, 0, 0 }, { 1, 0, 0 }, { 0.5, 0.5, 0.1 } },
    { { 1, 0, 0 }, { 1, 1, 0 }, { 0.5, 0.5, 0.1 } },
    { { 1, 1, 0 }, { 0, 1, 0 }, { 0.5, 0.5, 0.1 } }, { { 0, 1, 0 }, { 0, 0, 0 }, { 0.5, 0.5, 0.1 } }
  };
  for (const auto& file : { ReadOff(Off), ReadObj(Obj), ReadStl(Stl) })
  {
    ASSERT_TRUE(file) << file.Status.Message();
    EXPECT_EQ(Faces(file.Value), pyramid);
    EXPECT_EQ(file->Points.rows(), 5);
    EXPECT_TRUE(file->LeftOut.empty());
    EXPECT_TRUE(file->Warnings.empty());
  }
}

TEST(MeshFiles, OffVariantsAreRead_ExactOracle)
{
  for (const char* text :
    { "COFF 3 1 0\n0 0 0 255 0 0 255\n1 0 0 0 0 0 0\n0 1 0 1 1 1 1\n3 0 1 2\n",
      "NOFF\n3 1\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2 0.5 0.5 0.5 1\n",
      "OFF\r\n3 1 0\r\n0 0 0\r\n+1 0 0\r\n0 1e0 0\r\n3 0 1 2\r\n\r\n# end" })
  {
    const auto file = ReadOff(text);
    ASSERT_TRUE(file) << file.Status.Message() << "\n" << text;
    EXPECT_EQ(file->Polygons, (std::vector<std::vector<int>>{ { 0, 1, 2 } }));
    PointMatrix points(3, 3);
    points << 0, 0, 0, 1, 0, 0, 0, 1, 0;
    EXPECT_EQ(file->Points, points);
  }
}

TEST(MeshFiles, OffDamageIsNamedWithItsLine_ExactOracle)
{
  ExpectRefused(ReadOff,
    { { "", ErrorCode::EmptyInput, "empty" },
      { "PLY\n", ErrorCode::InvalidFormat, "line 1: 'PLY' is not OFF" },
      { "OFF\n", ErrorCode::InvalidFormat, "numbers of points and faces are missing" },
      { With(Off, "5 4 0", "0junk 4 0"), ErrorCode::InvalidFormat,
        "line 2: number of points: '0junk'" },
      { With(Off, "5 4 0", "5 4.9x 0"), ErrorCode::InvalidFormat,
        "line 2: number of faces: '4.9x'" },
      { With(Off, "5 4 0", "5"), ErrorCode::InvalidFormat, "line 2: number of faces: is missing" },
      { With(Off, "5 4 0", "5 4 0 1"), ErrorCode::InvalidFormat, "line 2: '1' stands behind" },
      { With(Off, "5 4 0", "0 0 0"), ErrorCode::EmptyInput, "no points" },
      { With(Off, "5 4 0", "5 -4 0"), ErrorCode::InvalidFormat, "'-4'" },
      { With(Off, "5 4 0", "2000000000 4 0"), ErrorCode::InvalidFormat, "room" },
      { With(Off, "5 4 0", "5 3 0"), ErrorCode::InvalidFormat,
        "line 12: '3' stands behind the last of 3 faces; correct the counts in line 2" },
      { With(Off, "5 4 0", "5 5 0"), ErrorCode::InvalidFormat, "face 4 of 5 is missing" },
      { With(Off, "1 1 0", "1 nan 0"), ErrorCode::NonFiniteInput, "line 5: point 2: 'nan'" },
      { With(Off, "1 1 0", "1 1e309 0"), ErrorCode::InvalidFormat, "line 5: point 2: '1e309'" },
      { With(Off, "1 1 0", "1 abc 0"), ErrorCode::InvalidFormat, "line 5: point 2: 'abc'" },
      { With(Off, "1 1 0", "1 1"), ErrorCode::InvalidFormat, "line 5: point 2: a point has three" },
      { With(Off, "1 1 0", "1 1 0 red"), ErrorCode::InvalidFormat, "line 5: point 2: 'red'" },
      { With(Off, "3 0 1 4", "4.9x 0 1 4"), ErrorCode::InvalidFormat, "line 9: face 0, number" },
      { With(Off, "3 0 1 4", "3 0 1 4.9x"), ErrorCode::InvalidFormat, "line 9: face 0, corner 2" },
      { With(Off, "3 0 1 4", "3 0 1 1e309"), ErrorCode::InvalidFormat, "line 9: face 0, corner 2" },
      { With(Off, "3 0 1 4", "3 0 1 5"), ErrorCode::InvalidFormat, "'5' is outside 0 to 4" },
      { With(Off, "3 0 1 4", "3 0 1"), ErrorCode::InvalidFormat, "corner 2: is missing" },
      { With(Off, "3 0 1 4", "2 0 1"), ErrorCode::InvalidFormat, "line 9: face 0 has 2 corners" },
      { With(Off, "255 0 0", "255 0 x"), ErrorCode::InvalidFormat, "line 10: face 1: 'x'" },
      { With(Off, "255 0 0", "1 2 3 4 5"), ErrorCode::InvalidFormat,
        "'5' stands behind face 1" } });
}

TEST(MeshFiles, ObjDamageIsNamedWithItsLine_ExactOracle)
{
  ExpectRefused(ReadObj,
    { { "", ErrorCode::EmptyInput, "no points" },
      { With(Obj, "v 1 0 0", "v inf 0 0"), ErrorCode::NonFiniteInput, "line 4: 'inf'" },
      { With(Obj, "v 1 0 0", "v nan 0 0"), ErrorCode::NonFiniteInput, "line 4: 'nan'" },
      { With(Obj, "v 1 0 0", "v abc 0 0"), ErrorCode::InvalidFormat, "line 4: 'abc'" },
      { With(Obj, "v 1 0 0", "v 1.0.0 0 0"), ErrorCode::InvalidFormat, "line 4: '1.0.0'" },
      { With(Obj, "v 1 0 0", "v 1e309 0 0"), ErrorCode::InvalidFormat, "line 4: '1e309'" },
      { With(Obj, "v 1 0 0", "v 1 0"), ErrorCode::InvalidFormat, "line 4: a point has 3 to 7" },
      { With(Obj, "v 1 0 0", "v 1 2 3 4 5 6 7 8"), ErrorCode::InvalidFormat, "remove '8'" },
      { With(Obj, "v 1 0 0", "w 1 0 0"), ErrorCode::InvalidFormat, "line 4: 'w' is no keyword" },
      { With(Obj, "f 1 2 5", "f 1 2 6"), ErrorCode::InvalidFormat,
        "line 9: a corner is point 6, but there are 5" },
      { With(Obj, "f 1 2 5", "f 0 2 5"), ErrorCode::InvalidFormat, "line 9: '0' is no number" },
      { With(Obj, "f 1 2 5", "f -6 2 5"), ErrorCode::InvalidFormat, "line 9: '-6' is outside" },
      { With(Obj, "f 1 2 5", "f 1 2 1e309"), ErrorCode::InvalidFormat, "line 9: '1e309'" },
      { With(Obj, "f 1 2 5", "f 1 2 4.9x"), ErrorCode::InvalidFormat, "line 9: '4.9x'" },
      { With(Obj, "f 1 2 5", "f 1 2"), ErrorCode::InvalidFormat, "line 9: a face of 2 corners" },
      { With(Obj, "f 1 2 5", "vt 0 0\nf 1/2 2 5"), ErrorCode::InvalidFormat,
        "texture coordinates 2" },
      { With(Obj, "f 1 2 5", "f 1//x 2 5"), ErrorCode::InvalidFormat, "line 9: 'x'" },
      { With(Obj, "f 1 2 5", "f 1/1/1/1 2 5"), ErrorCode::InvalidFormat, "point/texture/normal" },
      { With(Obj, "f 1 2 5", "l 1"), ErrorCode::InvalidFormat, "line 9: a line of 1 corners" },
      { With(Obj, "s off", "vt 0"), ErrorCode::InvalidFormat, "line 8: a texture coordinate" },
      { With(Obj, "s off", "vt 0 nan"), ErrorCode::NonFiniteInput, "line 8: 'nan'" } });
}

/// As programs write it that leave texture coordinates out, but not their numbers.
TEST(MeshFiles, ObjWithNumbersOfNoTexture_ExactOracle)
{
  const auto file = ReadObj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/4 2/5 3/6\n");
  ASSERT_TRUE(file) << file.Status.Message();
  EXPECT_EQ(file->Polygons, (std::vector<std::vector<int>>{ { 0, 1, 2 } }));
  EXPECT_TRUE(file->Names.empty());
  ASSERT_EQ(file->Warnings.size(), 1u);
  EXPECT_NE(file->Warnings[0].find("texture"), std::string::npos);
}

TEST(MeshFiles, ObjKeepsLinesAndTexture_ExactOracle)
{
  const auto file = ReadObj("v 0 0 0\nvt 0 0.5\nvt 1 0.25\nvt 0 0.5 0\nv 1 0 0 1 0.5 0.5 0.5\n"
                            "v 0 1 0\nf 1/1 2/2 3/3\nf 2/2/9 1/3/1 3/1/1\nl 1 2 3\np 1\n");
  ASSERT_TRUE(file) << file.Status.Message();
  EXPECT_EQ(file->Names, (std::vector<std::string>{ "TCoords:0", "TCoords:1" }));
  PointMatrix texture(3, 2);
  texture << 0, 0.5, 1, 0.25, 0, 0.5;
  EXPECT_EQ(file->Channels, texture);
  EXPECT_EQ(file->Polygons, (std::vector<std::vector<int>>{ { 0, 1, 2 }, { 1, 0, 2 } }));
  EXPECT_EQ(file->Lines, (std::vector<std::vector<int>>{ { 0, 1, 2 } }));
  // a point with two pairs, or without one, has none; the warning says so
  for (const char* corners : { "f 1/1 2/2 3/1\nf 1/2 2/2 3/1\n", "f 1/1 2/2 3\n", "l 1/1 2/2\n" })
  {
    const auto without =
      ReadObj(std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 1\n") + corners);
    ASSERT_TRUE(without) << without.Status.Message();
    EXPECT_TRUE(without->Names.empty());
    EXPECT_EQ(without->Warnings.size(), 1U) << corners;
  }
  const auto surface = ReadObj("v 0 0 0\nv 1 0 0\ncstype bezier\nsurf 0 1 0 1 1 2\nend\n");
  ASSERT_TRUE(surface) << surface.Status.Message();
  ASSERT_EQ(surface->LeftOut.size(), 1U);
  EXPECT_NE(surface->LeftOut[0].find("line 4: 1 curves, surfaces"), std::string::npos);
}

TEST(MeshFiles, StlDamageIsNamedWithItsPlace_ExactOracle)
{
  const std::string inner = "vertex 0.5 0.5 0.1";
  ExpectRefused(ReadStl,
    { { "", ErrorCode::InvalidFormat, "line 1" },
      { "solid\nendsolid\n", ErrorCode::EmptyInput, "no facet" },
      { With(Stl, inner, "vertex 0.5 nan 0.1"), ErrorCode::NonFiniteInput, "line 6: 'nan'" },
      { With(Stl, inner, "vertex 0.5 abc 0.1"), ErrorCode::InvalidFormat, "line 6: 'abc'" },
      { With(Stl, inner, "vertex 0.5 1e309 0.1"), ErrorCode::InvalidFormat, "line 6: '1e309'" },
      { With(Stl, inner, "vertex 0.5 0.1"), ErrorCode::InvalidFormat, "line 7: 'endloop'" },
      { With(Stl, inner, inner + " 1"), ErrorCode::InvalidFormat, "line 6: '1' stands where" },
      { With(Stl, "endloop", "vertex 1 1 1 endloop"), ErrorCode::InvalidFormat, "'vertex'" },
      { With(Stl, "endfacet", "end"), ErrorCode::InvalidFormat, "'endfacet' is expected" },
      { With(Stl, "endsolid", "solid"), ErrorCode::InvalidFormat, "'facet' or 'endsolid'" },
      { Stl + "\njunk", ErrorCode::InvalidFormat, "'junk' stands where 'solid'" },
      { Stl.substr(0, Stl.find("endsolid")), ErrorCode::InvalidFormat, "truncated" } });
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::string sound = BinaryStl({ { { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } } } }, "solid x");
  ExpectRefused(ReadStl,
    { { BinaryStl({ { { { 0, 0, 0 }, { 1, 0, 0 }, { 0, nan, 0 } } } }, "x"),
        ErrorCode::NonFiniteInput, "facet 0" },
      { sound + '\0', ErrorCode::InvalidFormat, "tells of 1 facets" },
      { sound.substr(0, 120), ErrorCode::InvalidFormat, "tells of 1 facets" },
      { BinaryStl({}, "empty"), ErrorCode::EmptyInput, "no facet" } });
}

TEST(MeshFiles, BinaryStlHoldsTheSame_CrossOracle)
{
  for (const char* head : { "made by a test", "solid made by a test" })
  {
    const auto file = ReadStl(BinaryStl({ { { { 0, 0, 0 }, { 1, 0, 0 }, { 0.5F, 0.5F, 0.1F } } },
                                          { { { 1, 0, 0 }, { 1, 1, 0 }, { 0.5F, 0.5F, 0.1F } } },
                                          { { { 1, 1, 0 }, { 1, 1, 0 }, { 0, 1, 0 } } } },
      head));
    ASSERT_TRUE(file) << file.Status.Message();
    EXPECT_EQ(file->Polygons, (std::vector<std::vector<int>>{ { 0, 1, 2 }, { 1, 3, 2 } }));
    EXPECT_EQ(file->Points(2, 2), static_cast<double>(0.1F));
    ASSERT_EQ(file->Warnings.size(), 1U); // the third facet is none
    EXPECT_NE(file->Warnings[0].find("facet 2"), std::string::npos);
  }
  const auto two = ReadStl(Stl + "\n" + Stl);
  ASSERT_TRUE(two);
  EXPECT_EQ(two->Polygons.size(), 8U);
  EXPECT_EQ(two->Points.rows(), 5);
}

// Whatever is cut off or replaced: an error of one line, or corners that are points and coordinates
// that are finite.
TEST(MeshFiles, NoDamageGivesWrongNumbers_PropertyOracle)
{
  const std::string binary =
    BinaryStl({ { { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } } } }, "solid of one");
  const std::pair<Reader, std::string> cases[] = { { ReadOff, Off }, { ReadObj, Obj },
    { ReadStl, Stl }, { ReadStl, binary } };
  for (unsigned seed = 1; seed <= 500; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    for (const auto& [read, sound] : cases)
    {
      std::string text = sound.substr(0, seed % 2 ? sound.size() : random() % sound.size());
      for (unsigned i = 0; i < seed % 4 && !text.empty(); ++i)
      {
        constexpr std::string_view characters = "0123456789.-+eEnaix \n/#\\fv";
        text[random() % text.size()] = characters[random() % characters.size()];
      }
      const auto file = read(text);
      EXPECT_EQ(file.Status.Detail.find('\n'), std::string::npos);
      EXPECT_TRUE(file->Points.allFinite());
      for (const auto* cells : { &file->Polygons, &file->Lines })
      {
        for (const std::vector<int>& cell : *cells)
        {
          EXPECT_GE(cell.size(), cells == &file->Lines ? 2U : 3U);
          for (int corner : cell)
          {
            EXPECT_TRUE(corner >= 0 && corner < file->Points.rows());
          }
        }
      }
    }
  }
}
