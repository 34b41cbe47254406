// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/TrimmedModel.h>

namespace knotwork
{
/// The boundary of volume patches as faces without loops: sides that no other side (of any patch,
/// the own one too) covers, turned outward. Patches that touch by a side are one body. Sides that
/// are a point or a curve are left out.
/// @param patches    tensor-product volumes, clamped or not.
/// @param tolerance  of the model's size: sides are one when their 5 x 5 sample points agree in one
/// of the eight ways, in (0, 0.1].
/// @return EmptyInput; InvalidParameter; DimensionMismatch: no tensor product, or not in space;
/// failures of Spline::Check and of knot insertion.
Result<TrimmedModel> BoundaryFaces(const std::vector<Spline<3>>& patches, double tolerance = 1e-6);
}
