// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/DomainParameterization/JacobianField.h>

#include <memory>

namespace knotwork
{
/// Functionals int f(|J|^2, det J) of a map whose area (volume) is scaled to 1; d = Dim.
enum class DensityKind
{
  Quality, ///< |J|^2 / (det J + eps)^(2/d) + lambda (det J - 1)^2, infinite where det J <= 0
  Penalty, ///< the same with chi = (det J + sqrt(det J^2 + delta^2)) / 2 for the denominator
  Relu,    ///< max(0, delta - det J)
  Inverse  ///< (delta / det J)^power + 1e-3 |J|^2 / (det J)^(2/d), infinite where det J <= 0
};

struct Density
{
  DensityKind Kind = DensityKind::Quality;
  double Lambda = 1.0;
  double Epsilon = 1e-10;
  double Delta = 0.05;
  double Power = 8.0;
};

struct EnergyValue
{
  double Energy = 0.0; ///< infinite for Quality and Inverse when MinDet <= 0
  double MinDet = 0.0; ///< at the quadrature points
};

/// A functional on a field of quadrature points, with exact gradients.
template <int Dim>
class DomainEnergy
{
public:
  DomainEnergy(std::unique_ptr<JacobianField<Dim>> field, int numFunctions);

  /// @param points  Dim planes of NumFunctions coordinates.
  /// @param weights  NumFunctions, nullptr: polynomial.
  /// @param gradient  Dim planes, overwritten; nullptr: not wanted (nor weightGradient).
  /// @param weightGradient  with respect to the logarithms of the weights; may be nullptr.
  EnergyValue Evaluate(const Density& density, const double* points, const double* weights,
    double* gradient, double* weightGradient);

  int NumFunctions() const { return this->Functions; }
  JacobianField<Dim>& Field() { return *this->Points; }

private:
  std::unique_ptr<JacobianField<Dim>> Points;
  int Functions = 0;
  std::vector<double> Planes, PlaneGradients; ///< homogeneous
};
}
