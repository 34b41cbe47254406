// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "Interval.h"
#include <knotwork/SplineCore/Spline.h>

/// Private to the search of critical points: a function as polynomial pieces on boxes of a plane,
/// with bounds of their rounding errors, and how the pieces join.
namespace knotwork
{
using PlaneBox = std::array<Interval, 2>;

/// A polynomial on [0, 1]^2 in Bernstein form.
struct BernsteinField
{
  IntArray<2> Degree{};
  std::vector<double> C;  ///< first parameter fastest
  double Error = 0.0;     ///< every coefficient may be off by so much
  double Magnitude = 0.0; ///< largest absolute coefficient

  /// Sets the magnitude and adds roundings of that size to the error.
  void Close(double roundings);
  /// Bounds on a box of local parameters inside [0, 1]^2, of any width.
  /// @complexity O((p + 1)^3).
  Interval Range(const PlaneBox& local) const;
  /// Half the width of the range at a point.
  double Noise() const
  {
    return this->Error + 8.0 * (this->Degree[0] + this->Degree[1]) * 0x1p-53 * this->Magnitude +
      0x1p-900;
  }
  double Evaluate(const RealArray<2>& local) const;
};

/// One element. The function is scaled by a power of two and shifted (ScalarPieces): where
/// rational, f = Value / Weight and Gradient is the numerator Weight^2 grad f.
struct ScalarPiece
{
  PlaneBox Box;
  BernsteinField Value;
  BernsteinField Weight; ///< empty unless rational
  std::array<BernsteinField, 2> Gradient;
  std::array<std::array<BernsteinField, 2>, 2> Jacobian; ///< [d][k]: d Gradient[d] / d parameter k

  /// The part of a box of the plane on the piece in local parameters, rounded outward.
  PlaneBox Local(const PlaneBox& box) const;
  bool Holds(const RealArray<2>& point) const
  {
    return this->Box[0].Lo <= point[0] && point[0] <= this->Box[0].Hi &&
      this->Box[1].Lo <= point[1] && point[1] <= this->Box[1].Hi;
  }
};

enum class JoinKind : std::uint8_t
{
  Smooth,  ///< the gradient is continuous
  Crease,  ///< the function is
  Boundary ///< nothing there, or the function jumps
};

/// A part of a side of a piece. Sides: 0 and 1 are the lower and upper end of the first parameter,
/// 2 and 3 of the second.
struct PieceJoin
{
  int Side = 0;
  int Neighbor = -1; ///< -1: Boundary
  JoinKind Kind = JoinKind::Boundary;
  Interval Along; ///< of the other parameter
};

class ScalarPieces
{
public:
  std::vector<ScalarPiece> Pieces;
  std::vector<std::size_t> JoinStart; ///< pieces + 1
  std::vector<PieceJoin> Joins;       ///< of a piece by side, then along it
  double Shift = 0.0;
  double Scale = 1.0; ///< f of the spline = Shift + Scale * f of the pieces
  bool Rational = false;
  /// Without a domain: local parameter d of element e is the plane's direction Axis[e][d], against
  /// it where Reversed[e][d].
  bool HasDomain = true;
  std::vector<IntArray<2>> Axis;
  std::vector<std::array<bool, 2>> Reversed;

  const PieceJoin* BeginJoins(int e) const
  {
    return this->Joins.data() + this->JoinStart[static_cast<std::size_t>(e)];
  }
  const PieceJoin* EndJoins(int e) const
  {
    return this->Joins.data() + this->JoinStart[static_cast<std::size_t>(e) + 1];
  }
  const ScalarPiece& operator[](int e) const { return this->Pieces[static_cast<std::size_t>(e)]; }
  int NumPieces() const { return static_cast<int>(this->Pieces.size()); }

  /// Bounds of the spline's f on the part of a box on a piece.
  Interval ValueRange(int e, const PlaneBox& box) const;
};

/// @return InvalidTopology: see FindCriticalPoints.
Result<ScalarPieces> MakeScalarPieces(const Spline<2>& spline, int component, int threads);

/// Finds neighbours and compares the functions and gradients of both sides; fills the joins.
void JoinPieces(ScalarPieces& pieces, int threads);
}
