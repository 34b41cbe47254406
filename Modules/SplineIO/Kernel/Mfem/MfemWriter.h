// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineIO/ElementMesh.h>

namespace knotwork
{
struct MfemText
{
  std::string Text;
  std::vector<std::string> LeftOut;
};

/// MFEM mesh v1.0: the elements of the highest dimension, those of one dimension less as boundary.
/// Attributes are the first groups; elements without one have 1, or where there are groups one more
/// than the largest. Curved elements have `nodes`: every element its own, equidistant ones, which
/// are the elements' nodes, so values are exact.
/// @return EmptyInput; InvalidParameter for elements of several degrees, without nodes in
/// quadrilaterals and inside, curved pyramids, and groups below 0.
Result<MfemText> WriteMfemMesh(const ElementMesh& mesh);
}
