// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "PatchForm.h"

#include <map>
#include <tuple>

/// Private to the measures of cells: integrals over curves and surfaces in Bernstein form, until
/// the rules themselves say that they have converged.
namespace knotwork
{
/// What is integrated over x(t) or x(s, t), relative to the origin.
enum class PatchIntegrand : std::uint8_t
{
  Size, ///< |x_t|, |x_s x x_t|: length, area
  /// The share of closed curves or surfaces in what they enclose, by the divergence theorem:
  /// det(x, x_t) / 2, det(x, x_s, x_t) / 3.
  Flux
};

struct PatchIntegralParams
{
  PatchIntegrand Integrand = PatchIntegrand::Flux;
  bool Rational = false;
  double Size = 1.0; ///< of the coordinates: moments are compared relative to it
  /// Part of |Measure| that the estimated error is brought to.
  double Tolerance = 1e-12;
  int MaxDepth = 40; ///< halvings of a patch at most
  /// Of the rules of all pieces: no piece is halved any more when there are as many.
  std::int64_t MaxPoints = 40000;
};

struct PatchIntegral
{
  double Measure = 0.0;
  double Absolute = 0.0; ///< of the integrand's absolute value: what rounding is relative to
  std::array<double, 3> Moment{};
  /// Estimate of what the rules leave, of Measure and of Moment over Size; without rounding.
  double Error = 0.0;
  bool Converged = true;
  std::int64_t Points = 0; ///< at which the integrand was evaluated
};

/// Gauss rules with the values of Bernstein and Legendre polynomials at their nodes.
class PatchRules
{
public:
  struct Rule
  {
    int Count = 0;
    std::vector<double> Weights;
    std::vector<double> Values; ///< (degree + 1) x Count
    std::vector<double> Slopes; ///< alike
    /// (2 k + 1) w_i P_k(x_i) for the six highest k below Count: 6 x Count. What they give of a
    /// function are its Legendre coefficients.
    std::vector<double> Tails;
  };
  const Rule& Get(int degree, int count);

private:
  std::map<std::pair<int, int>, Rule> Rules;
};

/// The sum of the integrals over all patches. Polynomial fluxes are exact but for rounding.
/// Everything else is halved, the piece of the largest estimated error first, in the direction it
/// comes from. Before a piece is integrated its weights are balanced: factors 2^(a i + b j) are a
/// change of parameters that leaves the integral as it is, so a layer that weights over many
/// decades make near a side takes as many halvings as the logarithm of their logarithm.
///
/// The estimate: the Legendre coefficients c_k of an analytic function fall like r^k, and a Gauss
/// rule of n points errs by about c_2n. Of the last six coefficients below n the largest of the
/// last three, times eight times the larger of its share in the function and of the third power of
/// its share in the three before: so a part that is small but falls slowly is taken for what it is.
/// Both directions are added. Where the weights of a piece are far from equal, it is not believed.
PatchIntegral IntegratePatches(
  std::vector<PatchForm> patches, const PatchIntegralParams& params, PatchRules& rules);
}
