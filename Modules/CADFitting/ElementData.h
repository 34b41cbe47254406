// SPDX-License-Identifier: BSD-3-Clause
// Finite elements from and to datasets.
#pragma once
#include "vtkKnotworkCADFittingModule.h" // for export macro
#include <knotwork/CADFitting/CurvedElements.h>

#include "vtkType.h"

#include <string>
#include <vector>

class vtkPointSet;
class vtkUnstructuredGrid;

namespace knotwork
{
struct DecodedElements
{
  StraightElements Elements;
  std::vector<vtkIdType> Cells; ///< of the dataset, one an element
  int NumLeftOut = 0;           ///< cells of fewer dimensions than others
};

/// Corners of triangles, quadrilaterals, tetrahedra, wedges and hexahedra of any order, Bezier
/// cells among them. Of cells of several dimensions those of the most are taken.
/// @return EmptyInput without such cells; InvalidTopology naming the first cell of another kind;
/// TooLarge.
VTKKNOTWORKCADFITTING_EXPORT Result<DecodedElements> DecodeStraightElements(vtkPointSet* data);

/// Numbers of the elements' values of a cell array: equal values, equal numbers.
/// @param array  of the dataset's cells; empty or "None": none.
/// @return InvalidParameter for an array that is not there or has several components.
Result<std::vector<int>> DecodeRegions(
  vtkPointSet* data, const DecodedElements& decoded, const std::string& array);

/// Lagrange or Bezier cells of one order; the latter with their degrees.
void EncodeCurvedElements(
  const CurvedElements& elements, int order, bool isBezier, vtkUnstructuredGrid* grid);
}
