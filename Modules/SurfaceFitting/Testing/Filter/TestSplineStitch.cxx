// SPDX-License-Identifier: BSD-3-Clause
#include <knotwork/SurfaceFitting/vtkSplineStitch.h>

#include "FilterCases.h"
#include "HeightTiles.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SurfaceFitting/StitchTiles.h>

#include "vtkTable.h"
#include "vtkVariant.h"

#include <limits>

using namespace knotwork;

namespace
{
double Number(vtkSplineStitch* filter, const char* name)
{
  return vtkTable::SafeDownCast(filter->GetOutputDataObject(2))->GetValueByName(0, name).ToDouble();
}
}

TEST(SplineStitchFilter, Defaults_ExactOracle)
{
  vtkNew<vtkSplineStitch> filter;
  EXPECT_EQ(filter->GetContinuity(), 1);
  EXPECT_EQ(filter->GetMatching(), vtkSplineStitch::DOMAIN_BOXES);
  EXPECT_EQ(filter->GetTolerance(), 1e-6);
}

TEST(SplineStitchFilter, OneGridAndManyInputsAndTheKernel_CrossOracle)
{
  const std::vector<SplinePatch> patches = FourTiles(0.05);
  for (const int continuity : { 0, 1 })
  {
    vtkNew<vtkSplineStitch> one;
    one->SetContinuity(continuity);
    one->SetInputDataObject(GridOfPatches(patches));
    one->Update();
    vtkNew<vtkSplineStitch> many;
    many->SetContinuity(continuity);
    many->AddInputDataObject(GridOfPatches({ patches[0] }));
    many->AddInputDataObject(
      Collect({ GridOfPatches({ patches[1] }), GridOfPatches({ patches[2] }) }));
    many->AddInputDataObject(GridOfPatches({ patches[3] }));
    many->Update();
    std::vector<Spline<2>> tiles;
    for (const SplinePatch& patch : patches)
    {
      tiles.push_back(std::get<Spline<2>>(patch.Geometry));
    }
    StitchParams params;
    params.Continuity = continuity;
    const auto kernel = StitchTiles(tiles, params);
    ASSERT_TRUE(kernel);
    const SplineModel a = DecodePatches(one->GetOutputDataObject(0));
    const SplineModel b = DecodePatches(many->GetOutputDataObject(0));
    ASSERT_EQ(a.Patches.size(), 4u);
    ASSERT_EQ(b.Patches.size(), 4u);
    for (std::size_t t = 0; t < 4; ++t)
    {
      const auto& x = std::get<Spline<2>>(a.Patches[t].Geometry);
      const auto& y = std::get<Spline<2>>(b.Patches[t].Geometry);
      EXPECT_EQ(x.Space->Kind, SpaceKind::LocallyRefined);
      EXPECT_EQ(x.ControlPoints, y.ControlPoints);
      EXPECT_EQ(x.ControlPoints, kernel->Tiles[t].ControlPoints);
      EXPECT_EQ(a.Patches[t].Id, static_cast<int>(t));
      ASSERT_EQ(a.Patches[t].Fields.size(), 1u);
      EXPECT_EQ(a.Patches[t].Fields[0].Name, "Slope");
    }
    EXPECT_EQ(Number(one, "Edges"), 4);
    EXPECT_EQ(Number(one, "MaxChange"), kernel->MaxChange);
    EXPECT_GT(Number(one, "MaxJumpBefore"), 0.05);
    EXPECT_LE(Number(one, "MaxJump"), 1e-13);
    EXPECT_EQ(Number(one, "MaxSlopeJump") <= 1e-11, continuity == 1);
    vtkTable* edges = vtkTable::SafeDownCast(one->GetOutputDataObject(1));
    EXPECT_EQ(edges->GetNumberOfRows(), 4);
    EXPECT_EQ(edges->GetValueByName(0, "TileB").ToInt(), 1);
  }
}

TEST(SplineStitchFilter, FieldsAreStitchedAlong_PropertyOracle)
{
  vtkNew<vtkSplineStitch> filter;
  filter->SetInputDataObject(GridOfPatches(FourTiles(0.05)));
  filter->Update();
  const SplineModel model = DecodePatches(filter->GetOutputDataObject(0));
  // tiles 0 and 1 meet at u = 1; the field as a spline of its own
  std::array<EvaluationBatch, 2> batches;
  PointMatrix at(50, 2);
  for (int i = 0; i < 50; ++i)
  {
    at.row(i) << 1.0, i / 50.0;
  }
  for (std::size_t t = 0; t < 2; ++t)
  {
    Spline<2> field = std::get<Spline<2>>(model.Patches[t].Geometry);
    field.ControlPoints = model.Patches[t].Fields[0].Coefficients;
    EvaluationParams first;
    first.Derivatives = 1;
    ASSERT_TRUE(EvaluateParameters(MakeBezierForm(field), at, first, batches[t]));
  }
  EXPECT_LE((batches[0].Values - batches[1].Values).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_LE((batches[0].First - batches[1].First).cwiseAbs().maxCoeff(), 1e-11);
}

TEST(SplineStitchFilter, PairsAndGeometry_CrossOracle)
{
  const std::vector<SplinePatch> patches = FourTiles(0.0);
  std::vector<vtkSmartPointer<vtkUnstructuredGrid>> results;
  for (const int matching :
    { vtkSplineStitch::DOMAIN_BOXES, vtkSplineStitch::PAIRS, vtkSplineStitch::GEOMETRY })
  {
    vtkNew<vtkSplineStitch> filter;
    filter->SetMatching(matching);
    filter->SetTolerance(matching == vtkSplineStitch::GEOMETRY ? 0.05 : 1e-6);
    filter->AddPair(0, 1, 1, 0, 0);
    filter->AddPair(0, 3, 2, 2, 0);
    filter->AddPair(1, 3, 3, 2, 0);
    filter->AddPair(2, 1, 3, 0, 0);
    filter->SetInputDataObject(GridOfPatches(patches));
    filter->Update();
    EXPECT_EQ(Number(filter, "Edges"), 4);
    results.push_back(vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0)));
  }
  const SplineModel a = DecodePatches(results[0]);
  for (std::size_t m = 1; m < results.size(); ++m)
  {
    SCOPED_TRACE(m);
    const SplineModel b = DecodePatches(results[m]);
    for (std::size_t t = 0; t < 4; ++t)
    {
      EXPECT_EQ(std::get<Spline<2>>(a.Patches[t].Geometry).ControlPoints,
        std::get<Spline<2>>(b.Patches[t].Geometry).ControlPoints);
    }
  }
  // the tiles' sides differ by some hundredths: to a narrow tolerance they are other places
  vtkNew<vtkSplineStitch> narrow;
  narrow->SetMatching(vtkSplineStitch::GEOMETRY);
  narrow->SetTolerance(1e-9);
  narrow->SetInputDataObject(GridOfPatches(patches));
  ExpectFailure(narrow, ErrorCode::InvalidTopology, "share");
}

TEST(SplineStitchFilter, IdsThatAreNotUniqueAreNumbered_PropertyOracle)
{
  std::vector<SplinePatch> patches = FourTiles(0.1);
  vtkNew<vtkSplineStitch> filter;
  for (SplinePatch& patch : patches)
  {
    patch.Id = 7;
    filter->AddInputDataObject(GridOfPatches({ patch }));
  }
  filter->Update();
  const SplineModel model = DecodePatches(filter->GetOutputDataObject(0));
  ASSERT_EQ(model.Patches.size(), 4u);
  EXPECT_EQ(model.Patches[3].Id, 3);
}

TEST(SplineStitchFilter, BadInput_ExactOracle)
{
  vtkNew<vtkSplineStitch> filter;
  ExpectBadInputIsRefused(filter);
  filter->SetInputDataObject(ShapeGrid(vtkSplineSource::CUBE));
  ExpectFailure(filter, ErrorCode::DimensionMismatch, "not a surface");
  filter->SetInputDataObject(ShapeGrid(vtkSplineSource::DISC));
  ExpectFailure(filter, ErrorCode::InvalidTopology, "overlap");
  std::vector<SplinePatch> patches = FourTiles(0.0);
  patches[2].Fields.clear();
  filter->SetInputDataObject(GridOfPatches({ patches[0] }));
  filter->AddInputDataObject(GridOfPatches({ patches[2] }));
  ExpectFailure(filter, ErrorCode::SizeMismatch, "tile 1");
  filter->SetMatching(vtkSplineStitch::PAIRS);
  filter->AddPair(0, 1, 4, 0, 0);
  filter->SetInputDataObject(GridOfPatches(FourTiles(0.0)));
  ExpectFailure(filter, ErrorCode::InvalidParameter, "tile 4");
  filter->ClearPairs();
  filter->SetMatching(vtkSplineStitch::DOMAIN_BOXES);
  filter->Update();
  EXPECT_EQ(Number(filter, "Edges"), 4) << "the filter works again";
}

TEST(SplineStitchFilter, ReportsProgressAndAborts_PropertyOracle)
{
  vtkNew<vtkSplineStitch> filter;
  filter->SetInputDataObject(GridOfPatches(FourTiles(0.1)));
  ExpectProgressAndAbort(filter, 1);
}
