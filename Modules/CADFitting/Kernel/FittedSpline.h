// SPDX-License-Identifier: BSD-3-Clause
// The spline on a mesh that lies on its target, private to the kernel.
#pragma once
#include "ElementMending.h"
#include "FittedMesh.h"
#include "ProgressiveFit.h"

namespace knotwork
{
/// A spline on a mesh, how it is made, and which of its elements are valid.
template <int Dim>
struct FittedSpline
{
  SplineSpacePtr<Dim> Space;
  CreasePolicy Policy = CreasePolicy::Full; ///< that was taken
  FastPath<Dim> Fast;
  std::vector<int> LinearCells; ///< as ProgressiveFitParams
  Spline<Dim> Value;
  Spline<Dim> Before; ///< as ProgressiveFit
  std::vector<int> OnCurves;
  std::vector<std::string> Warnings;
  ElementVerdicts Verdicts;

  /// Makes the space of a mesh and the spline there, along features that go on where creases end on
  /// the surface of a volume, and element by element where a quicker path leaves some invalid.
  /// @param hasMeanLengths  of knot intervals.
  /// @return the errors of MakeUnstructuredSpace, MeanSheetLengths and the target; Aborted.
  Status Fit(const FittedMesh<Dim>& mesh, bool hasMeanLengths, const CADFitParams& params);
  /// The spline of the space as it is. @return the errors of FitProgressively.
  Status Project(const FittedMesh<Dim>& mesh, const CADFitParams& params);
  /// The spline projected onto the target once more from where it is now.
  Result<ProgressiveFit<Dim>> ProjectedAgain(
    const FittedMesh<Dim>& mesh, const CADFitParams& params) const;
  /// Of the spline as it is. @return the errors of CertifyElements.
  Status Certify(const CADFitParams& params, ElementVerdicts& verdicts) const;
};
}
