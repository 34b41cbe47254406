// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "FitSystem.h"
#include "Regularity.h"

namespace knotwork
{
/// Takes the steps of a fit so that a regular map stays regular. Elements that a full step would
/// leave folded, or with a small part of their Jacobian only, are held back: the change of the
/// map's derivatives there gets a weight (FitWeights::Stiffness), ten times as much with every
/// trial, while the other elements move on. When that does not suffice the whole step is shortened.
/// The weights fade from step to step.
template <int Dim>
class RegularityGuard
{
public:
  /// How a step was taken.
  struct Outcome
  {
    double Length = 0.0;       ///< share of the step; 0: none that is allowed was found
    int Held = 0;              ///< elements that were held back
    bool IsEndangered = false; ///< the full step as it came would have been too much
  };

  explicit RegularityGuard(int threads) : Threads(threads) {}

  /// The map that steps start from.
  Status Begin(const BezierForm<Dim>& form);
  bool IsRegular() const { return this->Present.IsRegular(); }
  /// Elements that the last step held back, increasing.
  std::vector<int> HeldElements() const;

  /// Solves for a step and takes what is allowed of it.
  /// @param map   changed, and form with it.
  /// @param shorten  asked for the share of a step that may be taken for other reasons, in (0, 1].
  /// @param giveUp  leave the map alone when the full step endangers it.
  /// @return failures of the solver and of the certificate.
  Result<Outcome> Step(FitSystem<Dim>& system, const FitSamples<Dim>& samples,
    const FitWeights& weights, Spline<Dim>& map, BezierForm<Dim>& form,
    const std::function<double(const PointMatrix& step)>& shorten, bool giveUp);

private:
  std::vector<std::size_t> Endangered(const Regularity& trial) const;
  Result<std::vector<std::size_t>> Try(
    const PointMatrix& step, Spline<Dim>& map, BezierForm<Dim>& form);

  int Threads;
  Regularity Present;
  std::vector<double> Stiffness; // an element
};
}
