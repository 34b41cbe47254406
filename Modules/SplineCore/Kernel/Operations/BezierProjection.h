// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Spline.h>

#include <functional>

namespace knotwork
{
/// Values of the projected function at points of one element.
/// @param element  id. @param local  n x Dim in [0, 1]. @param parameters  n x Dim, in the domain.
/// @param values   n x c, to fill. May be called from several threads.
/// @return false to report that the function is not defined there (ends with OutsideDomain).
using ElementFunction = std::function<bool(
  int element, const PointMatrix& local, const PointMatrix& parameters, PointMatrix& values)>;

struct ProjectionParams
{
  int ExtraPoints = 1; ///< Gauss points a direction: p + 1 + ExtraPoints, in [0, 16]
  int Threads = 0;
  ProgressCallback Progress;
};

/// Bezier projection: local L2 projection on every element, local spline coefficients by the
/// inverse extraction, weighted averages over the elements on which the function's own coefficient
/// appears. Reproduces splines of the space, local, O(h^{p+1}), no global solve.
/// @source  Thomas, Scott, Evans, Tew, Evans, CMAME 284 (2015) 55-105; for hierarchical spaces the
/// averages run over the function's own level only (Speleers & Manni, Numer. Math. 132 (2016)).
/// @return EmptyInput, InvalidParameter; OutsideDomain, NonFiniteInput or SizeMismatch with the
/// first element on which the function failed; Aborted. The result is polynomial.
/// @post  bit-identical for any number of threads.
template <int Dim>
Result<Spline<Dim>> ProjectOntoSpace(const SplineSpacePtr<Dim>& space, int numComponents,
  const ElementFunction& function, const ProjectionParams& params = {});

/// The same with given coefficients in some functions: on every element the polynomials nearest in
/// L2 with these. What curves or surfaces have been fitted to goes on inside so.
/// @param functions  of the space, each once. @param values  as many rows, a column a component.
/// @return also InvalidParameter for a function that is not there, SizeMismatch.
/// @post  a spline of the space that has the given coefficients is reproduced.
/// @complexity that of the projection, and O((p + 1)^(3 Dim)) for every kind of element.
template <int Dim>
Result<Spline<Dim>> ProjectWithCoefficients(const SplineSpacePtr<Dim>& space,
  const ElementFunction& function, const std::vector<int>& functions, const PointMatrix& values,
  const ProjectionParams& params = {});
}
