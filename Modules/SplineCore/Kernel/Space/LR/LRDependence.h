// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/LRRefinement.h>

namespace knotwork
{
enum class LRVerdict
{
  Independent, ///< proved
  Dependent,   ///< proved
  Undecided    ///< too many functions are left for the elimination
};

struct LRDependenceResult
{
  LRVerdict Verdict = LRVerdict::Undecided;
  /// Functions that may be in a relation: independence on elements rules out all others. Ascending.
  std::vector<int> Unpeeled;
  /// Number of independent relations.
  int Defect = 0;
  /// One relation when dependent: sum_k Coefficients[k] N_i(u, v) = 0, i = Functions[k], none of
  /// the coefficients 0, the largest of magnitude 1, rounded to double precision.
  std::vector<int> Functions;
  std::vector<double> Coefficients;
  /// The same relation of the unscaled functions B[t_i] B[s_i], in whole numbers, and exactly true.
  /// Empty when they do not fit into 62 bits.
  std::vector<std::int64_t> Integers;
};

/// Decides whether the functions of a space of kind LocallyRefined are linearly independent, for
/// its knots as they are (doubles are dyadic fractions, so nothing is rounded).
///
/// Peeling: when the functions that may still be in a relation are independent on one element, they
/// are in none; repeat. This holds without assumptions, and covers the peeling of overloaded
/// elements. What is left is eliminated modulo a prime: full rank proves independence. A rank that
/// is short modulo primes whose product exceeds every minor of the matrix (Hadamard's bound) is
/// short: this proves dependence. The whole numbers of the relation are verified in the same way.
/// @return DimensionMismatch. @complexity O(functions * (p+1)^4) when peeling takes all.
/// @source  Dokken, Lyche, Pettersen, CAGD 30 (2013), section 7 (peeling); Patrizi, Dokken, CAGD 77
/// (2020) 101803.
Result<LRDependenceResult> DecideDependence(const SplineSpace<2>& space);
Result<LRDependenceResult> DecideDependence(const SplineSpace<3>& space);

/// For callers without a limit of their own.
inline constexpr int MaxResolvingSegments = 100;

/// A spline whose functions are independent.
struct LRResolution
{
  Spline<2> Value;
  std::vector<LRSegment> Segments; ///< what was inserted, in order; empty when nothing was to do
};

/// Inserts segments that split functions of a relation until the functions are independent; the map
/// stays. Lines that end inside such a function's support are preferred: they only go on. Used
/// after every refinement step it is refinement that never keeps a dependence.
/// @param maxSegments  >= 0. @param threads  0 = all cores. @return NotConverged when they do not
/// suffice or the elimination is undecided.
Result<LRResolution> ResolveDependence(const Spline<2>& spline, int maxSegments, int threads);
}
