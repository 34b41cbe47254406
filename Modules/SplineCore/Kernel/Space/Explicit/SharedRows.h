// SPDX-License-Identifier: BSD-3-Clause
// Rows of extraction operators that are one, private to the kernel.
#pragma once
#include "ExplicitSpace.h"

namespace knotwork
{
/// Bernstein coefficients of all elements in the functions, one row each, in compressed rows.
struct BernsteinRows
{
  std::vector<std::size_t> Start{ 0 }; ///< rows + 1
  std::vector<int> Functions;          ///< ascending within a row
  std::vector<double> Coefficients;
};

/// The rows of a checked table, first direction fastest, element by element.
template <int Dim>
BernsteinRows RowsOf(const ExtractionTable<Dim>& table);

/// Of every row the first one that is the same to rounding. Rows of one element, and those inside
/// of elements, are themselves.
template <int Dim>
std::vector<int> FindEqualRows(const ExtractionTable<Dim>& table, const BernsteinRows& rows);
}
