// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Refinement.h>
#include <knotwork/SplineCore/SizeLimit.h>

#include <cstdint>

namespace knotwork
{
/// Definition of a space of trivariate LR B-splines: a mesh of axis-parallel rectangles on a box,
/// and B-splines of minimal support on it, which sum to one. Indices below are indices into Knots.
///
/// The mesh is kept as the multiplicity of every face of the grid of all knots: whether rectangles
/// cover a cross-section together is then a look at its faces, for rectangles in any position.
/// @source  Dokken, Lyche, Pettersen, CAGD 30 (2013) 331-356, sections 2 and 3 (any dimension).
struct LRVolumeBasis
{
  IntArray<3> Degree{};
  /// Distinct values, ascending; the first and the last are the ends of the domain.
  std::array<std::vector<double>, 3> Knots;
  /// Faces[d]: multiplicities of the faces on which parameter d is a knot, by FaceIndex.
  std::array<std::vector<std::uint8_t>, 3> Faces;
  /// Local knots of every function: p_d + 2 indices a direction, not descending. Functions ascend
  /// by the third direction's knots, then by the second's, then by the first's.
  std::vector<int> LocalKnots;
  std::vector<double> Scaling; ///< gamma_i > 0

  /// The other directions, ascending.
  static constexpr std::array<int, 2> Across(int d) { return { d == 0 ? 1 : 0, d == 2 ? 1 : 2 }; }
  int Spans(int d) const
  {
    return static_cast<int>(this->Knots[static_cast<std::size_t>(d)].size()) - 1;
  }
  /// The face on plane k of direction d above the knots a, b of the directions Across(d).
  std::size_t FaceIndex(int d, int k, int a, int b) const
  {
    const auto [first, second] = Across(d);
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(this->Spans(second)) +
             static_cast<std::size_t>(b)) *
      static_cast<std::size_t>(this->Spans(first)) +
      static_cast<std::size_t>(a);
  }
  int NumFunctions() const { return static_cast<int>(this->Scaling.size()); }
  int Stride() const { return this->Degree[0] + this->Degree[1] + this->Degree[2] + 6; }
  const int* Local(int function, int direction) const
  {
    return this->LocalKnots.data() + std::ptrdiff_t{ function } * this->Stride() +
      (direction > 0 ? this->Degree[0] + 2 : 0) + (direction > 1 ? this->Degree[1] + 2 : 0);
  }
  bool operator==(const LRVolumeBasis& other) const
  {
    return this->Degree == other.Degree && this->Knots == other.Knots &&
      this->Faces == other.Faces && this->LocalKnots == other.LocalKnots &&
      this->Scaling == other.Scaling;
  }
};

/// The grid of all knots has at most so many cells.
inline constexpr std::size_t MaxLRVolumeCells = std::size_t{ 1 } << 27;

/// Data of a space of kind LocallyRefined with three parameters beside the general form. Elements
/// ascend by their lower corners, third direction first.
struct LRVolume
{
  LRVolumeBasis Basis;
  /// Box of every element as knot indices: lower corner, upper corner.
  std::vector<std::array<int, 6>> ElementKnots;
  /// Ids of the functions alive on element e, ascending: AliveFunctions[AliveStart[e] ...
  /// AliveStart[e + 1]).
  std::vector<std::size_t> AliveStart;
  std::vector<int> AliveFunctions;
  /// Element of every cell of the grid of all knots, first direction fastest.
  std::vector<int> Cells;
};

/// @pre space is of kind LocallyRefined.
const LRVolume& LRVolumeOf(const SplineSpace<3>& space);

/// The space of a definition; its local functions are the Bernstein polynomials of the elements, as
/// with MakeLRSpace. @return what MakeLRSpace returns; TooLarge also for grids above
/// MaxLRVolumeCells.
/// @param threads  0 = all cores; the space is the same for any number.
Result<SplineSpacePtr<3>> MakeLRVolumeSpace(LRVolumeBasis basis, int threads);

/// The definition of a tensor-product space as LR B-splines; functions keep their numbers.
/// @return as LRBasisOfTensor; TooLarge.
Result<LRVolumeBasis> LRVolumeBasisOfTensor(const SplineSpace<3>& space);

/// A mesh rectangle: parameter Direction has Value, the other two, in ascending order, run from
/// Lower to Upper.
struct LRRectangle
{
  int Direction = 0;
  double Value = 0.0;
  RealArray<2> Lower{};
  RealArray<2> Upper{};
  /// The multiplicity along the rectangle becomes at least this, in [1, degree + 1].
  int Multiplicity = 1;
};

/// The same map in the larger space, for rectangles in any order: the mesh is that of all of them,
/// then functions are split until all have minimal support. A tensor-product spline becomes
/// LocallyRefined first. The result is the same for every order of the rectangles, to the last bit.
/// Values within 1e-12 of the domain's size of a knot are that knot.
/// @param maxFunctions  more than that are TooLarge. @param threads  0 = all cores.
/// @return DimensionMismatch for other kinds, Spline::Check's codes, LRVolumeBasisOfTensor's;
/// InvalidParameter (direction, multiplicity, no area), NonFiniteInput, OutsideDomain;
/// InvalidTopology when a side is at no knot, when a rectangle ends inside an element, or traverses
/// the support of no function.
Result<Spline<3>> InsertRectangles(const Spline<3>& spline,
  const std::vector<LRRectangle>& rectangles, int maxFunctions, int threads);

struct LRVolumeStrategyParams
{
  LRStrategy Strategy = LRStrategy::FullSpan;
  /// Directions whose parameter is constant on new rectangles.
  std::array<bool, 3> Directions{ true, true, true };
};

/// Rectangles that halve elements in the chosen directions. Each lies across the support of one
/// function, so that all are legal: FullSpan takes all functions alive on the element, the others
/// one of the smallest support: MinimumSpan halves the element only, StructuredMesh all knot spans,
/// RestrictedMesh those with marked elements but for spans of at most half the longest of them.
/// @param space  of kind LocallyRefined. @return DimensionMismatch, InvalidParameter for a bad id.
Result<std::vector<LRRectangle>> RectanglesForElements(const SplineSpace<3>& space,
  const std::vector<int>& elements, const LRVolumeStrategyParams& params = {});

/// Splits the marked elements of a Tensor or LocallyRefined volume; the result is LocallyRefined.
/// @return InsertRectangles' and RectanglesForElements' codes.
Result<RefinedSpline<3>> RefineMarkedLRVolume(const Spline<3>& spline,
  const std::vector<int>& marked, const LRVolumeStrategyParams& params = {},
  int maxFunctions = DefaultMaxFunctions, int threads = 0);

/// Inserts rectangles and names the elements that those of the result come from.
Result<RefinedSpline<3>> RefineByRectangles(const Spline<3>& spline,
  const std::vector<LRRectangle>& rectangles, int maxFunctions, int threads);
}
