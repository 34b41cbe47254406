// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "ShapeImages.h"

namespace knotwork
{
/// Mends all bodies. May throw OpenCASCADE's exceptions.
/// @param tolerance  unit of the shapes, > 0.
/// @param unit  of lengths in texts, in that of the shapes.
/// @param step  gets Healing and NewFaces.
void Heal(double tolerance, double unit, ModelBodies& model, CADStep& step);
}
