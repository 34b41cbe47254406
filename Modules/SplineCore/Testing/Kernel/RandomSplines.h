// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "HierarchicalSpace.h"
#include "TensorSpace.h"

#include <algorithm>
#include <random>

/// Seeded random spaces and splines for property tests.
namespace knotwork::testing
{
using Random = std::mt19937;

inline double Uniform(Random& random, double lower, double upper)
{
  return lower + (upper - lower) * std::uniform_real_distribution<double>()(random);
}

inline int UniformInt(Random& random, int lower, int upper)
{
  return std::uniform_int_distribution<int>(lower, upper)(random);
}

/// Clamped (or, with clamped = false, simple end knots), non-uniform: spans in [0.5, 2], interior
/// multiplicities in [1, maxMultiplicity].
inline KnotVector RandomKnots(
  Random& random, int degree, int elements, int maxMultiplicity, bool clamped = true)
{
  std::vector<double> knots;
  double t = Uniform(random, -3.0, 3.0);
  for (int i = 0; i <= degree; ++i)
  {
    knots.push_back(t);
    t += clamped ? 0.0 : Uniform(random, 0.5, 2.0);
  }
  t = knots.back();
  for (int e = 0; e < elements; ++e)
  {
    t += Uniform(random, 0.5, 2.0);
    const int multiplicity = e + 1 < elements ? UniformInt(random, 1, maxMultiplicity) : 1;
    knots.insert(knots.end(), static_cast<std::size_t>(multiplicity), t);
  }
  for (int i = 0; i < degree; ++i)
  {
    t += clamped ? 0.0 : Uniform(random, 0.5, 2.0);
    knots.push_back(t);
  }
  return KnotVector::Create(degree, knots).Value;
}

template <int Dim>
SplineSpacePtr<Dim> RandomTensorSpace(Random& random, int maxDegree, int maxElements)
{
  std::array<KnotVector, Dim> knots;
  for (KnotVector& k : knots)
  {
    // one draw a statement: the order in which arguments are evaluated is not fixed
    const int degree = UniformInt(random, 1, maxDegree);
    const int elements = UniformInt(random, 1, maxElements);
    const int multiplicity = UniformInt(random, 1, degree);
    const bool clamped = UniformInt(random, 0, 2) > 0;
    k = RandomKnots(random, degree, elements, multiplicity, clamped);
  }
  return MakeTensorSpace<Dim>(knots).Value;
}

/// A few random elements refined `steps` times, starting from a random tensor-product space.
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
      marked.push_back(UniformInt(random, 0, space->NumElements() - 1));
    }
    RefinementParams params;
    params.Extension = UniformInt(random, 0, 2);
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
  spline.ControlPoints = PointMatrix(space->NumFunctions, components);
  for (double& x : spline.ControlPoints.reshaped())
  {
    x = Uniform(random, -10.0, 10.0);
  }
  if (rational)
  {
    spline.Weights.resize(space->NumFunctions);
    for (double& w : spline.Weights)
    {
      w = Uniform(random, 0.5, 2.0);
    }
  }
  return spline;
}
}
