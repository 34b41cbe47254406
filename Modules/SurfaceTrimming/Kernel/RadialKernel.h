// SPDX-License-Identifier: BSD-3-Clause
// phi(r) = r^2 ln r of many centres, private to the kernel.
#pragma once
#include <knotwork/SplineCore/WideVectors.h>

#include <Eigen/Core>

namespace knotwork
{
/// Centres in the plane and what each is multiplied by, for the vectors that the processor at hand
/// has; the bits do not depend on these.
class RadialKernel
{
public:
  /// @param centres  n x 2. @param coefficients  n x c, c in [1, 4]; empty: none.
  explicit RadialKernel(const Eigen::Ref<const Eigen::MatrixXd>& centres,
    const Eigen::Ref<const Eigen::MatrixXd>& coefficients = Eigen::MatrixXd());

  /// phi of the distances of a point from all centres. @param values  n of them.
  void Values(double u, double v, double* values) const;
  /// The sum of the coefficients times phi. @param sums  c of them.
  void Sums(double u, double v, double* sums) const;

  static constexpr int MaxComponents = 4;

private:
  std::size_t Count = 0;
  int Components = 0;
  VectorArray<double> X; ///< padded to whole blocks
  VectorArray<double> Y;
  VectorArray<double> Coefficients; ///< component by component; 0 beyond the last centre
};
}
