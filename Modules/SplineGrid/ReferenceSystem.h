// SPDX-License-Identifier: BSD-3-Clause
// The coordinate reference system of a data set: a string (WKT, or what else a file says) in the
// field data array `CoordinateReferenceSystem`.
#pragma once
#include "vtkKnotworkSplineGridModule.h" // for export macro

#include <string>

class vtkAlgorithm;
class vtkDataObject;

namespace knotwork
{
/// Of a collection that of the first block that has one; empty: none.
VTKKNOTWORKSPLINEGRID_EXPORT std::string ReferenceSystemOf(vtkDataObject* data);

/// Of a collection that of all its blocks. An empty text removes it.
VTKKNOTWORKSPLINEGRID_EXPORT void SetReferenceSystem(vtkDataObject* data, const std::string& text);

/// For the constructor of a vtkSplineAlgorithm whose outputs lie where its first input does: they
/// get its reference system.
VTKKNOTWORKSPLINEGRID_EXPORT void KeepReferenceSystem(vtkAlgorithm* filter);
VTKKNOTWORKSPLINEGRID_EXPORT bool KeepsReferenceSystem(vtkAlgorithm* filter);
}
