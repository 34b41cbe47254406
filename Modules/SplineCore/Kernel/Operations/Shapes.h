// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/SizeLimit.h>
#include <knotwork/SplineCore/Spline.h>

namespace knotwork
{
/// Ready-made spline geometries. All are exact: circles, cylinders, spheres and tori are rational.
/// Every map is right-handed with det J > 0 everywhere (surfaces in space: normal outward and never
/// zero), except where a sentence below says "degenerate". The words in brackets say what the three
/// numbers ShapeParams::Elements count.
enum class ShapeKind
{
  Line,                 ///< curve along x of length Size[0] [along]
  Arc,                  ///< circular arc of OuterRadius from +x through Angle [along]
  Square,               ///< Size[0] x Size[1] [x, y]
  AnnulusSector,        ///< InnerRadius to OuterRadius, from +x through Angle [radial, angular]
  Disc,                 ///< 5 patches: a square core with corners at InnerRadius and four patches
                        ///< out to OuterRadius [radial, along the core's sides]
  PlateWithHole,        ///< 4 patches: Size[0] x Size[1] without the disc of InnerRadius [radial,
                        ///< around]
  QuarterPlateWithHole, ///< 2 patches: the quarter x, y >= 0 of PlateWithHole [radial, around]
  CylinderSurface,      ///< OuterRadius, Angle, Height along z [angular, axial]
  SphereSurface,        ///< 6 patches of degree 4, OuterRadius [along the sides]
  PolarSphereSurface,   ///< one patch, OuterRadius, longitudes from +x through Angle; degenerate at
                        ///< the poles: an edge is a point [longitude, latitude]
  TorusSurface,         ///< tube of InnerRadius around the circle of OuterRadius, Angle about z
                        ///< [about z, around the tube]
  Cube,                 ///< Size[0] x Size[1] x Size[2] [x, y, z]
  SolidTube,            ///< AnnulusSector times Height [radial, angular, axial]
  SolidCylinder,        ///< 5 patches: Disc times Height [radial, along the core's sides, axial]
  BallSector,           ///< InnerRadius to OuterRadius, longitudes from +x through Angle, latitudes
                        ///< +-PolarAngle / 2; degenerate at the centre when InnerRadius is 0 and
                        ///< at the poles when PolarAngle is 180 [radial, longitude, latitude]
  Ball,       ///< 7 patches: a cube core with corners at InnerRadius and six patches out to
              ///< OuterRadius, degree 4 [radial, along the core's sides]
  TwistedBar, ///< Size, every slice z = const the rectangle turned about z, by Twist in all; its
              ///< volume is that of Cube [x, y, z]
  SolidTorus  ///< 5 patches: Disc of InnerRadius (core corners at half of it) turned about z
              ///< at distance OuterRadius through Angle [radial, along the core's sides, about z]
};
inline constexpr int NumShapeKinds = 18;

/// Name of a shape as in the enumeration, nullptr for another number.
const char* ToString(ShapeKind kind);
/// Parameters of its patches: 1, 2 or 3.
int NumParameters(ShapeKind kind);

/// Lengths in any one unit, angles in degrees.
struct ShapeParams
{
  ShapeKind Kind = ShapeKind::Square;
  double InnerRadius = 0.5;                 ///< > 0 (BallSector: >= 0) and < OuterRadius
  double OuterRadius = 1.0;                 ///< > 0
  double Angle = 90.0;                      ///< (0, 360]; at 360 a seam of equal points remains
  int Sectors = 1;                          ///< patches that share Angle (AnnulusSector,
                                            ///< SolidTube), [1, 4096]; a ring at 360 degrees
  double PolarAngle = 90.0;                 ///< (0, 180]
  double Height = 1.0;                      ///< > 0
  double Twist = 90.0;                      ///< [-3600, 3600]
  std::array<double, 3> Size{ 1., 1., 1. }; ///< > 0; PlateWithHole: > 2 InnerRadius
  std::array<double, 3> Center{};           ///< of the box, circle, sphere, ring or axis
  /// Every direction is raised to this degree, 1..9; 0 (and directions above it): the lowest degree
  /// that is exact.
  int Degree = 0;
  /// Every knot span of the shape is cut into so many equal elements, >= 1, with the highest
  /// continuity at the new knots.
  std::array<int, 3> Elements{ 1, 1, 1 };
  int MaxFunctions = DefaultMaxFunctions; ///< of all patches, >= 1
};

/// Makes the patches of a shape: tensor-product spaces, three-component points, rational where the
/// shape needs it. Patches that touch agree there point by point, in parameters, degrees, knots and
/// weights.
/// @return InvalidParameter naming the parameter; TooLarge for more than
/// MaxFunctions.
/// @source  The NURBS Book, chapters 7 and 8 (arcs, ruled surfaces, revolution); Cobb, Tiling the
/// sphere with rational Bezier patches, University of Utah UUCS-88-009, 1988 (six patches).
/// @complexity O(control points * degree).
Result<std::vector<AnySpline>> MakeShape(const ShapeParams& params);
}
