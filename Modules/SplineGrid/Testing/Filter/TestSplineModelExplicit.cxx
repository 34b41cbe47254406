// SPDX-License-Identifier: BSD-3-Clause
// Splines by extraction operators travel as grids: written and read bit for bit, recovered from
// moved points, damage found, drawn; what needs a mesh is one error.
#include "FamilyCases.h"
#include "FilterCases.h"
#include "RandomModels.h"
#include <knotwork/SplineCore/ExplicitSpace.h>
#include <knotwork/SplineGrid/FilterErrorCode.h>
#include <knotwork/SplineGrid/vtkSplineRefine.h>
#include <knotwork/SplineGrid/vtkSplineTessellate.h>

#include "vtkDataArray.h"
#include "vtkFeatureEdges.h"
#include "vtkFieldData.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"
#include "vtkXMLUnstructuredGridReader.h"
#include "vtkXMLUnstructuredGridWriter.h"

using namespace knotwork;
using oracle::Random;

namespace
{
template <int Dim>
void AddPatches(Random& random, bool rational, SplineModel& model)
{
  for (const SplineSpacePtr<Dim>& of : knotwork::testing::SpacesOfAllFamilies<Dim>(random))
  {
    const auto made = MakeExplicitSpace<Dim>(ExtractionOf(*of), of->NumFunctions);
    ASSERT_TRUE(made) << made.Status.Message();
    SplinePatch patch;
    patch.Id = 3 + 2 * static_cast<int>(model.Patches.size());
    patch.Geometry = knotwork::testing::RandomSpline<Dim>(random, made.Value, 3, rational);
    patch.Fields.push_back({ "Temperature", PointMatrix::Random(of->NumFunctions, 1) });
    model.Patches.push_back(patch);
  }
}

/// Curves, surfaces and volumes, also of degrees that differ between elements and directions.
SplineModel ExplicitModel(unsigned seed, bool rational)
{
  Random random(seed);
  SplineModel model;
  AddPatches<1>(random, rational, model);
  AddPatches<2>(random, rational, model);
  AddPatches<3>(random, rational, model);
  return model;
}

void ExpectSame(const SplineModel& a, const SplineModel& b)
{
  ASSERT_EQ(a.Patches.size(), b.Patches.size());
  for (const SplinePatch& patch : a.Patches)
  {
    const SplinePatch& other = PatchOf(b, patch.Id);
    std::visit(
      [&](const auto& x)
      {
        const auto& y = std::get<std::decay_t<decltype(x)>>(other.Geometry);
        ASSERT_EQ(y.Space->Kind, SpaceKind::Explicit);
        EXPECT_TRUE(*x.Space->Extraction == *y.Space->Extraction);
        EXPECT_EQ(x.ControlPoints, y.ControlPoints);
        EXPECT_EQ(x.Weights, y.Weights);
      },
      patch.Geometry);
    EXPECT_EQ(patch.Fields[0].Coefficients, other.Fields[0].Coefficients);
    EXPECT_FALSE(other.Recovered);
  }
}
}

TEST(SplineModelExplicit, RoundTrip_ExactOracle)
{
  for (const bool rational : { false, true })
  {
    const SplineModel model = ExplicitModel(rational ? 2 : 1, rational);
    const auto grid = Encode(model);
    ExpectSame(model, Decode(grid));
    const std::string name = std::string(KNOTWORK_OUTPUT_DIR) + "/SplineModelExplicit.vtu";
    vtkNew<vtkXMLUnstructuredGridWriter> writer;
    writer->SetInputData(grid);
    writer->SetFileName(name.c_str());
    ASSERT_EQ(writer->Write(), 1);
    vtkNew<vtkXMLUnstructuredGridReader> reader;
    reader->SetFileName(name.c_str());
    reader->Update();
    ExpectSame(model, Decode(reader->GetOutput()));
  }
}

TEST(SplineModelExplicit, MovedPointsAreRecovered_ExactOracle)
{
  for (const bool rational : { false, true })
  {
    const SplineModel model = ExplicitModel(rational ? 4 : 3, rational);
    const auto grid = Encode(model);
    vtkPoints* points = grid->GetPoints();
    for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
    {
      double x[3];
      points->GetPoint(i, x);
      points->SetPoint(i, x[0] + 1.0, 2.0 * x[1], x[2] - x[0]);
    }
    for (const SplinePatch& patch : Decode(grid).Patches)
    {
      EXPECT_TRUE(patch.Recovered);
      PointMatrix expected = ControlPoints(PatchOf(model, patch.Id));
      expected.col(2) -= expected.col(0);
      expected.col(0).array() += 1.0;
      expected.col(1) *= 2.0;
      // 64 eps of the size 20, times the condition of these bases, some hundred
      EXPECT_LE((ControlPoints(patch) - expected).cwiseAbs().maxCoeff(), 3e-11) << patch.Id;
    }
  }
}

TEST(SplineModelExplicit, DamageIsFound_ExactOracle)
{
  for (const char* name : { "KnotworkExtractionElements", "KnotworkExtractionFunctions",
         "KnotworkExtractionCoefficients" })
  {
    const auto grid = Encode(ExplicitModel(5, false));
    vtkDataArray* array = grid->GetFieldData()->GetArray(name);
    ASSERT_NE(array, nullptr) << name;
    array->SetComponent(1, 0, array->GetComponent(1, 0) + 1);
    EXPECT_EQ(DecodeSplineModel(grid, 0).Status.Code, ErrorCode::InvalidTopology) << name;
    grid->GetFieldData()->RemoveArray(name);
    EXPECT_EQ(DecodeSplineModel(grid, 0).Status.Code, ErrorCode::InvalidTopology) << name;
  }
}

TEST(SplineModelExplicit, IsDrawnWithoutGapsAndNotRefined_ExactOracle)
{
  UnstructuredParams params;
  params.Degree = 3;
  const auto of = MakeUnstructuredSpace<2>(meshes::CubeSphere(3), params)->Space;
  Random random(1);
  SplinePatch patch;
  patch.Geometry = knotwork::testing::RandomSpline<2>(
    random, MakeExplicitSpace<2>(ExtractionOf(*of), of->NumFunctions).Value, 3, false);
  SplineModel model;
  model.Patches.push_back(patch);
  vtkNew<vtkSplineTessellate> tessellate;
  tessellate->SetInputData(Encode(model));
  vtkNew<vtkFeatureEdges> edges;
  edges->SetInputConnection(tessellate->GetOutputPort());
  edges->FeatureEdgesOff();
  edges->ManifoldEdgesOff();
  edges->Update();
  EXPECT_GT(edges->GetPolyDataInput(0)->GetNumberOfCells(), 54);
  EXPECT_EQ(edges->GetOutput()->GetNumberOfCells(), 0);

  vtkNew<vtkSplineRefine> refine;
  vtkNew<MessageRecorder> recorder;
  recorder->Watch(refine);
  refine->SetInputData(Encode(model));
  refine->Update();
  EXPECT_EQ(refine->GetErrorCode(), FilterErrorCode({ ErrorCode::DimensionMismatch, "" }));
  ASSERT_FALSE(recorder->Errors.empty());
  EXPECT_NE(recorder->Errors[0].find("has no mesh to refine"), std::string::npos)
    << recorder->Errors[0];
}
