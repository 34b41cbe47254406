// SPDX-License-Identifier: BSD-3-Clause
// Seeded models of every family, and how two models are compared.
#pragma once
#include <knotwork/SplineGrid/SplineModel.h>

#include "vtkSmartPointer.h"
#include "vtkUnstructuredGrid.h"

#include <gtest/gtest.h>

#include <ostream>

namespace knotwork
{
/// One kind of model. Every patch of a model has a space of its own.
struct ModelCase
{
  int Dimension = 2;
  SpaceKind Kind = SpaceKind::Tensor;
  bool Rational = false; ///< with several patches the second one is polynomial all the same
  int NumPatches = 1;    ///< ids 3, 5, 7, ...
  unsigned Seed = 1;
};
std::ostream& operator<<(std::ostream& os, const ModelCase& model);

/// Tensor and hierarchical, polynomial and rational, 1D to 3D, one patch and three; seeds 1 and 2.
std::vector<ModelCase> AllModelCases();
std::string NameOf(const ::testing::TestParamInfo<ModelCase>& info);

/// Knots with random lengths, multiplicities up to degree + 1, ends not always clamped; random
/// control points around the Greville points; weights in [0.5, 2]. Fields: "Temperature" (1) and
/// "Velocity" (3) on all patches, "Stress" (6) on the first only.
SplineModel RandomModel(const ModelCase& model);

/// The grid of a model; a failed encoding fails the test.
vtkSmartPointer<vtkUnstructuredGrid> Encode(const SplineModel& model);
/// The model of a dataset; a failed decoding fails the test and gives an empty model.
SplineModel Decode(vtkDataObject* data);

/// Columns x, y, z of a patch, its weights (ones when polynomial), and its elements' number.
const PointMatrix& ControlPoints(const SplinePatch& patch);
Eigen::VectorXd Weights(const SplinePatch& patch);
bool IsRational(const SplinePatch& patch);
SpaceKind KindOf(const SplinePatch& patch);
int NumElements(const SplinePatch& patch);
int NumFunctions(const SplinePatch& patch);
/// The patch with an id; fails the test when there is none.
const SplinePatch& PatchOf(const SplineModel& model, int id);

/// Bit for bit: spaces, control points, weights, fields. Patches in any order.
::testing::AssertionResult Identical(const SplineModel& a, const SplineModel& b);
/// Same space; coefficients (not multiplied by weights) differ by at most tolerance, weights by at
/// most weightTolerance relative to them.
::testing::AssertionResult Near(const SplinePatch& a, const PointMatrix& controlPoints,
  const Eigen::VectorXd& weights, double tolerance, double weightTolerance);
/// Largest coordinate of a matrix.
double SizeOf(const PointMatrix& points);
}
