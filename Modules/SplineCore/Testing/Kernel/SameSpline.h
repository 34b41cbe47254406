// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Spline.h>

#include <gtest/gtest.h>

namespace knotwork::testing
{
/// Bit for bit.
template <int Dim>
::testing::AssertionResult SameSpline(const Spline<Dim>& a, const Spline<Dim>& b)
{
  const auto fail = [](const char* what) { return ::testing::AssertionFailure() << what; };
  if (!(a.Space->Knots == b.Space->Knots))
  {
    return fail("knots differ");
  }
  if (a.Space->NumFunctions != b.Space->NumFunctions ||
    a.Space->RowFunction != b.Space->RowFunction ||
    a.Space->RowCoefficient != b.Space->RowCoefficient ||
    a.Space->LocalFunctionIds != b.Space->LocalFunctionIds)
  {
    return fail("spaces differ");
  }
  if (a.ControlPoints.rows() != b.ControlPoints.rows() ||
    a.ControlPoints.cols() != b.ControlPoints.cols() || a.ControlPoints != b.ControlPoints)
  {
    return fail("control points differ");
  }
  if (a.Weights.size() != b.Weights.size() || a.Weights != b.Weights)
  {
    return fail("weights differ");
  }
  return ::testing::AssertionSuccess();
}
}
