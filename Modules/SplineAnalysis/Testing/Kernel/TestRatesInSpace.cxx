// SPDX-License-Identifier: BSD-3-Clause
// Orders of convergence of splines in space, on curved bodies.
#include "Rates.h"

namespace knotwork::testing
{
namespace
{
/// The bent cube in two halves; the second one's parameters run backwards along x and y. All meshes
/// have the map of 2 elements a direction. @param n  a power of 2, from 2 on.
AnalysisCase TwoHalves(int n, int degree)
{
  MultiPatch<3> body;
  for (int k = 0; k < 2; ++k)
  {
    Spline<3> patch = BentBox<3>(degree, 2, 0.0);
    for (Eigen::Index i = 0; i < patch.ControlPoints.rows(); ++i)
    {
      double* x = patch.ControlPoints.row(i).data();
      x[0] = 0.5 * (k == 0 ? x[0] : 2.0 - x[0]);
      x[1] = k == 0 ? x[1] : 1.0 - x[1];
      Bend(x, 3);
    }
    for (int elements = 2; elements < n; elements *= 2)
    {
      patch = RefineAllElements(patch)->Value;
    }
    body.Patches.push_back(patch);
  }
  body.Topology.Interfaces = FindInterfaces(body.Patches);
  EXPECT_EQ(body.Topology.Interfaces.size(), 1U);
  AnalysisCase made{ "", MakeGalerkinSpace(body).Value, {} };
  made.Boundary = BoundaryFacets(made.Space).Value;
  return made;
}

/// A quarter of a tube, whose weights are those of circles. The solution does not vary along it.
AnalysisCase Tube(int n, int degree)
{
  ShapeParams tube;
  tube.Kind = ShapeKind::SolidTube;
  tube.InnerRadius = 0.5;
  tube.OuterRadius = 1.0;
  tube.Height = 0.5;
  tube.Elements = { n, n, n / 4 };
  tube.Degree = degree;
  const Spline<3> body = ShapePatches<3>(tube)[0];
  EXPECT_GT(body.Weights.size(), 0);
  return CaseOf<3>("", body);
}

/// The bent cube with an eighth of its elements split.
AnalysisCase RefinedBox(int n, int degree)
{
  const Spline<3> box = BentBox<3>(degree, n);
  std::vector<int> marked;
  for (int e = 0; e < box.Space->NumElements(); ++e)
  {
    if (e % n < n / 2 && e / n % n < n / 2 && e / n / n < n / 2)
    {
      marked.push_back(e);
    }
  }
  return CaseOf<3>("", RefineMarkedElements(box, marked)->Value);
}
}

TEST(RatesInSpace, PoissonOnSplines_ExactOracle)
{
  for (const int p : { 2, 3 })
  {
    ExpectRates("tensor", p, 6, [p](int n) { return CaseOf<3>("", BentBox<3>(p, n)); });
    ExpectRates("THB", p, 6, [p](int n) { return RefinedBox(n, p); });
    ExpectRates("multi-patch", p, 8, [p](int n) { return TwoHalves(n, p); });
    ExpectRates(
      "unstructured", p, 4, [p](int n) { return CaseOf<3>("", BentStar<3>(5, n, p, n)); });
    ExpectRates("rational", p, 20, [p](int n) { return Tube(n, p); });
  }
}
}
