// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/TemplateMapping/TemplateMap.h>

#include <string>
#include <vector>

class vtkDataObject;
class vtkTable;
class vtkUnstructuredGrid;

/// Between spline grids and the maps of the kernel. Internal to the module.
namespace knotwork
{
/// The only patch of a spline grid as a map of the plane or of space; control points of a plane map
/// lie in z = 0 to 1e-9 of their size.
/// @param warnings  receives what is worth knowing of the decoding.
/// @return failures of DecodeSplineModel; InvalidTopology (not one patch), DimensionMismatch
/// (another number of parameters, z).
template <int Dim>
Result<Spline<Dim>> DecodeInitialMap(
  vtkDataObject* data, int threads, std::vector<std::string>& warnings);

/// The map as a grid of one patch with the cell arrays MaxError, JacobianMinLower,
/// JacobianMaxUpper and the field data MinJacobianBound, Injective, InjectivityReason (the last two
/// when it was asked for).
template <int Dim>
Status EncodeMap(const TemplateMapResult<Dim>& result, bool injectivity, vtkUnstructuredGrid* grid);
}
