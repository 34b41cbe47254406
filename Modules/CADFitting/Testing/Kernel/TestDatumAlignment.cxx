// SPDX-License-Identifier: BSD-3-Clause
// Coordinate systems of a part of OpenCASCADE that was moved. Oracle: its places in the part's own.
#include "AlignmentCases.h"
#include <knotwork/CADFitting/DatumAlignment.h>

#include <gtest/gtest.h>

using namespace knotwork;
using namespace alignment;

namespace
{
/// The bracket at another place, and its regions.
struct Found
{
  TriangleMesh Own; ///< in the part's own coordinates
  TriangleMesh Mesh;
  RigidMotion Motion;
  std::vector<RecognizedRegion> Regions;

  explicit Found(unsigned seed) : Own(MeshOf(Bracket(), 0.02)), Motion(Seeded(seed).Motion(50.0))
  {
    this->Mesh = { this->Motion.Move(this->Own.Points), this->Own.Triangles };
    auto regions = RecognizeSurfaces(this->Mesh);
    EXPECT_TRUE(regions) << regions.Status.Message();
    this->Regions = std::move(regions->Regions);
  }

  /// The region of a type on whose surface a point of the part lies, nearest to the bound.
  int At(SurfaceType type, double x, double y, double z) const
  {
    const Eigen::Vector3d place =
      this->Motion.Rotation * Eigen::Vector3d(x, y, z) + this->Motion.Translation;
    for (std::size_t r = 0; r < this->Regions.size(); ++r)
    {
      const AnalyticSurface& surface = this->Regions[r].Surface;
      if (surface.Type == type && std::abs(surface.Distance(place)) < 1e-4)
      {
        return static_cast<int>(r);
      }
    }
    ADD_FAILURE() << "no region at " << x << " " << y << " " << z;
    return 0;
  }
  int Bottom() const { return this->At(SurfaceType::Plane, 9.0, 9.0, 0.0); }
  int Left() const { return this->At(SurfaceType::Plane, 0.0, 3.0, 2.0); }
  int Front() const { return this->At(SurfaceType::Plane, 9.0, 0.0, 2.0); }
  int Hole() const { return this->At(SurfaceType::Cylinder, 7.0, 4.0, 2.0); }
  int Boss() const { return this->At(SurfaceType::Cylinder, 17.0, 7.0, 6.0); }

  DatumAlignment Aligned(const DatumParams& params) const
  {
    const auto found = AlignToDatums(this->Mesh, this->Regions, params);
    EXPECT_TRUE(found) << found.Status.Message();
    return found.Value;
  }
  /// Where points of the part come to, less where they should be: an axis along x and one along z
  /// of the part, and the origin.
  double Error(const DatumAlignment& found, const Eigen::Vector3d& x, const Eigen::Vector3d& z,
    const Eigen::Vector3d& origin) const
  {
    RigidMotion expected;
    expected.Rotation.row(0) = x.normalized().transpose();
    expected.Rotation.row(1) = z.cross(x.normalized()).transpose();
    expected.Rotation.row(2) = z.transpose();
    expected.Translation = -(expected.Rotation * origin);
    return (found.Motion.Move(this->Mesh.Points) - expected.Move(this->Own.Points))
      .cwiseAbs()
      .maxCoeff();
  }
};

using Eigen::Vector3d;
}

TEST(DatumAlignment, PlanesAndAHole_ExactOracle)
{
  for (unsigned seed = 1; seed <= 5; ++seed)
  {
    SCOPED_TRACE(seed);
    const Found part(seed);
    DatumParams params;
    params.Plane = part.Bottom();
    params.Axis = part.Left();
    params.Point = { part.Hole() };
    // outward normals of the bottom and the left side
    DatumAlignment found = part.Aligned(params);
    EXPECT_LE(part.Error(found, -Vector3d::UnitX(), -Vector3d::UnitZ(), { 5.0, 4.0, 0.0 }), 1e-5);
    EXPECT_EQ(found.FreeMotions, 0);
    params.Inward = true;
    found = part.Aligned(params);
    EXPECT_LE(part.Error(found, Vector3d::UnitX(), Vector3d::UnitZ(), { 5.0, 4.0, 0.0 }), 1e-5);
    // three planes meet in a corner
    params.Point = { part.Front() };
    found = part.Aligned(params);
    EXPECT_LE(part.Error(found, Vector3d::UnitX(), Vector3d::UnitZ(), Vector3d::Zero()), 1e-5);
    EXPECT_EQ(found.FreeMotions, 0);
    // from hole to boss
    params.Point = { part.Hole() };
    params.Axis = part.Boss();
    found = part.Aligned(params);
    EXPECT_LE(part.Error(found, { 9.0, 3.0, 0.0 }, Vector3d::UnitZ(), { 5.0, 4.0, 0.0 }), 1e-5);
    EXPECT_EQ(found.FreeMotions, 0);
  }
}

TEST(DatumAlignment, WhatIsFreeIsCounted_ExactOracle)
{
  const Found part(6);
  DatumParams params;
  params.Inward = true;
  const auto z = [&](const DatumAlignment& found)
  { return Vector3d((found.Motion * part.Motion).Rotation.row(2).transpose()); };
  params.Plane = part.Bottom();
  DatumAlignment found = part.Aligned(params);
  EXPECT_EQ(found.FreeMotions, 3);
  EXPECT_LE((z(found) - Vector3d::UnitZ()).norm(), 1e-6);
  params.Axis = part.Left(); // along both sides
  EXPECT_EQ(part.Aligned(params).FreeMotions, 1);
  params.Axis = part.Hole(); // the origin, and no x
  found = part.Aligned(params);
  EXPECT_EQ(found.FreeMotions, 1);
  const PointMatrix centre = Eigen::RowVector3d(5.0, 4.0, 0.0);
  EXPECT_LE((found.Motion * part.Motion).Move(centre).norm(), 1e-5);
  params.Plane = -1;
  found = part.Aligned(params); // along and around the axis
  EXPECT_EQ(found.FreeMotions, 2);
  EXPECT_LE(z(found).cross(Vector3d::UnitZ()).norm(), 1e-6);
  EXPECT_NEAR(found.Motion.Rotation.determinant(), 1.0, 1e-12);
}

TEST(DatumAlignment, CentreOfASphere_ExactOracle)
{
  const TopoDS_Shape shape = BRepAlgoAPI_Fuse(BRepPrimAPI_MakeBox(8.0, 6.0, 2.0).Shape(),
    BRepPrimAPI_MakeSphere(gp_Pnt(3.0, 2.0, 2.5), 1.5).Shape())
                               .Shape();
  const TriangleMesh mesh = MeshOf(shape, 0.01);
  const auto regions = RecognizeSurfaces(mesh);
  ASSERT_TRUE(regions);
  DatumParams params;
  for (std::size_t r = 0; r < regions->Regions.size(); ++r)
  {
    const AnalyticSurface& surface = regions->Regions[r].Surface;
    if (surface.Type == SurfaceType::Sphere)
    {
      params.Point = { static_cast<int>(r) };
    }
    else if (std::abs(surface.Distance({ 1.0, 1.0, 0.0 })) < 1e-6)
    {
      params.Plane = static_cast<int>(r);
    }
  }
  ASSERT_EQ(params.Point.size(), 1u);
  const auto found = AlignToDatums(mesh, regions->Regions, params);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->FreeMotions, 1);
  EXPECT_LE(found->Motion.Move(PointMatrix(Eigen::RowVector3d(3.0, 2.0, 2.5))).norm(), 1e-5);
}

TEST(DatumAlignment, EveryFailureIsReachable)
{
  const Found part(7);
  const auto refused = [&](const DatumParams& params, const char* words)
  {
    const auto found = AlignToDatums(part.Mesh, part.Regions, params);
    EXPECT_EQ(found.Status.Code, ErrorCode::InvalidParameter);
    EXPECT_NE(found.Status.Detail.find(words), std::string::npos) << found.Status.Detail;
  };
  DatumParams params;
  refused(params, "give the region");
  params.Plane = 1000;
  refused(params, "region 1000");
  params.Plane = part.Hole();
  refused(params, "a cylinder");
  params.Plane = part.Bottom();
  params.Axis = part.At(SurfaceType::Plane, 8.0, 11.0, 5.0); // the top
  refused(params, "are parallel");
  params.Axis = part.Left();
  params.Point = { 0, 1, 2, 3 };
  refused(params, "at most three");
  params.Point = { -2 };
  refused(params, "region -2");
  // opposite sides, one and the same, what an axis has fixed
  const int top = part.At(SurfaceType::Plane, 8.0, 11.0, 5.0);
  params.Point = { part.Bottom(), top };
  refused(params, ("region " + std::to_string(top) + " of the datum point fixes nothing").c_str());
  params.Point = { part.Front(), part.Front() };
  refused(params, "fixes nothing");
  params.Point = { part.Hole(), part.Left() };
  refused(params, "fixes nothing");
}
