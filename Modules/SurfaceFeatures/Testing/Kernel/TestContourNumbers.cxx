// SPDX-License-Identifier: BSD-3-Clause
#include "CloudCases.h"
#include "LRCases.h"
#include "MergeTrees.h"
#include <knotwork/SplineCore/Numbers.h>
#include <knotwork/SplineCore/Refinement.h>
#include <knotwork/SurfaceFeatures/Contours.h>

#include <set>

namespace knotwork::testing
{
namespace
{
/// Hills and a cliff over biquadratic or bicubic LR functions whose elements are smaller along it.
Spline<2> Cliff(Random& random, int degree, int elements, int steps)
{
  std::array<KnotVector, 2> knots;
  for (KnotVector& k : knots)
  {
    std::vector<double> t(static_cast<std::size_t>(degree), 0.0);
    for (int i = 0; i <= elements; ++i)
    {
      t.push_back(static_cast<double>(i) / elements);
    }
    t.insert(t.end(), static_cast<std::size_t>(degree), 1.0);
    k = KnotVector::Create(degree, t).Value;
  }
  Spline<2> f;
  f.Space = InsertSegments(MakeTensorSpace<2>(knots).Value, {}, 0).Value;
  f.ControlPoints = PointMatrix::Zero(f.Space->NumFunctions, 1);
  const auto line = [](double x) { return 0.4 + 0.1 * std::sin(6.0 * x); };
  for (int step = 0; step < steps; ++step)
  {
    std::vector<int> marked;
    for (int e = 0; e < f.Space->NumElements(); ++e)
    {
      const ParametricBox<2>& box = f.Space->Elements[static_cast<std::size_t>(e)].Box;
      const double at = line(0.5 * (box.Lower[0] + box.Upper[0]));
      if (box.Lower[1] <= at && at < box.Upper[1])
      {
        marked.push_back(e);
      }
    }
    f = RefineMarkedElements<2>(f, marked).Value.Value;
  }
  const clouds::Terrain terrain;
  for (int i = 0; i < f.Space->NumFunctions; ++i)
  {
    double place[2];
    for (int d = 0; d < 2; ++d)
    {
      const std::vector<double> t = LocalKnotValues(f.Space->LocallyRefined->Basis, i, d);
      place[d] = std::accumulate(t.begin() + 1, t.end() - 1, 0.0) / degree;
    }
    f.ControlPoints(i, 0) = terrain(place[0], place[1]) + random.In(-0.02, 0.02);
  }
  return f;
}

/// Random coefficients over a random mesh; continuous.
Spline<2> Rugged(Random& random, int family)
{
  const bool rational = random.Int(0, 2) == 0;
  if (family == 0)
  {
    return RandomSpline<2>(random, RandomTensorSpace<2>(random, 4, 6), 1, rational);
  }
  if (family == 1)
  {
    return RandomSpline<2>(random, RandomHierarchicalSpace<2>(random, 4, 4, 2), 1, rational);
  }
  SplineSpacePtr<2> space =
    InsertSegments(RandomClampedSurface(random, 4, 4, 1, false).Space, {}, 0).Value;
  for (int i = 0; i < 8; ++i)
  {
    LRSegment segment = RandomSegment(random, *space);
    segment.Multiplicity = std::min(segment.Multiplicity,
      space->LocallyRefined->Basis.Degree[static_cast<std::size_t>(segment.Direction)]);
    const auto next = InsertSegments(space, { segment }, 0);
    space = next ? next.Value : space;
  }
  return RandomSpline<2>(random, space, 1, rational);
}

/// Levels next to all critical values, above and below, and what the contours there number.
/// @return the number of levels.
int CompareNumbers(const Spline<2>& f)
{
  const auto found = FindCriticalPoints(f);
  EXPECT_TRUE(found) << found.Status.Message();
  EXPECT_TRUE(found->Proved);
  EXPECT_EQ(found->EulerCharacteristic, 1);
  const BezierForm<2> form = MakeBezierForm(f);
  const ContourNumbers numbers(form, found.Value);
  EXPECT_TRUE(numbers.AreTrees());
  std::set<double> values;
  for (const CriticalPoint& point : found->Points)
  {
    values.insert(point.Value);
  }
  const double range = *values.rbegin() - *values.begin();
  ContourParams params;
  params.Component = 0;
  params.Tolerance = 0.1 * range; // which does not matter for numbers
  double previous = *values.begin() - range;
  for (auto value = values.begin(); value != values.end(); ++value)
  {
    const double next = std::next(value) == values.end() ? *value + range : *std::next(value);
    for (const double distance : { 1.0, 1e-9 })
    {
      // not beyond the neighbouring critical values
      params.Levels.push_back(*value - std::min(distance * range, 0.4 * (*value - previous)));
      params.Levels.push_back(*value + std::min(distance * range, 0.4 * (next - *value)));
    }
    previous = *value;
  }
  const auto contours = TraceContours(form, params);
  EXPECT_TRUE(contours) << contours.Status.Message();
  EXPECT_TRUE(contours->Undecided.empty());
  for (std::size_t l = 0; l < contours->Levels.size(); ++l)
  {
    const double level = contours->Levels[l];
    EXPECT_EQ(contours->NumComponents[l], numbers.All(level)) << Digits(level);
    EXPECT_EQ(contours->NumClosed[l], numbers.Closed(level)) << Digits(level);
  }
  // on a critical value: as just below it
  params.Levels.assign(values.begin(), values.end());
  const auto on = TraceContours(form, params);
  EXPECT_TRUE(on) << on.Status.Message();
  EXPECT_TRUE(on->Undecided.empty());
  for (std::size_t l = 0; l < on->Levels.size(); ++l)
  {
    const double below = on->Levels[l] - 1e-12 * range;
    EXPECT_EQ(on->NumComponents[l], numbers.All(below)) << Digits(below);
    EXPECT_EQ(on->NumClosed[l], numbers.Closed(below)) << Digits(below);
  }
  return static_cast<int>(contours->Levels.size());
}
}

TEST(ContourNumbers, OfACliffFollowFromItsCriticalPoints_CrossOracle)
{
  for (int degree : { 2, 3 })
  {
    SCOPED_TRACE("degree " + std::to_string(degree));
    Random random(static_cast<unsigned>(degree));
    EXPECT_GT(CompareNumbers(Cliff(random, degree, 12, 3)), 400);
  }
}

TEST(ContourNumbers, OfRandomSplinesFollowFromTheirCriticalPoints_CrossOracle)
{
  int levels = 0;
  for (unsigned seed = 1; seed <= 24; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    levels += CompareNumbers(Rugged(random, static_cast<int>(seed % 3)));
  }
  EXPECT_GT(levels, 1000);
}
}
