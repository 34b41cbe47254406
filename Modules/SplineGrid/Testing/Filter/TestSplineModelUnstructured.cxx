// SPDX-License-Identifier: BSD-3-Clause
// Splines on unstructured meshes travel as grids: written and read bit for bit, recovered from
// moved points, damage found, refined and drawn by the filters for all families.
#include "FilterCases.h"
#include "MeshCases.h"
#include "RandomModels.h"
#include <knotwork/SplineCore/MeshTraces.h>
#include <knotwork/SplineCore/SheetRefinement.h>
#include <knotwork/SplineGrid/vtkSplineExtract.h>
#include <knotwork/SplineGrid/vtkSplineRefine.h>
#include <knotwork/SplineGrid/vtkSplineTessellate.h>

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkFeatureEdges.h"
#include "vtkFieldData.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"
#include "vtkXMLUnstructuredGridReader.h"
#include "vtkXMLUnstructuredGridWriter.h"

using namespace knotwork;

namespace
{
template <int Dim>
SplinePatch MakePatch(const CellMesh<Dim>& mesh, CreasePolicy policy, bool rational, int id)
{
  UnstructuredParams params;
  params.Degree = 2;
  params.Policy = policy;
  const auto sheets = MeshTopology<Dim>::Make(mesh).Value.FindSheets();
  for (int s = 0; rational && s < sheets.Count; ++s)
  {
    params.Lengths.push_back(1.0 + 0.25 * (s % 3));
  }
  const auto made = MakeUnstructuredSpace<Dim>(mesh, params);
  EXPECT_TRUE(made) << made.Status.Message();
  Spline<Dim> spline;
  spline.Space = made->Space;
  spline.ControlPoints = PointMatrix::Random(made->Space->NumFunctions, 3);
  if (rational)
  {
    spline.Weights = Eigen::VectorXd::LinSpaced(made->Space->NumFunctions, 0.5, 2.0);
  }
  SplinePatch patch;
  patch.Id = id;
  patch.Geometry = spline;
  patch.Fields.push_back({ "Temperature", PointMatrix::Random(made->Space->NumFunctions, 1) });
  return patch;
}

/// Surfaces and volumes, closed and bounded, with rows of averages and without.
SplineModel UnstructuredModel(bool rational)
{
  SplineModel model;
  model.Patches.push_back(MakePatch<2>(meshes::CubeSphere(4), CreasePolicy::Minimal, rational, 3));
  model.Patches.push_back(MakePatch<2>(meshes::Star(5, 3), CreasePolicy::Full, rational, 4));
  model.Patches.push_back(
    MakePatch<3>(meshes::Sweep(meshes::Star(3, 2), 3), CreasePolicy::Minimal, rational, 7));
  return model;
}

template <int Dim>
void ExpectSamePatch(const SplinePatch& a, const SplinePatch& b)
{
  const auto& x = std::get<Spline<Dim>>(a.Geometry);
  const auto& y = std::get<Spline<Dim>>(b.Geometry);
  ASSERT_EQ(y.Space->Kind, SpaceKind::Unstructured);
  EXPECT_EQ(MeshOf(*x.Space).Corners, MeshOf(*y.Space).Corners);
  EXPECT_EQ(ContinuityOf(*x.Space), ContinuityOf(*y.Space));
  EXPECT_EQ(x.Space->FactorData, y.Space->FactorData);
  EXPECT_EQ(x.ControlPoints, y.ControlPoints);
  EXPECT_EQ(x.Weights, y.Weights);
  EXPECT_EQ(a.Fields[0].Coefficients, b.Fields[0].Coefficients);
  EXPECT_FALSE(b.Recovered);
}

void ExpectSame(const SplineModel& a, const SplineModel& b)
{
  ASSERT_EQ(a.Patches.size(), b.Patches.size());
  ExpectSamePatch<2>(a.Patches[0], PatchOf(b, 3));
  ExpectSamePatch<2>(a.Patches[1], PatchOf(b, 4));
  ExpectSamePatch<3>(a.Patches[2], PatchOf(b, 7));
}
}

TEST(SplineModelUnstructured, RoundTrip_ExactOracle)
{
  for (const bool rational : { false, true })
  {
    const SplineModel model = UnstructuredModel(rational);
    const auto grid = Encode(model);
    ExpectSame(model, Decode(grid));
    const std::string name = std::string(KNOTWORK_OUTPUT_DIR) + "/SplineModelUnstructured.vtu";
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

TEST(SplineModelUnstructured, MovedPointsAreRecovered_ExactOracle)
{
  const SplineModel model = UnstructuredModel(false);
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
    // 64 eps of the size 2, times the amplification of the dual functionals, below 50
    EXPECT_LE((ControlPoints(patch) - expected).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(SplineModelUnstructured, DamageIsFound_ExactOracle)
{
  for (const char* name : { "KnotworkMeshCorners", "KnotworkFacetContinuity" })
  {
    const auto grid = Encode(UnstructuredModel(false));
    vtkDataArray* array = grid->GetFieldData()->GetArray(name);
    ASSERT_NE(array, nullptr) << name;
    array->SetComponent(3, 0, array->GetComponent(3, 0) + 1);
    EXPECT_EQ(DecodeSplineModel(grid, 0).Status.Code, ErrorCode::InvalidTopology) << name;
    grid->GetFieldData()->RemoveArray(name);
    EXPECT_EQ(DecodeSplineModel(grid, 0).Status.Code, ErrorCode::InvalidTopology) << name;
  }
}

TEST(SplineModelUnstructured, IsRefinedAndDrawnWithoutGaps_ExactOracle)
{
  SplineModel model;
  model.Patches.push_back(MakePatch<2>(meshes::CubeSphere(3), CreasePolicy::Full, false, 1));
  vtkNew<vtkSplineRefine> refine;
  refine->SetInputData(Encode(model));
  refine->SetNumberOfRefinements(1);
  refine->Update();
  const SplineModel fine = Decode(refine->GetOutputDataObject(0));
  ASSERT_EQ(fine.Patches.size(), 1U);
  EXPECT_EQ(KindOf(fine.Patches[0]), SpaceKind::Unstructured);
  EXPECT_EQ(NumElements(fine.Patches[0]), 4 * 54);
  EXPECT_EQ(NumFunctions(fine.Patches[0]), 6 * 49 + 2); // n = 6, p = 2
  vtkNew<vtkSplineTessellate> tessellate;
  tessellate->SetInputConnection(refine->GetOutputPort());
  vtkNew<vtkFeatureEdges> edges;
  edges->SetInputConnection(tessellate->GetOutputPort());
  edges->FeatureEdgesOff();
  edges->ManifoldEdgesOff();
  edges->Update();
  EXPECT_GT(edges->GetPolyDataInput(0)->GetNumberOfCells(), 216);
  EXPECT_EQ(edges->GetOutput()->GetNumberOfCells(), 0);
}

TEST(SplineModelUnstructured, SheetsThroughMarkedCellsAreHalved_CrossOracle)
{
  SplineModel model;
  model.Patches.push_back(MakePatch<2>(meshes::Star(5, 3), CreasePolicy::Full, true, 4));
  const auto grid = Encode(model);
  vtkNew<vtkIntArray> mark;
  mark->SetName("Mark");
  mark->SetNumberOfValues(grid->GetNumberOfCells());
  mark->FillValue(0);
  mark->SetValue(7, 1);
  grid->GetCellData()->AddArray(mark);
  vtkNew<vtkSplineRefine> filter;
  filter->SetInputData(grid);
  filter->SetMode(vtkSplineRefine::CELL_ARRAY);
  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "Mark");
  filter->SetLowerThreshold(1.0);
  filter->Update();
  const SplineModel refined = DecodePatches(filter->GetOutputDataObject(0));
  ASSERT_EQ(refined.Patches.size(), 1U);
  const auto& spline = std::get<Spline<2>>(model.Patches[0].Geometry);
  const auto sheets = MeshTopology<2>::Make(MeshOf(*spline.Space)).Value.FindSheets();
  const auto expected = HalveSheets(spline, { sheets.Of[14], sheets.Of[15] });
  ASSERT_TRUE(expected);
  const auto& found = std::get<Spline<2>>(refined.Patches[0].Geometry);
  EXPECT_EQ(found.Space->NumElements(), 45 + 12 + 1); // two sheets of six cells cross in one
  EXPECT_EQ(MeshOf(*found.Space).Corners, MeshOf(*expected->Value.Space).Corners);
  // grids hold points, not coefficients
  EXPECT_LE((found.ControlPoints - expected->Value.ControlPoints).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ(refined.Patches[0].Fields.size(), 1U);
}

// The ends of the curves' elements are points of the surface, on its boundary.
TEST(SplineModelUnstructured, BoundaryOfASurfaceIsCurves_ExactOracle)
{
  SplineModel model;
  model.Patches.push_back(MakePatch<2>(meshes::Star(5, 2), CreasePolicy::Full, true, 7));
  model.Patches.push_back(MakePatch<2>(meshes::Grid<2>({ 5, 3 }, { true, false }),
    CreasePolicy::Full, true, 2)); // a ring: two closed curves
  vtkNew<vtkSplineExtract> filter;
  filter->SetInputData(Encode(model));
  filter->BoundaryOn();
  filter->Update();
  const SplineModel taken = DecodePatches(filter->GetOutputDataObject(0));
  std::size_t place = 0;
  std::vector<int> ids;
  for (const SplinePatch& patch : model.Patches)
  {
    const auto& surface = std::get<Spline<2>>(patch.Geometry);
    const auto topology = MeshTopology<2>::Make(MeshOf(*surface.Space)).Value;
    const auto traces = TraceOnFacets(*surface.Space, BoundaryFacets(topology));
    ASSERT_TRUE(traces) << traces.Status.Message();
    EXPECT_EQ(traces->size(), patch.Id == 7 ? 1U : 2U);
    for (const MeshTrace<1>& trace : traces.Value)
    {
      ASSERT_LT(place, taken.Patches.size());
      const SplinePatch& found = taken.Patches[place++];
      ids.push_back(found.Id);
      const auto& curve = std::get<Spline<1>>(found.Geometry);
      const Spline<1> expected = TraceOf<1>(surface, trace);
      EXPECT_EQ(curve.Space->NumElements(), expected.Space->NumElements());
      EXPECT_LE((curve.ControlPoints - expected.ControlPoints).cwiseAbs().maxCoeff(), 1e-12);
      EXPECT_EQ(found.Fields.size(), patch.Fields.size());
    }
  }
  EXPECT_EQ(place, taken.Patches.size());
  EXPECT_EQ(ids, (std::vector<int>{ 7, 2, 8 }));
}

TEST(SplineModelUnstructured, BoundaryOfAVolumeIsOneSurface_ExactOracle)
{
  SplineModel model;
  model.Patches.push_back(
    MakePatch<3>(meshes::Sweep(meshes::Star(3, 2), 3), CreasePolicy::Full, true, 7));
  vtkNew<vtkSplineExtract> filter;
  filter->SetInputData(Encode(model));
  filter->BoundaryOn();
  filter->Update();
  const SplineModel taken = DecodePatches(filter->GetOutputDataObject(0));
  ASSERT_EQ(taken.Patches.size(), 1U);
  EXPECT_EQ(taken.Patches[0].Id, 7);
  const auto& surface = std::get<Spline<2>>(taken.Patches[0].Geometry);
  const auto& volume = std::get<Spline<3>>(model.Patches[0].Geometry);
  const auto topology = MeshTopology<3>::Make(MeshOf(*volume.Space)).Value;
  const auto trace = TraceOnFacets(*volume.Space, BoundaryFacets(topology));
  ASSERT_TRUE(trace) << trace.Status.Message();
  EXPECT_EQ(surface.Space->Kind, SpaceKind::Unstructured);
  EXPECT_EQ(surface.Space->NumElements(), 2 * 12 + 3 * 12);
  const Spline<2> expected = TraceOf<2>(volume, trace.Value);
  EXPECT_LE((surface.ControlPoints - expected.ControlPoints).cwiseAbs().maxCoeff(), 1e-12);
  ASSERT_EQ(taken.Patches[0].Fields.size(), 1U);
  EXPECT_EQ(taken.Patches[0].Fields[0].Coefficients.rows(), surface.Space->NumFunctions);

  filter->SetIsoCurve(vtkSplineExtract::FIRST);
  ExpectFailure(filter, ErrorCode::DimensionMismatch, "patch 7");
  filter->SetIsoCurve(vtkSplineExtract::NONE);
  filter->SetInputData(Encode(UnstructuredModel(false))); // begins with a closed surface
  ExpectFailure(filter, ErrorCode::EmptyInput, "patch 3: no facets");
  filter->SetInputData(ShapeGrid(vtkSplineSource::SQUARE));
  ExpectFailure(filter, ErrorCode::DimensionMismatch, "only surfaces and volumes on unstructured");
  model.Patches[0] =
    MakePatch<3>(meshes::Sweep(meshes::CubeSphere(1), 3, true), CreasePolicy::Full, false, 7);
  filter->SetInputData(Encode(model)); // closed
  ExpectFailure(filter, ErrorCode::EmptyInput, "patch 7: no facets");
}
