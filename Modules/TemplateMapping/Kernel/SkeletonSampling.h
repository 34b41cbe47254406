// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/BernsteinCells.h>
#include <knotwork/SplineCore/Spline.h>
#include <knotwork/TemplateMapping/Skeleton.h>

namespace knotwork
{
/// Points of a patch that is made from a spline, at least, unless asked otherwise: a circle of
/// radius 1 is then followed to 5e-6, a quarter of a sphere to 3e-4.
inline constexpr int DefaultCurveSamples = 2000;
inline constexpr int DefaultSurfaceSamples = 4000;

/// A spline curve of the plane as a patch: every element cut into equally many intervals of equal
/// parameters, so that all knots are points. Parameters are those of the curve (element number plus
/// local parameter for a chain of Bezier elements without a domain), normals are exact.
/// @param curve    2 or 3 components, Check() Ok; the third must be 0 to 1e-9 of the size.
/// @param samples  at least so many points, [2, 10^7]; 0: DefaultCurveSamples.
/// @return DimensionMismatch (not in the plane z = 0), InvalidTopology (elements that do not join),
/// InvalidParameter (samples).
Result<SkeletonPatch<2>> SampleCurve(int id, const Spline<1>& curve, int samples = 0);

/// A spline surface in space as a patch. With a domain: a grid whose lines contain the sides of all
/// elements, parameters those of the surface. Without: as SampleCells. Normals are exact where the
/// surface has one, else those of the mesh.
/// @param surface  3 components, Check() Ok.
Result<SkeletonPatch<3>> SampleSurface(int id, const Spline<2>& surface, int samples = 0);

/// Quadrilaterals and triangles in Bernstein form as one patch: every side cut into equally many
/// intervals. A single cell has its local parameters; several have none. Copies of a point on
/// common sides are bit-equal.
/// @param cells    3 components, Check() Ok, no other shapes.
Result<SkeletonPatch<3>> SampleCells(int id, const BernsteinCells& cells, int samples = 0);
}
