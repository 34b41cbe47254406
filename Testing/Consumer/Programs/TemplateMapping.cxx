// SPDX-License-Identifier: BSD-3-Clause
// A circle of lines is mapped onto itself.
#include <knotwork/SplineGrid/vtkSplineSource.h>
#include <knotwork/TemplateMapping/vtkTemplateMapping.h>
#include <vtkDataSet.h>
#include <vtkNew.h>

int main()
{
  vtkNew<vtkSplineSource> arc;
  arc->SetShapeName("Arc");
  vtkNew<vtkTemplateMapping> mapping;
  mapping->SetInputConnection(0, arc->GetOutputPort());
  mapping->SetInputConnection(1, arc->GetOutputPort());
  mapping->SetIterations(2);
  mapping->Update();
  auto* map = vtkDataSet::SafeDownCast(mapping->GetOutputDataObject(0));
  return map && map->GetNumberOfCells() > 0 ? 0 : 1;
}
