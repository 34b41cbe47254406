// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "vtkKnotworkSplineGridModule.h" // for export macro
#include <knotwork/SplineCore/Status.h>

#include "vtkSmartPointer.h"

#include <string>
#include <vector>

class vtkDataObject;
class vtkInformationVector;

namespace knotwork
{
/// Pieces that are asked for, or processes of the global controller, whichever are more.
VTKKNOTWORKSPLINEGRID_EXPORT int NumberOfPieces(vtkInformationVector* outputs);

/// Whether every process of several is asked for its own piece of as many.
VTKKNOTWORKSPLINEGRID_EXPORT bool IsPieceOfEveryProcess(vtkInformationVector* outputs);

/// Whether one of the inputs has points, cells or rows. Of several processes those without stay
/// idle.
VTKKNOTWORKSPLINEGRID_EXPORT bool HasData(vtkInformationVector** inputs, int numInputPorts);

/// Whether an algorithm that needs the whole of its inputs has got it: always with one piece and
/// one process. When every process is asked for its piece they tell each other whether they have
/// data, and one may have it. Asked for one of several pieces by a single process, or for the whole
/// in one of several processes, an input with data may be a part.
/// @pre when the number of pieces is that of the processes, all of them call this.
/// @param speaks  whether it is this process that should report the failure.
/// @return Ok or InvalidTopology.
VTKKNOTWORKSPLINEGRID_EXPORT Status CheckWholeInput(
  vtkInformationVector** inputs, int numInputPorts, vtkInformationVector* outputs, bool& speaks);

/// An input that every process needs whole, beside another one of which it has a piece: where one
/// process has it, it is sent to the others.
/// @pre all processes call it.
/// @return what this process works with, null where no process has data; InvalidTopology: several
/// have data that differ, so what they have are pieces.
VTKKNOTWORKSPLINEGRID_EXPORT Result<vtkSmartPointer<vtkDataObject>> WholeForAll(vtkDataObject* own);

/// What processes have made, in their order, in the first of them; empty elsewhere. Exact; names of
/// arrays and what they hold stay, active attributes may not.
/// @pre all processes call it.
VTKKNOTWORKSPLINEGRID_EXPORT std::vector<vtkSmartPointer<vtkDataObject>> CollectData(
  vtkDataObject* own);

/// Whether a writer of one file may write: not as one of several processes, each of which would
/// write the file. Nothing is exchanged between them, so that none waits.
/// @param idle  result: this process has no data and writes nothing, which is no failure.
/// @return Ok or InvalidTopology.
VTKKNOTWORKSPLINEGRID_EXPORT Status CheckOneWriter(vtkDataObject* data, bool& idle);
}
