// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "Status.h"

#include <string>

namespace knotwork
{
/// Looks for what VTK's XML readers do not survive (negative or absurd counts, unknown types of
/// values) in a .vtu, .vtp or .vtpc file and in the files that a .vtpc names. A file of another
/// ending (lower case, with the dot), or that is no XML at all, passes: its reader says what is
/// wrong.
/// @complexity one pass over the text; appended binary data is not read
Status CheckXmlFile(const std::string& file, const std::string& ending);
}
