// SPDX-License-Identifier: BSD-3-Clause
// Quicker ways to the spline of a mesh than by its elements one by one; private to the kernel.
#pragma once
#include "CADFit.h"

#include <knotwork/SplineCore/CompositeProjection.h>

#include <memory>
#include <string>
#include <vector>

namespace knotwork
{
/// How functions are projected onto one space. By default on its elements.
template <int Dim>
struct FastPath
{
  FitPath Path = FitPath::Unstructured;
  FitPath Tried = FitPath::Unstructured; ///< that was asked for
  std::string Note;                      ///< why it is not taken; empty: it is
  SplineSpacePtr<Dim> Space;
  /// Unless Unstructured.
  std::shared_ptr<const CompositeProjection<Dim>> Composite;
  std::vector<char> IsInside; ///< Coons: cells away from the sides of their patches
  PointMatrix Exact;          ///< Multilinear and Affine: the control points

  /// The mesh map as a spline.
  Result<Spline<Dim>> ProjectWhole(
    const ElementFunction& map, const ProjectionParams& params) const;
  /// Any function.
  Result<Spline<Dim>> Project(
    const ElementFunction& function, const ProjectionParams& params) const;
  /// Fills the insides of patches from their boundaries where that is the path.
  Status Complete(Spline<Dim>& spline) const;
};

struct FastPathParams
{
  FitPath Path = FitPath::Automatic;
  RestrictionKind Weights = RestrictionKind::Weighted;
  bool IsFull = false; ///< whether the space was made by CreasePolicy::Full
  /// Whether the spline is that of the mesh, without a target of its own.
  bool IsMeshTheTarget = false;
  /// Whether the inside of the patches lies on the target too.
  bool IsInsideFitted = false;
};

/// The path that is asked for where it gives the mesh's spline, else the unstructured one and why.
/// Automatic: the first of affine, multilinear, composite that gives what the unstructured path
/// does but for rounding.
/// @param points  NumPoints x 3, of the mesh.
/// @complexity O(cells (p + 1)^Dim).
template <int Dim>
FastPath<Dim> ChooseFastPath(
  const SplineSpacePtr<Dim>& space, const PointMatrix& points, const FastPathParams& params);
}
