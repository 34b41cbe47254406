// SPDX-License-Identifier: BSD-3-Clause
#include "vtkLatticeWriter.h"

#include "LatticeText.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkLatticeWriter);

vtkLatticeWriter::vtkLatticeWriter() = default;

bool vtkLatticeWriter::Holds(knotwork::SpaceKind kind) const
{
  return kind == knotwork::SpaceKind::Tensor;
}

knotwork::Result<std::string> vtkLatticeWriter::Format(const knotwork::SplineFile& file)
{
  return knotwork::WriteLattice(file);
}
