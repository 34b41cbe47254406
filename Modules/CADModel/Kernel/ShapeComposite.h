// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "ShapeImages.h"

namespace knotwork
{
/// Faces become one where they lie on the same surface; what is left of several gets the name of a
/// composite. May throw OpenCASCADE's exceptions.
/// @return failures of ModifyCAD.
Status Compose(const std::vector<int>& ids, ModelBodies& model, CADStep& step);

/// The group of the first face that is in one; empty: none is.
std::string FirstComposite(const ModelBodies& model);
}
