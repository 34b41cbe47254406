// SPDX-License-Identifier: BSD-3-Clause
#include "vtkLatticeReader.h"

#include "LatticeText.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkLatticeReader);

vtkLatticeReader::vtkLatticeReader() = default;

knotwork::Result<knotwork::SplineFile> vtkLatticeReader::Parse(std::string_view text)
{
  return knotwork::ReadLattice(text);
}

bool vtkLatticeReader::Recognize(std::string_view beginning)
{
  return knotwork::LooksLikeLattice(beginning);
}
