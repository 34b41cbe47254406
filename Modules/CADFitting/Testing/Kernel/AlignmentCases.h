// SPDX-License-Identifier: BSD-3-Clause
// Parts that OpenCASCADE makes, as targets and as scans at other places.
#pragma once
#include "OutputFile.h"
#include <knotwork/CADFitting/ModelTarget.h>
#include <knotwork/CADFitting/RigidAlignment.h>
#include <knotwork/CADModel/CADExchange.h>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <gp_Ax2.hxx>

#include <Eigen/Geometry>

#include <map>
#include <random>

namespace alignment
{
using namespace knotwork;

/// A plate with a hole, a boss, a countersink and a step: nothing of it is symmetric.
inline TopoDS_Shape Bracket()
{
  TopoDS_Shape shape = BRepPrimAPI_MakeBox(20.0, 12.0, 5.0).Shape();
  const auto up = [](double x, double y, double z)
  { return gp_Ax2(gp_Pnt(x, y, z), gp_Dir(0, 0, 1)); };
  shape = BRepAlgoAPI_Cut(shape, BRepPrimAPI_MakeCylinder(up(5, 4, -1), 2.0, 8.0).Shape()).Shape();
  shape = BRepAlgoAPI_Fuse(shape, BRepPrimAPI_MakeCylinder(up(14, 7, 4), 3.0, 4.0).Shape()).Shape();
  shape = BRepAlgoAPI_Cut(shape, BRepPrimAPI_MakeCone(up(14, 7, 5), 0.5, 1.5, 4.0).Shape()).Shape();
  return BRepAlgoAPI_Cut(shape, BRepPrimAPI_MakeBox(gp_Pnt(-1, 8, 3), gp_Pnt(4, 13, 6)).Shape())
    .Shape();
}

/// As a file of OpenCASCADE is read.
inline TrimmedModel ModelOf(const TopoDS_Shape& shape)
{
  const std::string file = OutputFile("part.brep");
  BRepTools::Write(shape, file.c_str());
  const auto read = ReadCAD(file);
  EXPECT_TRUE(read) << read.Status.Message();
  return read->Model;
}

inline FitTargetPtr TargetOf(const TopoDS_Shape& shape)
{
  const auto target = MakeModelTarget(ModelOf(shape));
  EXPECT_TRUE(target) << target.Status.Message();
  return target.Value;
}

/// Its triangles; points of common edges are one.
inline TriangleMesh MeshOf(const TopoDS_Shape& shape, double sag)
{
  TriangleMesh mesh;
  const BRepMesh_IncrementalMesh mesher(shape, sag);
  std::map<std::array<long long, 3>, int> numbers;
  std::vector<Eigen::RowVector3d> points;
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next())
  {
    const TopoDS_Face face = TopoDS::Face(it.Current());
    TopLoc_Location place;
    const Handle(Poly_Triangulation) triangles = BRep_Tool::Triangulation(face, place);
    for (int t = 1; !triangles.IsNull() && t <= triangles->NbTriangles(); ++t)
    {
      std::array<int, 3> corners{};
      int ids[3];
      triangles->Triangle(t).Get(ids[0], ids[1], ids[2]);
      for (std::size_t k = 0; k < 3; ++k)
      {
        const gp_Pnt p = triangles->Node(ids[k]).Transformed(place);
        const std::array<long long, 3> key = { std::llround(p.X() * 1e6), std::llround(p.Y() * 1e6),
          std::llround(p.Z() * 1e6) };
        const auto [entry, isNew] = numbers.emplace(key, static_cast<int>(points.size()));
        if (isNew)
        {
          points.emplace_back(p.X(), p.Y(), p.Z());
        }
        corners[k] = entry->second;
      }
      if (face.Orientation() == TopAbs_REVERSED)
      {
        std::swap(corners[0], corners[1]);
      }
      if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0])
      {
        mesh.Triangles.push_back(corners);
      }
    }
  }
  mesh.Points.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    mesh.Points.row(static_cast<Eigen::Index>(i)) = points[i];
  }
  return mesh;
}

/// Numbers that are the same on every machine.
class Seeded
{
public:
  explicit Seeded(unsigned seed) : Engine(seed) {}
  double In(double a, double b)
  {
    return a + (b - a) * (static_cast<double>(this->Engine()) + 0.5) / 4294967296.0;
  }
  double Normal() // Box and Muller
  {
    const double radius = std::sqrt(-2.0 * std::log(this->In(0.0, 1.0)));
    return radius * std::cos(2.0 * EIGEN_PI * this->In(0.0, 1.0));
  }
  RigidMotion Motion(double shift)
  {
    Eigen::Vector4d q(this->Normal(), this->Normal(), this->Normal(), this->Normal());
    q.normalize();
    RigidMotion motion;
    motion.Rotation = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
    motion.Translation = { this->In(-shift, shift), this->In(-shift, shift),
      this->In(-shift, shift) };
    return motion;
  }

private:
  std::mt19937 Engine;
};

/// A cloud on a target with normal noise; a share of its points is anywhere in the target's box.
inline PointMatrix CloudOn(
  const FitTarget& target, int count, double noise, double outliers, Seeded& random)
{
  const TargetSamples samples = target.Samples(4 * count);
  const double step = samples.Areas.sum() / count;
  const Eigen::RowVector3d lower = samples.Points.colwise().minCoeff();
  const Eigen::RowVector3d upper = samples.Points.colwise().maxCoeff();
  PointMatrix cloud(count, 3);
  double sum = 0.0;
  Eigen::Index row = 0;
  for (Eigen::Index i = 0; i < samples.Points.rows() && row < count; ++i)
  {
    for (sum += samples.Areas[i]; sum >= step * (static_cast<double>(row) + 0.5) && row < count;
         ++row)
    {
      const bool isOutlier = random.In(0.0, 1.0) < outliers;
      for (Eigen::Index d = 0; d < 3; ++d)
      {
        cloud(row, d) = isOutlier ? random.In(lower[d], upper[d])
                                  : samples.Points(i, d) + noise * random.Normal();
      }
    }
  }
  return cloud.topRows(row);
}
}
