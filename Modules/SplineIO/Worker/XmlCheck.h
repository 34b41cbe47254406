// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>

#include <string>

namespace knotwork
{
/// Looks for what VTK's XML readers do not survive in a .vtu, .vtp or .vtpc file and in the files
/// that a .vtpc names: text that is not well-formed, document types (entities), elements within
/// elements without end, negative or absurd counts, unknown types of values, appended data that
/// begins outside of the file. A file of another ending (lower case, with the dot) passes.
/// @return InvalidTopology: damaged; EmptyInput: no text, or a part of a
/// collection is missing. Details name
/// file, line and element.
/// @complexity one pass over the text in bounded memory; appended data is not read
Status CheckXmlFile(const std::string& file, const std::string& ending);
}
