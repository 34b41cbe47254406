// SPDX-License-Identifier: BSD-3-Clause
#include "MeshCases.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/PatchFaces.h>
#include <knotwork/SplineCore/SplitIntoPatches.h>
#include <knotwork/SplineCore/UnstructuredSpace.h>

#include <gtest/gtest.h>

using namespace knotwork;
using namespace meshes;

namespace
{
Spline<2> RandomSurface(Random& random, const CellMesh<2>& mesh, int degree, CreasePolicy policy)
{
  UnstructuredParams params;
  params.Degree = degree;
  params.Policy = policy;
  if (random.Unit() < 0.3)
  {
    params.Features = RandomFacets<2>(random, mesh);
  }
  auto made = MakeUnstructuredSpace<2>(mesh, params);
  EXPECT_TRUE(made) << made.Status.Message();
  Spline<2> surface;
  surface.Space = made->Space;
  surface.ControlPoints.resize(surface.Space->NumFunctions, 3);
  for (Eigen::Index i = 0; i < surface.ControlPoints.size(); ++i)
  {
    surface.ControlPoints.data()[i] = random.In(-1.0, 1.0);
  }
  return surface;
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
    const auto model = FacesOfPatches(RandomSurface(random, mesh, random.Int(1, 3), policy), 1);
    ASSERT_TRUE(model) << model.Status.Message();
    ASSERT_TRUE(model->Check()) << model->Check().Message();
    ExpectCurvesOnSurfaces(model.Value);
    std::vector<int> uses(static_cast<std::size_t>(model->NumEdges), 0);
    for (const TrimmedFace& face : model->Faces)
    {
      for (const TrimmingCurve& use : face.Loops[0].Curves)
      {
        ++uses[static_cast<std::size_t>(use.Edge)];
      }
    }
    EXPECT_LE(*std::max_element(uses.begin(), uses.end()), 2);
    const bool closed = MeshTopology<2>::Make(mesh)->NumBoundaryFacets == 0;
    EXPECT_EQ(*std::min_element(uses.begin(), uses.end()) == 2, closed);
  }
}

TEST(PatchFaces, KnownModels_ExactOracle)
{
  Random random(1);
  const auto cube = FacesOfPatches(RandomSurface(random, CubeSphere(4), 3, CreasePolicy::Full), 1);
  ASSERT_TRUE(cube) << cube.Status.Message();
  EXPECT_EQ(cube->Faces.size(), 6U);
  EXPECT_EQ(cube->NumEdges, 12);
  EXPECT_EQ(cube->NumVertices, 8);
  const auto torus = FacesOfPatches(
    RandomSurface(random, Grid<2>({ 6, 5 }, { true, true }), 3, CreasePolicy::Full), 1);
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
  const auto tubes = FacesOfPatches(RandomSurface(random, two, 2, CreasePolicy::Full), 1);
  ASSERT_EQ(tubes->Faces.size(), 2U);
  EXPECT_EQ(tubes->Faces[0].Body, tubes->Faces[1].Body); // parts turned inward are cavities
  EXPECT_EQ(tubes->NumEdges, 6);
  EXPECT_EQ(tubes->NumVertices, 4);
}

TEST(PatchFaces, RationalSurfacesHaveNoLoops_ExactOracle)
{
  Random random(1);
  Spline<2> surface = RandomSurface(random, Star(5, 2), 2, CreasePolicy::Full);
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
  Spline<2> surface = RandomSurface(random, Star(5, 2), 2, CreasePolicy::Full);
  surface.ControlPoints = PointMatrix(surface.ControlPoints.leftCols(2));
  EXPECT_EQ(FacesOfPatches(surface, 1).Status.Code, ErrorCode::SizeMismatch);
}
