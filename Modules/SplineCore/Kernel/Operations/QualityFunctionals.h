// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/BezierForm.h>

#include <Eigen/SparseCore>

namespace knotwork
{
/// Measures of the quality of a map g of the parameter domain into Dim-space: integrals over the
/// domain of sums of squares, int sum_i q_i^2. Indices of g are derivatives with respect to the
/// domain's parameters, k and l run over the Dim directions.
/// @source  Falini, Speh, Juettler, CAGD 35-36 (2015) 95-108, in the plane; here for every Dim.
enum class QualityKind
{
  Uniformity,      ///< int sum_kl |g_kl|^2: mixed derivatives count twice (thin plate)
  Length,          ///< int sum_k |g_k|^2
  Orthogonality,   ///< int sum_{k<l} (g_k . g_l)^2
  Skewness,        ///< int sum_{k<l} [(g_k . g_l)^2 / (|g_k|^2 |g_l|^2)]^2, cos^4 of the angles
  Eccentricity,    ///< int sum_k [(g_k . g_kk) / |g_k|^2]^2, squared slopes of log |g_k|
  Area,            ///< int (det J)^2
  SelfIntersection ///< int sum_k 1 / (|g_k|^2 + 1e-7)^2
};
inline constexpr int NumQualityKinds = 7;

/// Uniformity and Length are quadratic functionals of the control points.
constexpr bool IsQuadratic(QualityKind kind)
{
  return kind == QualityKind::Uniformity || kind == QualityKind::Length;
}

/// Value of a functional by Gauss quadrature, p + 1 points a direction on every element: exact for
/// the quadratic ones. Infinite where a measure divides by a g_k that is 0.
/// Bit-identical for any number of threads.
/// @param form  polynomial, Dim components, with a parameter domain.
template <int Dim>
double QualityValue(const BezierForm<Dim>& form, QualityKind kind, int threads = 0);

/// The same of control points in a space.
template <int Dim>
double QualityValue(const SplineSpacePtr<Dim>& space, const PointMatrixView& controlPoints,
  QualityKind kind, int threads = 0);

/// Symmetric matrix K of a weighted sum of the quadratic functionals in the space's *local
/// functions*: with q = T c (see SplineSpace) the sum is trace(q^T K q); for a tensor-product space
/// q = c. Integrals are exact: on an element they are products of one integral a direction.
/// @param lengths  empty, or what each element's part of the length counts beside length.
/// @complexity O(elements * prod(p + 1)^2); elements where nothing counts cost nothing.
template <int Dim>
Eigen::SparseMatrix<double, Eigen::RowMajor> QuadraticMatrix(const SplineSpace<Dim>& space,
  double uniformity, double length, int threads = 0, const std::vector<double>& lengths = {});

/// T as a sparse matrix, NumLocalFunctions x NumFunctions. @pre !space.IsIdentityMap()
template <int Dim>
Eigen::SparseMatrix<double, Eigen::RowMajor> TruncationMatrix(const SplineSpace<Dim>& space);

/// Lower triangle of T^T matrix T: a symmetric matrix in local functions, in the functions.
template <int Dim>
Eigen::SparseMatrix<double> LowerInFunctions(
  const SplineSpace<Dim>& space, const Eigen::SparseMatrix<double, Eigen::RowMajor>& local);

/// Derivatives of a map at a point that the measures which are not quadratic read: rows g_0, ...,
/// then g_00, g_11, ....
template <int Dim>
using QualityJet = Eigen::Matrix<double, 2 * Dim, Dim, Eigen::RowMajor>;

/// One q_i with its derivatives with respect to the entries of the jet.
template <int Dim>
struct QualityResidual
{
  double Value = 0.0;
  QualityJet<Dim> Gradient;
};

/// The q_i at a point of a measure that is not quadratic.
/// @param residuals  room for three. @return how many there are.
template <int Dim>
int QualityResiduals(QualityKind kind, const QualityJet<Dim>& jet, QualityResidual<Dim>* residuals);
/// Only Eccentricity reads second derivatives.
constexpr bool ReadsSecondDerivatives(QualityKind kind)
{
  return kind == QualityKind::Eccentricity;
}
}
