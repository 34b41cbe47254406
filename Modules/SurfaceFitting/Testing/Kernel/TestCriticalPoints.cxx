// SPDX-License-Identifier: BSD-3-Clause
#include "BezierForm.h"
#include "CriticalCases.h"
#include "CriticalPoints.h"

namespace knotwork::testing
{
namespace
{
CriticalPoints Find(const Spline<2>& f, const CriticalPointParams& params = {})
{
  Result<CriticalPoints> found = FindCriticalPoints(f, params);
  EXPECT_TRUE(found) << found.Status.Message();
  return found.Value;
}

int NumAt(const CriticalPoints& found, CriticalPlace place)
{
  int n = 0;
  for (const CriticalPoint& point : found.Points)
  {
    n += point.Place == place ? 1 : 0;
  }
  return n;
}

std::string Summary(const CriticalPoints& found)
{
  std::ostringstream text;
  text << found.NumMinima << " minima, " << found.NumMaxima << " maxima, " << found.NumSaddles
       << " saddles, " << found.Clusters.size() << " clusters of " << found.Boxes.size()
       << " boxes, index " << found.IndexSum << ", characteristic " << found.EulerCharacteristic
       << ", " << found.NumTested << " tested";
  return text.str();
}
}

TEST(CriticalPoints, RandomSplinesHaveTheIndexOfTheirDomain_PropertyOracle)
{
  int numPoints = 0;
  int numCreases = 0;
  for (unsigned seed = 1; seed <= 600; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    Spline<2> f;
    const int family = static_cast<int>(seed % 3);
    const bool rational = random.Int(0, 2) == 0;
    if (family == 0)
    {
      f = RandomSpline<2>(random, RandomTensorSpace<2>(random, 4, 6), 1, rational);
    }
    else if (family == 1)
    {
      f = RandomSpline<2>(random, RandomHierarchicalSpace<2>(random, 4, 4, 2), 1, rational);
    }
    else
    {
      f = RandomClampedSurface(random, 4, 5, 1, rational);
    }
    const CriticalPoints found = Find(f);
    numPoints += static_cast<int>(found.Points.size());
    numCreases += NumAt(found, CriticalPlace::Crease);
    EXPECT_TRUE(found.Proved) << Summary(found);
    EXPECT_EQ(found.IndexSum, found.EulerCharacteristic) << Summary(found);
    EXPECT_EQ(found.EulerCharacteristic, 1);
    if (::testing::Test::HasFailure()) { std::cout << seed << " " << Summary(found) << "\n"; for (const CriticalBox& b : found.Boxes) std::cout << b.Element << ": " << b.Box.Lower[0] << " " << b.Box.Lower[1] << " " << b.Box.Upper[0] - b.Box.Lower[0] << " " << b.Box.Upper[1]-b.Box.Lower[1] << "\n"; break; }
  }
  std::cout << numPoints << " " << numCreases << "\n";
}
}
