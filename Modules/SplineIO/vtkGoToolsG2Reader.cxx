// SPDX-License-Identifier: BSD-3-Clause
#include "vtkGoToolsG2Reader.h"

#include "GoToolsG2.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkGoToolsG2Reader);

vtkGoToolsG2Reader::vtkGoToolsG2Reader() = default;

knotwork::Result<knotwork::SplineFile> vtkGoToolsG2Reader::Parse(std::string_view text)
{
  return knotwork::ReadG2(text);
}

bool vtkGoToolsG2Reader::Recognize(std::string_view beginning)
{
  return knotwork::LooksLikeG2(beginning) && !knotwork::BeginsWithG2Points(beginning);
}
