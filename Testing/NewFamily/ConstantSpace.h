// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "Spline.h"

namespace knotwork
{
/// One constant function per element of a tensor-product grid.
template <int Dim>
Result<SplineSpacePtr<Dim>> MakeConstantSpace(const std::array<KnotVector, Dim>& knots);

/// The family's entry in the table.
template <int Dim>
const SpaceFamily<Dim>& ConstantFamily();
}
