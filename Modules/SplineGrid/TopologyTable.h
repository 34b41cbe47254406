// SPDX-License-Identifier: BSD-3-Clause
// The table of interfaces of a spline grid: which sides of its patches are stated to be one.
#pragma once
#include <knotwork/SplineCore/MultiPatch.h>

#include <map>

class vtkFieldData;

namespace knotwork
{
/// A patch by its place in a model, and its number of parameters.
struct PatchPlace
{
  int Index = 0;
  int Dimension = 0;
};

/// @param topology  by PatchId. @return whether there was something to write.
bool WriteTopology(const PatchTopology& topology, vtkFieldData* fieldData);

/// @param patches  by PatchId. @param lost  receives the number of rows that refer to patches,
/// sides or orientations that are not there: they are left out.
/// @return the topology by places; also that of version 1, in which readers of G+Smo's files stored
/// it as PatchInterfaces and PatchBoundaries.
PatchTopology ReadTopology(
  vtkFieldData* fieldData, const std::map<int, PatchPlace>& patches, int& lost);
}
