// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Spline.h>

namespace knotwork
{
/// Per element the Bernstein control points of a spline, one contiguous block an element: c planes
/// of prod(p_d + 1) values (first parameter fastest), homogeneous (w x, w y, ..., w; the weights
/// are the last plane) only when rational. What batches of evaluations, tessellation, certificates,
/// quadrature of geometry and the VTK bridge take.
template <int Dim>
struct BezierForm
{
  SplineSpacePtr<Dim> Space; ///< elements: degrees, boxes, location
  int NumComponents = 0;     ///< of the Euclidean point
  bool Rational = false;
  std::vector<std::size_t> Offsets; ///< NumElements + 1 offsets into Data
  std::vector<double> Data;

  int NumPlanes() const { return this->NumComponents + (this->Rational ? 1 : 0); }
  const double* Block(int e) const
  {
    return this->Data.data() + this->Offsets[static_cast<std::size_t>(e)];
  }
  double* Block(int e) { return this->Data.data() + this->Offsets[static_cast<std::size_t>(e)]; }
};

/// The blocks of a BezierForm one after the other, where all at once would be too much memory.
/// Keeps the spline's coefficients, which must live as long.
template <int Dim>
class BezierElements
{
public:
  /// @pre spline.Check() is Ok.
  explicit BezierElements(const Spline<Dim>& spline, int threads = 0);
  int NumPlanes() const { return this->Planes; }
  /// @param block  gets NumPlanes() planes of the element's functions.
  void Block(int e, double* block) const;

private:
  SplineSpacePtr<Dim> Space;
  int Planes;
  PointMatrix Copy;           ///< of coefficients that are not read in place
  const double* Coefficients; ///< rows of Planes values
};

/// Bezier form of a spline. @pre spline.Check() is Ok. @complexity O(elements * (p+1)^(Dim+1) * c).
template <int Dim>
BezierForm<Dim> MakeBezierForm(const Spline<Dim>& spline, int threads = 0);

/// What a batch evaluation computes.
struct EvaluationParams
{
  int Derivatives = 0; ///< highest order, 0..2
  int Threads = 0;     ///< 0 = all cores
};

/// Output of a batch; kept between calls it is not allocated again. Derivatives are with respect to
/// the parameters of the domain (of the element's [0, 1]^Dim when the family has no domain), exact
/// for rational splines (quotient rule).
struct EvaluationBatch
{
  PointMatrix Values; ///< n x c
  PointMatrix First;  ///< n x (Dim * c): d/du_0 of all components, then d/du_1, ...
  PointMatrix
    Second; ///< n x (Dim (Dim + 1) / 2 * c): pairs 00, 01, 11 in 2D; 00, 01, 02, 11, 12, 22 in 3D
  std::vector<int> Elements; ///< n; -1 where the point lies outside the domain (rows are NaN)
};

/// Evaluates at n parameter points of the domain, in any order.
/// @param parameters  n x Dim.
/// @return SizeMismatch, DimensionMismatch (no domain), InvalidParameter; OutsideDomain when a
/// point lies outside (the others are evaluated; the detail names the first).
/// @complexity one location and (p+1)^Dim multiplications a component and point; equal
/// degrees in all directions are compiled for their size.
template <int Dim>
Status EvaluateParameters(const BezierForm<Dim>& form, const PointMatrixView& parameters,
  const EvaluationParams& params, EvaluationBatch& batch);

/// Evaluates at n points given as element + local parameters in [0, 1]^Dim. Derivatives as above.
template <int Dim>
Status EvaluateElements(const BezierForm<Dim>& form, const std::vector<int>& elements,
  const PointMatrixView& local, const EvaluationParams& params, EvaluationBatch& batch);
}
