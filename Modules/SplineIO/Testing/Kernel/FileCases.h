// SPDX-License-Identifier: BSD-3-Clause
// Files written by hand from the description of their formats, seeded files, and how two files are
// compared.
#pragma once
#include "RandomSplines.h"
#include "SameSpline.h"
#include <knotwork/SplineIO/SplineFile.h>

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

namespace knotwork::testing
{
inline std::string TextOfData(const std::string& name)
{
  std::ifstream stream(KNOTWORK_DATA_DIR "/SplineIO/" + name, std::ios::binary);
  EXPECT_TRUE(stream) << name;
  return { std::istreambuf_iterator<char>(stream), {} };
}

/// A rational g2 curve and a bilinear polynomial surface in the plane.
inline const std::string HandWrittenG2 = TextOfData("by_hand.g2");

/// Two bilinear squares side by side with their interface, a rational curve, and a THB function of
/// degree 1 on 2 x 1 elements, the left one refined: of the 3 x 2 functions of level 0 the four at
/// u = 1 and u = 2 stay, and 2 x 3 of level 1 come in at u = 0 and u = 0.5.
inline const std::string HandWrittenXml = TextOfData("by_hand.xml");

/// Bit for bit.
inline ::testing::AssertionResult SameSplines(
  const std::vector<AnySpline>& a, const std::vector<AnySpline>& b)
{
  if (a.size() != b.size())
  {
    return ::testing::AssertionFailure() << a.size() << " and " << b.size() << " splines";
  }
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    if (a[i].index() != b[i].index())
    {
      return ::testing::AssertionFailure() << "spline " << i << " has another dimension";
    }
    const auto same = std::visit([&](const auto& spline)
      { return SameSpline(spline, std::get<std::decay_t<decltype(spline)>>(b[i])); },
      a[i]);
    if (!same)
    {
      return ::testing::AssertionFailure() << "spline " << i << ": " << same.message();
    }
  }
  return ::testing::AssertionSuccess();
}

/// A double with random sign, exponent and all bits of the mantissa.
inline double WildNumber(Random& random, int maxExponent)
{
  const double mantissa = 1.0 + random.Unit() + std::ldexp(random.Unit(), -32);
  return std::ldexp(mantissa, random.Int(-maxExponent, maxExponent)) *
    (random.Int(0, 1) == 1 ? 1.0 : -1.0);
}

/// Numbers of every size in place of a spline's control points and weights.
template <int Dim>
Spline<Dim> WithWildNumbers(Random& random, Spline<Dim> spline)
{
  for (Eigen::Index i = 0; i < spline.ControlPoints.size(); ++i)
  {
    spline.ControlPoints.data()[i] = random.Int(0, 9) == 0 ? 0.0 : WildNumber(random, 60);
  }
  for (double& w : spline.Weights)
  {
    w = std::fabs(WildNumber(random, 10));
  }
  return spline;
}

/// Splines of every dimension, polynomial and rational, with degrees up to 9 for curves.
inline SplineFile RandomFile(unsigned seed, bool hierarchical)
{
  Random random(seed);
  SplineFile file;
  const auto add = [&](auto space)
  {
    for (bool rational : { false, true })
    {
      file.Ids.push_back(3 * static_cast<int>(file.Splines.size()) + random.Int(0, 2));
      file.Splines.emplace_back(
        WithWildNumbers(random, RandomSpline(random, space, random.Int(1, 4), rational)));
    }
  };
  add(RandomTensorSpace<1>(random, 9, 6));
  add(RandomTensorSpace<2>(random, 5, 4));
  add(RandomTensorSpace<3>(random, 3, 2));
  if (hierarchical)
  {
    add(RandomHierarchicalSpace<1>(random, 5, 5, 3));
    add(RandomHierarchicalSpace<2>(random, 4, 4, 3));
    add(RandomHierarchicalSpace<3>(random, 2, 2, 2));
  }
  return file;
}
}
