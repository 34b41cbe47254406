// SPDX-License-Identifier: BSD-3-Clause
#include "vtkGismoXMLReader.h"

#include <knotwork/SplineIO/GismoXml.h>

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkGismoXMLReader);

vtkGismoXMLReader::vtkGismoXMLReader() = default;

knotwork::Result<knotwork::SplineFile> vtkGismoXMLReader::Parse(std::string_view text)
{
  return knotwork::ReadGismoXml(text);
}

bool vtkGismoXMLReader::Recognize(std::string_view beginning)
{
  return knotwork::LooksLikeGismoXml(beginning);
}
