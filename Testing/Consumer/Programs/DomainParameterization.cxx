// SPDX-License-Identifier: BSD-3-Clause
// Sides that are no boundary are refused with a message.
#include <knotwork/DomainParameterization/vtkDomainParameterization.h>
#include <knotwork/SplineGrid/vtkSplineSource.h>
#include <vtkNew.h>
#include <vtkObject.h>

int main()
{
  vtkObject::GlobalWarningDisplayOff(); // the message is expected
  vtkNew<vtkSplineSource> line;
  line->SetShapeName("Line");
  vtkNew<vtkDomainParameterization> domain;
  domain->SetInputConnection(line->GetOutputPort());
  domain->Update();
  return domain->GetErrorCode() != 0 ? 0 : 1;
}
