// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/BezierForm.h>

namespace knotwork
{
/// About a gigabyte and a half.
inline constexpr int DefaultMaxContourPoints = 5000000;

struct ContourParams
{
  /// Values of the contours, any order; finite. Empty: NumLevels of them.
  std::vector<double> Levels;
  /// >= 1; evenly inside the range of the values at the elements' corners, as ContourLevels says.
  int NumLevels = 10;
  int Component = -1; ///< of the points of the surface; -1: the last
  /// Of |value - level| everywhere on a contour; > 0, or 0: a ten-thousandth of the range of the
  /// values at the elements' corners.
  double Tolerance = 0.0;
  int NumSpaceComponents =
    -1; ///< the first ones are positions in space; -1: those before Component
  /// Of the distance in space between a straight piece and the surface curve with the same
  /// parameters; >= 0, 0: as it comes.
  double ChordTolerance = 0.0;
  /// Opposite sides of the domain that lie on each other (all components) are joined.
  bool JoinSeams = true;
  int MaxCells = 65536; ///< an element is divided into for a level, in [16, 2^20]
  int MaxPoints = DefaultMaxContourPoints; ///< of all contours, >= 1
  int Threads = 0;
  ProgressCallback Progress;
};

/// A connected curve of a level.
struct ContourComponent
{
  int Level = 0; ///< index in ContourSet::Levels
  bool Closed = false;
  /// Rows of ContourSet::Parameters; a closed component does not repeat its first point.
  std::size_t First = 0;
  std::size_t NumPoints = 0;
  double MaxError = 0.0; ///< proved bound of |value - level| on its straight pieces
};

/// Where a limit stopped the division before the contour of a level was decided.
struct UndecidedBox
{
  int Level = 0;
  int Element = 0;
  ParametricBox<2> Box; ///< of the domain (of the element without a domain)
};

struct ContourSet
{
  std::vector<double> Levels;               ///< ascending, each once
  std::vector<ContourComponent> Components; ///< by level
  /// Of points: that of the straight piece that begins there.
  std::vector<int> Elements;
  PointMatrix Local;      ///< n x 2 in [0, 1]^2, of Elements
  PointMatrix Parameters; ///< n x 2, of the domain (Local without a domain)
  /// n x 2 in [0, 1]^2: the other end of the straight piece that begins at a point, on the point's
  /// own element; Local itself at the end of an open component and before a seam.
  PointMatrix PieceEnds;
  std::vector<int> NumComponents; ///< a level
  std::vector<int> NumClosed;
  std::vector<UndecidedBox> Undecided;
  double MaxError = 0.0;
  double Tolerance = 0.0; ///< that was used
};

/// Curves {value = level} of a component of a surface as chains of points on them, such that on all
/// straight pieces (straight in the parameter plane, each inside one element) |value - level| is
/// proved to stay within the tolerance, and with the number of components and their ends as the
/// surface has them.
///
/// A contour is the border of {value >= level - d}; d is 2^-46 of the values around the level or,
/// if that is more, four times the largest difference of values on both sides of elements' sides
/// that is no jump (up to 1e-9 of the coefficients), and at most a quarter of the tolerance. What
/// lies on the level belongs to the upper set. So saddles on the level join what is above, plateaus
/// on the level are surrounded, an isolated maximum on the level is a tiny loop and an isolated
/// minimum nothing. Components keep the upper set on their left in the parameter plane. They end on
/// the boundary of the domain and at jumps of the value (lines of full multiplicity). Components
/// that cross a seam repeat the point there with the parameters of both sides.
///
/// Elements are divided until every cell's Bernstein coefficients show that it has no point of the
/// contour, or that the value rises or falls along one parameter all over the cell; cells where
/// MaxCells (or a size of 2^-40) comes first are in Undecided: a ridge that lies on the level,
/// perhaps. Bit-identical for every number of threads.
///
/// @return EmptyInput; DimensionMismatch, InvalidParameter naming the option; NonFiniteInput
/// naming the element; TooLarge above MaxPoints; Aborted.
/// @complexity O(elements log elements) and what the contours cross.
/// @source  isolation by variation diminishing and monotone cells as in Plantinga & Vegter,
/// Visual Computer 23 (2007) 45-58; bounds of chords: blossoms.
Result<ContourSet> TraceContours(const BezierForm<2>& form, const ContourParams& params);

/// Smallest and largest value of a component at the elements' corners, and n values that divide
/// what lies between into n + 1 equal parts.
std::array<double, 2> CornerRange(const BezierForm<2>& form, int component);
std::vector<double> ContourLevels(const std::array<double, 2>& range, int n);
}
