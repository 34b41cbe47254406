// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineIO/ElementMesh.h>

#include <string_view>

namespace knotwork
{
/// Reads the mesh of an Abaqus input file: *NODE, *ELEMENT (solids of 4, 5, 6, 8, 10, 15 and 20
/// nodes, plane, shell and membrane elements of 3, 4, 6 and 8, trusses and beams), *NSET and
/// *ELSET, flat or as one *PART with one *INSTANCE that is not moved. Element sets are Groups too,
/// numbered from 1. Keywords that say nothing of the mesh are passed over.
/// @return InvalidFormat with the line; InvalidParameter for what makes or places the mesh
/// otherwise
/// (*INCLUDE, *NGEN, several parts, *SYSTEM, ...) and elements that are not read; InvalidTopology
/// for nodes and elements that are not there or twice; NonFiniteInput; TooLarge for values beyond
/// 1e60; EmptyInput without an element.
/// @complexity time O(text + sets x (nodes + elements)), memory O(text).
Result<ElementMesh> ReadAbaqusInput(std::string_view text);

/// Whether a text may begin like this.
bool LooksLikeAbaqusInput(std::string_view beginning);
}
