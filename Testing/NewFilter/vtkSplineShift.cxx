// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplineShift.h"

#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPoints.h"
#include "vtkUnstructuredGrid.h"

vtkStandardNewMacro(vtkSplineShift);

vtkSplineShift::vtkSplineShift() = default;

knotwork::Status vtkSplineShift::Compute(
  vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkUnstructuredGrid* output = vtkUnstructuredGrid::GetData(outputs);
  output->DeepCopy(vtkUnstructuredGrid::GetData(inputs[0]));
  for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
  {
    double x[3];
    output->GetPoint(i, x);
    x[this->Way == ALONG_X ? 0 : 2] += this->Distance;
    output->GetPoints()->SetPoint(i, x);
  }
  return {};
}
