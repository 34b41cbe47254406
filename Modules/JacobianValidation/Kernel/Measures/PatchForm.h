// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/BernsteinCells.h>

/// Private to this module: curves and surfaces in one form, to be halved with balanced weights.
namespace knotwork
{
/// A rational curve or surface: planes x, y, z, w of (p + 1)(q + 1) homogeneous coefficients, first
/// direction fastest. Curves have degree { 0, p }, polynomials weights 1.
struct PatchForm
{
  static constexpr int NumPlanes = 4;
  std::array<int, 2> Degree{};
  std::vector<double> Data;

  bool IsCurve() const { return this->Degree[0] == 0; }
  int Size() const { return (this->Degree[0] + 1) * (this->Degree[1] + 1); }
};
/// A side of a cell, or a curve or surface itself, relative to an origin. A triangle's (u, v)
/// become (s, t (1 - s)), which keeps the orientation and collapses one edge; all that is formed
/// are means.
/// @param shape, degree  of the side.
/// @param coefficients   of the cell, in the order of the side's.
PatchForm MakePatchForm(const BernsteinCells& cells, int cell, CellShape shape,
  const CellDegree& degree, const std::vector<int>& coefficients,
  const std::array<double, 3>& origin);

/// Multiplies the coefficients by 2^(a i + b j + c), so that the weights' logarithms have no slope
/// and the largest is about one: a change of parameters of the same patch, and exact. A layer that
/// weights over many decades make near a side so takes as many halvings as the logarithm of their
/// logarithm.
/// @return the exponent of the largest weight over the least.
int BalanceWeights(PatchForm& form);

/// Cuts the first half in a direction off; the form keeps the second.
PatchForm CutOffHalf(PatchForm& form, int direction);
}
