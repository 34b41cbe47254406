// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/JacobianValidation/JacobianCertificate.h>

namespace knotwork
{
/// How cells fit together, as far as it is known beside their control points. Everything may be
/// empty: then cells are glued where whole sides agree bit by bit.
struct CellComplex
{
  /// Patch of each cell. Empty: every cell is a patch of its own.
  std::vector<int> Patches;
  /// Box of each cell in the parameter domain of its patch (quadrilaterals and hexahedra; the third
  /// interval of quadrilaterals is not looked at). Cells of one patch are glued where their boxes
  /// touch, a coarse side to several finer ones too (hanging nodes). Boxes of a cell without a
  /// domain: Lower == Upper. Empty: none.
  std::vector<ParametricBox<3>> Boxes;
  /// An id for every coefficient, cell by cell in the cells' order. Corners with the same id are
  /// the same point of the complex, and sides of one patch that share all ids are inner ones; sides
  /// of one patch that only have the same control points are a seam. Empty: none.
  std::vector<std::int64_t> PointIds;
};

enum class InjectivityVerdict : std::int8_t
{
  NotInjective = -1,
  Undecided = 0,
  Injective = 1,
  InjectiveUpToSeam = 2 ///< but for boundary points that exactly coincide: InjectivityReason
};
/// "injective", "injective_up_to_seam", "not_injective", "undecided".
const char* ToString(InjectivityVerdict verdict);

enum class InjectivityReason : std::uint8_t
{
  None,          ///< injective without reservation
  Seam,          ///< two sides of one patch have the same control points
  CollapsedSide, ///< a side is a point or a curve
  Touching,      ///< corners or edges of the boundary coincide exactly
  FoldedCell,    ///< det J takes both signs in a cell
  FoldedSide,    ///< two cells lie on the same side of the side they share
  Overlap,       ///< two different points have the same image
  LocalJacobian, ///< the local certificate does not prove det J != 0 in a cell
  Gap,           ///< sides of two patches nearly agree, but are not equal: Gaps
  OpenSide,      ///< a side of a patch's element is only partly covered by its neighbours
  OpenBoundary,  ///< what is left unglued does not form closed curves or surfaces
  Boxes,         ///< InjectivityParams::MaxBoxes: more may go on
  TooClose       ///< boundary points that no subdivision separates: they touch, or all but touch
};
/// One plain sentence, without a full stop.
const char* ToString(InjectivityReason reason);

/// Sides are numbered so: Quadrilateral, Hexahedron 2 d + end (u = 0, u = 1, v = 0, ...); Triangle
/// v = 0, u + v = 1, u = 0; Tetrahedron u = 0, v = 0, w = 0, u + v + w = 1; Wedge v = 0, u + v = 1,
/// u = 0, w = 0, w = 1.
int NumSides(CellShape shape);

/// A pair of points. NotInjective by Overlap: both have the same image, which is proved: the exact
/// second point lies within Radius of its parameters. Otherwise the place that the reason speaks
/// of.
struct InjectivityWitness
{
  struct Place
  {
    int Cell = -1;
    int Side = -1; ///< -1: inside the cell
    std::array<double, 3> Parameters{};
    std::array<double, 3> Position{};
  };
  std::array<Place, 2> Places;
  double Radius = 0.0;
};

/// Sides of two patches that should be one interface.
struct InterfaceGap
{
  std::array<int, 2> Cells{ -1, -1 };
  std::array<int, 2> Sides{ -1, -1 };
  double Size = 0.0; ///< largest distance found between them (sampled)
  std::array<double, 3> Position{};
};

struct InjectivityParams
{
  /// Pairs of sub-sides and sub-cells looked at, over all, >= 1; of few cells a 7500th part of it a
  /// cell, at least a 125th, so that the proof costs about as much as the cells are many. A pair of
  /// sides gets up to 4096 first; those still open share what is left.
  std::int64_t MaxBoxes = 1000000;
  /// Sides of different patches that come nearer than this part of the model's size along more than
  /// half of one of them are a gap. In [0, 1]. 0: only sides whose corners all coincide.
  double GapTolerance = 1e-6;
  /// Neighbouring elements of one patch may differ along their common side by this part of the
  /// largest coordinate: the rounding of their extraction. In [0, 1e-6]. What was found is
  /// reported.
  double InnerTolerance = 0x1p-40;
  /// Sides of patches whose control points agree within this part of the largest coordinate, and
  /// weights likewise, are glued: what rounding leaves of equal sides that were computed on two
  /// ways. What was found is reported. In [0, 1e-6]. 0: only sides that agree bit by bit.
  double InterfaceTolerance = 0x1p-48;
  /// As JacobianParams::CollapseTolerance, for sides; control points of a side that agree so are
  /// one point: it stands still there. In [0, 1e-6].
  double CollapseTolerance = 0x1p-46;
  int Threads = 0; ///< 0 = all cores; the result does not depend on it
};

struct InjectivityCertificate
{
  InjectivityVerdict Verdict = InjectivityVerdict::Undecided;
  InjectivityReason Reason = InjectivityReason::None;
  bool HasWitness = false;
  InjectivityWitness Witness;
  std::vector<InterfaceGap> Gaps; ///< all, or those met before NotInjective was proved
  int NumBoundarySides = 0;
  int NumBoundaryComponents = 0;
  int NumInterfaces = 0;      ///< pairs of sides of different patches that are glued
  int NumSeams = 0;           ///< pairs of sides of one patch that are glued by their points alone
  int NumCollapsedSides = 0;  ///< sides that are a point or a curve
  int NumTouching = 0;        ///< boundary corners and edges that coincide with others
  double InnerRounding = 0.0; ///< largest difference met at glued sides, a length
  std::int64_t Boxes = 0;
};

/// Proves that a plane or solid map of Bernstein cells is injective as a whole, or that it is not.
///
/// When det J > 0 in every cell (the local certificate), inner sides cancel in pairs of opposite
/// orientation, the boundary is simple (its components closed, disjoint and without
/// self-intersection), and near one point of every component the map covers the plane or space just
/// once, then the degree of the map is 0 or 1 everywhere off the boundary's image, which is the
/// number of preimages of almost every point, and open maps can take no value twice then. Cells of
/// det J < 0 count as mirrored.
///
/// A surface that one point sees all of from inside is simple. Other boundary sides are bisected
/// until convex hulls are separated by a plane; pieces that share a
/// corner by a plane through it; pieces that share an edge, and single pieces, by a projection
/// under which their common chart is monotone, or where the outline of the projection is simple and
/// its Jacobian positive inside. All of it with bounds of the rounding. Overlaps are
/// proved by a contraction argument for the second preimage.
/// @param certificate  of the same cells.
/// @return what BernsteinCells::Check says; EmptyInput; DimensionMismatch unless all cells have 2
/// parameters and components, or 3; SizeMismatch for a complex or certificate of other sizes;
/// InvalidParameter; Aborted.
/// @complexity O(cells log cells) and as many boxes as the boundary's curvature and nearness ask.
/// @source  Kestelman, Amer. Math. Monthly 78 (1971) 1-9; Meisters & Olech, Duke Math. J. 30 (1963)
/// 63-80 (degree arguments for globally one-to-one maps).
Result<InjectivityCertificate> ProveInjectivity(const BernsteinCells& cells,
  const CellComplex& complex, const JacobianCertificate& certificate,
  const InjectivityParams& params = {}, const ProgressCallback& progress = {});
}
