// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "FitSystem.h"

namespace knotwork
{
/// The Gauss-Newton models of the measures that are not quadratic, element by element, without
/// their matrix: derivatives at the Gauss points by sums direction by direction, a small matrix a
/// point, and the transpose. On an element vectors are Dim planes of stride numbers, one a local
/// function.
/// Memory: d^2 (d^2 + 1) / 2 numbers a Gauss point (d = Dim), 2 d^2 more with eccentricity.
/// @source  Orszag, J. Comput. Phys. 37 (1980) 70-92 (sum factorization).
template <int Dim>
class MeasureTerms
{
public:
  MeasureTerms(SplineSpacePtr<Dim> space, std::size_t stride, int threads);

  /// Evaluates the models at control points given in the local functions.
  void Linearize(const FitWeights& weights, const PointMatrix& local);
  /// sum += (int dq^T dq) x on an element.
  void Apply(int element, const double* x, double* sum) const;
  /// sum -= int dq^T q.
  void AddRight(int element, double* sum) const;
  /// Adds the element's part of the diagonal blocks of the local functions, up to the variation of
  /// dq over the element: for preconditioning.
  void AddDiagonal(int element, Eigen::Matrix<double, Dim, Dim>* blocks) const;

private:
  static constexpr int NumFirst = Dim * Dim;
  static constexpr int NumPacked = NumFirst * (NumFirst + 1) / 2;

  struct Scratch;
  int NumTerms() const { return this->HasSecond ? 2 * Dim : Dim; }
  const double* Line(int element, int direction, int order) const;
  const double* LineTransposed(int element, int direction, int order) const;
  /// Fields: plane term * Dim + component of NumPoints numbers.
  void Evaluate(int element, const double* x, double* fields) const;
  void Integrate(int element, const double* fields, double* sum) const;

  SplineSpacePtr<Dim> Space;
  std::size_t Stride;
  int Threads;
  bool HasSecond = false;
  IntArray<3> Size{ 1, 1, 1 }; // points and functions a direction
  std::size_t NumPoints = 1;   // of an element
  /// Of a direction: orders 0, 1, 2 of values at points, then the same transposed.
  std::vector<std::vector<double>> Lines;
  std::vector<std::array<int, Dim>> LineOfElement;
  std::vector<double> PointWeights; // of an element of volume 1
  std::vector<double> Volumes;
  std::vector<double> Squares; // element, entry, point: lower triangle of sum w dq dq^T
  std::vector<double> Pairs; // element, direction, entry (2 Dim), point: eccentricity's dq sqrt(w)
  std::vector<double> Right; // element, term and component, point: -sum w q dq
};
}
