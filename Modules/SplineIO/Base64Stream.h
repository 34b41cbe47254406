// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <vtkBase64OutputStream.h>

namespace knotwork
{
/// VTK's base64, thousands of characters at a time where VTK hands over four.
class Base64Stream : public vtkBase64OutputStream
{
public:
  static Base64Stream* New();

  int Write(void const* data, size_t length) override;

protected:
  Base64Stream() = default;
};
}
