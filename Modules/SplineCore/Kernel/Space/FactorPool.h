// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <map>
#include <vector>

namespace knotwork
{
/// Collects the 1D operators of a space while it is built. Operators whose entries agree after
/// rounding to 1e-13 are one (bitwise comparison would keep dozens of copies on computed uniform
/// knots).
class FactorPool
{
public:
  /// @param data  SplineSpace::FactorData of the space under construction.
  explicit FactorPool(std::vector<double>& data) : Data(data) {}
  /// @param matrix  (degree + 1) x (degree + 1) row-major.
  /// @return offset into the data; -1 for the identity.
  int Add(int degree, const double* matrix);

private:
  std::vector<double>& Data;
  std::map<std::vector<std::int64_t>, int> Offsets;
};
}
