// SPDX-License-Identifier: BSD-3-Clause
// Damaged and foreign meshes: one clear error with the line, in bounded time and memory.
#include <knotwork/SplineIO/MfemMesh.h>

#include <gtest/gtest.h>

#include <random>

using namespace knotwork;

namespace
{
/// A quadrilateral and a triangle.
const std::string Linear =
  "MFEM mesh v1.0\n\ndimension\n2\n\nelements\n2\n1 3 0 1 2 3\n5 2 1 4 2\n\n"
  "boundary\n1\n9 1 0 1\n\nvertices\n5\n2\n0 0\n1 0\n1 1\n0 1\n2 0\n";

const std::string Head = "nodes\nFiniteElementSpace\nFiniteElementCollection: H1_2D_P1\nVDim: 2\n"
                         "Ordering: 1\n";

const std::string Curved = "MFEM mesh v1.0\ndimension\n2\nelements\n1\n1 3 0 1 2 3\nboundary\n0\n"
                           "vertices\n4\n" +
  Head + "0 0\n1 0\n1 1\n0 1\n";

const std::string Nurbs =
  "MFEM NURBS mesh v1.0\ndimension\n2\nelements\n1\n1 3 0 1 2 3\nboundary\n0\nedges\n4\n0 0 1\n"
  "0 3 2\n1 0 3\n1 1 2\nvertices\n4\nknotvectors\n2\n1 2 0 0 1 1\n1 3 0 0 0.5 1 1\nweights\n"
  "1 1 1 1 1 1\nFiniteElementSpace\nFiniteElementCollection: NURBS1\nVDim: 2\nOrdering: 1\n"
  "0 0\n1 0\n1 1\n0 1\n0 0.5\n1 0.5\n";

const std::string Patches =
  "MFEM NURBS mesh v1.0\ndimension\n2\nelements\n1\n1 3 0 1 2 3\nboundary\n0\nedges\n4\n0 0 1\n"
  "0 3 2\n1 0 3\n1 1 2\nvertices\n4\npatches\nknotvectors\n2\n1 2 0 0 1 1\n1 2 0 0 1 1\n"
  "dimension\n2\ncontrolpoints_cartesian\n0 0 1\n1 0 2\n0 1 1\n1 1 1\n";

std::string With(std::string text, const std::string& part, const std::string& replacement)
{
  const std::size_t at = text.find(part);
  EXPECT_NE(at, std::string::npos) << part;
  return at == std::string::npos ? text : text.replace(at, part.size(), replacement);
}

void ExpectOneLine(const Status& status)
{
  EXPECT_FALSE(status.Detail.empty());
  EXPECT_EQ(status.Detail.find('\n'), std::string::npos);
}
}

TEST(MfemErrors, SoundTexts)
{
  for (const std::string* text : { &Linear, &Curved, &Nurbs, &Patches })
  {
    const auto read = ReadMfemMesh(*text);
    EXPECT_TRUE(read) << read.Status.Message();
  }
  EXPECT_TRUE(LooksLikeMfemMesh(Linear));
  EXPECT_FALSE(LooksLikeMfemMesh("MeshVersionFormatted 2"));
  // control points of the form that is not cartesian are multiplied by their weights
  const auto products = ReadMfemMesh(With(Patches, "controlpoints_cartesian", "controlpoints"));
  const auto& spline = std::get<Spline<2>>(products->Splines.Splines.at(0));
  EXPECT_EQ(spline.ControlPoints(1, 0), 0.5);
  EXPECT_EQ(spline.Weights[1], 2.0);
  const auto part = ReadMfemMesh(With(Linear, "2 0\n", "2 0\nmfem_serial_mesh_end\nanything 1 2"));
  ASSERT_TRUE(part);
  EXPECT_EQ(part->Warnings.size(), 1U);
}

TEST(MfemErrors, EveryError)
{
  struct Case
  {
    std::string Text;
    ErrorCode Code;
    std::vector<std::string> Words;
  };
  const auto format = ErrorCode::InvalidFormat;
  const auto topology = ErrorCode::InvalidTopology;
  const auto parameter = ErrorCode::InvalidParameter;
  const std::vector<Case> cases = {
    { "", ErrorCode::EmptyInput, { "empty" } },
    { "# nothing\n", ErrorCode::EmptyInput, { "empty" } },
    { "MeshVersionFormatted 2\nDimension 3\n", parameter, { "line 1", "Medit", ".vtk" } },
    { "hello", format, { "line 1", "'hello'", "MFEM mesh v1.0" } },
    { With(Linear, "v1.0", "v2.0"), parameter, { "line 1", "v2.0", "save" } },
    { With(Linear, "MFEM mesh", "MFEM NC mesh"), parameter, { "NC mesh", "conforming" } },
    { With(Linear, "MFEM mesh", "MFEM INLINE mesh"), parameter, { "INLINE" } },
    { With(Linear, "dimension", "dimensions"), format, { "line 3", "'dimension'" } },
    { With(Linear, "dimension\n2", "dimension\n4"), format, { "line 4", "'4'" } },
    { With(Linear, "elements\n2", "elements\n3"), format, { "line 11", "element 2" } },
    { With(Linear, "elements\n2", "elements\n100000000"), format, { "line 7", "no room" } },
    { With(Linear, "elements\n2", "elements\n-1"), format, { "line 7", "'-1'" } },
    { With(Linear, "elements\n2\n1 3 0 1 2 3\n5 2 1 4 2\n", "elements\n0\n"), ErrorCode::EmptyInput,
      { "no elements" } },
    { With(Linear, "1 3 0", "1 8 0"), format, { "line 8", "geometry type of element 0", "'8'" } },
    { With(Linear, "5 2 1 4 2", "5 4 1 4 2 0"), topology,
      { "line 9", "element 1", "tetrahedron", "dimension 2" } },
    { With(Linear, "9 1 0 1", "9 2 0 1 2"), topology, { "boundary element 0", "triangle" } },
    { With(Linear, "5 2 1 4 2", "5 2 1 5 2"), topology,
      { "element 1", "vertex 5", "there are 5" } },
    { With(Linear, "9 1 0 1", "9 1 0 7"), topology, { "boundary element 0", "vertex 7" } },
    { With(Linear, "5 2 1 4 2", "5 2 1 -4 2"), topology, { "line 9", "'-4'" } },
    { With(Linear, "vertices\n5", "vertices\n100000000"), format, { "no room" } },
    { With(Linear, "5\n2\n0", "5\n4\n0"), format, { "coordinates of a vertex", "'4'" } },
    { With(Linear, "0 1\n2 0", "0 nan\n2 0"), ErrorCode::NonFiniteInput, { "line 21", "nan" } },
    { With(Linear, "0 1\n2 0", "0 1e61\n2 0"), ErrorCode::TooLarge, { "line 21", "larger" } },
    { With(Linear, "0 1\n2 0", "0 x\n2 0"), format, { "line 21", "'x'" } },
    { With(Linear, "\n2 0\n", "\n2\n"), format, { "the text ends", "truncated" } },
    { Linear + "7", format, { "'7'", "behind the last" } },
    { With(Linear, "vertices", "vertex_parents"), parameter, { "not conforming" } },
    { With(Linear, "boundary\n", "attribute_sets\n1\n\"a b 3\nboundary\n"), format,
      { "name of a set", "the text ends" } },
    { With(Curved, "H1_2D_P1", "RT_2D_P1"), parameter, { "'RT_2D_P1'", "H1_2D_P3" } },
    { With(Curved, "H1_2D_P1", "H1_2D_Px"), parameter, { "'H1_2D_Px'" } },
    { With(Curved, "H1_2D_P1", "H1_3D_P1"), ErrorCode::DimensionMismatch, { "dimension 2" } },
    { With(Curved, "H1_2D_P1", "H1_2D_P10"), ErrorCode::InvalidDegree, { "[1, 9]" } },
    { With(Curved, "H1_2D_P1", "L2_2D_P0"), ErrorCode::InvalidDegree, { "[1, 9]" } },
    { With(Curved, "H1_2D_P1", "NURBS1"), parameter, { "MFEM NURBS mesh v1.0" } },
    { With(Curved, "H1_2D_P1", "H1_2D_P9"), format, { "no room", "200" } },
    { With(Curved, "VDim: 2", "VDim: 4"), format, { "VDim", "'4'" } },
    { With(Curved, "Ordering: 1", "Ordering: 2"), format, { "Ordering", "'2'" } },
    { With(Curved, "1 3 0 1 2 3", "1 3 0 1 1 3"), topology, { "element 0", "twice" } },
    { "MFEM mesh v1.0\ndimension\n3\nelements\n1\n1 7 0 1 2 3 4\nboundary\n0\nvertices\n5\n" +
        With(Head, "2D", "3D"),
      parameter, { "element 0", "pyramid", "tetrahedra" } },
    { "MFEM mesh v1.0\ndimension\n3\nelements\n2\n1 5 0 1 2 3 4 5 6 7\n1 4 0 1 2 8\nboundary\n0\n"
      "vertices\n9\n" +
        With(Head, "2D_P1", "3D_P3"),
      topology, { "element 1", "quadrilateral", "triangle" } },
    { With(Nurbs, "1 3 0 1 2 3", "1 2 0 1 2"), topology, { "triangle", "no patch" } },
    { With(Nurbs, "edges\n4\n0 0 1\n", "edges\n3\n"), topology, { "4 edges, of which 3" } },
    { With(Nurbs, "0 3 2", "0 3 4"), topology, { "vertex 4", "there are 4" } },
    { With(Nurbs, "0 3 2", "0 1 0"), topology, { "edge from vertex 1 to 0", "twice" } },
    { With(Nurbs, "0 3 2", "7 3 2"), topology, { "knot vector 7", "there are 2" } },
    { With(Nurbs, "0 3 2", "1 3 2"), topology, { "element 0", "direction 0" } },
    { With(Nurbs, "1 1 2\nvert", "1 2 1\nvert"), ErrorCode::Ok, {} }, // symmetric knots
    { With(With(Nurbs, "0.5", "0.25"), "1 1 2\nvert", "1 2 1\nvert"), topology,
      { "element 0", "direction 1", "order of vertices" } },
    { With(Nurbs, "1 2 0 0 1 1", "0 2 0 0 1 1"), ErrorCode::InvalidDegree, { "knot vector 0" } },
    { With(Nurbs, "1 2 0 0 1 1", "1 2 0 1 0 1"), ErrorCode::InvalidKnots, { "knot vector 0" } },
    { With(Nurbs, "1 2 0 0 1 1", "1 2 -1 0 1 2"), ErrorCode::InvalidKnots,
      { "knot vector 0", "2 times" } },
    { With(Nurbs, "1 3 0 0", "1 300000 0 0"), format, { "no room" } },
    { With(Nurbs, "weights", "periodic\n0\n0\nweights"), parameter, { "'periodic'" } },
    { With(Nurbs, "weights", "mesh_elements\n1\n0\nweights"), parameter, { "'mesh_elements'" } },
    { With(Nurbs, "weights\n1 1", "weights\n1 0"), ErrorCode::InvalidWeight, { "not positive" } },
    { With(Nurbs, "NURBS1", "H1_2D_P1"), parameter, { "NURBS2" } },
    { With(Patches, "1 0 2", "1 0 -2"), ErrorCode::InvalidWeight, { "not positive" } },
    { With(Patches, "controlpoints_cartesian", "points"), format, { "'points'" } },
    { With(Patches, "patches\nknotvectors\n2", "patches\nknotvectors\n3"), format, { "'3'" } },
    { With(Patches, "1 0 2", "1 inf 2"), ErrorCode::NonFiniteInput, { "inf" } },
  };
  for (const Case& one : cases)
  {
    SCOPED_TRACE(one.Text);
    const auto read = ReadMfemMesh(one.Text);
    EXPECT_EQ(read.Status.Code, one.Code) << read.Status.Detail;
    for (const std::string& word : one.Words)
    {
      EXPECT_NE(read.Status.Detail.find(word), std::string::npos)
        << read.Status.Detail << " has no " << word;
    }
    if (!read)
    {
      ExpectOneLine(read.Status);
    }
  }
}

/// Cut anywhere, or with words exchanged: an error of one line or a mesh, never a crash.
TEST(MfemErrors, RandomDamage_PropertyOracle)
{
  std::mt19937 random(5);
  const auto below = [&random](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  const std::vector<std::string> words = { "0", "-1", "1", "7", "2147483647", "1e308", "nan",
    "nodes", "patches", "edges", "\n", " ", "3", "H1_2D_P9", "99999999999999999999" };
  for (int trial = 0; trial < 20000; ++trial)
  {
    const std::array<const std::string*, 4> sound{ &Linear, &Curved, &Nurbs, &Patches };
    std::string text = *sound[below(4)];
    for (std::size_t k = 0; k <= below(3); ++k)
    {
      const std::size_t at = below(text.size());
      const std::string& word = words[below(words.size())];
      below(4) == 0 ? text.resize(at + 1) : static_cast<void>(text.replace(at, below(3), word));
    }
    const auto read = ReadMfemMesh(text);
    if (!read)
    {
      ExpectOneLine(read.Status);
    }
    for (const int point : read->CellPoints)
    {
      ASSERT_LT(point, read->Points.rows()) << text;
    }
  }
}
