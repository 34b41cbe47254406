// SPDX-License-Identifier: BSD-3-Clause
#include "vtkBEXTReader.h"

#include <knotwork/SplineIO/BextFile.h>

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkBEXTReader);

vtkBEXTReader::vtkBEXTReader() = default;

knotwork::Result<knotwork::SplineFile> vtkBEXTReader::Parse(std::string_view text)
{
  return knotwork::ReadBext(text);
}

bool vtkBEXTReader::Recognize(std::string_view beginning)
{
  return knotwork::LooksLikeBext(beginning);
}
