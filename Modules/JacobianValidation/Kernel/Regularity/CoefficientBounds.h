// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "JacobianForms.h"

namespace knotwork
{
/// Coefficients of the cells of a pack, one a lane.
template <typename Pack>
using BlocksOf = std::array<const double*, LanesOf<Pack>>;

/// What the coefficients of the numerators of a pack of cells say, a cell a lane.
template <typename Pack>
struct CoefficientBounds
{
  Pack Smallest{}; ///< unscaled coefficient of the numerator (of a surface: along one direction)
  Pack Largest{};  ///< the same; of a surface: largest norm
  Pack SmallestCorner{}; ///< value at a corner, over the weights' power; of a surface: squared norm
  Pack LargestCorner{};
  Pack Error{}; ///< of the numerator's coefficients
  Pack SmallestWeight{};
  Pack LargestWeight{};
  Pack Magnitude{}; ///< largest plane coefficient: the error bound holds within 2^-200 .. 2^200
  Pack NotFinite{}; ///< NaN when an input is not finite, else 0
};
}
