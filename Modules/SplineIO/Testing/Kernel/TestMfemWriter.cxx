// SPDX-License-Identifier: BSD-3-Clause
// MFEM meshes of elements: what is written is what the reader takes for the same polynomials.
#include <knotwork/SplineIO/AbaqusInput.h>
#include <knotwork/SplineIO/GmshMesh.h>
#include <knotwork/SplineIO/MfemWriter.h>

#include <gtest/gtest.h>

using namespace knotwork;

namespace
{
/// Triangles of group 5 and of none, an edge of group 7, by an edge of degree 1 or 2.
std::string Triangles(bool curved)
{
  const std::string head = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n9\n1 0 0 0\n2 1 0 0\n"
                           "3 0 1 0\n4 1 1 0\n5 0.5 -0.125 0\n6 0.5 0.5 0\n7 0 0.5 0\n"
                           "8 1 0.5 0\n9 0.5 1 0\n$EndNodes\n$Elements\n3\n";
  return head +
    (curved ? "1 8 2 7 1 1 2 5\n2 9 2 5 1 1 2 3 5 6 7\n3 9 2 0 1 2 4 3 8 9 6\n"
            : "1 1 2 7 1 1 2\n2 2 2 5 1 1 2 3\n3 2 2 0 1 2 4 3\n") +
    "$EndElements\n";
}

Result<MfemMesh> ThroughMfem(const std::string& text)
{
  const auto mesh = ReadGmshMesh(text);
  EXPECT_TRUE(mesh) << mesh.Status.Message();
  const auto written = WriteMfemMesh(mesh.Value);
  EXPECT_TRUE(written) << written.Status.Message();
  return ReadMfemMesh(written->Text);
}
}

TEST(MfemWriter, LinearElementsWithAttributes)
{
  const auto mesh = ThroughMfem(Triangles(false));
  ASSERT_TRUE(mesh) << mesh.Status.Message();
  EXPECT_EQ(mesh->NumVertices, 4);
  EXPECT_EQ(mesh->Degree, 0);
  ASSERT_EQ(mesh->Cells.size(), 2U);
  EXPECT_EQ(mesh->Cells[0].Attribute, 5);
  EXPECT_EQ(mesh->Cells[1].Attribute, 8); // one more than the largest group
  EXPECT_EQ(mesh->Cells[1].Corners[1], 3);
  EXPECT_EQ(mesh->Points.row(3), (PointMatrix(1, 3) << 1, 1, 0).finished());
}

TEST(MfemWriter, CurvedElementsAreTheSamePolynomials)
{
  const auto mesh = ThroughMfem(Triangles(true));
  ASSERT_TRUE(mesh) << mesh.Status.Message();
  EXPECT_EQ(mesh->Degree, 2);
  ASSERT_EQ(mesh->CellPoints.size(), 12U);
  // the middle coefficient of an edge is 2 m - (a + b) / 2, with the node m
  EXPECT_NEAR(mesh->Points(mesh->CellPoints[1], 0), 0.5, 1e-14);
  EXPECT_NEAR(mesh->Points(mesh->CellPoints[1], 1), -0.25, 1e-14);
  EXPECT_EQ(mesh->Points.rows(), 9); // neighbours share what is theirs
}

TEST(MfemWriter, EveryError)
{
  EXPECT_EQ(WriteMfemMesh({}).Status.Code, ErrorCode::EmptyInput);
  const auto mixed = ReadGmshMesh(
    Triangles(true).replace(Triangles(true).find("3 9 2 0 1 2 4 3 8 9 6"), 21, "3 2 2 0 1 2 4 3"));
  ASSERT_TRUE(mixed) << mixed.Status.Message();
  const auto refused = WriteMfemMesh(mixed.Value);
  EXPECT_EQ(refused.Status.Code, ErrorCode::InvalidParameter);
  EXPECT_NE(refused.Status.Detail.find("element 3"), std::string::npos);
  auto negative = ReadGmshMesh(Triangles(false));
  for (auto& list : negative->GroupLists)
  {
    list = { -4 };
  }
  EXPECT_NE(WriteMfemMesh(negative.Value).Status.Detail.find("-4"), std::string::npos);
  const auto serendipity =
    ReadAbaqusInput("*NODE\n1,0\n2,1\n3,1,1\n4,0,1\n5,.5\n6,1,.5\n7,.5,1\n8,0,.5\n"
                    "*ELEMENT, TYPE=CPS8\n1,1,2,3,4,5,6,7,8\n");
  ASSERT_TRUE(serendipity) << serendipity.Status.Message();
  EXPECT_EQ(WriteMfemMesh(serendipity.Value).Status.Code, ErrorCode::InvalidParameter);
}
