// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "SplineSpace.h"

/// How coefficients of a space are read off its Bernstein coefficients: what recovery and Bezier
/// projection share.
namespace knotwork
{
/// Function whose coefficient is the local coefficient of a row of T, or -1 when the row mixes
/// functions.
template <int Dim>
int OwnFunction(const SplineSpace<Dim>& space, int localFunction)
{
  if (space.IsIdentityMap())
  {
    return localFunction;
  }
  const std::size_t begin = space.RowStart[static_cast<std::size_t>(localFunction)];
  const std::size_t end = space.RowStart[static_cast<std::size_t>(localFunction) + 1];
  return end == begin + 1 && space.RowCoefficient[begin] == 1.0 ? space.RowFunction[begin] : -1;
}

/// Integrals over [0, 1] of the p + 1 local functions of one direction: every Bernstein polynomial
/// has 1 / (p + 1). @param factor  of the element, null: the identity.
inline Eigen::VectorXd IntegralsOf(int degree, const double* factor)
{
  if (!factor)
  {
    return Eigen::VectorXd::Constant(degree + 1, 1.0 / (degree + 1));
  }
  return Eigen::Map<const PointMatrix>(factor, degree + 1, degree + 1).rowwise().sum() /
    (degree + 1);
}

/// Multi-index of entry `local` of a tensor array of prod(p_d + 1) values, first direction fastest.
template <int Dim>
IntArray<Dim> TensorIndex(const IntArray<Dim>& degree, int local)
{
  IntArray<Dim> index;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    index[d] = local % (degree[d] + 1);
    local /= degree[d] + 1;
  }
  return index;
}

/// Bernstein coefficients of the L2 projection on [0, 1] of values at Gauss points.
/// @return  (degree + 1) x points. @pre points > degree.
PointMatrix GaussToBernstein(int degree, int points);

/// Dual functionals of the local functions of every element: the inverted extraction factors.
/// Made in one inversion a distinct factor; the space must outlive it.
template <int Dim>
class DualFunctionals
{
public:
  explicit DualFunctionals(const SplineSpace<Dim>& space);

  /// Inverse F^-1 of the factor of an element in a direction, row-major; nullptr is the identity.
  /// The local coefficient of function i is sum_k Q[k] F^-1[k][i].
  const double* Inverse(int e, int direction) const
  {
    const int f = this->Offset(e, direction);
    return f < 0 ? nullptr : this->InverseData.data() + f;
  }

  /// Row sum of the absolute values of the functional of local function `local`: rounding of the
  /// Bernstein coefficients grows at most by this. Infinite when the element's local functions are
  /// dependent.
  double Amplification(int e, int local) const;

  /// row[k] = share of Bernstein coefficient k in the local coefficient `local`; prod(p_d + 1)
  /// values. @pre Amplification(e, local) is finite.
  void Functional(int e, int local, double* row) const;

private:
  int Offset(int e, int direction) const
  {
    return this->Space.Elements[static_cast<std::size_t>(e)]
      .Factor[static_cast<std::size_t>(direction)];
  }

  const SplineSpace<Dim>& Space;
  std::vector<double> InverseData; ///< laid out as FactorData
  std::vector<double> SumData;     ///< p + 1 absolute column sums at the offset of each factor
};

/// Where the coefficient of a function is read: the element and local index of the functional with
/// the least amplification (the first of equals). Element -1 when no element has a row of its own.
struct FunctionalSite
{
  int Element = -1;
  int Local = -1;
  double Amplification = 0.0;
};

/// One site a function. @complexity O(elements * prod(p + 1)).
template <int Dim>
std::vector<FunctionalSite> ChooseSites(
  const SplineSpace<Dim>& space, const DualFunctionals<Dim>& duals);
}
