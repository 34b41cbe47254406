// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/SizeLimit.h>
#include <knotwork/SplineCore/Spline.h>

namespace knotwork
{
struct CombineParams
{
  /// The first components, which the result takes from the first spline as they are: x and y of
  /// height fields.
  int NumKept = 0;
  /// Both splines are restricted to the box that their domains have in common; else domains that
  /// differ are an error.
  bool CommonDomain = false;
  int MaxFunctions = DefaultMaxFunctions; ///< of the common refinement, >= 1
  int Threads = 0;
};

struct CombinedSpline
{
  Spline<2> Value;
  /// Every component lies between these, proved by its Bernstein coefficients.
  std::vector<double> Lower;
  std::vector<double> Upper;
};

/// weightA a + weightB b as one spline: difference (1, -1), average (1/2, 1/2), any other mean.
///
/// Both are brought into a common refinement, so the result is exact up to rounding: tensor-product
/// splines take each other's knots (and stay of their kind; degrees are raised where they are
/// lower, and domains that differ are cut by knots), hierarchical ones of one domain and the same
/// level-0 knots the union of their hierarchies; else both become LR splines and take each other's
/// lines. Lines that cannot be inserted as they are become
/// as long as the domain.
/// @return Spline::Check's codes naming the spline; InvalidWeight for rational splines;
/// SizeMismatch (components); InvalidDegree for degrees that differ unless both are tensor-product
/// splines; InvalidTopology for domains that differ (by more than 1e-9 of a side) or have nothing
/// in common; DimensionMismatch for Bezier elements without a domain; NotInSpace for knots closer
/// than can be told apart (1e-12 of a side); InvalidParameter; what MakeLocallyRefined and the
/// insertion of segments return; TooLarge above MaxFunctions.
/// @complexity that of the insertions.
Result<CombinedSpline> CombineSplines(const Spline<2>& a, const Spline<2>& b, double weightA,
  double weightB, const CombineParams& params = {});

enum class CombineMode
{
  Difference, ///< first - second
  Average,
  Weighted ///< SurfaceCombination::Weights
};

struct SurfaceCombination
{
  CombineMode Mode = CombineMode::Difference;
  std::array<double, 2> Weights{ 0.5, 0.5 };
  bool CommonDomain = false;              ///< see CombineParams
  int MaxFunctions = DefaultMaxFunctions; ///< see CombineParams
  int Threads = 0;
};

struct CombinedSurface
{
  Spline<2> Value;
  /// After x, y, z the value has three components more than the surfaces: their difference.
  bool HasDifference = false;
  /// z of height fields, or every component of the difference or of the sum, lies between these.
  double Lower = 0.0;
  double Upper = 0.0;
};

/// Two surfaces in space combined: of height fields (HeightField.h) z, x and y stay; else the sum
/// of points, or for Difference the first surface with the difference of points beside it. Further
/// components are combined with the same weights.
/// @param a, b  x, y, z and further components. @return as CombineSplines; SizeMismatch below three
/// components.
Result<CombinedSurface> CombineSurfaces(
  const Spline<2>& a, const Spline<2>& b, const SurfaceCombination& combination);
}
