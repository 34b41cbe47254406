// SPDX-License-Identifier: BSD-3-Clause
// Volumes and areas of shapes whose formulas are known; every edge in two triangles.
#include "FilterCases.h"
#include <knotwork/TetMeshing/vtkSplineBoundary.h>

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkVariant.h"

#include <cmath>
#include <map>
#include <set>

using namespace knotwork;

namespace
{
double Number(vtkSplineBoundary* filter, const char* name)
{
  return vtkTable::SafeDownCast(filter->GetOutputDataObject(1))->GetValueByName(0, name).ToDouble();
}

/// Every edge once in each direction.
bool IsWatertight(vtkPolyData* mesh)
{
  std::map<std::pair<vtkIdType, vtkIdType>, int> edges;
  vtkNew<vtkIdList> corners;
  for (vtkIdType t = 0; t < mesh->GetNumberOfCells(); ++t)
  {
    mesh->GetCellPoints(t, corners);
    for (int i = 0; i < 3; ++i)
    {
      ++edges[{ corners->GetId(i), corners->GetId((i + 1) % 3) }];
    }
  }
  return std::all_of(edges.begin(), edges.end(),
    [&](const auto& edge)
    {
      const auto other = edges.find({ edge.first.second, edge.first.first });
      return edge.second == 1 && other != edges.end() && other->second == 1;
    });
}

std::set<int> Values(vtkPolyData* mesh, const char* name)
{
  std::set<int> values;
  for (vtkIdType t = 0; t < mesh->GetNumberOfCells(); ++t)
  {
    values.insert(static_cast<int>(mesh->GetCellData()->GetArray(name)->GetTuple1(t)));
  }
  return values;
}
}

TEST(vtkSplineBoundary, ShapesOfKnownVolume)
{
  const struct
  {
    int Shape;
    double Volume;
    std::set<int> Patches;
    std::set<int> Faces;
  } cases[] = {
    { vtkSplineSource::CUBE, 1.0, { 0 }, { 0, 1, 2, 3, 4, 5 } },
    // outer patches show the outer end of their radial direction, the core nothing
    { vtkSplineSource::BALL, 4.0 / 3.0 * M_PI, { 1, 2, 3, 4, 5, 6 }, { 5 } },
    { vtkSplineSource::SPHERE_SURFACE, 4.0 / 3.0 * M_PI, { 0, 1, 2, 3, 4, 5 }, { 0 } },
    { vtkSplineSource::SOLID_CYLINDER, M_PI, { 0, 1, 2, 3, 4 }, { 1, 4, 5 } },
  };
  for (const auto& c : cases)
  {
    SCOPED_TRACE(c.Shape);
    vtkNew<vtkSplineBoundary> filter;
    filter->SetInputDataObject(ShapeGrid(c.Shape));
    filter->SetChordalTolerance(1e-3);
    filter->Update();
    ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
    auto* mesh = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0));
    EXPECT_TRUE(IsWatertight(mesh));
    EXPECT_EQ(Number(filter, "Closed"), 1);
    EXPECT_EQ(Number(filter, "Triangles"), mesh->GetNumberOfCells());
    // within the chordal bound all around
    EXPECT_NEAR(Number(filter, "Volume"), c.Volume,
      1e-12 + Number(filter, "ChordalBound") * Number(filter, "Area"));
    EXPECT_EQ(Values(mesh, "PatchId"), c.Patches);
    EXPECT_EQ(Values(mesh, "FaceId"), c.Faces);
  }
}

TEST(vtkSplineBoundary, AnOpenSurfaceIsSaidToBeOpen)
{
  vtkNew<vtkSplineBoundary> filter;
  filter->SetInputDataObject(ShapeGrid(vtkSplineSource::DISC));
  filter->Update();
  EXPECT_EQ(Number(filter, "Closed"), 0);
  EXPECT_EQ(Number(filter, "Volume"), 0.0);
  EXPECT_NEAR(Number(filter, "Area"), M_PI, 0.02 * M_PI);
}

TEST(vtkSplineBoundary, CurvesBoundNothing)
{
  vtkNew<vtkSplineBoundary> filter;
  filter->SetInputDataObject(ShapeGrid(vtkSplineSource::ARC));
  ExpectFailure(filter, ErrorCode::DimensionMismatch, "curves bound nothing");
}
