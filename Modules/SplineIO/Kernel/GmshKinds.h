// SPDX-License-Identifier: BSD-3-Clause
// Gmsh's element types.
#pragma once
#include "ElementMesh.h"

namespace knotwork
{
/// @return InvalidParameter for a type that is not read: one sentence with the remedy.
Result<ElementKind> GmshKind(int type);

/// Gmsh's number of an element; 0: it has none.
int GmshType(ElementShape shape, int degree, bool isComplete);
}
