// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Private to the proof of cells: values of quotients, from the numbers that are stored of them.
namespace knotwork
{
/// A number computed as a quotient by weights and scaled: bounds in terms of stored numbers.
struct ValueRange
{
  double WeightLower = 1.0; ///< of the weight function's power, rounded outward
  double WeightUpper = 1.0;
  int Scale = 0;     ///< power of two
  bool Root = false; ///< of a square: the value is its root

  double Lower(double coefficient) const;
  double Upper(double coefficient) const;
};
/// Range of the weight function to a power on a cell. @pre weights > 0.
ValueRange WeightRange(const double* weights, int count, int power);
}
