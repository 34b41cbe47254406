// SPDX-License-Identifier: BSD-3-Clause
// The knots that matter on a cell along one of its directions, private to the kernel.
#pragma once
#include "Types.h"

#include <cstdint>
#include <map>
#include <vector>

namespace knotwork
{
/// How coefficients in the B-splines of one window follow from those of another with the same cell:
/// rows are affine combinations (blossoms at the knots of the first).
struct WindowConversion
{
  bool IsConvex = false; ///< no entry is negative
  /// (p + 1) x (p + 1) row-major; entries within 1e-12 of 0 or 1 are 0 or 1.
  std::vector<double> Matrix;
};

/// Coefficients in the B-splines of the cell between target[p - 1] and target[p] from those in the
/// B-splines of the cell between knots[p - 1] and knots[p], 2 p local knots each.
/// @return (p + 1) x (p + 1) row-major.
std::vector<double> ConvertLocalKnots(
  int degree, const std::vector<double>& target, const std::vector<double>& knots);

/// All windows of a mesh, equal ones once. A window is the length of a cell and p knots on each
/// side as distances outward from the cell's ends, which makes the reversed window an exact one.
/// @source  Ramshaw, CAGD 6 (1989) 323-358 (blossoms).
class KnotWindows
{
public:
  explicit KnotWindows(int degree)
    : Degree(degree), Size(static_cast<std::size_t>(2 * degree + 1)), Slots(64, -1)
  {
  }
  /// @param window  2 p + 1 values: length, knots below, knots above; each from the cell outward.
  /// @return number of the window.
  int Add(const double* window);
  int Count() const { return static_cast<int>(this->Values.size() / this->Size); }
  /// Number of the reversed window. Ready after Finish.
  int Reversed(int window) const { return this->Reverse[static_cast<std::size_t>(window)]; }
  void Finish();
  /// Bezier extraction, (p + 1) x (p + 1) row-major.
  void Extraction(int window, double* matrix) const;
  /// Of coefficients in the B-splines of `to` from those in the B-splines of `from`.
  const WindowConversion& Conversion(int to, int from);
  /// 2 p knots; the cell is [0, length].
  std::vector<double> LocalKnots(int window) const;

private:
  std::size_t Hash(const double* window) const;
  std::size_t SlotOf(const double* window) const;

  int Degree;
  std::size_t Size;
  std::vector<double> Values;
  std::vector<int> Slots; ///< open addressing, a power of two
  std::vector<int> Reverse;
  std::map<std::pair<int, int>, WindowConversion> Conversions;
};
}
