// SPDX-License-Identifier: BSD-3-Clause
// Meshes of every kind that files bring build with every policy.
#include "SmoothnessOracle.h"

#include <gtest/gtest.h>

using namespace knotwork;
using namespace meshes;

namespace
{
/// Degrees 2 and 3 with every policy: the functions meet the conditions, are not negative, sum to
/// one and are independent on every cell; what is less smooth than the policy says is counted.
template <int Dim>
void ExpectAllPolicies(const std::string& name, const CellMesh<Dim>& mesh)
{
  Random random(1);
  const std::vector<int> lengths(static_cast<std::size_t>(mesh.NumCells()) * Dim, 1);
  for (int p = 2; p <= 3; ++p)
  {
    for (const auto policy : { CreasePolicy::Automatic, CreasePolicy::Full,
           CreasePolicy::Motorcycle, CreasePolicy::Minimal })
    {
      if (Dim == 3 && policy == CreasePolicy::Motorcycle)
      {
        continue;
      }
      SCOPED_TRACE(
        name + ", p " + std::to_string(p) + ", policy " + std::to_string(static_cast<int>(policy)));
      UnstructuredParams params;
      params.Degree = p;
      params.Policy = policy;
      const auto made = MakeUnstructuredSpace<Dim>(mesh, params);
      ASSERT_TRUE(made) << made.Status.Message();
      EXPECT_LE(made->Repairs, made->CreasedFacets);
      const oracle::SmoothnessConditions<Dim> conditions(
        mesh, p, ContinuityOf(*made->Space), lengths);
      oracle::ExpectFunctions<Dim>(*made->Space, conditions, random);
    }
  }
}

/// Of random squares that are glued: a sheet runs through a cell in both directions.
CellMesh<2> CrossedSheet()
{
  Random random(7);
  for (;;)
  {
    const CellMesh<2> mesh = GluedSquares(random, 3, 3, false);
    const auto topology = MeshTopology<2>::Make(mesh);
    if (!topology || mesh.NumCells() < 8)
    {
      continue;
    }
    const auto sheets = topology->FindSheets();
    for (int c = 0; c < mesh.NumCells(); ++c)
    {
      if (sheets.Of[static_cast<std::size_t>(2 * c)] ==
        sheets.Of[static_cast<std::size_t>(2 * c + 1)])
      {
        return mesh;
      }
    }
  }
}
}

TEST(MeshKinds, QuadrilateralsOfEveryTopologyBuild_PropertyOracle)
{
  ExpectAllPolicies<2>("sphere", CubeSphere(4));
  ExpectAllPolicies<2>("coarsest sphere", CubeSphere(1));
  ExpectAllPolicies<2>("disc", Blocks<2>(3, 2));
  ExpectAllPolicies<2>("Klein bottle", Twisted(6, 4, true));
  ExpectAllPolicies<2>("Moebius strip", Twisted(9, 3, false));
  ExpectAllPolicies<2>("strip of 3 cells", Grid<2>({ 3, 1 }, { true, false }));
  ExpectAllPolicies<2>("torus of 3 x 4 cells", Grid<2>({ 3, 4 }, { true, true }));
  ExpectAllPolicies<2>("sheet that crosses itself", CrossedSheet());
  for (const int valence : { 3, 4, 5, 7, 12, 31, 64 })
  {
    ExpectAllPolicies<2>("star of " + std::to_string(valence), Star(valence, 1 + valence % 3));
  }
  for (unsigned seed = 1; seed <= 6; ++seed)
  {
    Random random(seed);
    const CellMesh<2> triangles = CutSimplices<2>(random, { 6, 5 }, 0.95);
    if (MeshTopology<2>::Make(triangles))
    {
      ExpectAllPolicies<2>("split triangles", Shuffled(random, triangles));
    }
  }
}

TEST(MeshKinds, HexahedraOfEveryTopologyBuild_PropertyOracle)
{
  ExpectAllPolicies<3>("ball of 7 blocks", Blocks<3>(2, 2));
  ExpectAllPolicies<3>("ring over a star", Sweep(Star(5, 2), 4, true));
  ExpectAllPolicies<3>("shell", Sweep(CubeSphere(2), 2));
  ExpectAllPolicies<3>("ring over a disc, 3 cells around", Sweep(Blocks<2>(2, 1), 3, true));
  Random random(3);
  for (int i = 0; i < 4; ++i)
  {
    const CellMesh<3> cut = CutSimplices<3>(random, { 2, 1, 1 }, 1.0);
    ASSERT_TRUE(MeshTopology<3>::Make(cut));
    ExpectAllPolicies<3>("cut tetrahedra", Shuffled(random, cut));
  }
}
