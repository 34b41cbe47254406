// SPDX-License-Identifier: BSD-3-Clause
// Operations as words: those of the job `cadmodify` without the dashes.
#pragma once
#include "CADModify.h"

namespace knotwork
{
/// The first word of an operation: imprint, cut-plane, cut-face, cut-cylinder, split-plane,
/// split-iso, split-curve, composite, heal.
const char* NameOf(CADOperationKind kind);

/// `imprint`, `cut-plane X Y Z NX NY NZ`, `cut-face FACE`, `cut-cylinder X Y Z DX DY DZ R`,
/// `split-plane FACES X Y Z NX NY NZ`, `split-iso FACES u|v SHARE`, `split-curve FACES` (the curves
/// are given otherwise), `composite FACES`, `heal TOLERANCE`, with blanks between words; FACES are
/// ids with commas between. Numbers have a point whatever the locale.
/// @return EmptyInput: no word; InvalidParameter: another first word, missing or more words, one
/// that is no number, list of faces or direction. What they stand for is checked by ModifyCAD.
Result<CADOperation> ParseCADOperation(const std::string& text);

/// The words that ParseCADOperation makes the same operation of, numbers as short as that allows;
/// of a split by curves without these.
std::string TextOf(const CADOperation& operation);
}
