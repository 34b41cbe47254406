// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "GalerkinProblem.h"

namespace knotwork
{
/// What follows from a solution. Fluxes and stresses are those at Gauss points, fewer than the
/// matrix is made with on rational elements, and for drawing projected onto the functions (least
/// squares), which smooths them.
struct ResultFields
{
  /// A row a point: k grad u (Poisson), or the stress XX YY ZZ XY YZ XZ, von Mises' stress and the
  /// principal stresses, the largest first.
  PointMatrix GaussValues;         ///< no rows unless asked for
  PointMatrix GaussPoints;         ///< positions, a row each
  std::vector<int> GaussElements;  ///< of each point
  PointMatrix Projected;           ///< the same columns, a row a function
  Eigen::VectorXd Energy;          ///< of each element, half of a(u, u)
  Eigen::VectorXd LargestVonMises; ///< of each element at its Gauss points; size 0 for Poisson
  /// Of the solution, or of the length of displacements, at Gauss points and corners of facets.
  double LargestValue = 0.0;
  /// Von Mises' stress, or the length of the flux, where it is largest among evenly spaced points
  /// of the elements, degree + 1 a direction, on their boundaries too; and that point.
  double Peak = 0.0;
  Eigen::VectorXd PeakPosition;
};

/// Functions that are not 0 on facets, ascending.
std::vector<int> FunctionsOnFacets(const GalerkinSpace& space, const std::vector<CellSide>& facets);

/// Length or area of facets, by quadrature.
double FacetMeasure(const GalerkinSpace& space, const std::vector<CellSide>& facets);

/// Length of edges, likewise.
double EdgeLength(const GalerkinSpace& space, const std::vector<ElementEdge>& edges);

/// Columns of ResultFields::GaussValues: the flux's 3 alone, or all 10.
int NumResultColumns(GalerkinEquation equation);

/// @param keepGaussPoints  whether GaussValues, GaussPoints and GaussElements are wanted: a row a
/// point. @param boundary  facets whose corners count for LargestValue. @param coefficients  of the
/// solution. @return SingularSystem when functions are dependent;
/// Aborted.
/// @complexity O(elements q (p+1)^(2 Dim)) for q quadrature points, and conjugate gradients for the
/// mass matrix.
Result<ResultFields> MakeResultFields(const GalerkinSpace& space, const GalerkinProblem& problem,
  const std::vector<CellSide>& boundary, const PointMatrix& coefficients, bool keepGaussPoints,
  const GalerkinParams& params, const ProgressCallback& progress = {});
}
