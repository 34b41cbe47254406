// SPDX-License-Identifier: BSD-3-Clause
// A heated disc: the reactions balance the source, four times the area.
#include <knotwork/SplineAnalysis/vtkSplineAnalysis.h>
#include <knotwork/SplineGrid/vtkSplineSource.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkTable.h>

#include <cmath>

int main()
{
  vtkNew<vtkSplineSource> disc;
  disc->SetShapeName("Disc");
  vtkNew<vtkSplineAnalysis> analysis;
  analysis->SetInputConnection(disc->GetOutputPort());
  analysis->SetProblem("{\"source\": 4, \"conditions\": [{\"on\": \"boundary\", \"value\": 0}]}");
  analysis->Update();
  auto* table = vtkTable::SafeDownCast(analysis->GetOutputDataObject(3));
  auto* reaction =
    table ? vtkDataArray::SafeDownCast(table->GetColumnByName("TotalReaction")) : nullptr;
  const double area = 4.0 * std::atan(1.0); // of radius 1
  return reaction && std::abs(reaction->GetComponent(0, 0) + 4.0 * area) < 1e-6 ? 0 : 1;
}
