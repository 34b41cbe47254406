// SPDX-License-Identifier: BSD-3-Clause
// Quick ways to a spline against the one by elements.
#include "FitCases.h"

#include <gtest/gtest.h>

using namespace knotwork;
using namespace fits;

namespace
{
CADFitParams Params(int degree, FitPath path, CreasePolicy policy = CreasePolicy::Full)
{
  CADFitParams params;
  params.Space.Degree = degree;
  params.Space.Policy = policy;
  params.TargetSamples = 0;
  params.Path = path;
  return params;
}

template <int Dim>
CADFit<Dim> Fit(const PlacedMesh<Dim>& mesh, const FitTargetPtr& target, const CADFitParams& params)
{
  auto fit = FitToTarget<Dim>(mesh.Mesh, mesh.Points, target, params);
  EXPECT_TRUE(fit) << fit.Status.Message();
  return std::move(fit.Value);
}

template <int Dim>
double Difference(const CADFit<Dim>& a, const CADFit<Dim>& b)
{
  return (a.Value.ControlPoints - b.Value.ControlPoints).cwiseAbs().maxCoeff();
}

/// A block of which only the map of the corners matters.
template <int Dim, class Map>
PlacedMesh<Dim> Block(const std::array<int, Dim>& n, Map&& map)
{
  Placer<Dim> placer;
  AddBlock<Dim>(placer, n, map);
  return placer.Done();
}

PlacedMesh<2> Angle()
{
  Placer<2> placer;
  for (const auto& [x, y] : { std::pair(0, 0), std::pair(1, 0), std::pair(0, 1) })
  {
    AddBlock<2>(placer, { 4, 4 },
      [x = x, y = y](const double* u)
      { return Eigen::RowVector3d(x + u[0] + 0.3 * (y + u[1]), 2.0 * (y + u[1]), 0.0); });
  }
  return placer.Done();
}

template <int Dim>
void ExpectAllEqual(
  const PlacedMesh<Dim>& mesh, const std::vector<FitPath>& paths, FitPath automatic)
{
  for (const int degree : { 1, 2, 3 })
  {
    const auto cells = Fit<Dim>(mesh, nullptr, Params(degree, FitPath::Unstructured));
    EXPECT_EQ(cells.Path, FitPath::Unstructured);
    for (const FitPath path : paths)
    {
      const auto fit = Fit<Dim>(mesh, nullptr, Params(degree, path));
      EXPECT_EQ(fit.Path, path) << ToString(path) << ": " << fit.PathNote;
      EXPECT_LE(Difference(fit, cells), 1e-13) << ToString(path) << ' ' << degree;
    }
    // at degree 1 every cell is a patch, and multilinear
    const FitPath found = Fit<Dim>(mesh, nullptr, Params(degree, FitPath::Automatic)).Path;
    EXPECT_TRUE(degree == 1 || found == automatic) << ToString(found);
  }
}
}

/// Sizes near 1: 1e-13 is some hundred roundings.
TEST(FastPaths, AffineMultilinearAndCoonsCoincide_CrossOracle)
{
  const std::vector<FitPath> all{ FitPath::Affine, FitPath::Multilinear, FitPath::Coons,
    FitPath::Composite };
  ExpectAllEqual<2>(Angle(), all, FitPath::Affine);
  ExpectAllEqual<3>(
    Block<3>({ 4, 3, 5 },
      [](const double* u)
      { return Eigen::RowVector3d(u[0] + 0.2 * u[1], u[1] - 0.1 * u[2], u[2] + 0.3 * u[0]); }),
    all, FitPath::Affine);
  const std::vector<FitPath> multilinear(all.begin() + 1, all.end());
  ExpectAllEqual<2>(
    Block<2>({ 5, 4 },
      [](const double* u)
      { return Eigen::RowVector3d(u[0] + 0.2 * u[1] * u[0], u[1], 0.3 * u[0] * u[1]); }),
    multilinear, FitPath::Multilinear);
  ExpectAllEqual<3>(Block<3>({ 4, 3, 5 },
                      [](const double* u)
                      {
                        return Eigen::RowVector3d(u[0] + 0.2 * u[1] * u[2], u[1] * (1 + 0.2 * u[0]),
                          u[2] + 0.1 * u[0] * u[1] * u[2]);
                      }),
    multilinear, FitPath::Multilinear);
}

/// A block whose inside is the Boolean sum of its boundary: Coons is exact there.
TEST(FastPaths, CoonsOfCurvedBoundaries_CrossOracle)
{
  const auto plane = Block<2>({ 8, 6 },
    [](const double* u)
    { return Eigen::RowVector3d(u[0], u[1] + 0.1 * std::sin(3.0 * u[0]), 0.0); });
  ExpectAllEqual<2>(plane, { FitPath::Coons, FitPath::Composite }, FitPath::Composite);
  const auto solid = Block<3>({ 5, 6, 4 },
    [](const double* u)
    { return Eigen::RowVector3d(u[0], u[1] + 0.1 * std::sin(3.0 * u[0]), u[2] * (1 + u[1])); });
  ExpectAllEqual<3>(solid, { FitPath::Coons, FitPath::Composite }, FitPath::Composite);
}

/// On the target Coons keeps the surface of the unstructured path.
TEST(FastPaths, CoonsKeepsTheBoundary_CrossOracle)
{
  const FitTargetPtr sphere = Ellipsoid(1.0, 1.0, 1.0);
  const auto coons = Fit<3>(Ball(4), sphere, Params(2, FitPath::Coons));
  const auto cells = Fit<3>(Ball(4), sphere, Params(2, FitPath::Unstructured));
  EXPECT_EQ(coons.Path, FitPath::Coons) << coons.PathNote;
  EXPECT_EQ(coons.Certificate.Verdict, Verdict::Valid);
  EXPECT_NEAR(coons.Volume, cells.Volume, 1e-12);
  EXPECT_NEAR(coons.Area, cells.Area, 1e-12);
  EXPECT_GT(Difference(coons, cells), 1e-6);
}

/// With policy Full the patches give what the elements give.
TEST(FastPaths, CompositeIsTheUnstructuredResult_CrossOracle)
{
  const FitTargetPtr sphere = Ellipsoid(1.0, 1.0, 1.0);
  for (const int degree : { 2, 3 })
  {
    const auto fit = Fit<2>(Sphere(8), sphere, Params(degree, FitPath::Automatic));
    EXPECT_EQ(fit.Path, FitPath::Composite);
    EXPECT_LE(
      Difference(fit, Fit<2>(Sphere(8), sphere, Params(degree, FitPath::Unstructured))), 1e-10);
    const auto ball = Fit<3>(Ball(3), sphere, Params(degree, FitPath::Automatic));
    EXPECT_EQ(ball.Path, FitPath::Composite);
    EXPECT_LE(
      Difference(ball, Fit<3>(Ball(3), sphere, Params(degree, FitPath::Unstructured))), 1e-10);
  }
}

/// Other policies: another mean of the same order.
TEST(FastPaths, CompositeOfOtherPoliciesHasTheOrder_PropertyOracle)
{
  const FitTargetPtr sphere = Ellipsoid(1.0, 1.0, 1.0);
  double last[2] = { 0.0, 0.0 };
  for (const int n : { 8, 16 })
  {
    const double found[2] = {
      MeanDistance(
        Fit<2>(Sphere(n), sphere, Params(2, FitPath::Composite, CreasePolicy::Minimal)).Value,
        FromUnitSphere),
      MeanDistance(
        Fit<2>(Sphere(n), sphere, Params(2, FitPath::Unstructured, CreasePolicy::Minimal)).Value,
        FromUnitSphere)
    };
    // the policy's own rate on these meshes
    const double rate = std::log2(last[0] / found[0]);
    EXPECT_TRUE(n == 8 || rate >= std::log2(last[1] / found[1]) - 0.1) << rate;
    EXPECT_LE(found[0], 1.5 * found[1]);
    std::copy(found, found + 2, last);
  }
  const auto automatic =
    Fit<2>(Sphere(8), sphere, Params(2, FitPath::Automatic, CreasePolicy::Minimal));
  EXPECT_EQ(automatic.Path, FitPath::Unstructured);
  EXPECT_TRUE(automatic.PathNote.empty());
}

TEST(FastPaths, EveryReasonToGiveWay)
{
  const FitTargetPtr sphere = Ellipsoid(1.0, 1.0, 1.0);
  const auto note = [](const auto& fit)
  {
    EXPECT_EQ(fit.Path, FitPath::Unstructured);
    return std::string(ToString(fit.PathTried)) + ": " + fit.PathNote;
  };
  const auto sphereNote = [&](FitPath path)
  { return note(Fit<2>(Sphere(4), sphere, Params(2, path))); };
  EXPECT_EQ(sphereNote(FitPath::Coons), "coons: the insides of patches lie on the target as well");
  EXPECT_EQ(
    sphereNote(FitPath::Affine), "affine: the target is another shape than the mesh itself");
  EXPECT_EQ(note(Fit<2>(Sphere(4), nullptr, Params(2, FitPath::Multilinear))),
    "multilinear: points are not where the multilinear maps of their patches have them");
  EXPECT_EQ(note(Fit<2>(Sphere(8), nullptr, Params(3, FitPath::Coons, CreasePolicy::Minimal))),
    "coons: patches are smooth across their sides, take the policy full");
  const auto bent = Block<2>(
    { 4, 4 }, [](const double* u) { return Eigen::RowVector3d(u[0] * (1.0 + u[1]), u[1], 0.0); });
  EXPECT_EQ(note(Fit<2>(bent, nullptr, Params(2, FitPath::Affine))),
    "affine: the elements are not images of one lattice");
  // part of a ring that is twisted: its Boolean sum goes through the middle
  const auto twisted = Block<2>({ 24, 12 },
    [](const double* u)
    {
      const double angle = 4.0 * u[0] + 2.0 * u[1];
      const double radius = 1.0 + u[0];
      return Eigen::RowVector3d(radius * std::cos(angle), radius * std::sin(angle), 0.0);
    });
  const auto coons = Fit<2>(twisted, nullptr, Params(2, FitPath::Coons));
  EXPECT_NE(note(coons).find("elements had no certificate"), std::string::npos) << coons.PathNote;
  EXPECT_EQ(coons.Certificate.Verdict, Verdict::Valid);
  EXPECT_EQ(Difference(coons, Fit<2>(twisted, nullptr, Params(2, FitPath::Unstructured))), 0.0);
}
