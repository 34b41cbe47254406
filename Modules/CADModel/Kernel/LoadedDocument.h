// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "CADSession.h"

#include <TDocStd_Document.hxx>
#include <TopoDS_Shape.hxx>

#include <functional>
#include <string>

namespace knotwork
{
/// Names that entities of a file have besides those of the document.
using EntityNames = std::function<std::string(const TopoDS_Shape&)>;

struct LoadedDocument
{
  Handle(TDocStd_Document) Document; ///< empty where nothing of the file could be transferred
  EntityNames Names;                 ///< of IGES entities
  int NumMended = 0;                 ///< damaged curves that are to be found anew
};

/// Reads a STEP, IGES or BREP file within a session.
/// @param unit  of the session: of lengths in the document.
/// @return as LoadCAD.
Status LoadDocument(
  CADSession& session, const std::string& file, LengthUnit unit, LoadedDocument& loaded);
}
