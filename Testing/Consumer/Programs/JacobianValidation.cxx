// SPDX-License-Identifier: BSD-3-Clause
// A disc of five patches is proved valid.
#include <knotwork/JacobianValidation/vtkJacobianValidator.h>
#include <knotwork/SplineGrid/vtkSplineSource.h>
#include <vtkNew.h>
#include <vtkTable.h>

int main()
{
  vtkNew<vtkSplineSource> disc;
  disc->SetShapeName("Disc");
  vtkNew<vtkJacobianValidator> validator;
  validator->SetInputConnection(disc->GetOutputPort());
  validator->Update();
  auto* summary = vtkTable::SafeDownCast(validator->GetOutputDataObject(2));
  return summary && summary->GetNumberOfRows() == 6 && validator->GetErrorCode() == 0 ? 0 : 1;
}
