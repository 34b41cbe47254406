// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "FitDivision.h"
#include "FitPoints.h"

namespace knotwork
{
/// What least squares needs of the points of every element: their moments with the Bernstein
/// polynomials of degree 2p, because a product of two of degree p is a multiple of one of these
/// (so (2p + 1)(2q + 1) sums instead of all pairs), and right-hand sides.
class ElementMoments
{
public:
  /// @param division  must outlive the object: what each process has is told to all.
  ElementMoments(const IntArray<2>& degree, int numComponents, const FitDivision& division);

  int NumMoments() const { return (2 * this->Degree[0] + 1) * (2 * this->Degree[1] + 1); }
  int PerElement() const { return NumTensorFunctions<2>(this->Degree); }
  int Stride() const { return this->NumMoments() + this->Components * this->PerElement(); }

  /// Takes the moments of elements that are as they were and sums up those of the others.
  /// @param parents  of the elements in the space that the moments belong to; empty: all are new.
  /// @param isSplit  elements of that space that are divided now.
  void Update(const SplineSpace<2>& space, const std::vector<int>& parents,
    const std::vector<bool>& isSplit, const FitPoints& points, int threads);
  /// Sums up the moments of some elements anew.
  void Recompute(const SplineSpace<2>& space, const std::vector<int>& elements,
    const FitPoints& points, int threads);

  /// Sum of weights of an element's points.
  double Weight(int e) const;
  /// Matrix of the element's Bernstein polynomials, PerElement^2 numbers.
  void Gram(int e, double* matrix) const;
  /// Sums of weight * value * Bernstein polynomial of a component, PerElement numbers.
  const double* Right(int e, int component) const
  {
    return this->Block(e) + this->NumMoments() + component * this->PerElement();
  }

private:
  const double* Block(int e) const
  {
    return this->Data.data() + std::ptrdiff_t{ e } * this->Stride();
  }
  void Accumulate(const SplineSpace<2>& space, int e, const FitPoints& points, double* block) const;
  void Share(const std::vector<int>& elements);

  IntArray<2> Degree;
  int Components;
  const FitDivision& Division;
  UntouchedVector<double> Data;
  std::array<std::vector<double>, 2> Factors; // C(p, i) C(p, k) / C(2p, i + k)
};

/// Thin-plate energy of an element in its own parameters, [0, 1]^2: int s_uu^2 + 2 s_uv^2 + s_vv^2
/// as a matrix of its Bernstein coefficients.
std::vector<double> ThinPlateMatrix(const IntArray<2>& degree);
}
