// SPDX-License-Identifier: BSD-3-Clause
#include "vtkGismoXMLWriter.h"

#include <knotwork/SplineIO/GismoXml.h>

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkGismoXMLWriter);

vtkGismoXMLWriter::vtkGismoXMLWriter() = default;

bool vtkGismoXMLWriter::Holds(knotwork::SpaceKind kind) const
{
  return kind == knotwork::SpaceKind::Tensor || kind == knotwork::SpaceKind::Hierarchical;
}

knotwork::Result<std::string> vtkGismoXMLWriter::Format(const knotwork::SplineFile& file)
{
  return knotwork::WriteGismoXml(file);
}
