// SPDX-License-Identifier: BSD-3-Clause
// Faces of a composite as one: what is left of the model, and meshes that lie on the faces and pass
// over the edges between them.
#include "PartFiles.h"
#include <knotwork/CADMeshing/CADQuads.h>

#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>

#include <functional>

using namespace knotwork;

namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// 4 x 3 x 2, the edge x = 4, z = 2 rounded with radius 0.5.
TopoDS_Shape RoundedBox()
{
  const TopoDS_Shape box = BoxAt(gp_Pnt(0, 0, 0), 4, 3, 2);
  BRepFilletAPI_MakeFillet fillet(box);
  for (TopExp_Explorer edge(box, TopAbs_EDGE); edge.More(); edge.Next())
  {
    const BRepExtrema_DistShapeShape one(
      edge.Current(), BRepBuilderAPI_MakeVertex(gp_Pnt(4, 0, 2)).Vertex());
    const BRepExtrema_DistShapeShape other(
      edge.Current(), BRepBuilderAPI_MakeVertex(gp_Pnt(4, 3, 2)).Vertex());
    if (one.Value() < 1e-9 && other.Value() < 1e-9)
    {
      fillet.Add(0.5, TopoDS::Edge(edge.Current()));
      break;
    }
  }
  return fillet.Shape();
}

/// Makes faces a composite by their outward normals amid their edges.
void Group(CADTopology& model, const std::function<bool(const Eigen::Vector3d& normal)>& belongs)
{
  for (std::size_t f = 0; f < model.Faces.size(); ++f)
  {
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    const auto& loop = model.Faces[f].Loops.front();
    for (std::size_t use = 0; use < loop.size(); ++use)
    {
      middle += model.UseParameters(static_cast<int>(f), 0, static_cast<int>(use), 0.5) /
        static_cast<double>(loop.size());
    }
    if (belongs(model.FaceNormal(static_cast<int>(f), middle)))
    {
      model.Faces[f].Name = "composite:1";
    }
  }
}

/// Sides of the mesh along the lines where the rounded edge begins and ends.
int SidesAtRounding(const CADQuads& made)
{
  const auto onLine = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b, double x, double z)
  {
    return (a - Eigen::Vector3d(x, a[1], z)).norm() < 1e-6 &&
      (b - Eigen::Vector3d(x, b[1], z)).norm() < 1e-6;
  };
  int count = 0;
  for (const auto& quad : made.Mesh.Quads)
  {
    for (std::size_t i = 0; i < 4; ++i)
    {
      const Eigen::Vector3d& a = made.Mesh.Points[At(quad[i])];
      const Eigen::Vector3d& b = made.Mesh.Points[At(quad[(i + 1) % 4])];
      count += onLine(a, b, 3.5, 2.0) || onLine(a, b, 4.0, 1.5) ? 1 : 0;
    }
  }
  return count;
}
}

TEST(CompositeQuads, AMeshPassesOverARoundedEdgeAndLiesOnTheFaces_CrossOracle)
{
  const TopoDS_Shape part = RoundedBox();
  CADTopology model = TopologyOf(BREPFile(part));
  ASSERT_EQ(model.Faces.size(), 7u);
  CADQuadsParams params;
  params.EdgeLength = 0.31;
  const auto faceByFace = MeshQuads(model, params);
  ASSERT_TRUE(faceByFace) << faceByFace.Status.Message();
  EXPECT_GT(SidesAtRounding(faceByFace.Value), 0);

  // top, rounding and side
  Group(model, [](const Eigen::Vector3d& normal) { return normal[0] + normal[2] > 0.9; });
  EXPECT_EQ(JoinComposites(model), std::vector<std::string>());
  ASSERT_EQ(model.Faces.size(), 5u);
  EXPECT_EQ(model.Edges.size(), 13u); // 15 without the two between them
  EXPECT_EQ(model.Vertices.size(), 10u);
  EXPECT_EQ(model.Bodies[0].Sides.size(), 5u);
  for (const CADQuadMethod method : { CADQuadMethod::Automatic, CADQuadMethod::Unstructured })
  {
    params.Method = method;
    const auto made = MeshQuads(model, params);
    ASSERT_TRUE(made) << made.Status.Message();
    EXPECT_TRUE(made->Closed);
    EXPECT_EQ(made->EulerNumber, 2);
    EXPECT_GT(made->LeastScaledJacobian, 0.3);
    if (method == CADQuadMethod::Unstructured) // lines of a grid join vertices of its sides
    {
      EXPECT_EQ(SidesAtRounding(made.Value), 0);
    }
    double farthest = 0.0;
    // from the shell: within a solid the distance is 0
    for (TopExp_Explorer shell(part, TopAbs_SHELL); shell.More(); shell.Next())
    {
      for (const Eigen::Vector3d& point : made->Mesh.Points)
      {
        const BRepExtrema_DistShapeShape distance(
          BRepBuilderAPI_MakeVertex(gp_Pnt(point[0], point[1], point[2])).Vertex(),
          shell.Current());
        farthest = std::max(farthest, distance.Value());
      }
    }
    EXPECT_LT(farthest, 1e-9 * model.Diagonal);
  }
}

TEST(CompositeQuads, AClosedCompositeStaysInItsFaces)
{
  CADTopology model = TopologyOf(BREPFile(BoxAt(gp_Pnt(0, 0, 0), 1, 2, 3)));
  Group(model, [](const Eigen::Vector3d&) { return true; });
  const auto said = JoinComposites(model);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_NE(said[0].find("composite 1 (face 0 and others) stays in its faces"), std::string::npos)
    << said[0];
  EXPECT_EQ(model.Faces.size(), 6u);
  EXPECT_EQ(model.Edges.size(), 12u);
  const auto made = MeshQuads(model);
  ASSERT_TRUE(made) << made.Status.Message();
  EXPECT_EQ(made->EulerNumber, 2);
}

TEST(CompositeQuads, FacesThatDoNotHangTogetherAreSaid)
{
  CADTopology model = TopologyOf(BREPFile(BoxAt(gp_Pnt(0, 0, 0), 1, 2, 3)));
  Group(model, [](const Eigen::Vector3d& normal) { return std::abs(normal[2]) > 0.5; });
  const auto said = JoinComposites(model);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_NE(said[0].find("is several faces"), std::string::npos) << said[0];
  EXPECT_EQ(model.Faces.size(), 6u);
}

TEST(CompositeQuads, ACupOfSideAndBottomIsClosedByItsLid_PropertyOracle)
{
  CADTopology model = TopologyOf(BREPFile(CylinderAt(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1), 1.0, 1.0)));
  Group(model, [](const Eigen::Vector3d& normal) { return normal[2] < 0.5; });
  EXPECT_EQ(JoinComposites(model), std::vector<std::string>());
  ASSERT_EQ(model.Faces.size(), 2u);
  EXPECT_EQ(model.Edges.size(), 2u); // the rim, and the seam that stays
  const auto made = MeshQuads(model);
  ASSERT_TRUE(made) << made.Status.Message();
  EXPECT_TRUE(made->Closed);
  EXPECT_EQ(made->EulerNumber, 2);
}
