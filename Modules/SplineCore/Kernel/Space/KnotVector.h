// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>
#include <knotwork/SplineCore/Types.h>

#include <algorithm>
#include <vector>

namespace knotwork
{
/// Knot vector of a univariate B-spline basis: degree p in [1, 9], knots t_0 <= ... <= t_{n+p} for
/// n functions, domain [t_p, t_n] of positive length, every multiplicity at most p + 1. The ends
/// may be clamped or not. An *element* is a knot span of positive length inside the domain;
/// *breaks* are the element boundaries.
/// @source  Piegl & Tiller, The NURBS Book, 2nd edition, chapter 2.
class KnotVector
{
public:
  /// Degree 1 with one element on [0, 1].
  KnotVector();

  /// @param knots  n + p + 1 values, any unit.
  /// @return InvalidDegree, NonFiniteInput or InvalidKnots with the index of the offending knot.
  static Result<KnotVector> Create(int degree, std::vector<double> knots);

  /// Clamped, equally spaced: elements >= 1 on [begin, end], begin < end, degree in [1, 9].
  /// Interior knots are begin + (end - begin) * i / elements with exact ends.
  /// @param multiplicity  of the interior knots, in [1, degree + 1].
  static KnotVector Uniform(
    int degree, int elements, double begin = 0.0, double end = 1.0, int multiplicity = 1);

  int Degree() const { return this->P; }
  int NumFunctions() const { return static_cast<int>(this->T.size()) - this->P - 1; }
  int NumElements() const { return static_cast<int>(this->B.size()) - 1; }
  const std::vector<double>& Knots() const { return this->T; }
  /// NumElements() + 1 strictly increasing values; the first and last are the domain's ends.
  const std::vector<double>& Breaks() const { return this->B; }
  double Begin() const { return this->B.front(); }
  double End() const { return this->B.back(); }
  /// Knot index k with T[k] = Breaks()[element], T[k + 1] = Breaks()[element + 1]. The functions
  /// alive on the element are Span(element) - p ... Span(element).
  int Span(int element) const { return this->S[static_cast<std::size_t>(element)]; }
  /// Number of knots equal to Breaks()[b].
  int Multiplicity(int b) const;
  /// First and last element (inclusive) of a function's support inside the domain; first > last
  /// when the support meets the domain in no element.
  std::array<int, 2> Support(int function) const;
  /// Element of a parameter; a break belongs to the element on its right, the domain's end to the
  /// last element; parameters outside go to the nearest element. O(1) expected (bucket table).
  int FindElement(double u) const
  {
    int element = 0;
    this->FindElements(&u, 1, &element);
    return element;
  }
  /// The same of n parameters.
  void FindElements(const double* u, std::size_t n, int* elements) const;
  /// Mean of the p inner knots of a function.
  double Greville(int function) const;

  /// Values and derivatives of the p + 1 functions alive on an element.
  /// @param order   highest derivative, >= 0 (derivatives above p are zero).
  /// @param values  (order + 1) x (p + 1), row k = k-th derivatives; u may lie outside the element
  ///                (the element's polynomials are continued).
  /// @source  The NURBS Book, algorithm A2.3.
  void EvaluateFunctions(int element, double u, int order, double* values) const;

  /// Bezier extraction of one element: (p + 1) x (p + 1), row i = Bernstein coefficients on the
  /// element of function Span(element) - p + i. Row-major.
  /// @source  Borden, Scott, Evans, Hughes, IJNME 87 (2011) 15-47; computed by blossoming (Boehm).
  void Extraction(int element, double* matrix) const;

  /// Every element halved by a simple knot at its midpoint; existing multiplicities are kept.
  KnotVector Dyadic() const;

  bool operator==(const KnotVector& other) const
  {
    return this->P == other.P && this->T == other.T;
  }

private:
  void Prepare();
  int P = 1;
  std::vector<double> T; // knots
  std::vector<double> B; // breaks
  std::vector<int> S;    // span of each element
  std::vector<int> Bucket;
  double BucketScale = 0.0;
};

/// Bezier extraction of a span from the 2p knots that matter, t_{k-p+1} ... t_{k+p} with t_k <
/// t_{k+1} the span: the one routine behind every tensor and hierarchical operator.
/// @param localKnots  2p values. @param matrix  (p + 1) x (p + 1) row-major.
void ExtractionFromLocalKnots(int degree, const double* localKnots, double* matrix);
}
