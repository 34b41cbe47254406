// SPDX-License-Identifier: BSD-3-Clause
// The trimming curves of a model as field data of its surfaces, for those who have the surfaces
// alone (ParaView's Save Data). The module's page describes the arrays.
#pragma once
#include <knotwork/SplineCore/TrimmedModel.h>

#include <map>
#include <vector>

class vtkUnstructuredGrid;

namespace knotwork
{
/// A trimming curve and its place in the model.
struct CarriedCurve
{
  int Face = 0;
  int Loop = 0;
  int Curve = 0;
  TrimmingCurve Use; ///< edge and vertices as in the model
};

struct CarriedCurves
{
  int ModelId = 0;
  std::vector<CarriedCurve> Curves;
  std::map<int, PointMatrix> Surfaces; ///< by face: the control points that the curves belong to
};

/// Nothing is stored of a model without trimming curves.
void StoreCurves(const TrimmedModel& model, int modelId, vtkUnstructuredGrid* surfaces);

/// @return without curves when none are stored; InvalidTopology, or the errors of
/// KnotVector::Create, with the name of the array, when what is stored is damaged.
Result<CarriedCurves> LoadCurves(vtkUnstructuredGrid* surfaces);
}
