// SPDX-License-Identifier: BSD-3-Clause
// Level curves of a part of a sphere.
#include <knotwork/SplineGrid/vtkSplineSource.h>
#include <knotwork/SurfaceFeatures/vtkSplineContour.h>
#include <vtkNew.h>
#include <vtkPolyData.h>

int main()
{
  vtkNew<vtkSplineSource> source;
  source->SetShape(vtkSplineSource::SPHERE_SURFACE);
  vtkNew<vtkSplineContour> contour;
  contour->SetInputConnection(source->GetOutputPort());
  contour->Update();
  auto* lines = vtkPolyData::SafeDownCast(contour->GetOutputDataObject(0));
  return lines && lines->GetNumberOfCells() > 0 ? 0 : 1;
}
