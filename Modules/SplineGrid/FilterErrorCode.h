// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>

#include "vtkAlgorithm.h"
#include "vtkErrorCode.h"

namespace knotwork
{
/// What GetErrorCode() of a filter, reader or writer of ours tells: vtkErrorCode::UserError + code.
inline unsigned long FilterErrorCode(const Status& status)
{
  return vtkErrorCode::UserError + static_cast<unsigned long>(status.Code);
}

/// The code of ours behind GetErrorCode(). Of VTK's own codes below UserError, and of filters that
/// fail without one, LibraryError, but FileError where VTK says that a file cannot be opened,
/// found, or has no room. Never Ok: asked of what has failed.
inline ErrorCode CodeOfFilter(vtkAlgorithm* filter)
{
  const unsigned long code = filter->GetErrorCode();
  if (code > vtkErrorCode::UserError &&
    code <= vtkErrorCode::UserError + static_cast<unsigned long>(ErrorCode::LibraryError))
  {
    return static_cast<ErrorCode>(code - vtkErrorCode::UserError);
  }
  const bool isOfFile = code == vtkErrorCode::FileNotFoundError ||
    code == vtkErrorCode::CannotOpenFileError || code == vtkErrorCode::NoFileNameError ||
    code == vtkErrorCode::OutOfDiskSpaceError;
  return isOfFile ? ErrorCode::FileError : ErrorCode::LibraryError;
}
}
