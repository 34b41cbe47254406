// SPDX-License-Identifier: BSD-3-Clause
// Meshes of Abaqus input files: elements, sets, parts, and every error.
#include <knotwork/SplineIO/AbaqusInput.h>

#include <gtest/gtest.h>

using namespace knotwork;

namespace
{
const std::string Part =
  "*Heading\nanything, 1, 2\n** a comment\n*PART, NAME=Bracket\n*node, nset=All\n"
  "1, 0., 0.\n2, 1., 0., 0.\n3, 0., 1.d0, 0.\n 40, 0., 0., 1.\n50, 1, 1, 1\n"
  "*Element, type=C3D4H, elset=Tets\n7, 1, 2, 3,\n40\n9, 2, 3, 40, 50\n"
  "*Nset, nset=Base, generate\n1, 3, 1\n*NSET, NSET=\"Two of them\"\n40, 50\n"
  "*Elset, elset=Both\nTets,\n*elset, elset=Last, generate\n9, 1000000000, 2\n"
  "*Solid Section, elset=Tets, material=Steel\n1.,\n*End Part\n*Assembly, name=A\n"
  "*Instance, name=B-1, part=Bracket\n0., 0., 0.\n*End Instance\n*End "
  "Assembly\n*Step\n*Static\n1., 1.\n*End Step\n";

std::string With(std::string text, const std::string& part, const std::string& replacement)
{
  const std::size_t at = text.find(part);
  EXPECT_NE(at, std::string::npos) << part;
  return at == std::string::npos ? text : text.replace(at, part.size(), replacement);
}
}

TEST(AbaqusInput, ElementsAndSets)
{
  const auto mesh = ReadAbaqusInput(Part);
  ASSERT_TRUE(mesh) << mesh.Status.Message();
  EXPECT_EQ(mesh->NodeNumbers, (std::vector<std::int64_t>{ 1, 2, 3, 40, 50 }));
  EXPECT_EQ(mesh->ElementNumbers, (std::vector<std::int64_t>{ 7, 9 }));
  EXPECT_EQ(mesh->Nodes, (std::vector<std::int64_t>{ 0, 1, 2, 3, 1, 2, 3, 4 }));
  EXPECT_EQ(mesh->Points(2, 1), 1.0);
  ASSERT_EQ(mesh->Sets.size(), 6U);
  const std::vector<std::pair<std::string, std::vector<std::int64_t>>> sets = {
    { "All", { 0, 1, 2, 3, 4 } }, { "Tets", { 0, 1 } }, { "Base", { 0, 1, 2 } },
    { "Two of them", { 3, 4 } }, { "Both", { 0, 1 } }, { "Last", { 1 } }
  };
  for (std::size_t s = 0; s < sets.size(); ++s)
  {
    EXPECT_EQ(mesh->Sets[s].Name, sets[s].first);
    EXPECT_EQ(mesh->Sets[s].Members, sets[s].second) << sets[s].first;
  }
  EXPECT_EQ(
    mesh->GroupLists[static_cast<std::size_t>(mesh->GroupListOf[0])], (std::vector<int>{ 1, 2 }));
  EXPECT_EQ(mesh->GroupLists[static_cast<std::size_t>(mesh->GroupListOf[1])],
    (std::vector<int>{ 1, 2, 3 }));
  EXPECT_EQ(mesh->Groups.at(2).Name, "Last");
}

TEST(AbaqusInput, TypesOfElements)
{
  // what the manual says of each: nodes and shape
  const std::vector<std::tuple<std::string, std::size_t, ElementShape>> types = {
    { "C3D4", 4, ElementShape::Tetrahedron }, { "C3D10M", 10, ElementShape::Tetrahedron },
    { "C3D8R", 8, ElementShape::Hexahedron }, { "C3D8I", 8, ElementShape::Hexahedron },
    { "C3D20R", 20, ElementShape::Hexahedron }, { "C3D6", 6, ElementShape::Wedge },
    { "C3D15", 15, ElementShape::Wedge }, { "C3D5", 5, ElementShape::Pyramid },
    { "S3", 3, ElementShape::Triangle }, { "S4R", 4, ElementShape::Quadrilateral },
    { "S8R5", 8, ElementShape::Quadrilateral }, { "STRI65", 6, ElementShape::Triangle },
    { "CPS3", 3, ElementShape::Triangle }, { "CPE4", 4, ElementShape::Quadrilateral },
    { "CPS6M", 6, ElementShape::Triangle }, { "CAX8R", 8, ElementShape::Quadrilateral },
    { "M3D4", 4, ElementShape::Quadrilateral }, { "T3D2", 2, ElementShape::Segment },
    { "B31", 2, ElementShape::Segment }, { "B32", 3, ElementShape::Segment },
    { "DC3D10", 10, ElementShape::Tetrahedron }, { "SC8R", 8, ElementShape::Hexahedron }
  };
  for (const auto& [type, size, shape] : types)
  {
    std::string text = "*NODE\n";
    std::string element = "\n*ELEMENT, TYPE=" + type + "\n1";
    for (std::size_t i = 1; i <= size; ++i)
    {
      text += std::to_string(i) + ", " + std::to_string(i) + ".5, 0, 0\n";
      element += "," + std::string(i == 12 ? "\n" : "") + std::to_string(i);
    }
    const auto mesh = ReadAbaqusInput(text + element + "\n");
    ASSERT_TRUE(mesh) << type << mesh.Status.Message();
    EXPECT_EQ(mesh->Nodes.size(), size) << type;
    EXPECT_EQ(mesh->Kinds[0].Shape, shape) << type;
    EXPECT_EQ(mesh->Kinds[0].Places.size(), size) << type;
  }
}

TEST(AbaqusInput, EveryError)
{
  struct Case
  {
    std::string Text;
    ErrorCode Code;
    std::vector<std::string> Words;
  };
  const auto format = ErrorCode::InvalidFormat;
  const auto parameter = ErrorCode::InvalidParameter;
  const auto topology = ErrorCode::InvalidTopology;
  const std::vector<Case> cases = {
    { "", ErrorCode::EmptyInput, { "*ELEMENT" } },
    { With(Part, "*Heading", "*Include, input=a.inp"), parameter, { "line 1", "*INCLUDE" } },
    { With(Part, "*node, nset=All", "*node, input=nodes.txt"), parameter, { "another file" } },
    { With(Part, "*Heading", "*NGEN"), parameter, { "*NGEN", "write all nodes" } },
    { With(Part, "*node, nset=All", "*node, system=C"), parameter, { "SYSTEM=C" } },
    { With(Part, "*Step", "*Part, name=x"), parameter, { "second *PART" } },
    { With(Part, "*Step", "*Instance, name=x"), parameter, { "second *INSTANCE" } },
    { With(Part, "part=Bracket\n0.,", "part=Bracket\n3.,"), parameter, { "moved", "line 28" } },
    { With(Part, "C3D4H", "C3D27"), parameter, { "'C3D27'" } },
    { With(Part, ", type=C3D4H", ""), parameter, { "''" } },
    { With(Part, "40\n9", "40, 50\n9"), format, { "element 7", "more than its 4" } },
    { With(Part, "40\n9", "\n9"), format, { "element 7" } },
    { With(Part, "40, 50\n*Nset", "40\n*Nset"), format, { "element 9 lacks 1" } },
    { With(Part, "9, 2, 3", "7, 2, 3"), topology, { "element 7", "twice" } },
    { With(Part, "50, 1, 1, 1", "40, 1, 1, 1"), topology, { "node 40", "twice" } },
    { With(Part, "9, 2, 3", "9, 2, 4"), topology, { "element 9", "node 4" } },
    { With(Part, "them\"\n40, 50", "them\"\n41, 50"), topology, { "node 41", "Two of them" } },
    { With(Part, "Tets,\n", "Later,\n"), format, { "'LATER'" } },
    { With(Part, "*Elset, elset=Both", "*Elset"), format, { "no name" } },
    { With(Part, "2, 1., 0., 0.", "2, one, 0., 0."), format, { "'one'", "line 7" } },
    { With(Part, "2, 1., 0., 0.", "2, inf, 0., 0."), ErrorCode::NonFiniteInput, { "inf" } },
    { With(Part, "2, 1., 0., 0.", "2, 1e70, 0., 0."), ErrorCode::TooLarge, { "1e+60" } },
    { With(Part, "2, 1., 0., 0.", "-2, 1., 0., 0."), format, { "'-2'" } },
    { With(Part, "1, 3, 1\n", "3, 1, 1\n"), format, { "last number" } },
    { With(Part, "1, 3, 1\n", "1, 3, 0\n"), format, { "step" } },
  };
  for (const Case& one : cases)
  {
    const auto read = ReadAbaqusInput(one.Text);
    EXPECT_EQ(read.Status.Code, one.Code) << one.Text << read.Status.Message();
    for (const std::string& word : one.Words)
    {
      EXPECT_NE(read.Status.Detail.find(word), std::string::npos)
        << word << ": " << read.Status.Detail;
    }
    EXPECT_EQ(read.Status.Detail.find('\n'), std::string::npos);
  }
  EXPECT_TRUE(LooksLikeAbaqusInput(Part));
  EXPECT_FALSE(LooksLikeAbaqusInput("$MeshFormat"));
}
