// SPDX-License-Identifier: BSD-3-Clause
// Solids cut in memory: the same as cut in a file.
#include "PartFiles.h"
#include <knotwork/CADModel/CADPieces.h>

#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

using namespace knotwork;

namespace
{
const gp_Dir Up(0, 0, 1);

TopoDS_Shape Stepped()
{
  return BRepAlgoAPI_Fuse(
    CylinderAt(gp_Pnt(0, 0, 0), Up, 2, 3), CylinderAt(gp_Pnt(0, 0, 3), Up, 1, 2))
    .Shape();
}

bool IsPlane(const CADOperation& cut, const Eigen::Vector3d& point, const Eigen::Vector3d& normal)
{
  return cut.Kind == CADOperationKind::CutByPlane &&
    cut.Direction.cross(normal).norm() < 1e-9 * cut.Direction.norm() &&
    std::abs(normal.dot(cut.Point - point)) < 1e-9;
}
}

TEST(CADPieces, CutsAtConcaveEdgesComeFirstThenPlanesThroughAxes_GoldenOracle)
{
  const auto pieces = CADPieces::Read(STEPFile(Stepped(), "pieces.step"));
  ASSERT_TRUE(pieces) << pieces.Status.Message();
  const auto cuts = pieces->Cuts();
  ASSERT_TRUE(cuts);
  ASSERT_EQ(cuts->size(), 4u);
  // the circle where both cylinders meet has a plane and the smaller cylinder
  const auto first = cuts->begin();
  const auto isShoulder = [&](const CADOperation& cut) {
    return IsPlane(cut, { 0, 0, 3 }, Eigen::Vector3d::UnitZ());
  };
  const auto isCylinder = [](const CADOperation& cut)
  { return cut.Kind == CADOperationKind::CutByFace; };
  EXPECT_TRUE((isShoulder(first[0]) && isCylinder(first[1])) ||
    (isCylinder(first[0]) && isShoulder(first[1])));
  EXPECT_TRUE(IsPlane(first[2], { 0, 0, 0 }, Eigen::Vector3d::UnitX()));
  EXPECT_TRUE(IsPlane(first[3], { 0, 0, 0 }, Eigen::Vector3d::UnitY()));
  // through the middle of a ball in all directions of the file
  const auto ball = CADPieces::Read(BREPFile(BRepPrimAPI_MakeSphere(gp_Pnt(1, 2, 3), 2).Shape()));
  ASSERT_TRUE(ball);
  const auto planes = ball->Cuts();
  ASSERT_TRUE(planes);
  ASSERT_EQ(planes->size(), 3u);
  for (int d = 0; d < 3; ++d)
  {
    EXPECT_TRUE(
      IsPlane(planes.Value[static_cast<std::size_t>(d)], { 1, 2, 3 }, Eigen::Vector3d::Unit(d)));
  }
}

TEST(CADPieces, PiecesAreThoseOfTheFile_CrossOracle)
{
  const std::string file = STEPFile(Stepped(), "pieces.step");
  const auto pieces = CADPieces::Read(file);
  ASSERT_TRUE(pieces);
  const auto cuts = pieces->Cuts();
  ASSERT_TRUE(cuts);
  for (const CADOperation& cut : cuts.Value)
  {
    const auto behind = pieces->Cut(cut);
    ASSERT_TRUE(behind) << behind.Status.Message();
    const auto here = behind->Topology();
    ASSERT_TRUE(here);
    ASSERT_TRUE(ModifyCAD(file, OutputFile("pieces.brep"), { cut }));
    const auto there = CADTopology::Read(OutputFile("pieces.brep"));
    ASSERT_TRUE(there);
    EXPECT_EQ(here->Bodies.size(), there->Bodies.size());
    EXPECT_EQ(here->Faces.size(), there->Faces.size());
    EXPECT_EQ(here->Edges.size(), there->Edges.size());
    EXPECT_EQ(here->Vertices.size(), there->Vertices.size());
    EXPECT_NEAR(here->Diagonal, there->Diagonal, 1e-9);
  }
  // what was cut stays as it was
  const auto uncut = pieces->Topology();
  ASSERT_TRUE(uncut);
  EXPECT_EQ(uncut->Bodies.size(), 1u);
}

TEST(CADPieces, WhatCannotBeCutIsSaid)
{
  const auto pieces = CADPieces::Read(STEPFile(Stepped(), "pieces.step"));
  ASSERT_TRUE(pieces);
  CADOperation beside;
  beside.Kind = CADOperationKind::CutByPlane;
  beside.Point = { 0, 0, 100 };
  EXPECT_EQ(pieces->Cut(beside).Status.Code, ErrorCode::OutsideDomain);
  EXPECT_EQ(CADPieces::Read("no.step").Status.Code, ErrorCode::FileError);
}
