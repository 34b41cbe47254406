// SPDX-License-Identifier: BSD-3-Clause
// Small trimmed models, and how two models are compared.
#pragma once
#include <knotwork/SplineCore/TrimmedModel.h>

#include <gtest/gtest.h>

namespace knotwork
{
/// Two faces of one body that share an edge: a cubic one with a hole (edge 3, a rational circle in
/// the parameter plane), named and coloured, and a rational one that is reversed. Control points by
/// seed; loops close by their vertices, edges lie near the surfaces only.
/// @param spans  of the cubic surface in its first direction.
TrimmedModel TwoFaces(unsigned seed = 1, int spans = 3);

/// Bit for bit, but for colours, which are bytes in grids.
::testing::AssertionResult Identical(const TrimmedModel& a, const TrimmedModel& b);
}
