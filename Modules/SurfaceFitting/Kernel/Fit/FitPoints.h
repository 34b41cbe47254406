// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "SurfaceFit.h"
#include <knotwork/SplineCore/UntouchedVector.h>

#include <vector>

namespace knotwork
{
/// The points of a fit in the order of the elements that hold them, a column a property: everything
/// an element's points need is contiguous. When an element is split only its own points move.
struct FitPoints
{
  using Column = UntouchedVector<double>;
  Column U; ///< in the domain's coordinates
  Column V;
  std::vector<Column> Values; ///< one a component
  Column Tolerance;
  Column Base;                ///< weight asked for; 0 of an outlier
  Column Boost;               ///< weight gained by being outside, >= 1
  Column Distance;            ///< signed with one measured component
  UntouchedVector<int> Order; ///< row in the cloud
  double FactorAbove = 1.0;   ///< times the tolerance, for points above the surface
  double FactorBelow = 1.0;

  /// Points [Begin, End) of an element.
  struct Range
  {
    std::size_t Begin = 0;
    std::size_t End = 0;
    std::size_t Count() const { return this->End - this->Begin; }
  };
  std::vector<Range> Ranges; ///< one an element

  std::size_t Size() const { return this->U.size(); }
  /// Tolerance of a point where it is now: on its side of the surface.
  double Limit(std::size_t i) const
  {
    return this->Tolerance[i] * (this->Distance[i] > 0.0 ? this->FactorAbove : this->FactorBelow);
  }
  int NumComponents() const { return static_cast<int>(this->Values.size()); }
};

/// Elements of the points, whose parameters are n x 2. @pre the points are in the domain.
std::vector<int> LocatePoints(
  const SplineSpace<2>& space, const PointMatrix& parameters, int threads);

/// Points of a cloud by the elements of a space.
/// @pre the points are in the domain. @param tolerances one a point.
FitPoints GroupPoints(const SplineSpace<2>& space, const PointCloud& cloud,
  const std::vector<double>& tolerances, double significantWeight, int threads);

/// Moves the points of every element of the coarser space to its parts.
/// @param parents  elements of the coarser space that hold those of the finer one (ParentElements).
void RegroupPoints(const SplineSpace<2>& coarse, const SplineSpace<2>& fine,
  const std::vector<int>& parents, FitPoints& points, int threads);
}
