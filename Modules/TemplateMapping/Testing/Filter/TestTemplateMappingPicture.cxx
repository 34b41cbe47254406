// SPDX-License-Identifier: BSD-3-Clause
#include "../Kernel/TemplateCases.h"
#include "Rendering.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/TemplateMapping/TemplateMap.h>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include <gtest/gtest.h>

using namespace knotwork;

namespace
{
void AddLine(
  const PointMatrix& points, int kind, vtkPoints* all, vtkCellArray* lines, vtkIntArray* kinds)
{
  lines->InsertNextCell(static_cast<int>(points.rows()));
  kinds->InsertNextValue(kind);
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    lines->InsertCellPoint(all->InsertNextPoint(points(i, 0), points(i, 1), 0.0));
  }
}
}

// The parameter lines of the map, and the mapped circle: five lobes in a bent grid without folds.
TEST(TemplateMappingPicture, FiveLobes_ImageOracle)
{
  const auto result = MapTemplate(cases::CircleTemplate(2001), cases::LobedTarget());
  ASSERT_TRUE(result);
  const BezierForm<2> form = MakeBezierForm(result->Map);
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> lines;
  vtkNew<vtkIntArray> kinds;
  kinds->SetName("Kind");
  const int count = 24;
  for (int direction = 0; direction < 2; ++direction)
  {
    for (int k = 0; k <= count; ++k)
    {
      PointMatrix parameters(201, 2);
      parameters.col(direction).setConstant(double(k) / count);
      parameters.col(1 - direction) = Eigen::VectorXd::LinSpaced(201, 0.0, 1.0);
      EvaluationBatch batch;
      ASSERT_TRUE(EvaluateParameters(form, parameters, {}, batch));
      AddLine(batch.Values, direction, points, lines, kinds);
    }
  }
  AddLine(result->Skeleton[4].Points, 2, points, lines, kinds);
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetLines(lines);
  data->GetCellData()->AddArray(kinds);
  RenderOptions options;
  options.ColorBy = "Kind";
  EXPECT_TRUE(RenderAndCompare(data, "TemplateMappingFiveLobes", options));
}
