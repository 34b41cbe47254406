// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/JacobianValidation/BoundaryInjectivity.h>
#include <knotwork/SplineCore/BezierForm.h>

#include <vector>

namespace knotwork
{
/// Where a map from a domain into space of as many dimensions is proved regular.
struct Regularity
{
  JacobianCertificate Certificate; ///< with respect to local parameters
  /// Proved bounds of det J with respect to the domain's parameters, an entry an element, rounded
  /// outward.
  std::vector<double> MinLower;
  std::vector<double> MaxUpper;

  /// The smallest of MinLower.
  double Bound() const;
  /// det J > 0 is proved everywhere, boundary included.
  bool IsRegular() const
  {
    return this->Certificate.Verdict == Verdict::Valid && this->Bound() > 0.0;
  }
};

/// Certificate of a polynomial map with a parameter domain and its bounds in the domain's units.
/// @param relativeGap  of the bounds, (0, 1]: see JacobianParams.
/// @return failures of ValidateJacobian.
template <int Dim>
Result<Regularity> MeasureRegularity(
  const BezierForm<Dim>& form, double relativeGap, std::int64_t maxBoxes, int threads);

/// Whether the map takes no value twice: ProveInjectivity for the elements of one patch.
/// @param certificate  of the same map. @return failures of ProveInjectivity.
template <int Dim>
Result<InjectivityCertificate> ProveMapInjectivity(const BezierForm<Dim>& form,
  const JacobianCertificate& certificate, std::int64_t maxBoxes, int threads);
}
