// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Interface_InterfaceModel.hxx>

namespace knotwork
{
/// Turns the loops of a STEP file that run along a seam to a pole and back to where they leave it.
/// OpenCASCADE takes the sides of seams for each other, and so a face for its complement, where
/// such a loop begins elsewhere; it writes them so itself.
void BeginLoopsAtPoles(const Handle(Interface_InterfaceModel) & model);
}
