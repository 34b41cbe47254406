// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "SplineOracle.h"
#include <knotwork/SplineCore/HierarchicalSpace.h>

/// Random spaces and splines whose coefficients are well determined by their Bezier points, so that
/// an error of a percent cannot hide in the tolerance of a bad condition.
namespace knotwork::testing
{
using oracle::Random;

/// Spans in [0.5, 2], interior multiplicities in [1, maxMultiplicity], ends clamped or simple.
inline KnotVector MildKnots(
  Random& random, int degree, int elements, int maxMultiplicity, bool clamped = true)
{
  std::vector<double> knots;
  double t = random.In(-3.0, 3.0);
  const auto outside = [&]
  {
    for (int i = 0; i < degree; ++i)
    {
      knots.push_back(t);
      t += clamped ? 0.0 : random.In(0.5, 2.0);
    }
  };
  outside();
  knots.push_back(t);
  for (int e = 1; e < elements; ++e)
  {
    t += random.In(0.5, 2.0);
    knots.insert(knots.end(), static_cast<std::size_t>(random.Int(1, maxMultiplicity)), t);
  }
  t += random.In(0.5, 2.0);
  knots.push_back(t);
  t += clamped ? 0.0 : random.In(0.5, 2.0);
  outside();
  return KnotVector::Create(degree, knots).Value;
}

/// Degrees in [1, maxDegree], multiplicities up to the degree, 1..maxElements elements a direction.
template <int Dim>
SplineSpacePtr<Dim> RandomTensorSpace(Random& random, int maxDegree, int maxElements)
{
  std::array<KnotVector, Dim> knots;
  for (KnotVector& k : knots)
  {
    const int degree = random.Int(1, maxDegree);
    const int elements = random.Int(1, maxElements);
    const int multiplicity = random.Int(1, degree);
    k = MildKnots(random, degree, elements, multiplicity, random.Int(0, 2) > 0);
  }
  return MakeTensorSpace<Dim>(knots).Value;
}

/// Three random elements refined `steps` times, starting from a random tensor-product space.
template <int Dim>
SplineSpacePtr<Dim> RandomHierarchicalSpace(
  Random& random, int maxDegree, int maxElements, int steps)
{
  SplineSpacePtr<Dim> space = RandomTensorSpace<Dim>(random, maxDegree, maxElements);
  for (int step = 0; step < steps; ++step)
  {
    std::vector<int> marked;
    for (int k = 0; k < 3; ++k)
    {
      marked.push_back(random.Int(0, space->NumElements() - 1));
    }
    RefinementParams params;
    params.Extension = random.Int(0, 2);
    space = RefineElements<Dim>(space, marked, params).Value;
  }
  return space;
}

/// Control points in [-10, 10], weights (when rational) in [0.5, 2].
template <int Dim>
Spline<Dim> RandomSpline(
  Random& random, const SplineSpacePtr<Dim>& space, int components, bool rational)
{
  Spline<Dim> spline;
  spline.Space = space;
  spline.ControlPoints.resize(space->NumFunctions, components);
  for (Eigen::Index i = 0; i < spline.ControlPoints.size(); ++i)
  {
    spline.ControlPoints.data()[i] = random.In(-10.0, 10.0);
  }
  spline.Weights.resize(rational ? space->NumFunctions : 0);
  for (double& w : spline.Weights)
  {
    w = random.In(0.5, 2.0);
  }
  return spline;
}
}
