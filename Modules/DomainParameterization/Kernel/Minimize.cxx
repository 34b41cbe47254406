// SPDX-License-Identifier: BSD-3-Clause
#include "Minimize.h"

#include <cmath>
#include <limits>
#include <vector>

namespace knotwork
{
MinimizeResult MinimizeLbfgs(Eigen::VectorXd& x, const Objective& objective,
  const MinimizeParams& params, const Preconditioner& preconditioner, const MinimizeHook& hook)
{
  const Eigen::Index n = x.size();
  MinimizeResult result;
  Eigen::VectorXd gradient(n);
  double value = objective(x, gradient);
  ++result.Evaluations;
  const auto report = [&](int iteration)
  {
    result.State = { iteration, value, n > 0 ? gradient.lpNorm<Eigen::Infinity>() : 0.0 };
    result.Stopped = hook && !hook(result.State);
  };
  report(0);
  if (n == 0 || result.State.GradientNorm <= params.GradientTolerance)
  {
    result.Converged = true;
    return result;
  }

  struct Pair
  {
    Eigen::VectorXd S, Y;
    double Rho = 0.0;
  };
  std::vector<Pair> pairs(static_cast<std::size_t>(params.Memory));
  std::vector<double> alpha(pairs.size());
  std::size_t stored = 0;
  std::size_t next = 0; // overwritten next; the pair before is the newest
  double scale = 0.0;   // of the preconditioner, 0: unknown
  Eigen::VectorXd direction(n), trial(n), trialGradient(n), best(n), bestGradient(n), temporary(n);
  int calm = 0;
  for (int iteration = 1; iteration <= params.MaxIterations && !result.Stopped; ++iteration)
  {
    direction = -gradient;
    for (std::size_t k = 0; k < stored; ++k)
    {
      const std::size_t at = (next + pairs.size() - 1 - k) % pairs.size();
      alpha[at] = pairs[at].Rho * pairs[at].S.dot(direction);
      direction -= alpha[at] * pairs[at].Y;
    }
    if (preconditioner)
    {
      preconditioner(direction);
    }
    if (scale > 0.0)
    {
      direction *= scale;
    }
    else if (!preconditioner)
    {
      direction *= 1.0 / std::max(1.0, gradient.norm());
    }
    for (std::size_t k = stored; k-- > 0;)
    {
      const std::size_t at = (next + pairs.size() - 1 - k) % pairs.size();
      const double beta = pairs[at].Rho * pairs[at].Y.dot(direction);
      direction += (alpha[at] - beta) * pairs[at].S;
    }
    double slope = gradient.dot(direction);
    if (!(slope < 0.0))
    {
      if (stored == 0)
      {
        break;
      }
      stored = 0; // the curvature collected is of no use: start again
      scale = 0.0;
      continue;
    }

    constexpr double decrease = 1e-4;
    constexpr double curvature = 0.9;
    double low = 0.0;
    double high = std::numeric_limits<double>::infinity();
    double step = 1.0;
    double bestValue = value;
    double bestStep = 0.0;
    for (int search = 0; search < 40; ++search)
    {
      trial = x + step * direction;
      const double trialValue = objective(trial, trialGradient);
      ++result.Evaluations;
      const bool lower = trialValue <= value + decrease * step * slope; // false for NaN too
      if (lower && (trialValue < bestValue || bestStep == 0.0))
      {
        bestValue = trialValue;
        bestStep = step;
        best.swap(trial);
        bestGradient.swap(trialGradient);
      }
      if (!lower)
      {
        high = step;
        if (bestStep > 0.0)
        {
          break; // good enough: the step before was lower, only its slope was steep
        }
      }
      else if (bestStep == step && bestGradient.dot(direction) < curvature * slope)
      {
        low = step;
      }
      else
      {
        break;
      }
      step = std::isfinite(high) ? 0.5 * (low + high) : 2.0 * low;
    }
    if (bestStep == 0.0)
    {
      if (stored == 0)
      {
        break;
      }
      stored = 0;
      scale = 0.0;
      continue;
    }

    Pair& pair = pairs[next];
    pair.S = best - x;
    pair.Y = bestGradient - gradient;
    const double sy = pair.S.dot(pair.Y);
    if (sy > 1e-12 * pair.S.norm() * pair.Y.norm())
    {
      pair.Rho = 1.0 / sy;
      if (preconditioner)
      {
        temporary = pair.Y;
        preconditioner(temporary);
        scale = sy / pair.Y.dot(temporary);
      }
      else
      {
        scale = sy / pair.Y.squaredNorm();
      }
      next = (next + 1) % pairs.size();
      stored = std::min(stored + 1, pairs.size());
    }
    const double gain = value - bestValue;
    x.swap(best);
    gradient.swap(bestGradient);
    value = bestValue;
    report(iteration);
    calm = gain <= params.EnergyTolerance * std::abs(value) ? calm + 1 : 0;
    if (calm >= params.Patience || result.State.GradientNorm <= params.GradientTolerance)
    {
      result.Converged = true;
      break;
    }
  }
  return result;
}
}
