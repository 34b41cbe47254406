// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Spline.h>

#include <cstddef>
#include <vector>

namespace knotwork
{
/// Extraction operators, element by element: the functions alive there, and of each the vector of
/// its Bernstein coefficients, first direction fastest. Elements share vectors.
template <int Dim>
struct ExtractionTable
{
  std::vector<IntArray<Dim>> Degrees;             ///< one an element
  std::vector<std::size_t> FirstFunction{ 0 };    ///< of an element in Functions; elements + 1
  std::vector<int> Functions;                     ///< their numbers, each once an element
  std::vector<int> Vectors;                       ///< as many: the vector of each
  std::vector<std::size_t> FirstCoefficient{ 0 }; ///< of a vector in Coefficients; vectors + 1
  std::vector<double> Coefficients;

  std::size_t NumElements() const { return this->Degrees.size(); }
  std::size_t NumVectors() const { return this->FirstCoefficient.size() - 1; }
  /// Ends the functions of one more element.
  void EndElement(const IntArray<Dim>& degree)
  {
    this->Degrees.push_back(degree);
    this->FirstFunction.push_back(this->Functions.size());
  }
  /// Ends the coefficients of one more vector.
  void EndVector() { this->FirstCoefficient.push_back(this->Coefficients.size()); }

  bool operator==(const ExtractionTable& other) const
  {
    return this->Degrees == other.Degrees && this->FirstFunction == other.FirstFunction &&
      this->Functions == other.Functions && this->Vectors == other.Vectors &&
      this->FirstCoefficient == other.FirstCoefficient && this->Coefficients == other.Coefficients;
  }
};

/// How far the coefficients of all functions at a Bernstein polynomial may be from the sum 1, and
/// a coefficient below 0. The operators of smooth splines are products of some ten factors and
/// their coefficients sums of some hundred terms: rounding stays near 1e-15 for degrees up to 9,
/// and below 1e-14 where numbers have 16 decimals.
inline constexpr double ExtractionTolerance = 1e-12;

/// Space that is given by its extraction operators alone, as a file of them gives it: no mesh, no
/// parameter domain, and nothing that it could be refined by. Degrees may differ between elements
/// and directions. On every element the functions are not negative, sum to one and span all
/// polynomials of its degrees; there may be more of them than that takes. Functions that are nearly
/// dependent because their element is very short are taken.
///
/// Bernstein points on the sides of elements are one where their coefficients agree to 1e-12 in
/// every function, for then every spline of the space has one value there.
/// @param table  vectors in any order, also equal ones and such that no element has.
/// @param numFunctions  functions that no element has are allowed, up to as many as the table has
/// entries.
/// @param first  number of the first element, function and vector in messages: 0 or 1.
/// @return  a space whose table (Extraction) has each vector once, in the order of their first
/// use. EmptyInput without elements; InvalidDegree; SizeMismatch for a vector that has not one
/// coefficient a Bernstein polynomial, or tables that do not fit; InvalidTopology for a number
/// that is out of range or twice on an element; NonFiniteInput; NotInSpace when the functions are
/// negative, do not sum to one or do not span the polynomials. Details name the element.
/// @complexity O(coefficients of all elements, n^3 for each different operator of n polynomials)
template <int Dim>
Result<SplineSpacePtr<Dim>> MakeExplicitSpace(
  const ExtractionTable<Dim>& table, int numFunctions, int first = 0);

/// The extraction operators of a space of any family, each vector once: those that an explicit
/// space was made from, else rows of SplineSpace::ExtractionOperator.
template <int Dim>
ExtractionTable<Dim> ExtractionOf(const SplineSpace<Dim>& space);

/// The same operators with each vector once, in the order of their first use.
/// @pre functions and vectors are in range.
template <int Dim>
ExtractionTable<Dim> WithVectorsOnce(const ExtractionTable<Dim>& table);

/// Whether every function is alive on an element that has no more functions than polynomials: then
/// they are linearly independent. False decides nothing.
template <int Dim>
bool AreLocallyIndependent(const ExtractionTable<Dim>& table, int numFunctions);

/// The family's entry in the table.
template <int Dim>
const SpaceFamily<Dim>& ExplicitFamily();
}
