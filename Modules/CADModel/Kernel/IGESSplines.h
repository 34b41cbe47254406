// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>

#include <IGESData_IGESModel.hxx>

namespace knotwork
{
/// Finds B-splines of an IGES file whose knots do not rise or have too many equal ones:
/// OpenCASCADE would crash on them. A damaged
/// pcurve beside a curve in space is dropped, so that OpenCASCADE finds it anew from that curve;
/// likewise a damaged curve in space of a trimmed surface, which is the image of its pcurve.
/// @param dropped  result: how many curves.
/// @return InvalidFormat: a surface is damaged, or a curve that has no other; the directory entry
/// is named.
Status MendIGESSplines(const Handle(IGESData_IGESModel) & model, int& dropped);
}
