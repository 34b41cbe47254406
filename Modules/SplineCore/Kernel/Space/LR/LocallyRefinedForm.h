// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/LRSpace.h>

namespace knotwork
{
/// The same map as a spline of kind LocallyRefined, whose lines can end anywhere.
///
/// A tensor-product spline keeps its functions. A hierarchical one gets, level by level, the lines
/// that halve the refined cells, across the supports of all functions alive there; its control
/// points are recovered from its Bezier points. Should they not lie in that space (1e-11 of their
/// size), all lines become as long as the domain: the tensor-product space of all lines contains
/// every level's functions.
/// @return Spline::Check's codes; DimensionMismatch for the kind Bezier; what LRBasisOfTensor and
/// the insertion of segments return; NotInSpace. @param threads  0 = all cores.
Result<Spline<2>> MakeLocallyRefined(const Spline<2>& spline, int threads);
}
