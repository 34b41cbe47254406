// SPDX-License-Identifier: BSD-3-Clause
#include "vtkGoToolsG2Writer.h"

#include "GoToolsG2.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkGoToolsG2Writer);

vtkGoToolsG2Writer::vtkGoToolsG2Writer() = default;

knotwork::Result<std::string> vtkGoToolsG2Writer::Format(const knotwork::SplineFile& file)
{
  return knotwork::WriteG2File(file);
}
