// SPDX-License-Identifier: BSD-3-Clause
// Splines whose knots are lost, put together again from their Bezier elements.
#include <knotwork/SplineCore/JoinElements.h>

#include "DerivativeOracle.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/BezierSpace.h>

#include <gtest/gtest.h>

#include <limits>
#include <numeric>

using namespace knotwork;

namespace
{
/// Elements that share no control points, in another order than the spline's.
template <int Dim>
struct LooseElements
{
  Spline<Dim> Elements;
  std::vector<ParametricBox<Dim>> Boxes;

  explicit LooseElements(const Spline<Dim>& spline)
  {
    const BezierForm<Dim> form = MakeBezierForm(spline);
    const int numElements = spline.Space->NumElements();
    std::vector<IntArray<Dim>> degrees;
    std::vector<double> rows;
    for (int k = 0; k < numElements; ++k)
    {
      const int e = numElements - 1 - k;
      const auto& element = spline.Space->Elements[static_cast<std::size_t>(e)];
      degrees.push_back(element.Degree);
      this->Boxes.push_back(element.Box);
      const int n = NumTensorFunctions<Dim>(element.Degree);
      for (int i = 0; i < n; ++i)
      {
        for (int c = 0; c < form.NumPlanes(); ++c)
        {
          rows.push_back(form.Block(e)[c * n + i]);
        }
      }
    }
    const auto count = static_cast<int>(rows.size()) / form.NumPlanes();
    std::vector<int> ids(static_cast<std::size_t>(count));
    std::iota(ids.begin(), ids.end(), 0);
    this->Elements.Space = MakeBezierSpace<Dim>(degrees, ids, count).Value;
    this->Elements.SetHomogeneousPoints(
      Eigen::Map<const PointMatrix>(rows.data(), count, form.NumPlanes()), form.Rational);
  }
};

template <int Dim>
void ExpectTheSameMap(const IntArray<Dim>& degree, const IntArray<Dim>& elements, bool rational)
{
  for (unsigned seed = 1; seed <= 5; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    Spline<Dim> spline = RandomTensorSpline<Dim>(random, degree, elements, 3, rational);
    const LooseElements<Dim> loose(spline);
    const auto joined = JoinElements<Dim>(loose.Elements, loose.Boxes);
    ASSERT_TRUE(joined) << joined.Status.Message();
    const PointMatrix parameters = RandomParameters<Dim>(random, *spline.Space, 50);
    EvaluationBatch a;
    EvaluationBatch b;
    ASSERT_TRUE(EvaluateParameters<Dim>(MakeBezierForm(spline), parameters, { 1, 0 }, a));
    ASSERT_TRUE(EvaluateParameters<Dim>(MakeBezierForm(joined.Value), parameters, { 1, 0 }, b));
    // extraction twice, weights between 0.5 and 1.5, derivatives by elements as short as 0.05
    const double tolerance = 1e4 * std::numeric_limits<double>::epsilon();
    EXPECT_LE((a.Values - b.Values).cwiseAbs().maxCoeff(), tolerance);
    EXPECT_LE(
      (a.First - b.First).cwiseAbs().maxCoeff(), tolerance * (1.0 + a.First.cwiseAbs().maxCoeff()));
  }
}

TEST(JoinElements, KeepsTheMap_CrossOracle)
{
  for (bool rational : { false, true })
  {
    ExpectTheSameMap<1>({ 3 }, { 5 }, rational);
    ExpectTheSameMap<2>({ 2, 3 }, { 3, 4 }, rational);
    ExpectTheSameMap<3>({ 1, 2, 2 }, { 2, 1, 3 }, rational);
  }
}

TEST(JoinElements, RefusesWhatIsNoTensorProduct)
{
  std::mt19937_64 random(7);
  Spline<2> spline;
  spline.Space = MakeTensorSpace<2>({ KnotVector::Uniform(2, 3), KnotVector::Uniform(2, 3) }).Value;
  spline.ControlPoints = RandomMatrix(random, spline.Space->NumFunctions, 3);
  const LooseElements<2> good(spline);
  ASSERT_TRUE(JoinElements<2>(good.Elements, good.Boxes));
  const auto code = [](const Spline<2>& elements, const std::vector<ParametricBox<2>>& boxes)
  { return JoinElements<2>(elements, boxes).Status.Code; };
  auto boxes = good.Boxes;
  boxes.pop_back();
  EXPECT_EQ(code(good.Elements, boxes), ErrorCode::SizeMismatch);
  boxes = good.Boxes;
  boxes[1] = boxes[0];
  EXPECT_EQ(code(good.Elements, boxes), ErrorCode::InvalidTopology);
  boxes = good.Boxes;
  boxes[4].Upper[0] = boxes[4].Lower[0] + 0.1;
  EXPECT_EQ(code(good.Elements, boxes), ErrorCode::InvalidTopology);
  boxes = good.Boxes;
  boxes[8].Lower[1] += 5.0;
  boxes[8].Upper[1] += 5.0;
  EXPECT_EQ(code(good.Elements, boxes), ErrorCode::InvalidTopology) << "gaps";
  Spline<2> apart = good.Elements;
  apart.ControlPoints(0, 2) += 1e-3;
  EXPECT_EQ(code(apart, good.Boxes), ErrorCode::NotInSpace);
}
}
