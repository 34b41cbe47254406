// SPDX-License-Identifier: BSD-3-Clause
// Locally refined patches travel as grids: written and read bit for bit, recovered from moved
// points, damage found.
#include "RandomModels.h"
#include <knotwork/SplineCore/LRVolume.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkUnstructuredGrid.h"
#include "vtkXMLUnstructuredGridReader.h"
#include "vtkXMLUnstructuredGridWriter.h"

using namespace knotwork;

namespace
{
SplineModel LRModel(bool rational)
{
  const auto tensor =
    MakeTensorSpace<2>({ KnotVector::Uniform(3, 4), KnotVector::Uniform(2, 5, 0.0, 3.0) }).Value;
  Spline<2> start;
  start.Space = tensor;
  start.ControlPoints = PointMatrix::Random(tensor->NumFunctions, 3);
  if (rational)
  {
    start.Weights = Eigen::VectorXd::LinSpaced(tensor->NumFunctions, 0.5, 2.0);
  }
  SplineModel model;
  for (const int id : { 2, 5 })
  {
    std::vector<LRSegment> segments{ { 0, 0.375, 0.0, 1.8 }, { 1, 0.9, 0.0, 1.0, 2 } };
    if (id == 5)
    {
      segments.push_back({ 0, 0.3125, 0.0, 1.8 });
    }
    const auto spline = InsertSegments(start, segments, 0);
    EXPECT_TRUE(spline) << spline.Status.Message();
    SplinePatch patch;
    patch.Id = id;
    patch.Geometry = spline.Value;
    patch.Fields.push_back(
      { "Temperature", PointMatrix::Random(spline.Value.Space->NumFunctions, 1) });
    model.Patches.push_back(patch);
  }
  return model;
}

void ExpectSame(const SplineModel& a, const SplineModel& b)
{
  ASSERT_EQ(a.Patches.size(), b.Patches.size());
  for (const SplinePatch& patch : a.Patches)
  {
    const auto& x = std::get<Spline<2>>(patch.Geometry);
    const SplinePatch& other = PatchOf(b, patch.Id);
    const auto& y = std::get<Spline<2>>(other.Geometry);
    ASSERT_EQ(y.Space->Kind, SpaceKind::LocallyRefined);
    EXPECT_TRUE(x.Space->LocallyRefined->Basis == y.Space->LocallyRefined->Basis);
    EXPECT_EQ(x.ControlPoints, y.ControlPoints);
    EXPECT_EQ(x.Weights, y.Weights);
    EXPECT_EQ(patch.Fields[0].Coefficients, other.Fields[0].Coefficients);
    EXPECT_FALSE(other.Recovered);
  }
}
}

TEST(SplineModelLR, RoundTrip_ExactOracle)
{
  for (const bool rational : { false, true })
  {
    const SplineModel model = LRModel(rational);
    const auto grid = Encode(model);
    ExpectSame(model, Decode(grid));
    // points on common sides are shared: far fewer than elements times points of an element
    EXPECT_LT(grid->GetNumberOfPoints(), 9 * grid->GetNumberOfCells());

    const std::string name = std::string(KNOTWORK_OUTPUT_DIR) + "/SplineModelLR.vtu";
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

TEST(SplineModelLR, MovedPointsAreRecovered_ExactOracle)
{
  const SplineModel model = LRModel(false);
  const auto grid = Encode(model);
  vtkPoints* points = grid->GetPoints();
  for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
  {
    double x[3];
    points->GetPoint(i, x);
    points->SetPoint(i, x[0] + 1.0, 2.0 * x[1], x[2] - x[0]);
  }
  const SplineModel moved = Decode(grid);
  for (const SplinePatch& patch : moved.Patches)
  {
    EXPECT_TRUE(patch.Recovered);
    PointMatrix expected = ControlPoints(PatchOf(model, patch.Id));
    expected.col(2) -= expected.col(0);
    expected.col(0).array() += 1.0;
    expected.col(1) *= 2.0;
    // sums of a few coefficients of size 3, times the condition of the least squares
    EXPECT_LE((ControlPoints(patch) - expected).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(SplineModelLR, DamageIsFound_ExactOracle)
{
  for (const char* name : { "KnotworkMeshLines", "KnotworkLocalKnots", "KnotworkScaling" })
  {
    const auto grid = Encode(LRModel(false));
    vtkDataArray* array = grid->GetFieldData()->GetArray(name);
    ASSERT_NE(array, nullptr) << name;
    array->SetComponent(3, 0, array->GetComponent(3, 0) + 1);
    EXPECT_EQ(DecodeSplineModel(grid, 0).Status.Code, ErrorCode::InvalidTopology) << name;
    grid->GetFieldData()->RemoveArray(name);
    EXPECT_EQ(DecodeSplineModel(grid, 0).Status.Code, ErrorCode::InvalidTopology) << name;
  }
}

/// Surfaces and volumes in one grid share the tables of functions; every patch gets its own rows.
TEST(SplineModelLR, VolumesBesideSurfacesKeepEveryBit_ExactOracle)
{
  SplineModel model = LRModel(false);
  const KnotVector knots = KnotVector::Uniform(2, 4);
  Spline<3> volume;
  volume.Space = MakeTensorSpace<3>({ knots, knots, KnotVector::Uniform(1, 3) }).Value;
  volume.ControlPoints = PointMatrix::Random(volume.Space->NumFunctions, 3);
  const auto refined = InsertRectangles(volume,
    { { 0, 0.375, { 0.0, 0.0 }, { 0.75, 1.0 }, 2 }, { 2, 0.5, { 0.0, 0.25 }, { 0.75, 1.0 } } },
    10000, 0);
  ASSERT_TRUE(refined) << refined.Status.Message();
  SplinePatch patch;
  patch.Id = 3;
  patch.Geometry = refined.Value;
  patch.Fields.push_back(
    { "Temperature", PointMatrix::Random(refined.Value.Space->NumFunctions, 1) });
  model.Patches.insert(model.Patches.begin() + 1, patch);
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->WriteToOutputStringOn();
  writer->SetInputData(Encode(model));
  ASSERT_EQ(writer->Write(), 1);
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->ReadFromInputStringOn();
  reader->SetInputString(writer->GetOutputString());
  reader->Update();
  const SplineModel read = Decode(reader->GetOutput());
  ASSERT_EQ(read.Patches.size(), 3U);
  const SplinePatch& found = PatchOf(read, 3);
  const auto& other = std::get<Spline<3>>(found.Geometry);
  ASSERT_EQ(other.Space->Kind, SpaceKind::LocallyRefined);
  EXPECT_TRUE(LRVolumeOf(*other.Space).Basis == LRVolumeOf(*refined->Space).Basis);
  EXPECT_EQ(other.ControlPoints, refined->ControlPoints);
  EXPECT_EQ(found.Fields[0].Coefficients, patch.Fields[0].Coefficients);
  for (const int id : { 2, 5 })
  {
    EXPECT_TRUE(std::get<Spline<2>>(PatchOf(read, id).Geometry).Space->LocallyRefined->Basis ==
      std::get<Spline<2>>(PatchOf(model, id).Geometry).Space->LocallyRefined->Basis);
  }
}
