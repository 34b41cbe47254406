// SPDX-License-Identifier: BSD-3-Clause
// Meshes of Gmsh: both versions, text and binary of both byte orders, what is written, and every
// error.
#include <knotwork/SplineIO/GmshMesh.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>

using namespace knotwork;

namespace
{
/// Two triangles and an edge of numbers that are far apart; a point element of group 8.
const std::string New =
  "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n1 7 \"left side\"\n"
  "2 5 \"plate\"\n$EndPhysicalNames\n$Entities\n1 1 1 0\n4 0 0 0 1 8\n"
  "2 0 0 0 0 1 0 1 7 0\n3 0 0 0 1 1 0 2 5 6 1 2\n$EndEntities\n"
  "$Nodes\n2 4 1 1000000000\n2 3 0 3\n1\n20\n1000000000\n0 0 0\n1 0 0\n1 1 0\n"
  "1 2 1 1\n4\n0 1 0 0.5\n$EndNodes\n$Periodic\n0\n$EndPeriodic\n"
  "$Elements\n3 4 10 900000000\n0 4 15 1\n900000000 1\n1 2 1 1\n10 1 4\n"
  "2 3 2 2\n11 1 20 1000000000\n12 1 1000000000 4\n$EndElements\n";

const std::string Old = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n20 1 0 0\n"
                        "1000000000 1 1 0\n4 0 1 0\n$EndNodes\n$Elements\n4\n9 15 2 8 4 1\n"
                        "10 1 2 7 2 1 4\n11 2 2 5 3 1 20 1000000000\n12 2 2 0 3 1 1000000000 4\n"
                        "$EndElements\n";

std::string With(std::string text, const std::string& part, const std::string& replacement)
{
  const std::size_t at = text.find(part);
  EXPECT_NE(at, std::string::npos) << part;
  return at == std::string::npos ? text : text.replace(at, part.size(), replacement);
}

/// Numbers of the other byte order: the sections of a binary MSH 2.2 text made by hand.
class BinaryText
{
public:
  explicit BinaryText(bool swapped) : IsSwapped(swapped) {}
  BinaryText& Words(const std::string& words)
  {
    this->Text += words;
    return *this;
  }
  template <typename Number>
  BinaryText& Add(Number value)
  {
    char bytes[sizeof(Number)];
    std::memcpy(bytes, &value, sizeof(Number));
    if (this->IsSwapped)
    {
      std::reverse(bytes, bytes + sizeof(Number));
    }
    this->Text.append(bytes, sizeof(Number));
    return *this;
  }
  std::string Text;

private:
  bool IsSwapped;
};

std::string OldBinary(bool swapped)
{
  BinaryText text(swapped);
  text.Words("$MeshFormat\n2.2 1 8\n").Add(1).Words("\n$EndMeshFormat\n$Nodes\n3\n");
  for (int node = 1; node <= 3; ++node)
  {
    text.Add(node).Add(node == 2 ? 1.0 : 0.0).Add(node == 3 ? 1.0 : 0.0).Add(0.25);
  }
  text.Words("\n$EndNodes\n$Elements\n1\n").Add(2).Add(1).Add(2);
  text.Add(77).Add(5).Add(3).Add(1).Add(2).Add(3).Words("\n$EndElements\n");
  return text.Text;
}

void ExpectSame(const ElementMesh& a, const ElementMesh& b)
{
  EXPECT_EQ(a.Points, b.Points);
  EXPECT_EQ(a.NodeNumbers, b.NodeNumbers);
  EXPECT_EQ(a.NodeGroups, b.NodeGroups);
  EXPECT_EQ(a.ElementNumbers, b.ElementNumbers);
  EXPECT_EQ(a.Entities, b.Entities);
  EXPECT_EQ(a.Nodes, b.Nodes);
  EXPECT_EQ(a.Begin, b.Begin);
  ASSERT_EQ(a.KindOf.size(), b.KindOf.size());
  for (std::size_t e = 0; e < a.KindOf.size(); ++e)
  {
    EXPECT_EQ(a.Kinds[static_cast<std::size_t>(a.KindOf[e])].Places,
      b.Kinds[static_cast<std::size_t>(b.KindOf[e])].Places);
    EXPECT_EQ(a.GroupLists[static_cast<std::size_t>(a.GroupListOf[e])],
      b.GroupLists[static_cast<std::size_t>(b.GroupListOf[e])]);
  }
  ASSERT_EQ(a.Groups.size(), b.Groups.size());
  for (std::size_t g = 0; g < a.Groups.size(); ++g)
  {
    EXPECT_EQ(a.Groups[g].Name, b.Groups[g].Name);
    EXPECT_EQ(a.Groups[g].Dimension, b.Groups[g].Dimension);
    EXPECT_EQ(a.Groups[g].Id, b.Groups[g].Id);
  }
}
}

TEST(GmshMesh, NumbersGroupsAndEntities)
{
  const auto mesh = ReadGmshMesh(New);
  ASSERT_TRUE(mesh) << mesh.Status.Message();
  EXPECT_EQ(mesh->NodeNumbers, (std::vector<std::int64_t>{ 1, 20, 1000000000, 4 }));
  EXPECT_EQ(mesh->NodeGroups, (std::vector<int>{ 8, 0, 0, 0 }));
  EXPECT_EQ(mesh->ElementNumbers, (std::vector<std::int64_t>{ 10, 11, 12 }));
  EXPECT_EQ(mesh->Entities, (std::vector<int>{ 2, 3, 3 }));
  EXPECT_EQ(mesh->Nodes, (std::vector<std::int64_t>{ 0, 3, 0, 1, 2, 0, 2, 3 }));
  EXPECT_EQ(
    mesh->GroupLists[static_cast<std::size_t>(mesh->GroupListOf[1])], (std::vector<int>{ 5, 6 }));
  EXPECT_EQ(mesh->Groups.at(0).Name, "left side");
  EXPECT_EQ(mesh->Points(3, 1), 1.0);

  const auto old = ReadGmshMesh(Old);
  ASSERT_TRUE(old) << old.Status.Message();
  EXPECT_EQ(old->Nodes, mesh->Nodes);
  EXPECT_EQ(old->NodeGroups, mesh->NodeGroups);
  EXPECT_EQ(old->Entities, mesh->Entities);
  EXPECT_TRUE(old->GroupLists[static_cast<std::size_t>(old->GroupListOf[2])].empty());
}

TEST(GmshMesh, BothByteOrders)
{
  for (const bool swapped : { false, true })
  {
    const auto mesh = ReadGmshMesh(OldBinary(swapped));
    ASSERT_TRUE(mesh) << mesh.Status.Message();
    EXPECT_EQ(mesh->ElementNumbers, std::vector<std::int64_t>{ 77 });
    EXPECT_EQ(mesh->Points(2, 1), 1.0);
    EXPECT_EQ(mesh->Points(2, 2), 0.25);
  }
}

TEST(GmshMesh, RoundTripsAreExact)
{
  auto mesh = ReadGmshMesh(New);
  ASSERT_TRUE(mesh);
  std::mt19937 random(3);
  for (Eigen::Index i = 0; i < mesh->Points.size(); ++i)
  {
    mesh->Points.data()[i] =
      std::ldexp(static_cast<double>(random()) - 1e9, int(random() % 80) - 60);
  }
  for (const bool isBinary : { false, true })
  {
    const auto text = WriteGmshMesh(mesh.Value, isBinary);
    ASSERT_TRUE(text) << text.Status.Message();
    const auto again = ReadGmshMesh(text.Value);
    ASSERT_TRUE(again) << again.Status.Message();
    ExpectSame(mesh.Value, again.Value);
  }
}

TEST(GmshMesh, TruncatedTextsAreErrors)
{
  const auto mesh = ReadGmshMesh(New);
  const auto binary = WriteGmshMesh(mesh.Value, true);
  for (const std::string& text : { New, Old, binary.Value, OldBinary(true) })
  {
    // the last line may lack its end
    for (std::size_t size = 0; size + 1 < text.size(); ++size)
    {
      const auto read = ReadGmshMesh(text.substr(0, size));
      EXPECT_FALSE(read) << size;
      EXPECT_EQ(read.Status.Detail.find('\n'), std::string::npos);
    }
  }
}

TEST(GmshMesh, EveryError)
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
    { "", format, { "$MeshFormat" } },
    { With(New, "4.1 0", "4.0 0"), parameter, { "line 2", "'4.0'", "Mesh.MshFileVersion" } },
    { With(New, "4.1 0 8", "4.1 2 8"), format, { "line 2", "kind of file" } },
    { With(New, "4.1 0 8", "4.1 0 4"), format, { "line 2", "size" } },
    { With(OldBinary(false), std::string("\1\0\0\0", 4), std::string("\2\0\0\0", 4)), format,
      { "byte order", "byte" } },
    { With(New, "$Nodes", "Nodes"), format, { "'Nodes'", "section" } },
    { With(New, "\"plate\"", "plate"), format, { "quotes", "line 7" } },
    { With(New, "1 1 1 0\n4", "1 1 999999999 0\n4"), format, { "no room", "entities" } },
    { With(New, "2 4 1 1000000000", "2 5 1 1000000000"), format, { "less", "$Nodes" } },
    { With(New, "2 4 1 1000000000", "2 3 1 1000000000"), format, { "more", "$Nodes" } },
    { With(New, "2 4 1 1000000000", "2 400000000000 1 1"), format, { "no room" } },
    { With(New, "1\n20\n", "1\n1\n"), topology, { "node 1", "twice" } },
    { With(New, "1 0 0\n1 1 0\n", "1 nan 0\n1 1 0\n"), ErrorCode::NonFiniteInput, { "nan" } },
    { With(New, "1 0 0\n1 1 0\n", "1 x 0\n1 1 0\n"), format, { "'x'", "line" } },
    { With(New, "1 0 0\n1 1 0\n", "1 1e70 0\n1 1 0\n"), ErrorCode::TooLarge, { "1e+60" } },
    { With(New, "2 3 2 2\n", "2 3 14 2\n"), parameter, { "14", "SecondOrderIncomplete" } },
    { With(New, "2 3 2 2\n", "2 3 20 2\n"), parameter, { "type 20", "$Elements" } },
    { With(New, "2 3 2 2\n", "2 3 2 3\n"), format, { "more elements" } },
    { With(New, "3 4 10", "3 5 10"), format, { "1 elements less" } },
    { With(New, "11 1 20", "11 1 21"), topology, { "element 11", "node 21" } },
    { With(New, "900000000 1\n", "900000000 2\n"), topology, { "point element", "node 2" } },
    { With(New, "$EndElements", "$EndElement"), format, { "$EndElements" } },
    { With(New, "$Entities", "$PartitionedEntities"), parameter, { "partitions" } },
    { With(New, "$EndPeriodic", "$Periodic"), format, { "$EndPeriodic", "truncated" } },
    { With(Old, "4\n1 0 0 0", "400000000\n1 0 0 0"), format, { "no room", "nodes" } },
    { With(Old, "4\n9 15", "400000000\n9 15"), format, { "no room", "elements" } },
    { With(Old, "9 15 2", "9 15 -2"), format, { "tags", "'-2'" } },
    { "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n", ErrorCode::EmptyInput, { "no elements" } },
  };
  for (const Case& one : cases)
  {
    const auto read = ReadGmshMesh(one.Text);
    EXPECT_EQ(read.Status.Code, one.Code) << one.Text << read.Status.Message();
    for (const std::string& word : one.Words)
    {
      EXPECT_NE(read.Status.Detail.find(word), std::string::npos)
        << word << ": " << read.Status.Detail;
    }
    EXPECT_EQ(read.Status.Detail.find('\n'), std::string::npos);
  }
  const auto left =
    ReadGmshMesh(New + "$NodeData\n1\n\"T\"\n$EndNodeData\n$Comments\nx\n$EndComments\n");
  ASSERT_TRUE(left);
  EXPECT_EQ(left->LeftOut.size(), 1U);
  EXPECT_TRUE(LooksLikeGmshMesh(New));
  EXPECT_FALSE(LooksLikeGmshMesh("MFEM mesh v1.0"));
}

TEST(GmshMesh, ErrorsOfWriting)
{
  EXPECT_EQ(WriteGmshMesh({}, false).Status.Code, ErrorCode::EmptyInput);
  auto mesh = ReadGmshMesh(New);
  mesh->Groups[0].Name = "a \"quoted\" name";
  EXPECT_EQ(WriteGmshMesh(mesh.Value, true).Status.Code, ErrorCode::InvalidParameter);
  mesh = ReadGmshMesh(New);
  mesh->Kinds[0].Degree = 9;
  mesh->Kinds[1].Degree = 9;
  EXPECT_EQ(WriteGmshMesh(mesh.Value, true).Status.Code, ErrorCode::InvalidParameter);
}

TEST(GmshMesh, ElementsOfOneEntityInOtherGroupsGetEntitiesOfTheirOwn)
{
  const auto old = ReadGmshMesh(Old); // elements 11 and 12 lie on entity 3
  const auto text = WriteGmshMesh(old.Value, false);
  ASSERT_TRUE(text);
  const auto again = ReadGmshMesh(text.Value);
  ASSERT_TRUE(again) << again.Status.Message();
  EXPECT_EQ(again->Entities, (std::vector<int>{ 2, 3, 1 }));
  EXPECT_EQ(
    again->GroupLists[static_cast<std::size_t>(again->GroupListOf[1])], std::vector<int>{ 5 });
  EXPECT_TRUE(again->GroupLists[static_cast<std::size_t>(again->GroupListOf[2])].empty());
}

TEST(GmshMesh, NodesOfEveryTypeFillItsLattice)
{
  // type, nodes of a complete element by Gmsh's manual, and three of its nodes with their places
  struct Type
  {
    int Number;
    std::size_t Nodes;
    std::vector<std::pair<std::size_t, std::array<int, 3>>> Places;
  };
  const std::vector<Type> types = { { 1, 2, {} }, { 8, 3, { { 2, { 1, 0, 0 } } } }, { 26, 4, {} },
    { 27, 5, {} }, { 28, 6, {} }, { 2, 3, {} }, { 9, 6, { { 5, { 0, 1, 0 } } } },
    { 21, 10, { { 9, { 1, 1, 0 } } } }, { 23, 15, { { 12, { 1, 1, 0 } } } }, { 25, 21, {} },
    { 3, 4, {} }, { 10, 9, { { 8, { 1, 1, 0 } } } }, { 36, 16, { { 14, { 2, 2, 0 } } } },
    { 37, 25, {} }, { 38, 36, {} }, { 16, 8, { { 7, { 0, 1, 0 } } } }, { 4, 4, {} },
    { 11, 10, { { 8, { 0, 1, 1 } }, { 9, { 1, 0, 1 } } } }, // Gmsh's last two are not VTK's
    { 29, 20, { { 16, { 1, 1, 0 } }, { 19, { 1, 1, 1 } } } }, { 30, 35, { { 34, { 1, 1, 1 } } } },
    { 31, 56, {} }, { 5, 8, {} }, { 12, 27, { { 26, { 1, 1, 1 } }, { 9, { 0, 1, 0 } } } },
    { 92, 64, {} }, { 93, 125, {} }, { 94, 216, {} }, { 17, 20, { { 19, { 1, 2, 2 } } } },
    { 6, 6, {} }, { 13, 18, { { 8, { 0, 0, 1 } } } }, { 18, 15, {} }, { 7, 5, {} },
    { 19, 13, { { 7, { 0, 0, 1 } } } } };
  for (const Type& type : types)
  {
    std::string text =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" + std::to_string(type.Nodes) + "\n";
    std::string element = "1 " + std::to_string(type.Number) + " 2 0 1";
    for (std::size_t i = 1; i <= type.Nodes; ++i)
    {
      text += std::to_string(i) + " 0 0 0\n";
      element += " " + std::to_string(i);
    }
    const auto mesh =
      ReadGmshMesh(text + "$EndNodes\n$Elements\n1\n" + element + "\n$EndElements\n");
    ASSERT_TRUE(mesh) << type.Number << mesh.Status.Message();
    auto places = mesh->Kinds[0].Places;
    EXPECT_EQ(places.size(), type.Nodes) << type.Number;
    for (const auto& [node, place] : type.Places)
    {
      EXPECT_EQ(places.at(node), place) << type.Number << ", node " << node;
    }
    std::sort(places.begin(), places.end());
    EXPECT_EQ(std::unique(places.begin(), places.end()), places.end()) << type.Number;
  }
}
