// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "BoundaryInjectivity.h"
#include "CellPieces.h"
#include "SideContacts.h"

#include <Eigen/Core>

/// Private to the injectivity proof: sides of two patches that nearly agree.
namespace knotwork
{
class InterfaceGaps
{
public:
  /// @param sideCells  the sides, as cells. @param tolerance  a length.
  /// @param middle  that the sides were moved by.
  InterfaceGaps(const std::vector<BoundarySide>& boundary, const BernsteinCells& sideCells,
    const CellLatticeTable& lattices, double tolerance, const std::array<double, 3>& middle)
    : Boundary(boundary), SideCells(sideCells), Lattices(lattices), Tolerance(tolerance),
      Middle(middle)
  {
  }

  /// Whether two sides of different patches should be one interface.
  bool IsGap(int a, int b, InterfaceGap& gap) const;

private:
  const BoundarySide& Side(int i) const { return this->Boundary[static_cast<std::size_t>(i)]; }
  /// Points of a side at a uniform lattice.
  std::vector<std::array<double, 3>> SideSamples(int side, int n) const;
  /// Distance of a point to a side: the nearest sample, improved by Gauss-Newton steps.
  double SideDistance(int side, const std::vector<std::array<double, 3>>& samples,
    const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& x) const;
  /// Places of samples of a side.
  std::vector<Eigen::Vector3d> SidePoints(
    int side, const std::vector<std::array<double, 3>>& samples) const;
  /// Whether too many samples of a side are proved too far from another for a gap: by distances
  /// from planes on the other side of which the control points are.
  bool IsFar(int to, const std::vector<Eigen::Vector3d>& samples, bool haveSameCorners) const;

  const std::vector<BoundarySide>& Boundary;
  const BernsteinCells& SideCells;
  const CellLatticeTable& Lattices;
  double Tolerance;
  const std::array<double, 3>& Middle;
};
}
