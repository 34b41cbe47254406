// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/BezierProjection.h>
#include <knotwork/SplineCore/MeshPatches.h>

#include <Eigen/SparseCore>

/// Projection onto unstructured spaces by way of the tensor-product patches of their meshes.
namespace knotwork
{
/// How coefficients of the patches become those of the space: rows of Restriction.
enum class RestrictionKind
{
  /// Means over the patches by the shares of the function's integral, of the rows that invert the
  /// Prolongation on the cells of the patch; there always are such.
  Weighted,
  /// The shortest row among those on the function's own rows of the Prolongation; there may be none
  /// next to facets of C^1 and more between patches (policies Motorcycle and Minimal).
  Plain
};

/// A space and the direct sum of the clamped B-splines of its patches, which contains it.
template <int Dim>
struct CompositeProjection
{
  using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

  SplineSpacePtr<Dim> Space;
  MeshPatches<Dim> Layout;                  ///< FindSpacePatches of the space
  std::vector<SplineSpacePtr<Dim>> Patches; ///< tensor-product spaces, C^1 and smoother inside
  std::vector<int> First;                   ///< function of a patch, and the number of all
  Matrix Prolongation; ///< patch functions x functions; of 0 and 1 where patches meet C^0
  Matrix Restriction;  ///< functions x patch functions; Restriction Prolongation = 1
};

/// @return EmptyInput; DimensionMismatch unless the space is of kind Unstructured; NotInSpace with
/// the function that has no Plain restriction.
/// @complexity O(cells (p + 1)^Dim); Plain: a dense factorization for every function that shares
/// rows of the Prolongation with others.
template <int Dim>
Result<CompositeProjection<Dim>> MakeCompositeProjection(
  const SplineSpacePtr<Dim>& space, RestrictionKind restriction = RestrictionKind::Weighted);

/// Bezier projection patch by patch, direction by direction, and Restriction: reproduces splines of
/// the space, O(h^{p+1}). Weighted, and with patches that meet C^0 everywhere (policy Full unless
/// strips of cells close without a crease), the result of ProjectOntoSpace to rounding.
/// Values at all Gauss points of a patch are kept, reduced in one direction.
/// @return as ProjectOntoSpace; with the lowest element that failed among those that were tried.
/// @post  bit-identical for any number of threads.
template <int Dim>
Result<Spline<Dim>> ProjectByPatches(const CompositeProjection<Dim>& composite, int numComponents,
  const ElementFunction& function, const ProjectionParams& params = {});
}
