// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "DataFile.h"
#include <knotwork/SplineIO/FileFormats.h>

#include <string>

namespace knotwork
{
/// How the formats of a family are read and written.
struct FormatHandler
{
  /// Sets the data, the curves and what was left out; errors are errors of VTK, the code is
  /// returned. Null: no format of the family is read.
  ErrorCode (*Read)(const std::string& file, DataFile& found);
  /// A failure without a text is an error of VTK too. Null: no format of the family is written.
  Status (*Write)(vtkDataObject* data, const std::string& file, const DataFileParams& params);
};

/// The one place where families meet readers and writers. VTK's own formats have no reader here:
/// they are read in a process of their own (ForeignFile.h).
FormatHandler HandlerOf(FormatFamily family);
}
