// SPDX-License-Identifier: BSD-3-Clause
#include "DomainEnergy.h"

#include <knotwork/SplineCore/WideVectors.h>

#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
/// Of the quality functional in Inverse: among maps of one least det J the better shaped one.
constexpr double ShapeShare = 1e-3;

inline void SquareRoot(const RowVector& x, RowVector& root)
{
  for (int l = 0; l < RowLanes; ++l)
  {
    root[l] = std::sqrt(x[l]);
  }
}

/// x^(-2/Dim), x > 0.
template <int Dim>
inline void Shrink(const RowVector& x, RowVector& result)
{
  if constexpr (Dim == 2)
  {
    result = 1.0 / x;
  }
  else
  {
    for (int l = 0; l < RowLanes; ++l)
    {
      const double root = std::cbrt(x[l]);
      result[l] = 1.0 / (root * root);
    }
  }
}

/// Values of a density and of its derivatives with respect to |J|^2 and det J.
template <int Dim, DensityKind Kind>
inline void Apply(const Density& density, const RowVector& f, const RowVector& d, RowVector& value,
  RowVector& byF, RowVector& byD)
{
  constexpr double power = 2.0 / Dim;
  const RowVector zero{};
  if constexpr (Kind == DensityKind::Relu)
  {
    value = d < density.Delta ? density.Delta - d : zero;
    byF = zero;
    byD = d < density.Delta ? zero - 1.0 : zero;
    return;
  }
  if constexpr (Kind == DensityKind::Inverse)
  {
    const RowVector positive = d > zero ? d : zero + 1.0;
    Shrink<Dim>(positive, byF);
    byF *= ShapeShare;
    value = f * byF;
    byD = -power * value / positive;
    for (int l = 0; l < RowLanes; ++l)
    {
      const double p = std::pow(density.Delta / positive[l], density.Power);
      value[l] += p;
      byD[l] -= density.Power * p / positive[l];
    }
    return;
  }
  const RowVector excess = d - 1.0;
  if constexpr (Kind == DensityKind::Quality)
  {
    const RowVector positive = (d > zero ? d : zero) + density.Epsilon;
    Shrink<Dim>(positive, byF);
    value = f * byF;
    byD = -power * value / positive;
  }
  else
  {
    RowVector root;
    SquareRoot(d * d + density.Delta * density.Delta, root);
    // the second form has no cancellation where det J is negative
    const RowVector chi =
      d > zero ? 0.5 * (d + root) : 0.5 * density.Delta * density.Delta / (root - d);
    Shrink<Dim>(chi, byF);
    value = f * byF;
    byD = -power * value / root;
  }
  value += density.Lambda * excess * excess;
  byD += 2.0 * density.Lambda * excess;
}

/// Cofactors of J (J[Dim * c + k] = d x_c / d u_k) and its determinant.
template <int Dim>
inline void Cofactors(const RowVector* j, RowVector* cofactors, RowVector& det)
{
  if constexpr (Dim == 2)
  {
    cofactors[0] = j[3];
    cofactors[1] = -j[2];
    cofactors[2] = -j[1];
    cofactors[3] = j[0];
    det = j[0] * j[3] - j[1] * j[2];
  }
  else
  {
    for (int c = 0; c < 3; ++c)
    {
      const RowVector* a = j + 3 * ((c + 1) % 3);
      const RowVector* b = j + 3 * ((c + 2) % 3);
      cofactors[3 * c] = a[1] * b[2] - a[2] * b[1];
      cofactors[3 * c + 1] = a[2] * b[0] - a[0] * b[2];
      cofactors[3 * c + 2] = a[0] * b[1] - a[1] * b[0];
    }
    det = j[0] * cofactors[0] + j[1] * cofactors[1] + j[2] * cofactors[2];
  }
}

template <int Dim, DensityKind Kind, bool Rational>
class EnergyBody final : public RowBody
{
public:
  EnergyBody(const Density& density) : Chosen(density) {}

  void Row(int n, const double* fields, double* gradients, const double* weights, double factor,
    const double* padding) override
  {
    WithWidestVectors([&](auto) { this->Points(n, fields, gradients, weights, factor, padding); });
  }
  EnergyValue Result() const
  {
    EnergyValue value;
    value.Energy = this->Total;
    value.MinDet = std::min(std::min(this->Smallest[0], this->Smallest[1]),
      std::min(this->Smallest[2], this->Smallest[3]));
    // a comparison with NaN is false: the sum tells
    if (!(value.MinDet > 0.0) && (Kind == DensityKind::Quality || Kind == DensityKind::Inverse))
    {
      value.Energy = std::numeric_limits<double>::infinity();
    }
    return value;
  }

private:
  void Points(int n, const double* fields, double* gradients, const double* weights, double factor,
    const double* padding)
  {
    constexpr int NumPlanes = Dim + (Rational ? 1 : 0);
    const auto at = [n](int t, int c) { return (t * NumPlanes + c) * n; };
    RowVector sum{};
    for (int i = 0; i < n; i += RowLanes)
    {
      RowVector j[Dim * Dim];
      RowVector x[Dim];
      RowVector weightSlope[Dim];
      RowVector inverse;
      if constexpr (Rational)
      {
        inverse = 1.0 / (At(fields + at(0, Dim) + i) + At(padding + i));
        for (int k = 0; k < Dim; ++k)
        {
          weightSlope[k] = At(fields + at(k + 1, Dim) + i);
        }
      }
      for (int c = 0; c < Dim; ++c)
      {
        if constexpr (Rational)
        {
          x[c] = At(fields + at(0, c) + i) * inverse;
        }
        for (int k = 0; k < Dim; ++k)
        {
          j[Dim * c + k] = At(fields + at(k + 1, c) + i);
          if constexpr (Rational)
          {
            j[Dim * c + k] = (j[Dim * c + k] - x[c] * weightSlope[k]) * inverse;
          }
        }
      }
      RowVector cofactors[Dim * Dim];
      RowVector det;
      Cofactors<Dim>(j, cofactors, det);
      det += At(padding + i);
      RowVector f = j[0] * j[0];
      for (int k = 1; k < Dim * Dim; ++k)
      {
        f += j[k] * j[k];
      }
      RowVector value, byF, byD;
      Apply<Dim, Kind>(this->Chosen, f, det, value, byF, byD);
      const RowVector weight = factor * At(weights + i);
      sum += weight * value;
      this->Smallest = det < this->Smallest ? det : this->Smallest;
      if (!gradients)
      {
        continue;
      }
      byF *= 2.0 * weight;
      byD *= weight;
      RowVector toWeight{};
      RowVector toSlope[Dim] = {};
      for (int c = 0; c < Dim; ++c)
      {
        RowVector toValue{};
        for (int k = 0; k < Dim; ++k)
        {
          const RowVector g = byF * j[Dim * c + k] + byD * cofactors[Dim * c + k];
          if constexpr (Rational)
          {
            const RowVector scaled = g * inverse;
            At(gradients + at(k + 1, c) + i) = scaled;
            toValue -= scaled * weightSlope[k] * inverse;
            toSlope[k] -= scaled * x[c];
            toWeight -= scaled * (j[Dim * c + k] - x[c] * weightSlope[k] * inverse);
          }
          else
          {
            At(gradients + at(k + 1, c) + i) = g;
          }
        }
        if constexpr (Rational)
        {
          At(gradients + at(0, c) + i) = toValue;
        }
      }
      if constexpr (Rational)
      {
        At(gradients + at(0, Dim) + i) = toWeight;
        for (int k = 0; k < Dim; ++k)
        {
          At(gradients + at(k + 1, Dim) + i) = toSlope[k];
        }
      }
    }
    this->Total += (sum[0] + sum[2]) + (sum[1] + sum[3]);
  }

  Density Chosen;
  double Total = 0.0;
  RowVector Smallest = RowVector{} + std::numeric_limits<double>::infinity();
};

template <int Dim, DensityKind Kind>
EnergyValue Visit(JacobianField<Dim>& field, const Density& density, const double* planes,
  double* gradient, bool rational)
{
  if (rational)
  {
    EnergyBody<Dim, Kind, true> body(density);
    field.Visit(planes, gradient, Dim + 1, true, body);
    return body.Result();
  }
  EnergyBody<Dim, Kind, false> body(density);
  field.Visit(planes, gradient, Dim, false, body);
  return body.Result();
}
}

template <int Dim>
DomainEnergy<Dim>::DomainEnergy(std::unique_ptr<JacobianField<Dim>> field, int numFunctions)
  : Points(std::move(field)), Functions(numFunctions)
{
}

template <int Dim>
EnergyValue DomainEnergy<Dim>::Evaluate(const Density& density, const double* points,
  const double* weights, double* gradient, double* weightGradient)
{
  const int n = this->Functions;
  const double* planes = points;
  double* planeGradients = gradient;
  if (weights)
  {
    this->Planes.resize(static_cast<std::size_t>((Dim + 1) * n));
    this->PlaneGradients.resize(this->Planes.size());
    for (int i = 0; i < n; ++i)
    {
      for (int c = 0; c < Dim; ++c)
      {
        this->Planes[static_cast<std::size_t>(c * n + i)] = weights[i] * points[c * n + i];
      }
      this->Planes[static_cast<std::size_t>(Dim * n + i)] = weights[i];
    }
    planes = this->Planes.data();
    planeGradients = gradient ? this->PlaneGradients.data() : nullptr;
  }
  EnergyValue value;
  switch (density.Kind)
  {
    case DensityKind::Quality:
      value = Visit<Dim, DensityKind::Quality>(
        *this->Points, density, planes, planeGradients, weights != nullptr);
      break;
    case DensityKind::Penalty:
      value = Visit<Dim, DensityKind::Penalty>(
        *this->Points, density, planes, planeGradients, weights != nullptr);
      break;
    case DensityKind::Inverse:
      value = Visit<Dim, DensityKind::Inverse>(
        *this->Points, density, planes, planeGradients, weights != nullptr);
      break;
    case DensityKind::Relu:
      value = Visit<Dim, DensityKind::Relu>(
        *this->Points, density, planes, planeGradients, weights != nullptr);
      break;
  }
  if (weights && gradient)
  {
    for (int i = 0; i < n; ++i)
    {
      double toWeight = planeGradients[Dim * n + i];
      for (int c = 0; c < Dim; ++c)
      {
        gradient[c * n + i] = weights[i] * planeGradients[c * n + i];
        toWeight += points[c * n + i] * planeGradients[c * n + i];
      }
      if (weightGradient)
      {
        weightGradient[i] = weights[i] * toWeight;
      }
    }
  }
  return value;
}

template class DomainEnergy<2>;
template class DomainEnergy<3>;
}
