// SPDX-License-Identifier: BSD-3-Clause
#include "vtkBEXTWriter.h"

#include <knotwork/SplineCore/FileEnding.h>
#include <knotwork/SplineIO/BextFile.h>

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkBEXTWriter);

vtkBEXTWriter::vtkBEXTWriter() = default;

bool vtkBEXTWriter::Holds(knotwork::SpaceKind) const
{
  return true;
}

knotwork::Result<std::string> vtkBEXTWriter::Format(const knotwork::SplineFile& file)
{
  return knotwork::LowerEnding(this->FileName) == ".json" ? knotwork::WriteBextJson(file)
                                                          : knotwork::WriteBext(file);
}
