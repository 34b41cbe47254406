// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "CADSession.h"

#include <TopoDS_Shape.hxx>
#include <XSControl_Reader.hxx>

namespace knotwork
{
/// Reads the entities of a file with the settings of the session; nothing is transferred yet.
/// @param numMended  result: damaged curves of an IGES file that are to be found anew.
/// @return FileError: no such file; EmptyInput: nothing in it; InvalidFormat: damaged.
Status LoadCAD(XSControl_Reader& reader, CADFormat format, const std::string& file, int& numMended);

/// Reads the shape of a BREP file; its lengths are millimetres.
/// @param unit  of lengths in the shape.
/// @return as LoadCAD.
Status LoadBREP(const std::string& file, LengthUnit unit, TopoDS_Shape& shape);

/// Defects of a shape as CADSummary names them; none: it is valid.
std::vector<std::string> DefectsOf(const TopoDS_Shape& shape);

/// As CheckCAD, of the text of a STEP file, with the settings of the session.
Status CheckSTEPText(const std::string& text, CADSummary& summary);
}
