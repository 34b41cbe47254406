// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>

#include <vtkSmartPointer.h>

#include <cstdint>
#include <vector>

class vtkDataObject;

namespace knotwork
{
/// What each of several processes gets of an input.
enum class Share
{
  All,
  Cells,  ///< of grids, of all of them in order; each has all points
  Points, ///< of one set of points, without cells
  Blocks, ///< of a collection; the first process has what is none
  First   ///< all for the first process
};

/// The share of this process; the shares follow each other in the order of the processes and differ
/// by one cell, point or block at most. Points of Cells have global ids.
vtkSmartPointer<vtkDataObject> ShareOf(vtkDataObject* whole, Share share);

/// What a filter has made of the shares (Cells or Points) of an input that it adds arrays to, or
/// whose points it moves: the same of the whole, in the first process; null elsewhere.
/// @param whole  the input.   @param input  this process's share.   @param output  made of it.
/// @pre all processes call it.
vtkSmartPointer<vtkDataObject> JoinShares(
  Share share, vtkDataObject* whole, vtkDataObject* input, vtkDataObject* output);

/// What processes have made, in their order, without what is empty, in the first of them;
/// elsewhere what the process has made itself.
/// @pre all processes call it.
/// @return LibraryError: VTK cannot take it apart.
Result<std::vector<vtkSmartPointer<vtkDataObject>>> CollectPieces(vtkDataObject* output);

/// What processes have made, one after the other in the first of them; elsewhere what the process
/// has made itself. Points are not united. Collections get the blocks that each has.
/// @pre all processes call it.
/// @return LibraryError: VTK cannot take it apart.
Result<vtkSmartPointer<vtkDataObject>> AppendShares(vtkDataObject* output);

/// The parts that processes have made of one tessellation (vtkSplineTessellate::SetPart) as the
/// whole, in the first process; elsewhere what the process has made itself.
/// @pre all processes call it.
/// @return LibraryError: VTK cannot take it apart.
Result<vtkSmartPointer<vtkDataObject>> UniteTessellation(vtkDataObject* output);

/// Points of the whole that a part of a tessellation belongs to.
std::int64_t NumberOfTessellationPoints(vtkDataObject* part);

/// What one process has, to all.
/// @pre all processes call it.
vtkSmartPointer<vtkDataObject> SameForAll(vtkDataObject* data, int from = 0);
}
