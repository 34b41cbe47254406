// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/KnotVector.h>
#include <knotwork/SplineCore/Types.h>
#include <knotwork/SplineCore/UntouchedVector.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace knotwork
{
/// Families of spline spaces.
enum class SpaceKind
{
  Bezier,         ///< independent or glued Bezier elements without a common parameter domain
  Tensor,         ///< tensor-product B-splines
  Hierarchical,   ///< truncated hierarchical B-splines (THB)
  LocallyRefined, ///< LR B-splines, two parameters
  Unstructured,   ///< splines on a mesh of quadrilaterals or hexahedra with extraordinary ridges
  Explicit        ///< given by the extraction operators of their elements alone
};

inline constexpr SpaceKind AllSpaceKinds[] = { SpaceKind::Bezier, SpaceKind::Tensor,
  SpaceKind::Hierarchical, SpaceKind::LocallyRefined, SpaceKind::Unstructured,
  SpaceKind::Explicit };
/// Whether elements of such spaces are boxes of one parameter domain.
constexpr bool HasParameterDomain(SpaceKind kind)
{
  switch (kind)
  {
    case SpaceKind::Bezier:
    case SpaceKind::Unstructured:
    case SpaceKind::Explicit:
      return false;
    case SpaceKind::Tensor:
    case SpaceKind::Hierarchical:
    case SpaceKind::LocallyRefined:
      break;
  }
  return true;
}
/// What a family knows and does (SpaceFamily.h).
template <int Dim>
class SpaceFamily;

/// Box of elements of a level grid: cells with index in [Lower, Upper) per direction belong to
/// Omega^Level (they are refined at least to this level). Level >= 1.
template <int Dim>
struct HierarchyBox
{
  int Level = 1;
  std::array<std::int64_t, Dim> Lower{};
  std::array<std::int64_t, Dim> Upper{};
};

/// Data private to the hierarchical family: active functions by level, the refinement tree.
template <int Dim>
struct Hierarchy;
/// Data private to the locally refined family (LRSpace.h).
struct LRData;
/// Data private to the unstructured family: the mesh and the continuities.
template <int Dim>
struct UnstructuredData;
/// Data private to the explicit family: the extraction operators (ExplicitSpace.h).
template <int Dim>
struct ExtractionTable;

/// A spline space on Dim parameters in the form every algorithm takes: elements with Bezier
/// extraction.
///
/// On element e the space is spanned by prod(p_d + 1) *local functions* (for tensor and
/// hierarchical spaces: the B-splines of the element's level that do not vanish there). The
/// spline's coefficients in the local functions are a fixed sparse combination of the control
/// points,
///     q = T P            (T = CoefficientMap, one row a local function of the whole mesh),
/// and its Bernstein coefficients follow by one small matrix a direction,
///     Q_e = (F_0 (x) ... (x) F_{Dim-1})^T q[LocalFunctions(e)].
/// So row j of T is the truncation row of a level function (a unit row for tensor-product spaces),
/// rows are shared by all elements, and making a Bezier form touches each coefficient once a level.
/// The extraction operator of an element (alive functions x Bernstein) is the product of both.
/// @source  Borden et al., IJNME 87 (2011); Giannelli, Juettler, Speleers, CAGD 29 (2012)
/// (truncation and preservation of coefficients); D'Angella et al., CMAME 328 (2018) (hierarchical
/// extraction).
///
/// Spaces are made by the builders (TensorSpace.h, HierarchicalSpace.h, LRSpace.h,
/// BezierSpace.h, UnstructuredSpace.h, ExplicitSpace.h), never changed afterwards, and shared as
/// SplineSpacePtr.
template <int Dim>
class SplineSpace
{
public:
  struct Element
  {
    IntArray<Dim> Degree{};
    int Level = 0;
    ParametricBox<Dim> Box;     ///< [0, 1]^Dim when the family has no parameter domain
    IntArray<Dim> Factor{};     ///< offsets into FactorData; -1 is the identity
    std::size_t FirstLocal = 0; ///< offset into LocalFunctionIds, prod(p_d + 1) entries
  };

  SpaceKind Kind = SpaceKind::Tensor;
  std::vector<Element> Elements;
  int NumFunctions = 0;

  /// Local function ids (rows of T) of all elements, first direction fastest within an element.
  std::vector<int> LocalFunctionIds;
  /// 1D operators, (p + 1) x (p + 1) row-major each, shared between elements.
  std::vector<double> FactorData;

  /// T in compressed rows; all empty when T is the identity (local function j is function j).
  int NumLocalFunctions = 0;
  UntouchedVector<std::size_t> RowStart; ///< NumLocalFunctions + 1
  UntouchedVector<int> RowFunction;      ///< ascending within a row
  UntouchedVector<double> RowCoefficient;

  /// Level-0 knot vectors (Tensor and Hierarchical); those of the smallest tensor-product space
  /// that contains the space (LocallyRefined).
  std::array<KnotVector, Dim> Knots;
  /// Hierarchical only.
  std::shared_ptr<const Hierarchy<Dim>> Levels;
  /// LocallyRefined only.
  std::shared_ptr<const LRData> LocallyRefined;
  /// Unstructured only.
  std::shared_ptr<const UnstructuredData<Dim>> Unstructured;
  /// Explicit only.
  std::shared_ptr<const ExtractionTable<Dim>> Extraction;
  /// Element of a level-0 cell (>= 0), or -1 - block when the cell is refined: children of block k
  /// are Tree[k * 2^Dim ... ], bit d of the child number = upper half in direction d. First
  /// direction fastest. Empty when !HasDomain() and for LocallyRefined, which has its own locator.
  std::vector<int> RootCells;
  std::vector<int> Tree;

  /// True when Element::Box are boxes of one parameter domain and Locate works.
  bool HasDomain() const { return HasParameterDomain(this->Kind); }
  int NumElements() const { return static_cast<int>(this->Elements.size()); }
  bool IsIdentityMap() const { return this->RowStart.empty(); }
  const int* LocalFunctions(int e) const
  {
    return this->LocalFunctionIds.data() + this->Elements[static_cast<std::size_t>(e)].FirstLocal;
  }
  /// The 1D operator of an element in a direction; nullptr is the identity.
  const double* Factor(int e, int direction) const
  {
    const int f =
      this->Elements[static_cast<std::size_t>(e)].Factor[static_cast<std::size_t>(direction)];
    return f < 0 ? nullptr : this->FactorData.data() + f;
  }
  std::array<const double*, Dim> Factors(int e) const
  {
    std::array<const double*, Dim> f;
    for (int d = 0; d < Dim; ++d)
    {
      f[static_cast<std::size_t>(d)] = this->Factor(e, d);
    }
    return f;
  }
  /// Parameter domain. @pre HasDomain().
  ParametricBox<Dim> Domain() const;

  /// Element and local parameters in [0, 1]^Dim of a point of the domain. Points outside by at most
  /// 1e-12 of the domain's size count as inside. @return -1 outside, for NaN, or without a domain.
  /// Cost: O(1) a direction plus one step a level (LocallyRefined: expected O(1)).
  int Locate(const double* u, double* local) const;
  /// The same of n points, several times as fast a point.
  /// @param u         point i is u[i * stride], ..., u[i * stride + Dim - 1].
  /// @param elements  n. @param local  n x Dim.
  void Locate(
    const double* u, std::ptrdiff_t stride, std::size_t n, int* elements, double* local) const;

  /// q = T P for c columns; identity: a copy. @param threads  0 = all cores.
  PointMatrix LocalCoefficients(const PointMatrixView& controlPoints, int threads = 0) const;

  /// Ids of the functions alive on an element, ascending.
  std::vector<int> AliveFunctions(int e) const;
  /// Extraction operator of an element: rows = AliveFunctions(e), columns = Bernstein polynomials,
  /// entry = Bernstein coefficient. Sum of a column is 1 (partition of unity).
  Eigen::MatrixXd ExtractionOperator(int e) const;
};

template <int Dim>
using SplineSpacePtr = std::shared_ptr<const SplineSpace<Dim>>;
}
