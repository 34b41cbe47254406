// SPDX-License-Identifier: BSD-3-Clause
#include "vtkGoToolsG2Writer.h"

#include "BoundaryGrid.h"
#include <knotwork/SplineIO/GoToolsG2.h>

#include "vtkAlgorithm.h"
#include "vtkExecutive.h"
#include "vtkInformation.h"
#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkGoToolsG2Writer);

vtkGoToolsG2Writer::vtkGoToolsG2Writer()
{
  this->SetNumberOfInputPorts(2);
}

int vtkGoToolsG2Writer::FillInputPortInformation(int port, vtkInformation* info)
{
  const int done = this->Superclass::FillInputPortInformation(port, info);
  if (port == 1)
  {
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return done;
}

knotwork::Status vtkGoToolsG2Writer::AddMore(knotwork::SplineFile& file)
{
  vtkDataObject* curves =
    this->GetNumberOfInputConnections(1) > 0 ? this->GetExecutive()->GetInputData(1, 0) : nullptr;
  return curves ? knotwork::DecodeBoundaries(curves, file) : knotwork::Status();
}

bool vtkGoToolsG2Writer::Holds(knotwork::SpaceKind kind) const
{
  return kind == knotwork::SpaceKind::Tensor || kind == knotwork::SpaceKind::LocallyRefined;
}

knotwork::Result<std::string> vtkGoToolsG2Writer::Format(const knotwork::SplineFile& file)
{
  return knotwork::WriteG2File(file);
}
