// SPDX-License-Identifier: BSD-3-Clause
// VTK draws an encoded grid as it is.
#include "RandomModels.h"
#include "Rendering.h"
#include <knotwork/SplineCore/HierarchicalSpace.h>
#include <knotwork/SplineCore/Shapes.h>

#include "vtkCellData.h"
#include "vtkDataSetSurfaceFilter.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPolyData.h"

using namespace knotwork;

namespace
{
// A rational annulus (radii 1 and 2, three quarters) of 2 x 6 elements, refined at one end by
// two levels, cells coloured by level.
TEST(SplineModelImage, RefinedRationalAnnulus_GoldenOracle)
{
  ShapeParams params;
  params.Kind = ShapeKind::AnnulusSector;
  params.InnerRadius = 1.0;
  params.OuterRadius = 2.0;
  params.Angle = 270.0;
  params.Elements = { 2, 2, 1 };
  auto shape = MakeShape(params);
  ASSERT_TRUE(shape) << shape.Status.Message();
  const auto& annulus = std::get<Spline<2>>(shape.Value.at(0));
  ASSERT_TRUE(annulus.IsRational());
  auto space =
    RefineBoxes<2>(annulus.Space, { { 1, { 0, 0 }, { 4, 6 } }, { 2, { 2, 0 }, { 6, 6 } } });
  ASSERT_TRUE(space) << space.Status.Message();
  auto refined = TransferToRefined(annulus, space.Value);
  ASSERT_TRUE(refined) << refined.Status.Message();
  SplineModel model;
  model.Patches.resize(1);
  model.Patches[0].Geometry = refined.Value;
  vtkNew<vtkDataSetSurfaceFilter> surface;
  surface->SetInputData(Encode(model));
  surface->SetNonlinearSubdivisionLevel(4);
  surface->Update();
  // Cell edges are those of the triangles: the picture shows the cells by level.
  RenderOptions options;
  options.ColorBy = "Level";
  options.Edges = false;
  EXPECT_TRUE(RenderAndCompare(surface->GetOutput(), "SplineModelAnnulus", options));
}
}
