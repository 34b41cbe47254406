// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDomainBoundaryReader.h"

#include <knotwork/SplineIO/BextFile.h>
#include <knotwork/SplineIO/BoundaryJson.h>

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkDomainBoundaryReader);

vtkDomainBoundaryReader::vtkDomainBoundaryReader() = default;

knotwork::Result<knotwork::SplineFile> vtkDomainBoundaryReader::Parse(std::string_view text)
{
  return knotwork::ReadBoundaryJson(text);
}

bool vtkDomainBoundaryReader::Recognize(std::string_view beginning)
{
  return knotwork::LooksLikeBoundaryJson(beginning) && !knotwork::LooksLikeBextJson(beginning);
}
