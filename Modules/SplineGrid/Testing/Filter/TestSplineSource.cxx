// SPDX-License-Identifier: BSD-3-Clause
#include "FilterCases.h"
#include <knotwork/SplineCore/Shapes.h>

#include "vtkCellData.h"
#include "vtkDataArray.h"

#include <limits>

using namespace knotwork;

namespace
{
/// The grid holds the patches bit for bit.
void ExpectSame(vtkDataObject* data, const ShapeParams& params)
{
  const SplineModel model = DecodePatches(data);
  const auto shape = MakeShape(params);
  ASSERT_TRUE(shape) << shape.Status.Message();
  ASSERT_EQ(model.Patches.size(), shape.Value.size());
  for (std::size_t p = 0; p < model.Patches.size(); ++p)
  {
    EXPECT_EQ(model.Patches[p].Id, static_cast<int>(p));
    ASSERT_EQ(model.Patches[p].Geometry.index(), shape.Value[p].index());
    std::visit(
      [&](const auto& expected)
      {
        using Spline = std::decay_t<decltype(expected)>;
        const Spline& found = std::get<Spline>(model.Patches[p].Geometry);
        EXPECT_EQ(found.ControlPoints, expected.ControlPoints);
        EXPECT_EQ(found.Weights.size(), expected.Weights.size());
        if (found.Weights.size() == expected.Weights.size())
        {
          EXPECT_EQ(found.Weights, expected.Weights);
        }
        for (std::size_t d = 0; d < expected.Space->Knots.size(); ++d)
        {
          EXPECT_TRUE(found.Space->Knots[d] == expected.Space->Knots[d]);
        }
      },
      shape.Value[p]);
  }
}
}

TEST(vtkSplineSource, EveryShapeIsThatOfTheKernel_CrossOracle)
{
  for (int shape = 0; shape < NumShapeKinds; ++shape)
  {
    ShapeParams params;
    params.Kind = static_cast<ShapeKind>(shape);
    params.InnerRadius = 0.3;
    SCOPED_TRACE(ToString(params.Kind));
    vtkNew<vtkSplineSource> source;
    source->SetInnerRadius(0.3);
    source->SetShapeName(ToString(params.Kind));
    EXPECT_EQ(source->GetShape(), shape);
    source->Update();
    ExpectSame(source->GetOutputDataObject(0), params);
  }
}

TEST(vtkSplineSource, EveryPropertyReachesTheShape_CrossOracle)
{
  for (const ShapeKind kind :
    { ShapeKind::BallSector, ShapeKind::TwistedBar, ShapeKind::SolidTube })
  {
    SCOPED_TRACE(ToString(kind));
    ShapeParams params;
    params.Kind = kind;
    params.InnerRadius = 0.7;
    params.OuterRadius = 1.9;
    params.Angle = 130.0;
    params.Sectors = 3;
    params.PolarAngle = 40.0;
    params.Height = 3.0;
    params.Twist = -140.0;
    params.Size = { 0.5, 0.6, 2.5 };
    params.Center = { 1.0, 2.0, -3.0 };
    params.Degree = 3;
    params.Elements = { 2, 1, 3 };
    vtkNew<vtkSplineSource> source;
    source->SetShape(static_cast<int>(kind));
    source->SetInnerRadius(0.7);
    source->SetOuterRadius(1.9);
    source->SetAngle(130.0);
    source->SetSectors(3);
    source->SetPolarAngle(40.0);
    source->SetHeight(3.0);
    source->SetTwist(-140.0);
    source->SetSize(0.5, 0.6, 2.5);
    source->SetCenter(1.0, 2.0, -3.0);
    source->SetDegree(3);
    source->SetElements(2, 1, 3);
    source->Update();
    ExpectSame(source->GetOutputDataObject(0), params);
  }
}

TEST(vtkSplineSource, DefaultIsTheUnitSquare_GoldenOracle)
{
  vtkNew<vtkSplineSource> source;
  source->Update();
  auto* grid = vtkUnstructuredGrid::SafeDownCast(source->GetOutputDataObject(0));
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->GetNumberOfCells(), 1);
  EXPECT_EQ(grid->GetCellType(0), VTK_BEZIER_QUADRILATERAL);
  double bounds[6];
  grid->GetBounds(bounds);
  const double expected[6] = { -0.5, 0.5, -0.5, 0.5, 0.0, 0.0 };
  for (int i = 0; i < 6; ++i)
  {
    EXPECT_EQ(bounds[i], expected[i]);
  }
}

TEST(vtkSplineSource, BadPropertiesAreRefused)
{
  vtkNew<vtkSplineSource> source;
  source->SetShapeName("Disc");
  source->SetInnerRadius(2.0);
  ExpectFailure(source, ErrorCode::InvalidParameter, "inner radius");
  source->SetInnerRadius(0.5);
  source->SetCenter(0.0, std::numeric_limits<double>::infinity(), 0.0);
  ExpectFailure(source, ErrorCode::InvalidParameter, "centre");
  source->SetCenter(0.0, 0.0, 0.0);
  source->SetElements(1, 1000000, 1);
  ExpectFailure(source, ErrorCode::TooLarge, "MaximumFunctions");
  source->SetElements(1, 1, 1);
  source->Update();
  EXPECT_EQ(source->GetOutputDataObject(0)->GetNumberOfElements(vtkDataObject::CELL), 5);

  vtkNew<MessageRecorder> recorder;
  recorder->Watch(source);
  source->SetShapeName("Dodecahedron");
  source->SetShapeName(nullptr);
  EXPECT_EQ(recorder->Errors.size(), 2u);
  EXPECT_STREQ(source->GetShapeName(), "Disc");
}
