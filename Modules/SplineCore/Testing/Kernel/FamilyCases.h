// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "MeshCases.h"
#include "RandomSplines.h"
#include <knotwork/SplineCore/BezierSpace.h>
#include <knotwork/SplineCore/LRVolume.h>
#include <knotwork/SplineCore/Refinement.h>
#include <knotwork/SplineCore/UnstructuredSpace.h>

#include <vector>

/// Random spaces of every family that has some of a dimension.
namespace knotwork::testing
{
/// A tensor-product space clamped at its ends, as LR spaces need it, refined.
template <int Dim>
SplineSpacePtr<Dim> RandomLRSpace(Random& random)
{
  std::array<KnotVector, Dim> knots;
  for (KnotVector& k : knots)
  {
    const int degree = random.Int(1, Dim == 3 ? 2 : 3);
    k = MildKnots(random, degree, random.Int(2, 4), 1);
  }
  Spline<Dim> spline;
  spline.Space = MakeTensorSpace<Dim>(knots).Value;
  spline.ControlPoints = PointMatrix::Zero(spline.Space->NumFunctions, 1);
  for (int step = 0; step < 2; ++step)
  {
    const std::vector<int> marked{ random.Int(0, spline.Space->NumElements() - 1) };
    if constexpr (Dim == 3)
    {
      spline = RefineMarkedLRVolume(spline, marked).Value.Value;
    }
    else
    {
      spline = RefineMarkedLR(spline, marked).Value.Value;
    }
  }
  return spline.Space;
}

/// Two elements of degrees of their own that have a corner in common.
template <int Dim>
SplineSpacePtr<Dim> TwoBezierElements(Random& random)
{
  std::vector<IntArray<Dim>> degrees(2);
  std::vector<int> points;
  int next = 0;
  for (IntArray<Dim>& degree : degrees)
  {
    for (int& p : degree)
    {
      p = random.Int(1, Dim == 3 ? 2 : 4);
    }
    for (int i = 0; i < NumTensorFunctions<Dim>(degree); ++i)
    {
      points.push_back(i == 0 && next > 0 ? 0 : next++);
    }
  }
  return MakeBezierSpace<Dim>(degrees, points, next).Value;
}

template <int Dim>
std::vector<SplineSpacePtr<Dim>> SpacesOfAllFamilies(Random& random)
{
  std::vector<SplineSpacePtr<Dim>> spaces{ RandomTensorSpace<Dim>(random, 3, 4),
    RandomHierarchicalSpace<Dim>(random, Dim == 3 ? 2 : 3, 3, 2), TwoBezierElements<Dim>(random) };
  if constexpr (Dim > 1)
  {
    spaces.push_back(RandomLRSpace<Dim>(random));
    UnstructuredParams params;
    params.Degree = Dim == 3 ? 2 : random.Int(1, 4);
    CellMesh<Dim> mesh;
    if constexpr (Dim == 2)
    {
      mesh = random.Int(0, 1) > 0 ? meshes::CubeSphere(3) : meshes::Star(5, 3);
    }
    else
    {
      mesh = meshes::Sweep(meshes::Star(3, 2), 2);
    }
    spaces.push_back(MakeUnstructuredSpace<Dim>(mesh, params)->Space);
  }
  return spaces;
}
}
