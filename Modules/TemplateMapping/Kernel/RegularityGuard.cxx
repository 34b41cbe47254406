// SPDX-License-Identifier: BSD-3-Clause
#include "RegularityGuard.h"

#include <algorithm>
#include <numeric>

namespace knotwork
{
namespace
{
constexpr double Gap = 0.5; // of the bounds that steps are judged by
constexpr std::int64_t Boxes = 1000000;
/// What a step must leave of an element's smallest det J, unless that stays above EnoughShare of
/// the usual one.
constexpr double KeptShare = 0.2;
constexpr double EnoughShare = 0.05;
/// First weight of an element that is held back, in units of all samples' weight.
constexpr double FirstStiffness = 1e-3;
constexpr double Growth = 10.0;
constexpr int Trials = 8;
constexpr double ShortestStep = 1e-6;
}

template <int Dim>
Status RegularityGuard<Dim>::Begin(const BezierForm<Dim>& form)
{
  Result<Regularity> measured = MeasureRegularity(form, Gap, Boxes, this->Threads);
  if (measured)
  {
    this->Present = std::move(measured.Value);
    this->Stiffness.assign(form.Space->Elements.size(), 0.0);
  }
  return measured.Status;
}

template <int Dim>
std::vector<int> RegularityGuard<Dim>::HeldElements() const
{
  std::vector<int> held;
  for (std::size_t e = 0; e < this->Stiffness.size(); ++e)
  {
    if (this->Stiffness[e] > 0.0)
    {
      held.push_back(static_cast<int>(e));
    }
  }
  return held;
}

template <int Dim>
std::vector<std::size_t> RegularityGuard<Dim>::Endangered(const Regularity& trial) const
{
  const std::vector<double>& before = this->Present.MinLower;
  const double usual = std::accumulate(before.begin(), before.end(), 0.0) / double(before.size());
  std::vector<std::size_t> found;
  for (std::size_t e = 0; e < before.size(); ++e)
  {
    const bool isProved = trial.Certificate.Cells[e].Verdict == Verdict::Valid;
    const double least = std::min(KeptShare * before[e], EnoughShare * usual);
    if (!isProved || !(trial.MinLower[e] > least))
    {
      found.push_back(e);
    }
  }
  return found;
}

template <int Dim>
Result<std::vector<std::size_t>> RegularityGuard<Dim>::Try(
  const PointMatrix& step, Spline<Dim>& map, BezierForm<Dim>& form)
{
  Spline<Dim> trial = map;
  trial.ControlPoints += step;
  BezierForm<Dim> trialForm = MakeBezierForm(trial, this->Threads);
  Result<Regularity> regularity = MeasureRegularity(trialForm, Gap, Boxes, this->Threads);
  if (!regularity)
  {
    return regularity.Status;
  }
  std::vector<std::size_t> endangered = this->Endangered(regularity.Value);
  if (endangered.empty())
  {
    map = std::move(trial);
    form = std::move(trialForm);
    this->Present = std::move(regularity.Value);
  }
  return endangered;
}

template <int Dim>
Result<typename RegularityGuard<Dim>::Outcome> RegularityGuard<Dim>::Step(FitSystem<Dim>& system,
  const FitSamples<Dim>& samples, const FitWeights& weights, Spline<Dim>& map,
  BezierForm<Dim>& form, const std::function<double(const PointMatrix& step)>& shorten, bool giveUp)
{
  Outcome outcome;
  const double least =
    FirstStiffness * double(samples.Parameters.rows()) * (weights.Point + weights.Normal);
  for (double& value : this->Stiffness)
  {
    value = value > least ? value / Growth : 0.0;
  }
  FitWeights held = weights;
  PointMatrix step; // the share of the solver's that is allowed for other reasons
  double length = 1.0;
  for (int trial = 0; trial < Trials; ++trial)
  {
    held.Stiffness = this->Stiffness;
    Result<PointMatrix> solved = system.Step(samples, held, map.ControlPoints);
    if (!solved)
    {
      return solved.Status;
    }
    step = std::move(solved.Value);
    length = shorten(step);
    step *= length;
    Result<std::vector<std::size_t>> endangered = this->Try(step, map, form);
    if (!endangered)
    {
      return endangered.Status;
    }
    outcome.Held = static_cast<int>(std::count_if(
      this->Stiffness.begin(), this->Stiffness.end(), [](double value) { return value > 0.0; }));
    if (endangered->empty())
    {
      outcome.Length = length;
      return outcome;
    }
    outcome.IsEndangered = true;
    if (giveUp)
    {
      return outcome;
    }
    for (std::size_t e : endangered.Value)
    {
      this->Stiffness[e] = std::max(least, Growth * this->Stiffness[e]);
    }
  }
  for (double share = 0.5; share >= ShortestStep; share *= 0.5)
  {
    Result<std::vector<std::size_t>> endangered = this->Try(share * step, map, form);
    if (!endangered)
    {
      return endangered.Status;
    }
    if (endangered->empty())
    {
      outcome.Length = share * length;
      return outcome;
    }
  }
  return outcome;
}

template class RegularityGuard<2>;
template class RegularityGuard<3>;
}
