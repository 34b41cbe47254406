// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/BoxTree.h>
#include <knotwork/SplineCore/TrimmedModel.h>

namespace knotwork
{
/// Where something lies with respect to a region of the plane.
enum class RegionPlace : std::int8_t
{
  Outside = -1,
  Boundary = 0, ///< it meets the boundary, or is too near to tell
  Inside = 1
};

/// The part of the parameter plane that loops enclose: the points around which their winding
/// numbers do not add up to zero. Where curves of a loop do not meet, straight lines close it.
/// Answers are true of the exact curves: piecewise Bezier curves with boxes that include rounding,
/// halved as far as a query needs. Queries are read-only and may run in parallel.
class TrimmedRegion
{
public:
  /// The whole plane.
  TrimmedRegion() = default;
  /// @param loops  as TrimmedFace::Loops; none are the whole plane.
  /// @return failures of Spline::Check; DimensionMismatch unless pcurves are tensor splines with 2
  /// coordinates; EmptyInput for a loop without curves. Details name loop and curve.
  static Result<TrimmedRegion> Create(const std::vector<TrimmedLoop>& loops);

  bool IsWholePlane() const { return this->Pieces.empty(); }

  /// Inside and Outside are proved for every point of the closed box; Boundary may also be a box
  /// that is nearer to a curve than about an eighth of its size.
  RegionPlace Classify(const RealArray<2>& lower, const RealArray<2>& upper) const;

  /// Inside and Outside are proved; Boundary is within about 1e-13 of the loops' size of a curve.
  RegionPlace Contains(const RealArray<2>& point) const;

  /// Sum of the loops' winding numbers around a point. @param onCurve  set when the point is too
  /// near to a curve to tell; the number means nothing then.
  int WindingNumber(const RealArray<2>& point, bool& onCurve) const;

private:
  struct Piece
  {
    int Degree = 1;
    bool Rational = false;
    std::size_t Offset = 0; ///< into Data: planes u, v(, w), homogeneous
  };
  struct Part;

  void AddPiece(int degree, bool rational, const double* planes, bool reversed);
  void AddLine(const RealArray<2>& from, const RealArray<2>& to);
  Status AddLoop(const TrimmedLoop& loop, const std::string& place);
  void Index();
  Part MakePart(int piece) const;

  std::vector<Piece> Pieces;
  std::vector<double> Data;
  double Slack = 0.0; ///< by which boxes are widened for rounding
  BoxTree Tree;
};
}
