// SPDX-License-Identifier: BSD-3-Clause
// Splines on unstructured meshes as files of patches and faces.
#include "FilterCases.h"
#include "MeshCases.h"
#include "OutputFile.h"
#include <knotwork/CADModel/CADExchange.h>
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/MeshSpline.h>
#include <knotwork/SplineCore/Quadrature.h>
#include <knotwork/SplineCore/SplitIntoPatches.h>
#include <knotwork/SplineGrid/vtkUnstructuredSpline.h>
#include <knotwork/SplineIO/DataFile.h>
#include <knotwork/SplineIO/vtkCADWriter.h>
#include <knotwork/SplineIO/vtkGismoXMLReader.h>
#include <knotwork/SplineIO/vtkGismoXMLWriter.h>
#include <knotwork/SplineIO/vtkGoToolsG2Reader.h>
#include <knotwork/SplineIO/vtkGoToolsG2Writer.h>

#include <Eigen/Geometry>

using namespace knotwork;

namespace
{
/// A mesh with its points.
template <int Dim>
struct Shape
{
  CellMesh<Dim> Mesh;
  PointMatrix Points;
};

/// Cells of a lattice, or the facets between those that are in and those that are not.
class Lattice
{
public:
  /// A ring of 3 x 3 x 1 blocks without the one in the middle, each of n cells a direction.
  explicit Lattice(int n) : N(n) {}

  Shape<3> Cells()
  {
    Shape<3> shape;
    this->ForCells(
      [&](const std::array<int, 3>& at)
      {
        for (int corner = 0; corner < 8; ++corner)
        {
          shape.Mesh.Corners.push_back(this->Point(
            { at[0] + (corner & 1), at[1] + (corner >> 1 & 1), at[2] + (corner >> 2) }));
        }
      });
    this->Finish(shape);
    return shape;
  }

  Shape<2> Boundary()
  {
    Shape<2> shape;
    this->ForCells(
      [&](const std::array<int, 3>& at)
      {
        for (int side = 0; side < 6; ++side)
        {
          std::array<int, 3> beside = at;
          beside[side / 2] += side % 2 == 1 ? 1 : -1;
          if (this->IsIn(beside))
          {
            continue;
          }
          const bool swap = SideSign(side) < 0; // normals outward
          const auto directions = SideDirections<3>(side);
          for (int corner = 0; corner < 4; ++corner)
          {
            std::array<int, 3> place = at;
            place[side / 2] += side % 2;
            place[directions[0]] += (swap ? corner >> 1 : corner) & 1;
            place[directions[1]] += (swap ? corner : corner >> 1) & 1;
            shape.Mesh.Corners.push_back(this->Point(place));
          }
        }
      });
    this->Finish(shape);
    return shape;
  }

private:
  bool IsIn(const std::array<int, 3>& at) const
  {
    const auto block = [&](int d) { return at[d] < 0 ? -1 : at[d] / this->N; };
    const bool inBox =
      block(0) >= 0 && block(0) < 3 && block(1) >= 0 && block(1) < 3 && block(2) == 0;
    return inBox && !(block(0) == 1 && block(1) == 1);
  }
  template <typename Visit>
  void ForCells(const Visit& visit) const
  {
    for (int z = 0; z < this->N; ++z)
    {
      for (int y = 0; y < 3 * this->N; ++y)
      {
        for (int x = 0; x < 3 * this->N; ++x)
        {
          if (this->IsIn({ x, y, z }))
          {
            visit({ x, y, z });
          }
        }
      }
    }
  }
  int Point(const std::array<int, 3>& at)
  {
    return this->Numbers.emplace(at, static_cast<int>(this->Numbers.size())).first->second;
  }
  template <int Dim>
  void Finish(Shape<Dim>& shape)
  {
    shape.Mesh.NumPoints = static_cast<int>(this->Numbers.size());
    shape.Points.resize(shape.Mesh.NumPoints, 3);
    for (const auto& [at, number] : this->Numbers)
    {
      shape.Points.row(number) << at[0], at[1], at[2];
    }
    shape.Points /= this->N;
  }

  int N;
  std::map<std::array<int, 3>, int> Numbers;
};

template <int Dim>
Spline<Dim> MakeSpline(const Shape<Dim>& shape, int degree, CreasePolicy policy)
{
  UnstructuredParams params;
  params.Degree = degree;
  params.Policy = policy;
  const auto made = MakeUnstructuredSpace<Dim>(shape.Mesh, params);
  EXPECT_TRUE(made) << made.Status.Message();
  return SplineThroughVertices<Dim>(made->Space, shape.Points, 1).Value;
}

template <int Dim>
vtkSmartPointer<vtkUnstructuredGrid> MakeGrid(const Spline<Dim>& spline)
{
  SplineModel model;
  model.Patches.emplace_back();
  model.Patches[0].Geometry = spline;
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  EXPECT_TRUE(EncodeSplineGrid(model, grid));
  return grid;
}

/// By the divergence theorem, exact for polynomials.
double VolumeInside(const Spline<2>& surface)
{
  const int p = surface.Space->Elements[0].Degree[0];
  const auto rule = MakeElementQuadrature<2>({ 2 * p, 2 * p });
  const BezierForm<2> form = MakeBezierForm(surface, 1);
  EvaluationParams params;
  params.Derivatives = 1;
  EvaluationBatch batch;
  double volume = 0.0;
  for (int e = 0; e < surface.Space->NumElements(); ++e)
  {
    const std::vector<int> elements(static_cast<std::size_t>(rule.Local.rows()), e);
    EXPECT_TRUE(EvaluateElements<2>(form, elements, rule.Local, params, batch));
    for (Eigen::Index i = 0; i < rule.Local.rows(); ++i)
    {
      const Eigen::Vector3d u = batch.First.row(i).head<3>();
      const Eigen::Vector3d v = batch.First.row(i).tail<3>();
      volume += rule.Weights[i] * batch.Values.row(i).transpose().dot(u.cross(v)) / 3.0;
    }
  }
  return volume;
}

std::string Write(vtkDataObject* grid, const std::string& name)
{
  std::string file = OutputFile(name);
  vtkNew<vtkCADWriter> writer;
  vtkNew<MessageRecorder> messages;
  messages->Watch(writer);
  writer->SetInputDataObject(0, grid);
  writer->SetFileName(file.c_str());
  EXPECT_EQ(writer->Write(), 1) << (messages->Errors.empty() ? "" : messages->Errors[0]);
  EXPECT_EQ(messages->Warnings.size(), 1U); // how many faces it becomes
  return file;
}

void ExpectSolid(const Spline<2>& surface, const std::string& name, std::size_t faces)
{
  SCOPED_TRACE(name);
  const auto summary = CheckCAD(Write(MakeGrid(surface), name));
  ASSERT_TRUE(summary) << summary.Status.Message();
  EXPECT_TRUE(summary->Valid) << (summary->Defects.empty() ? "" : summary->Defects[0]);
  EXPECT_TRUE(summary->Closed);
  EXPECT_EQ(summary->NumSolids, 1);
  EXPECT_EQ(summary->NumFreeLoops, 0);
  EXPECT_EQ(summary->NumFaces, static_cast<int>(faces));
  const double volume = VolumeInside(surface);
  EXPECT_GT(volume, 0.0);
  EXPECT_NEAR(summary->Volume, volume, 1e-6 * volume);
}
}

TEST(UnstructuredExport, ClosedSurfacesAreSolidsInStep_CrossOracle)
{
  const CellMesh<2> cube = meshes::CubeSphere(4);
  const Shape<2> sphere{ cube, meshes::CubeSpherePoints(cube, 4) };
  for (const int p : { 2, 3 })
  {
    const std::string degree = std::to_string(p);
    ExpectSolid(MakeSpline(sphere, p, CreasePolicy::Full), "sphere" + degree + ".step", 6);
    const Shape<2> ring = Lattice(4).Boundary();
    for (const auto policy :
      { CreasePolicy::Full, CreasePolicy::Motorcycle, CreasePolicy::Minimal })
    {
      const Spline<2> surface = MakeSpline(ring, p, policy);
      const auto layout = FindSpacePatches(*surface.Space);
      EXPECT_EQ(layout.TJoints.empty(), policy == CreasePolicy::Full);
      ExpectSolid(surface,
        "ring" + degree + "-" + std::to_string(static_cast<int>(policy)) + ".step",
        layout.Patches.size());
    }
  }
}

TEST(UnstructuredExport, ClosedMeshesOfFilesAreSolidsInStep_CrossOracle)
{
  const char* folder = std::getenv("KNOTWORK_UNSTRUCTURED_MESHES");
  if (!folder)
  {
    GTEST_SKIP() << "KNOTWORK_UNSTRUCTURED_MESHES names no folder of meshes";
  }
  for (const char* name : { "bl_rod_764", "gs_bitorus" })
  {
    const auto file = ReadDataFile(std::string(folder) + "/" + name + ".off");
    ASSERT_TRUE(file) << file.Status.Message();
    for (const int degree : { 2, 3 })
    {
      vtkNew<vtkUnstructuredSpline> filter;
      filter->SetInputDataObject(file->Data);
      filter->SetDegree(degree);
      filter->Update();
      const SplineModel model = DecodePatches(filter->GetOutputDataObject(0));
      const auto& surface = std::get<Spline<2>>(model.Patches[0].Geometry);
      const std::size_t faces = FindSpacePatches(*surface.Space).Patches.size();
      EXPECT_LE(faces, 100U);
      ExpectSolid(surface, name + std::to_string(degree) + ".step", faces);
    }
  }
}

TEST(UnstructuredExport, VolumesAreTheirBoundaryInStep_ExactOracle)
{
  const Spline<3> ring = MakeSpline(Lattice(2).Cells(), 2, CreasePolicy::Full);
  const auto summary = CheckCAD(Write(MakeGrid(ring), "volume.step"));
  ASSERT_TRUE(summary) << summary.Status.Message();
  EXPECT_TRUE(summary->Valid);
  EXPECT_EQ(summary->NumSolids, 1);
  EXPECT_NEAR(summary->Volume, 8.0, 1e-6); // linear maps are in the space
}

namespace
{
template <typename Writer, typename Reader>
SplineModel RoundTrip(vtkDataObject* grid, const std::string& name)
{
  const std::string file = OutputFile(name);
  vtkNew<Writer> writer;
  vtkNew<MessageRecorder> messages;
  messages->Watch(writer);
  writer->SetInputDataObject(0, grid);
  writer->SetFileName(file.c_str());
  EXPECT_EQ(writer->Write(), 1);
  vtkNew<Reader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  return DecodePatches(reader->GetOutputDataObject(0));
}
}

TEST(UnstructuredExport, PatchesComeBackFromFiles_ExactOracle)
{
  const CellMesh<2> cube = meshes::CubeSphere(4);
  const Spline<2> sphere =
    MakeSpline<2>({ cube, meshes::CubeSpherePoints(cube, 4) }, 3, CreasePolicy::Full);
  const auto expected = SplitIntoPatches(sphere, 1);
  const auto grid = MakeGrid(sphere);
  const SplineModel xml = RoundTrip<vtkGismoXMLWriter, vtkGismoXMLReader>(grid, "unstructured.xml");
  const SplineModel g2 = RoundTrip<vtkGoToolsG2Writer, vtkGoToolsG2Reader>(grid, "unstructured.g2");
  EXPECT_EQ(xml.Topology.Interfaces.size(), 12U);
  for (const SplineModel* model : { &xml, &g2 })
  {
    ASSERT_EQ(model->Patches.size(), 6U);
    for (std::size_t p = 0; p < 6; ++p)
    {
      EXPECT_EQ(std::get<Spline<2>>(model->Patches[p].Geometry).ControlPoints,
        expected->Patches[p].ControlPoints);
    }
  }
  const SplineModel volumes = RoundTrip<vtkGismoXMLWriter, vtkGismoXMLReader>(
    MakeGrid(MakeSpline(Lattice(2).Cells(), 2, CreasePolicy::Full)), "volumes.xml");
  EXPECT_EQ(volumes.Patches.size(), 8U);
  EXPECT_EQ(volumes.Topology.Interfaces.size(), 8U);
  EXPECT_EQ(volumes.Topology.Boundary.size(), 32U);
}
