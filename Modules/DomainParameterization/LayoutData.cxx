// SPDX-License-Identifier: BSD-3-Clause
#include "LayoutData.h"

#include <knotwork/SplineGrid/InputChecks.h>

#include "vtkCell.h"
#include "vtkDataSet.h"

#include <string>

namespace knotwork
{
template <int Dim>
Result<PatchLayout<Dim>> DecodeLayout(vtkDataSet* data)
{
  // VTK goes around a quadrilateral; pixels and voxels are in the order of the kernel
  if (Status status = CheckCellSizes(data); !status)
  {
    return { status.Code, "layout: " + status.Detail };
  }
  constexpr int round = Dim == 2 ? VTK_QUAD : VTK_HEXAHEDRON;
  constexpr int lattice = Dim == 2 ? VTK_PIXEL : VTK_VOXEL;
  constexpr int around[8] = { 0, 1, 3, 2, 4, 5, 7, 6 };
  PatchLayout<Dim> layout;
  layout.Vertices.resize(data->GetNumberOfPoints(), Dim);
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    double point[3];
    data->GetPoint(i, point);
    for (int c = 0; c < Dim; ++c)
    {
      layout.Vertices(i, c) = point[c];
    }
  }
  for (vtkIdType i = 0; i < data->GetNumberOfCells(); ++i)
  {
    vtkCell* cell = data->GetCell(i);
    const int type = cell->GetCellType();
    if (cell->GetCellDimension() < Dim)
    {
      continue;
    }
    if (type != round && type != lattice)
    {
      return { ErrorCode::InvalidTopology,
        "cell " + std::to_string(i) + " of the layout is no " +
          (Dim == 2 ? "quadrilateral" : "hexahedron") };
    }
    layout.Patches.emplace_back();
    for (int c = 0; c < (1 << Dim); ++c)
    {
      layout.Patches.back()[static_cast<std::size_t>(c)] =
        static_cast<int>(cell->GetPointId(type == round ? around[c] : c));
    }
  }
  if (layout.Patches.empty())
  {
    return { ErrorCode::EmptyInput,
      std::string("the layout has no ") + (Dim == 2 ? "quadrilaterals" : "hexahedra") };
  }
  return layout;
}

template Result<PatchLayout<2>> DecodeLayout<2>(vtkDataSet*);
template Result<PatchLayout<3>> DecodeLayout<3>(vtkDataSet*);
}
