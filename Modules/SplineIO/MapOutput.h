// SPDX-License-Identifier: BSD-3-Clause
// What writers of maps have in common.
#pragma once
#include "vtkKnotworkSplineIOModule.h" // for export macro
#include <knotwork/SplineCore/Status.h>

#include <functional>
#include <string>
#include <vector>

class vtkDataObject;

namespace knotwork
{
/// The reference system as WKT that a map is written with.
/// @param stated  by the user; empty: that of the data.
/// @param warnings  gets one where that of the data is unknown, and left out.
/// @return empty: there is none; failures of FindReferenceSystem for one that the user states.
Result<std::string> SystemToWrite(
  vtkDataObject* data, const std::string& stated, std::vector<std::string>& warnings);

/// The reference system that a user states, such as EPSG:25832, as WKT; empty: none.
/// @return failures of FindReferenceSystem.
VTKKNOTWORKSPLINEIO_EXPORT Result<std::string> WktOfReferenceSystem(const std::string& stated);

/// States what the user says (empty: nothing) as the reference system of data.
/// @return its name: EPSG:25832 where it has a number, `unknown` where nobody knows it, empty where
/// there is none; failures of FindReferenceSystem for one that the user states.
VTKKNOTWORKSPLINEIO_EXPORT Result<std::string> StateReferenceSystem(
  const std::string& stated, vtkDataObject* data);

/// Has a file written in a temporary folder beside its place, which it takes when it is whole.
/// @param write  gets the name to write. @return its failures, said of the file; FileError.
Status WriteStaged(const std::string& file, const std::function<Status(const std::string&)>& write);
}
