// SPDX-License-Identifier: BSD-3-Clause
// Faces that count as one: a group that travels in the names of the faces, which STEP files keep.
#pragma once
#include <string>
#include <vector>

namespace knotwork
{
/// What the name of a face says: `composite:GROUP/NAME`, `composite:GROUP`, or `NAME`.
struct CompositeName
{
  std::string Group; ///< empty: the face is in no composite
  std::string Name;  ///< the face's own
};

CompositeName ParseCompositeName(const std::string& faceName);
std::string FormatCompositeName(const CompositeName& name);

/// A number for every face: that of its composite, from 0 in the order of their first faces; -1 in
/// none.
/// @param faceNames  one a face.
std::vector<int> CompositeIds(const std::vector<std::string>& faceNames);
}
