// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <vector>

class vtkDataSetAttributes;

namespace knotwork
{
/// Values of the input by ids, zero where these are negative, and the ids as an array.
void CopyOriginData(vtkDataSetAttributes* from, const std::vector<int>& ids, const char* name,
  vtkDataSetAttributes* to);
}
