// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "ElementRule.h"

#include <Eigen/Core>

#include <cstring>

/// The map of an element at its quadrature points, from rows of functions.
namespace knotwork
{
/// Two neighbours of a row: what every 64-bit processor has registers for.
typedef double Two __attribute__((vector_size(16)));
inline void Load(Two& two, const double* from)
{
  std::memcpy(&two, from, sizeof(Two));
}

/// @param count  a multiple of 4.
inline double Dot(const double* a, const double* b, int count)
{
  Two sums[2] = {};
  for (int i = 0; i < count; i += 4)
  {
    for (int k = 0; k < 2; ++k)
    {
      Two left;
      Two right;
      Load(left, a + i + 2 * k);
      Load(right, b + i + 2 * k);
      sums[k] += left * right;
    }
  }
  const Two sum = sums[0] + sums[1];
  return sum[0] + sum[1];
}

/// Coefficients of an element's functions, a row a component, to be combined with rows of
/// functions. One a thread.
class LocalCoefficients
{
public:
  /// @param stride  of rows of functions, as QuadratureFunctions::Stride.
  void Take(
    const GalerkinSpace& space, int element, int stride, const PointMatrixView& coefficients)
  {
    this->Stride = stride;
    this->Rows.assign(
      static_cast<std::size_t>(coefficients.cols()) * static_cast<std::size_t>(stride), 0.0);
    for (int a = 0; a < space.NumAlive(element); ++a)
    {
      const int f = space.Alive(element)[a];
      for (Eigen::Index c = 0; c < coefficients.cols(); ++c)
      {
        this->Rows[static_cast<std::size_t>(c * stride + a)] = coefficients(f, c);
      }
    }
  }

  double Combine(int component, const double* row) const
  {
    return Dot(this->Rows.data() + std::ptrdiff_t{ component } * this->Stride, row, this->Stride);
  }

private:
  int Stride = 0;
  std::vector<double> Rows;
};

/// The map of an element at its points. One a thread.
template <int Dim>
class ElementGeometry
{
public:
  void Take(const GalerkinSpace& space, int element, int stride)
  {
    this->Stride = stride;
    this->Points.Take(space, element, stride, space.Points);
  }

  /// @param values  a row of values.
  Eigen::Matrix<double, Dim, 1> Position(const double* values) const
  {
    Eigen::Matrix<double, Dim, 1> position;
    for (int c = 0; c < Dim; ++c)
    {
      position[c] = this->Points.Combine(c, values);
    }
    return position;
  }

  /// Entry (component, parameter). @param slopes  rows of derivatives, one a parameter.
  Eigen::Matrix<double, Dim, Dim> Jacobian(const double* slopes) const
  {
    Eigen::Matrix<double, Dim, Dim> jacobian;
    for (int k = 0; k < Dim; ++k)
    {
      jacobian.col(k) = this->Position(slopes + std::ptrdiff_t{ k } * this->Stride);
    }
    return jacobian;
  }

private:
  int Stride = 0;
  LocalCoefficients Points;
};
}
