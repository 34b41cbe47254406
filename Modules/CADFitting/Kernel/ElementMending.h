// SPDX-License-Identifier: BSD-3-Clause
// Control points that are moved until elements are valid, private to the kernel.
#pragma once
#include <knotwork/JacobianValidation/JacobianCertificate.h>
#include <knotwork/SplineCore/CellMesh.h>
#include <knotwork/SplineCore/Spline.h>

namespace knotwork
{
/// Elements of a spline on a mesh without a certificate: not valid, or, where most are reversed,
/// not reversed.
struct ElementVerdicts
{
  JacobianCertificate Certificate;
  std::vector<int> Bad;
  bool IsReversed = false; ///< most elements are
};

/// Of surfaces in a plane z = const the map of the plane is meant.
/// @return those of ValidateJacobian.
template <int Dim>
Result<ElementVerdicts> CertifyElements(
  const Spline<Dim>& spline, int threads, const ProgressCallback& progress = {});

/// Elements whose control net is inverted: at one of its cells det J of the corner differences is
/// not positive (surfaces in space: seen along the mean normal of the net).
template <int Dim>
std::vector<int> InvertedNets(const Spline<Dim>& spline, bool isReversed);

/// Of a control point that stays whatever Attraction is; 1: it is held while Attraction is 0.
inline constexpr char HeldFast = 2;

struct MendingParams
{
  int Rings = 2;
  /// Of MinimizeBarrier: 0: control points that are held stay. Else they move too, and the squares
  /// of their moves, in lengths of elements, count so much beside the functional of an element.
  double Attraction = 0.0;
  int Threads = 0;
  ProgressCallback Progress;
};

/// Adds a harmonic extension of the moves that the surface's control points made to those inside,
/// in rings of elements around some.
/// @param moves  NumFunctions x 3, of the functions that are held. @param isHeld  one a function.
/// @return how many elements changed.
template <int Dim>
int ExtendMoves(Spline<Dim>& spline, const std::vector<int>& elements, const PointMatrix& moves,
  const std::vector<char>& isHeld, const MendingParams& params);

/// Minimizes the barrier functional |J|^2 / (det J)^(2 / Dim) in rings of elements around some, by
/// their control points that are not held, or not held fast (Attraction). Of a surface in space
/// what is seen along the mean normal of the patch moves across that normal; patches that bend too
/// much for that stay.
/// @return how many elements changed; Aborted.
template <int Dim>
Result<int> MinimizeBarrier(Spline<Dim>& spline, const std::vector<int>& elements, bool isReversed,
  const std::vector<char>& isHeld, const MendingParams& params);
}
