// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/SplineSpace.h>
#include <knotwork/SplineCore/UntouchedVector.h>

#include <vector>

namespace knotwork
{
/// The functions alive on every element with their Bernstein coefficients there, for any family of
/// spaces: what is assembled by elements needs.
struct ElementFunctions
{
  int NumFunctions = 0;
  int PerElement = 0;                ///< Bernstein polynomials of an element
  std::vector<std::size_t> Start;    ///< elements + 1, offsets into Functions
  std::vector<int> Functions;        ///< ascending on an element
  UntouchedVector<double> Rows;      ///< PerElement Bernstein coefficients of every entry
  std::vector<std::size_t> UseStart; ///< functions + 1, offsets into Uses
  UntouchedVector<std::size_t> Uses; ///< entries of Functions that are this function, ascending
  UntouchedVector<int> ElementOfEntry;

  int NumElements() const { return static_cast<int>(this->Start.size()) - 1; }
  std::size_t First(int e) const { return this->Start[static_cast<std::size_t>(e)]; }
  int Alive(int e) const
  {
    const auto k = static_cast<std::size_t>(e);
    return static_cast<int>(this->Start[k + 1] - this->Start[k]);
  }
  const double* Row(std::size_t entry) const
  {
    return this->Rows.data() + entry * static_cast<std::size_t>(this->PerElement);
  }
  /// Bernstein coefficients on an element of the function with these coefficients, a column after
  /// the other. @param local  coefficients.cols() * PerElement numbers.
  void LocalCoefficients(int e, const PointMatrix& coefficients, double* local) const;
};

/// @complexity O(elements * alive * (p + 1)^Dim).
template <int Dim>
ElementFunctions FindElementFunctions(const SplineSpace<Dim>& space, int threads);
}
