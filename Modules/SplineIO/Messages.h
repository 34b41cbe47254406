// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "vtkKnotworkSplineIOModule.h" // for export macro

#include <string>
#include <vector>

namespace knotwork
{
/// While it lives, errors and warnings of VTK objects and of the libraries below them are kept here
/// and not printed.
class VTKKNOTWORKSPLINEIO_EXPORT MessageCapture
{
public:
  MessageCapture();
  ~MessageCapture();
  MessageCapture(const MessageCapture&) = delete;
  MessageCapture& operator=(const MessageCapture&) = delete;

  bool HasError() const;
  /// First error, one line, without VTK's place in the source, classes and addresses.
  std::string FirstError() const;
  /// Warnings, one line each.
  std::vector<std::string> Warnings() const;
};
}
