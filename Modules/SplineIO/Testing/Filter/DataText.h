// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "vtkDataObject.h"
#include "vtkSmartPointer.h"
#include "vtkXMLDataObjectWriter.h"
#include "vtkXMLWriter.h"

#include <string>

namespace knotwork::testing
{
/// All that VTK's XML says of a data set, numbers as text that gives them again.
inline std::string TextOf(vtkDataObject* data)
{
  const auto writer = vtkSmartPointer<vtkXMLWriter>::Take(
    vtkXMLDataObjectWriter::NewWriter(data->GetDataObjectType()));
  writer->SetInputDataObject(data);
  writer->SetDataModeToAscii();
  writer->WriteToOutputStringOn();
  writer->Write();
  return writer->GetOutputString();
}
}
