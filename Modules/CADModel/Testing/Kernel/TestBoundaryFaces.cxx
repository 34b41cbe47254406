// SPDX-License-Identifier: BSD-3-Clause
// Volumes of multi-patch models as solids.
#include "CADCases.h"
#include "OutputFile.h"
#include "RandomSplines.h"
#include <knotwork/CADModel/BoundaryFaces.h>
#include <knotwork/CADModel/CADExchange.h>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
std::vector<Spline<3>> Volumes(const ShapeParams& params)
{
  std::vector<Spline<3>> result;
  for (const AnySpline& patch : MakeShape(params).Value)
  {
    result.push_back(std::get<Spline<3>>(patch));
  }
  return result;
}
}

TEST(BoundaryFaces, ShapesAreSolidsOfTheirVolume_ExactOracle)
{
  struct Case
  {
    const char* Name;
    ShapeKind Kind;
    double Angle;
    double Volume;
    std::size_t Faces;
  };
  // OuterRadius 1, InnerRadius 0.5, Height 1, Size 1
  for (const Case& c : { Case{ "cube", ShapeKind::Cube, 90, 1.0, 6 },
         Case{ "tube", ShapeKind::SolidTube, 90, 0.75 * Pi / 4, 6 },
         Case{ "ring", ShapeKind::SolidTube, 360, 0.75 * Pi, 4 },
         Case{ "cylinder", ShapeKind::SolidCylinder, 90, Pi, 14 },
         Case{ "ball", ShapeKind::Ball, 90, 4 * Pi / 3, 6 },
         Case{ "torus", ShapeKind::SolidTorus, 360, Pi * Pi / 2, 4 },
         Case{ "bar", ShapeKind::TwistedBar, 90, 1.0, 6 } })
  {
    SCOPED_TRACE(c.Name);
    ShapeParams params;
    params.Kind = c.Kind;
    params.Angle = c.Angle;
    params.Twist = 45.0;
    const auto model = BoundaryFaces(Volumes(params));
    ASSERT_TRUE(model) << model.Status.Message();
    EXPECT_EQ(model->Faces.size(), c.Faces);
    const std::string file = OutputFile(std::string(c.Name) + ".step");
    const Status written = WriteCAD(model.Value, file);
    ASSERT_TRUE(written) << written.Message();
    const auto summary = CheckCAD(file);
    EXPECT_TRUE(summary->Valid) << (summary->Defects.empty() ? "" : summary->Defects[0]);
    EXPECT_EQ(summary->NumSolids, 1);
    EXPECT_TRUE(summary->Closed);
    if (c.Kind != ShapeKind::TwistedBar) // its volume is only near to that
    {
      EXPECT_NEAR(summary->Volume, c.Volume, 1e-6);
    }
  }
}

TEST(BoundaryFaces, NormalsPointOutwardWhateverTheHand_PropertyOracle)
{
  // the unit cube with two of its directions exchanged: left-handed
  ShapeParams params;
  params.Kind = ShapeKind::Cube;
  std::vector<Spline<3>> cube = Volumes(params);
  for (int turned = 0; turned < 2; ++turned)
  {
    if (turned == 1)
    {
      cube[0].ControlPoints.col(0).swap(cube[0].ControlPoints.col(1));
    }
    const auto model = BoundaryFaces(cube);
    ASSERT_EQ(model->Faces.size(), 6u);
    for (const TrimmedFace& face : model->Faces)
    {
      EvaluationParams evaluation;
      evaluation.Derivatives = 1;
      EvaluationBatch batch;
      EvaluateParameters<2>(
        MakeBezierForm<2>(face.Surface), PointMatrix::Constant(1, 2, 0.5), evaluation, batch);
      const Eigen::Vector3d du = batch.First.row(0).head<3>();
      const Eigen::Vector3d dv = batch.First.row(0).tail<3>();
      const Eigen::Vector3d outward = batch.Values.row(0).transpose(); // about the origin
      EXPECT_GT(du.cross(dv).dot(outward) * (face.Reversed ? -1.0 : 1.0), 0.1);
    }
  }
}

TEST(BoundaryFaces, SeparateVolumesAreBodies_ExactOracle)
{
  ShapeParams params;
  params.Kind = ShapeKind::Cube;
  std::vector<Spline<3>> cubes = Volumes(params);
  cubes.push_back(cubes[0]);
  cubes[1].ControlPoints.col(0).array() += 3.0;
  const auto model = BoundaryFaces(cubes);
  ASSERT_EQ(model->Faces.size(), 12u);
  EXPECT_NE(model->Faces.front().Body, model->Faces.back().Body);
  cubes[1].ControlPoints.col(0).array() -= 2.0; // side by side: one body of ten faces
  EXPECT_EQ(BoundaryFaces(cubes)->Faces.size(), 10u);
}

TEST(BoundaryFaces, WhatEnclosesNoSolidIsSaid_ExactOracle)
{
  // an L of three cubes on feet of one cube each, which meet along an edge
  ShapeParams params;
  params.Kind = ShapeKind::Cube;
  const Spline<3> cube = Volumes(params)[0];
  std::vector<Spline<3>> cubes;
  for (const Eigen::RowVector3d& at :
    { Eigen::RowVector3d(0, 0, 1), { 0, 1, 1 }, { 1, 1, 1 }, { 0, 0, 0 }, { 1, 1, 0 } })
  {
    cubes.push_back(cube);
    cubes.back().ControlPoints.rowwise() += at;
    if (cubes.size() == 4)
    {
      std::vector<std::string> none;
      ASSERT_TRUE(BoundaryFaces(cubes, 1e-6, &none));
      EXPECT_TRUE(none.empty());
    }
  }
  std::vector<std::string> warnings;
  const auto model = BoundaryFaces(cubes, 1e-6, &warnings);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].find("1 edges of the boundary have not just two faces"), 0U) << warnings[0];
  const std::string file = OutputFile("feet.step");
  ASSERT_TRUE(WriteCAD(model.Value, file));
  EXPECT_EQ(CheckCAD(file)->NumSolids, 0);
}

TEST(BoundaryFaces, WrongInputIsNamed_PropertyOracle)
{
  EXPECT_EQ(BoundaryFaces({}).Status.Code, ErrorCode::EmptyInput);
  ShapeParams params;
  params.Kind = ShapeKind::Cube;
  std::vector<Spline<3>> cube = Volumes(params);
  EXPECT_EQ(BoundaryFaces(cube, 0.0).Status.Code, ErrorCode::InvalidParameter);
  cube[0].ControlPoints(3, 1) = std::nan("");
  const auto failed = BoundaryFaces(cube);
  EXPECT_EQ(failed.Status.Code, ErrorCode::NonFiniteInput);
  EXPECT_NE(failed.Status.Detail.find("volume 0"), std::string::npos);
}
