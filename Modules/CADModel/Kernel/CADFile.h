// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "CADSession.h"

#include <XSControl_Reader.hxx>

namespace knotwork
{
/// Reads the entities of a file with the settings of the session; nothing is transferred yet.
/// @param numMended  result: damaged curves of an IGES file that are to be found anew.
/// @return FileError: no such file; EmptyInput: nothing in it; InvalidFormat: damaged.
Status LoadCAD(XSControl_Reader& reader, CADFormat format, const std::string& file, int& numMended);

/// As CheckCAD, of the text of a STEP file, with the settings of the session.
Status CheckSTEPText(const std::string& text, CADSummary& summary);
}
