// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineIO/ElementMesh.h>

#include <string>
#include <string_view>

namespace knotwork
{
/// Reads a mesh of Gmsh: MSH 2.2 or 4.1, text or binary of either byte order. Elements are lines,
/// triangles, quadrilaterals, tetrahedra and hexahedra of degree 1 to 5, wedges and pyramids of
/// degree 1 and 2, with all nodes or (degree 2) those of edges alone. Point elements become
/// NodeGroups. Entities and their groups; names of groups. Data of views, periodicity and sections
/// that are not known are left out, views with a sentence in LeftOut.
/// @return InvalidFormat with line (text) or byte (binary) and section; InvalidParameter for
/// versions, partitions and types of elements that are not read; InvalidTopology for nodes that are
/// not there or twice; NonFiniteInput; TooLarge for values beyond 1e60; EmptyInput without an
/// element of a line at least.
/// @complexity time and memory O(size of the text), whatever counts and numbers it claims.
Result<ElementMesh> ReadGmshMesh(std::string_view text);

/// MSH 4.1 of a mesh, text or binary of this machine's byte order: entities of its elements with
/// their groups and names, a node under the first entity that has it. Every group of NodeGroups is
/// a point entity a node. Numbers are written with the fewest digits that give them again.
/// @return InvalidParameter for elements that Gmsh does not have, and where elements of one entity
/// are in different groups; EmptyInput.
Result<std::string> WriteGmshMesh(const ElementMesh& mesh, bool isBinary);

/// Whether a text may begin like this.
bool LooksLikeGmshMesh(std::string_view beginning);
}
