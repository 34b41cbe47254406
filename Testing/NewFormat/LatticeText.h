// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineIO/SplineFile.h>

#include <string>
#include <string_view>

namespace knotwork
{
/// Whether a text may be a lattice: the word, the numbers of points in both directions, and three
/// coordinates a point.
bool LooksLikeLattice(std::string_view beginning);

/// A bilinear surface through the points of a lattice.
Result<SplineFile> ReadLattice(std::string_view text);

/// The lattice of a surface of degree 1.
Result<std::string> WriteLattice(const SplineFile& file);
}
