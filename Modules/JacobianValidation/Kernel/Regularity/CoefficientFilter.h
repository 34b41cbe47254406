// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "JacobianForms.h"

namespace knotwork
{
/// What the coefficients of the numerators of a pack of cells say, a cell a lane.
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

/// Numerator of det J for a pack of planar or spatial cells of one shape and degree, with the error
/// bound of JacobianForms. Degrees 1 to 4 of polynomial quadrilaterals, 1 to 3 of rational ones and
/// of polynomial hexahedra are compiled for their size.
/// @param block  one a lane.
class CoefficientFilter
{
public:
  CoefficientFilter() : Forms(this->Cache) {}
  void Determinant(CellShape shape, const CellDegree& degree, bool rational,
    const std::array<const double*, PackSize>& blocks, const Pack& given,
    CoefficientBounds& bounds);
  /// Surfaces and curves in space: the normal (tangent) along the mean of its coefficients.
  void Norm(CellShape shape, const CellDegree& degree, int numComponents, bool rational,
    const std::array<const double*, PackSize>& blocks, const Pack& given,
    CoefficientBounds& bounds);
  LayoutCache& Layouts() { return this->Cache; }

private:
  void Load(CellShape shape, const CellDegree& degree, int numComponents, bool rational,
    const std::array<const double*, PackSize>& blocks, const Pack& given,
    CoefficientBounds& bounds);

  LayoutCache Cache;
  JacobianForms<Pack> Forms;
  std::vector<Pack> Planes;
};
}
