// SPDX-License-Identifier: BSD-3-Clause
#include "MeshCases.h"
#include <knotwork/SplineCore/MeshPatches.h>

#include <gtest/gtest.h>

#include <set>

using namespace knotwork;
using namespace meshes;

namespace
{
/// Points of a side of a cell.
template <int Dim>
std::set<int> SidePoints(const CellMesh<Dim>& mesh, int cell, int side)
{
  std::set<int> points;
  for (int corner = 0; corner < (1 << Dim); ++corner)
  {
    if ((corner >> (side / 2) & 1) == side % 2)
    {
      points.insert(mesh.Cell(cell)[corner]);
    }
  }
  return points;
}

/// Every cell is in one box, neighbours in a box have the facet between them in common, and every
/// other facet is a cut or on the boundary.
template <int Dim>
void ExpectBoxes(const CellMesh<Dim>& mesh, const MeshPatches<Dim>& patches)
{
  std::map<std::set<int>, int> uses; // of facets: 1 on the boundary, 2 inside
  for (int c = 0; c < mesh.NumCells(); ++c)
  {
    for (int side = 0; side < 2 * Dim; ++side)
    {
      ++uses[SidePoints(mesh, c, side)];
    }
  }
  std::size_t inside = 0;
  for (const auto& [points, count] : uses)
  {
    inside += count == 2 ? 1 : 0;
  }
  std::set<int> seen;
  std::size_t joined = 0;
  for (std::size_t p = 0; p < patches.Patches.size(); ++p)
  {
    const MeshPatch<Dim>& patch = patches.Patches[p];
    for (std::size_t i = 0; i < patch.Cells.size(); ++i)
    {
      const int c = patch.Cells[i];
      ASSERT_TRUE(seen.insert(c).second);
      ASSERT_EQ(patches.PatchOf[static_cast<std::size_t>(c)], static_cast<int>(p));
      const IntArray<Dim>& index = patches.IndexOf[static_cast<std::size_t>(c)];
      const IntArray<Dim>& ahead = patches.AheadOf[static_cast<std::size_t>(c)];
      std::size_t at = 0;
      std::size_t stride = 1;
      for (std::size_t d = 0; d < Dim; ++d)
      {
        at += stride * static_cast<std::size_t>(index[d]);
        if (index[d] + 1 < patch.Size[d])
        {
          const int next = patch.Cells[i + stride];
          EXPECT_EQ(SidePoints(mesh, c, ahead[d]),
            SidePoints(mesh, next, patches.AheadOf[static_cast<std::size_t>(next)][d] ^ 1));
          ++joined;
        }
        stride *= static_cast<std::size_t>(patch.Size[d]);
      }
      ASSERT_EQ(at, i);
    }
  }
  EXPECT_EQ(static_cast<int>(seen.size()), mesh.NumCells());
  EXPECT_EQ(joined + patches.Cuts.size(), inside);
}

template <int Dim>
MeshPatches<Dim> Find(const CellMesh<Dim>& mesh, CreasePolicy policy)
{
  auto made = FindMeshPatches<Dim>(mesh, policy);
  EXPECT_TRUE(made) << made.Status.Message();
  ExpectBoxes(mesh, made.Value);
  return std::move(made.Value);
}
}

TEST(MeshPatches, RandomMeshesAreBoxes_PropertyOracle)
{
  for (unsigned seed = 1; seed <= 200; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto quads = RandomMesh<2>(random, 80);
    EXPECT_TRUE(Find<2>(quads, CreasePolicy::Full).TJoints.empty());
    Find<2>(quads, CreasePolicy::Motorcycle);
    Find<3>(RandomMesh<3>(random, 30), CreasePolicy::Full);
  }
}

TEST(MeshPatches, KnownMeshes_ExactOracle)
{
  EXPECT_EQ(Find<2>(Grid<2>({ 5, 3 }), CreasePolicy::Full).Patches.size(), 1U);
  EXPECT_EQ(Find<2>(CubeSphere(4), CreasePolicy::Full).Patches.size(), 6U);
  EXPECT_EQ(Find<2>(CubeSphere(4), CreasePolicy::Motorcycle).Patches.size(), 6U);
  EXPECT_EQ(Find<2>(Star(7, 3), CreasePolicy::Full).Patches.size(), 7U);
  EXPECT_EQ(Find<2>(Blocks<2>(3, 2), CreasePolicy::Full).Patches.size(), 5U);
  EXPECT_EQ(Find<3>(Blocks<3>(3, 2), CreasePolicy::Full).Patches.size(), 7U);
  EXPECT_EQ(Find<3>(Sweep(Star(5, 2), 4), CreasePolicy::Full).Patches.size(), 5U);
  // strips that close are cut once
  const auto torus = Find<2>(Grid<2>({ 5, 4 }, { true, true }), CreasePolicy::Full);
  EXPECT_EQ(torus.Patches.size(), 1U);
  EXPECT_EQ(torus.Cuts.size(), 9U);
  EXPECT_EQ(Find<2>(Twisted(5, 3, false), CreasePolicy::Full).Cuts.size(), 3U);
}

TEST(MeshPatches, EveryFailureIsReachable_ExactOracle)
{
  const auto code = [](auto mesh, CreasePolicy policy, std::vector<CellSide> features)
  { return FindMeshPatches(mesh, policy, features).Status.Code; };
  EXPECT_EQ(code(CellMesh<2>(), CreasePolicy::Full, {}), ErrorCode::EmptyInput);
  EXPECT_EQ(code(Grid<2>({ 1, 1 }), CreasePolicy::Minimal, {}), ErrorCode::InvalidParameter);
  EXPECT_EQ(code(Grid<3>({ 1, 1, 1 }), CreasePolicy::Motorcycle, {}), ErrorCode::InvalidParameter);
  EXPECT_EQ(code(Grid<2>({ 2, 1 }), CreasePolicy::Full, { { 0, 0 } }), ErrorCode::InvalidParameter);
  EXPECT_EQ(
    FindMeshPatches<2>(Grid<2>({ 2, 2 }), CreasePolicy::Full, { { 0, 1 } })->Patches.size(), 2U);
}

TEST(MeshPatches, MeshesOfFiles_PublishedOracle)
{
  const auto rod = ReadMesh<2>("bl_rod_764.off");
  if (rod.Corners.empty())
  {
    GTEST_SKIP() << "KNOTWORK_UNSTRUCTURED_MESHES names no folder of meshes";
  }
  EXPECT_EQ(Find<2>(rod, CreasePolicy::Full).Patches.size(), 716U);
  EXPECT_LE(Find<2>(rod, CreasePolicy::Motorcycle).Patches.size(), 100U);
  Find<3>(ReadMesh<3>("cmu_hepta.vtk"), CreasePolicy::Full);
}
