// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/TrimmedModel.h>

namespace knotwork
{
/// The boundary of volumes as faces, turned outward. Of tensor-product volumes: sides that no other
/// side (of any patch, the own one too) covers, without loops; patches that touch by a side are one
/// body, and sides that are a point or a curve are left out. A volume on an unstructured mesh gives
/// faces that share edges (FacesOfPatches), as bodies of its own; where its boundary is no surface,
/// it counts as the tensor-product patches that it consists of.
/// @param patches    tensor products, clamped or not, and volumes on unstructured meshes.
/// @param tolerance  of the model's size: sides are one when their 5 x 5 sample points agree in one
/// of the eight ways, in (0, 0.1].
/// @param warnings   when not null, takes what each volume on a mesh became, and that faces enclose
/// no solid because edges have more than two of them, or one.
/// @return EmptyInput; InvalidParameter; DimensionMismatch: neither of both kinds, or not in space;
/// failures of Spline::Check and of knot insertion.
Result<TrimmedModel> BoundaryFaces(const std::vector<Spline<3>>& patches, double tolerance = 1e-6,
  std::vector<std::string>* warnings = nullptr);
}
