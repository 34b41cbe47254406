// SPDX-License-Identifier: BSD-3-Clause
// TetGen 1.5.0 frees its mesh before it throws, and once more when the mesh is destroyed. The
// library's function is weak: this one takes its place. Its header has it inline, so that it must
// not be included here.
#include "TetGenEnd.h"

class tetgenmesh;

// NOLINTBEGIN(readability-identifier-naming): the library's name
__attribute__((visibility("default"))) void terminatetetgen(tetgenmesh* mesh, int reason);

void terminatetetgen(tetgenmesh*, int reason)
{
  throw knotwork::TetGenEnd{ reason };
}
// NOLINTEND(readability-identifier-naming)
