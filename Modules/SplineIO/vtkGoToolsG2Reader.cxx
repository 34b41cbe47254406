// SPDX-License-Identifier: BSD-3-Clause
#include "vtkGoToolsG2Reader.h"

#include "BoundaryGrid.h"
#include <knotwork/SplineIO/GoToolsG2.h>

#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkUnstructuredGrid.h"

vtkStandardNewMacro(vtkGoToolsG2Reader);

vtkGoToolsG2Reader::vtkGoToolsG2Reader()
{
  this->SetNumberOfOutputPorts(2);
}

int vtkGoToolsG2Reader::FillOutputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkUnstructuredGrid");
  return 1;
}

int vtkGoToolsG2Reader::RequestDataObject(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  return this->MakeDeclaredOutputs(outputs);
}

knotwork::Status vtkGoToolsG2Reader::EncodeMore(
  const knotwork::SplineFile& file, vtkInformationVector* outputs)
{
  return knotwork::EncodeBoundaries(file, vtkUnstructuredGrid::GetData(outputs, 1));
}

knotwork::Result<knotwork::SplineFile> vtkGoToolsG2Reader::Parse(std::string_view text)
{
  return knotwork::ReadG2(text);
}

bool vtkGoToolsG2Reader::Recognize(std::string_view beginning)
{
  return knotwork::LooksLikeG2(beginning) && !knotwork::BeginsWithG2Points(beginning);
}
