// SPDX-License-Identifier: BSD-3-Clause
#include "MeshCases.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/MeshSpline.h>
#include <knotwork/SplineCore/PatchFaces.h>
#include <knotwork/SplineCore/SplitIntoPatches.h>
#include <knotwork/SplineCore/TensorSpace.h>
#include <knotwork/SplineCore/UnstructuredSpace.h>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

using namespace knotwork;
using namespace meshes;

namespace
{
template <int Dim>
Spline<Dim> RandomSpline(Random& random, const CellMesh<Dim>& mesh, int degree, CreasePolicy policy)
{
  UnstructuredParams params;
  params.Degree = degree;
  params.Policy = policy;
  if (random.Unit() < 0.3)
  {
    params.Features = RandomFacets<Dim>(random, mesh);
  }
  auto made = MakeUnstructuredSpace<Dim>(mesh, params);
  EXPECT_TRUE(made) << made.Status.Message();
  Spline<Dim> spline;
  spline.Space = made->Space;
  spline.ControlPoints.resize(spline.Space->NumFunctions, 3);
  for (Eigen::Index i = 0; i < spline.ControlPoints.size(); ++i)
  {
    spline.ControlPoints.data()[i] = random.In(-1.0, 1.0);
  }
  return spline;
}

/// Faces that use each edge.
std::vector<int> UsesOfEdges(const TrimmedModel& model)
{
  std::vector<int> uses(static_cast<std::size_t>(model.NumEdges), 0);
  for (const TrimmedFace& face : model.Faces)
  {
    for (const TrimmingCurve& use : face.Loops[0].Curves)
    {
      ++uses[static_cast<std::size_t>(use.Edge)];
    }
  }
  return uses;
}

/// Curves lie on the surfaces of all faces that use them.
void ExpectCurvesOnSurfaces(const TrimmedModel& model)
{
  for (const TrimmedFace& face : model.Faces)
  {
    ASSERT_EQ(face.Loops.size(), 1U);
    const BezierForm<2> surface = MakeBezierForm(face.Surface, 1);
    for (const TrimmingCurve& use : face.Loops[0].Curves)
    {
      const double begin = use.Curve.Space->Knots[0].Begin();
      const double end = use.Curve.Space->Knots[0].End();
      PointMatrix parameters(7, 1);
      for (int i = 0; i < 7; ++i)
      {
        parameters(i, 0) = begin + (end - begin) * i / 6.0;
      }
      EvaluationBatch onCurve;
      EvaluationBatch plane;
      EvaluationBatch onSurface;
      ASSERT_TRUE(EvaluateParameters<1>(MakeBezierForm(use.Curve, 1), parameters, {}, onCurve));
      ASSERT_TRUE(
        EvaluateParameters<1>(MakeBezierForm(use.ParameterCurve(), 1), parameters, {}, plane));
      ASSERT_TRUE(EvaluateParameters<2>(surface, plane.Values, {}, onSurface));
      // dual functionals amplify rounding by some hundred
      EXPECT_LE((onCurve.Values - onSurface.Values).cwiseAbs().maxCoeff(), 1e-10);
    }
  }
}
}

TEST(PatchFaces, RandomSurfacesAreFacesWithEdgesInCommon_PropertyOracle)
{
  for (unsigned seed = 1; seed <= 300; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto policy = static_cast<CreasePolicy>(1 + seed % 3);
    const CellMesh<2> mesh = RandomMesh<2>(random, 60);
    const auto model = FacesOfPatches(RandomSpline(random, mesh, random.Int(1, 3), policy), 1);
    ASSERT_TRUE(model) << model.Status.Message();
    ASSERT_TRUE(model->Check()) << model->Check().Message();
    ExpectCurvesOnSurfaces(model.Value);
    const std::vector<int> uses = UsesOfEdges(model.Value);
    EXPECT_LE(*std::max_element(uses.begin(), uses.end()), 2);
    const bool closed = MeshTopology<2>::Make(mesh)->NumBoundaryFacets == 0;
    EXPECT_EQ(*std::min_element(uses.begin(), uses.end()) == 2, closed);
  }
}

TEST(PatchFaces, RandomVolumesHaveClosedBoundaries_PropertyOracle)
{
  int closed = 0;
  int withTJoints = 0;
  for (unsigned seed = 1; seed <= 300; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto policy = seed % 2 == 0 ? CreasePolicy::Full : CreasePolicy::Minimal;
    const CellMesh<3> mesh = RandomMesh<3>(random, 60);
    const auto model = FacesOfPatches(RandomSpline(random, mesh, random.Int(1, 3), policy), 1);
    if (!model) // cells that meet at a point alone, or have no boundary at all
    {
      const ErrorCode code = model.Status.Code;
      EXPECT_TRUE(code == ErrorCode::InvalidTopology || code == ErrorCode::EmptyInput)
        << model.Status.Message();
      continue;
    }
    ++closed;
    ASSERT_TRUE(model->Check()) << model->Check().Message();
    ExpectCurvesOnSurfaces(model.Value);
    const std::vector<int> uses = UsesOfEdges(model.Value);
    EXPECT_EQ(*std::min_element(uses.begin(), uses.end()), 2);
    EXPECT_EQ(*std::max_element(uses.begin(), uses.end()), 2);
    const auto isCut = [](const TrimmedFace& face) { return face.Loops[0].Curves.size() > 4; };
    withTJoints += std::any_of(model->Faces.begin(), model->Faces.end(), isCut) ? 1 : 0;
  }
  EXPECT_GE(closed, 280);
  EXPECT_GE(withTJoints, 20);
}

namespace
{
/// Signed volume inside of faces, by the divergence theorem: exact for flat faces.
double VolumeInside(const TrimmedModel& model, int body)
{
  double volume = 0.0;
  for (const TrimmedFace& face : model.Faces)
  {
    if (face.Body != body)
    {
      continue;
    }
    EvaluationParams params;
    params.Derivatives = 1;
    EvaluationBatch batch;
    const auto box = face.Surface.Space->Domain();
    const PointMatrix middle = (PointMatrix(1, 2) << 0.5 * (box.Lower[0] + box.Upper[0]),
      0.5 * (box.Lower[1] + box.Upper[1]))
                                 .finished();
    EXPECT_TRUE(EvaluateParameters<2>(MakeBezierForm(face.Surface, 1), middle, params, batch));
    const Eigen::Vector3d u = batch.First.row(0).head<3>();
    const Eigen::Vector3d v = batch.First.row(0).tail<3>();
    const double area = (box.Upper[0] - box.Lower[0]) * (box.Upper[1] - box.Lower[1]);
    volume += (face.Reversed ? -1.0 : 1.0) * area * batch.Values.row(0).transpose().dot(u.cross(v));
  }
  return volume / 3.0;
}
}

TEST(PatchFaces, BoundariesOfVolumesAreTurnedOutward_ExactOracle)
{
  // two boxes apart, the second one left-handed, with a cell left out in its middle
  CellMesh<3> mesh;
  std::vector<std::array<double, 3>> points;
  std::map<std::array<int, 4>, int> numbers;
  for (int box = 0; box < 2; ++box)
  {
    for (int cell = 0; cell < 27; ++cell)
    {
      for (int corner = 0; cell != 13 && corner < 8; ++corner)
      {
        const std::array<int, 4> at{ box, cell % 3 + corner % 2, cell / 3 % 3 + corner / 2 % 2,
          cell / 9 + corner / 4 };
        const auto [found, isNew] = numbers.try_emplace(at, static_cast<int>(points.size()));
        if (isNew)
        {
          points.push_back({ at[1] + 10.0 * box, 1.0 * at[2], 1.0 * (box == 0 ? at[3] : -at[3]) });
        }
        mesh.Corners.push_back(found->second);
      }
    }
  }
  mesh.NumPoints = static_cast<int>(points.size());
  UnstructuredParams params;
  params.Degree = 2;
  const auto made = MakeUnstructuredSpace<3>(mesh, params);
  ASSERT_TRUE(made) << made.Status.Message();
  PointMatrix vertices(mesh.NumPoints, 3);
  for (int i = 0; i < mesh.NumPoints; ++i)
  {
    const auto& [x, y, z] = points[static_cast<std::size_t>(i)];
    vertices.row(i) << x, y, z;
  }
  const auto model = FacesOfPatches(SplineThroughVertices<3>(made->Space, vertices, 1).Value, 1);
  ASSERT_TRUE(model) << model.Status.Message();
  const double tolerance = 1e-10; // dual functionals amplify rounding by some hundred
  EXPECT_NEAR(VolumeInside(model.Value, 0), 26.0, tolerance);
  EXPECT_NEAR(VolumeInside(model.Value, 1), 26.0, tolerance);
  EXPECT_EQ(VolumeInside(model.Value, 2), 0.0);
}

TEST(PatchFaces, KnownModels_ExactOracle)
{
  Random random(1);
  const auto cube = FacesOfPatches(RandomSpline(random, CubeSphere(4), 3, CreasePolicy::Full), 1);
  ASSERT_TRUE(cube) << cube.Status.Message();
  EXPECT_EQ(cube->Faces.size(), 6U);
  EXPECT_EQ(cube->NumEdges, 12);
  EXPECT_EQ(cube->NumVertices, 8);
  const auto torus = FacesOfPatches(
    RandomSpline(random, Grid<2>({ 6, 5 }, { true, true }), 3, CreasePolicy::Full), 1);
  EXPECT_EQ(torus->NumEdges, 2);
  EXPECT_EQ(torus->NumVertices, 1);
  // Euler characteristic of two tubes apart
  CellMesh<2> two = Grid<2>({ 4, 5 }, { true, false });
  const std::vector<int> first = two.Corners;
  for (const int point : first)
  {
    two.Corners.push_back(point + two.NumPoints);
  }
  two.NumPoints *= 2;
  const auto tubes = FacesOfPatches(RandomSpline(random, two, 2, CreasePolicy::Full), 1);
  ASSERT_EQ(tubes->Faces.size(), 2U);
  EXPECT_EQ(tubes->Faces[0].Body, tubes->Faces[1].Body); // parts turned inward are cavities
  EXPECT_EQ(tubes->NumEdges, 6);
  EXPECT_EQ(tubes->NumVertices, 4);
}

TEST(PatchFaces, RationalSurfacesHaveNoLoops_ExactOracle)
{
  Random random(1);
  Spline<2> surface = RandomSpline(random, Star(5, 2), 2, CreasePolicy::Full);
  surface.Weights = Eigen::VectorXd::Constant(surface.Space->NumFunctions, 2.0);
  const auto model = FacesOfPatches(surface, 1);
  ASSERT_TRUE(model) << model.Status.Message();
  ASSERT_EQ(model->Faces.size(), 5U);
  EXPECT_TRUE(model->Faces[0].Loops.empty());
  EXPECT_TRUE(model->Check());
}

TEST(PatchFaces, EveryFailureIsReachable_ExactOracle)
{
  Random random(1);
  EXPECT_EQ(FacesOfPatches(Spline<2>(), 1).Status.Code, ErrorCode::EmptyInput);
  Spline<2> surface = RandomSpline(random, Star(5, 2), 2, CreasePolicy::Full);
  surface.ControlPoints = PointMatrix(surface.ControlPoints.leftCols(2));
  EXPECT_EQ(FacesOfPatches(surface, 1).Status.Code, ErrorCode::SizeMismatch);
  EXPECT_EQ(FacesOfPatches(Spline<3>(), 1).Status.Code, ErrorCode::EmptyInput);
  Spline<3> volume = RandomSpline(random, Blocks<3>(1, 2), 2, CreasePolicy::Full);
  volume.ControlPoints = PointMatrix(volume.ControlPoints.leftCols(2));
  EXPECT_EQ(FacesOfPatches(volume, 1).Status.Code, ErrorCode::SizeMismatch);
  Spline<3> box;
  box.Space = MakeTensorSpace<3>({ KnotVector::Uniform(1, 1, 0, 1), KnotVector::Uniform(1, 1, 0, 1),
                                   KnotVector::Uniform(1, 1, 0, 1) })
                .Value;
  EXPECT_EQ(FacesOfPatches(box, 1).Status.Code, ErrorCode::DimensionMismatch);
}
