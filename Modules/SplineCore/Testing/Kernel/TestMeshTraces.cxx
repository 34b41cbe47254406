// SPDX-License-Identifier: BSD-3-Clause
#include "SmoothnessOracle.h"
#include <knotwork/SplineCore/MeshTraces.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>

using namespace knotwork;
using namespace meshes;

namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// The trace at random places of its elements is the whole there.
template <int Dim>
void ExpectSameValues(Random& random, const Spline<Dim + 1>& whole, const MeshTrace<Dim>& trace)
{
  const Spline<Dim> spline = TraceOf<Dim>(whole, trace);
  const int count = 100;
  PointMatrix local(count, Dim);
  PointMatrix wholeLocal(count, Dim + 1);
  std::vector<int> elements;
  std::vector<int> cells;
  for (int i = 0; i < count; ++i)
  {
    elements.push_back(random.Int(0, spline.Space->NumElements() - 1));
    const TraceElement<Dim>& element = trace.Elements[At(elements.back())];
    cells.push_back(element.Facet.Cell);
    wholeLocal(i, element.Facet.Side / 2) = element.Facet.Side % 2;
    for (int k = 0; k < Dim; ++k)
    {
      local(i, k) = random.Unit();
      wholeLocal(i, element.Direction[At(k)]) =
        element.Reversed[At(k)] ? 1.0 - local(i, k) : local(i, k);
    }
  }
  EvaluationBatch a;
  EvaluationBatch b;
  ASSERT_TRUE(EvaluateElements<Dim>(MakeBezierForm(spline, 1), elements, local, {}, a));
  ASSERT_TRUE(EvaluateElements<Dim + 1>(MakeBezierForm(whole, 1), cells, wholeLocal, {}, b));
  // coefficients below 2
  EXPECT_LE((a.Values - b.Values).cwiseAbs().maxCoeff(), 1e-13);
}

/// Functions that are not zero on the facets, by the Bernstein coefficients there.
template <int Dim>
std::set<int> FunctionsOn(const SplineSpace<Dim>& space, const std::vector<CellSide>& facets)
{
  std::set<int> found;
  const int p = space.Elements[0].Degree[0];
  const int count = NumTensorFunctions<Dim>(space.Elements[0].Degree);
  for (const auto [cell, side] : facets)
  {
    for (int i = 0; i < count; ++i)
    {
      int stride = 1;
      for (int d = 0; d < side / 2; ++d)
      {
        stride *= p + 1;
      }
      if (i / stride % (p + 1) != side % 2 * p) // vanishes: p equal knots are there
      {
        continue;
      }
      const int local = space.LocalFunctions(cell)[i];
      if (space.IsIdentityMap())
      {
        found.insert(local);
        continue;
      }
      for (std::size_t k = space.RowStart[At(local)]; k < space.RowStart[At(local) + 1]; ++k)
      {
        found.insert(space.RowFunction[k]);
      }
    }
  }
  return found;
}

template <int Dim>
std::vector<CellSide> Creases(const SplineSpace<Dim>& space)
{
  const auto topology = MeshTopology<Dim>::Make(MeshOf(space));
  const std::vector<int> continuity = ContinuityOf(space);
  std::vector<CellSide> creases;
  for (int c = 0; c < space.NumElements(); ++c)
  {
    for (int side = 0; side < 2 * Dim; ++side)
    {
      if (continuity[At(c * 2 * Dim + side)] == 0 && c < topology->Neighbour(c, side))
      {
        creases.push_back({ c, side });
      }
    }
  }
  return creases;
}

/// Whether a crease ends at a regular point inside: the surface is smooth beyond, or on the other
/// side of the crease that it ends on.
bool EndsInside(const SplineSpace<2>& space, const std::vector<CellSide>& creases)
{
  const auto topology = MeshTopology<2>::Make(MeshOf(space)).Value;
  const std::vector<int> continuity = ContinuityOf(space);
  const auto isCrease = [&](int cell, int side) { return continuity[At(cell * 4 + side)] == 0; };
  for (const auto [cell, side] : creases)
  {
    for (int end = 0; end < 2; ++end)
    {
      const int across = 2 * (1 - side / 2) + end;
      if (!topology.IsRegularInside(cell, MeshTopology<2>::RidgeOf(side, across)))
      {
        continue;
      }
      const CellSide opposite = topology.Opposite(cell, side, across);
      if (!isCrease(opposite.Cell, opposite.Side))
      {
        return true;
      }
    }
  }
  return false;
}

/// Some of the cells of a grid, each beside one before it.
CellMesh<3> RandomCubes(Random& random, int cells)
{
  std::vector<std::array<int, 3>> cubes{ { 0, 0, 0 } };
  std::set<std::array<int, 3>> taken(cubes.begin(), cubes.end());
  while (static_cast<int>(cubes.size()) < cells)
  {
    std::array<int, 3> at = cubes[At(random.Int(0, static_cast<int>(cubes.size()) - 1))];
    const int d = random.Int(0, 2);
    at[At(d)] = std::clamp(at[At(d)] + 2 * random.Int(0, 1) - 1, 0, 4 - d);
    if (taken.insert(at).second)
    {
      cubes.push_back(at);
    }
  }
  Maker<3> maker;
  for (const auto& [x, y, z] : cubes)
  {
    for (int corner = 0; corner < 8; ++corner)
    {
      maker.AddCorner({ x + (corner & 1), y + (corner >> 1 & 1), z + (corner >> 2) });
    }
  }
  return maker.Done();
}

Spline<3> RandomVolume(Random& random, std::vector<int>& lengths)
{
  return oracle::RandomSpline<3>(random, 3, 30, lengths);
}
}

TEST(MeshTraces, BoundaryOfVolumesIsOneSurface_ExactOracle)
{
  int surfaces = 0;
  int refused = 0;
  for (unsigned seed = 1; seed <= 80; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    std::vector<int> lengths;
    const Spline<3> volume = RandomVolume(random, lengths);
    const auto facets = BoundaryFacets(MeshTopology<3>::Make(MeshOf(*volume.Space)).Value);
    const auto trace = TraceOnFacets(*volume.Space, facets);
    if (!trace)
    {
      // volumes that meet themselves along an edge
      EXPECT_EQ(trace.Status.Code, ErrorCode::InvalidTopology) << trace.Status.Message();
      ++refused;
      continue;
    }
    ++surfaces;
    ASSERT_EQ(trace->Elements.size(), facets.size());
    const std::set<int> alive = FunctionsOn<3>(*volume.Space, facets);
    const std::set<int> functions(trace->Functions.begin(), trace->Functions.end());
    EXPECT_EQ(functions, alive);
    EXPECT_EQ(trace->Functions.size(), alive.size());
    ExpectSameValues<2>(random, volume, trace.Value);
    std::vector<int> own;
    for (const TraceElement<2>& element : trace->Elements)
    {
      for (const int d : element.Direction)
      {
        own.push_back(lengths[At(element.Facet.Cell * 3 + d)]);
      }
    }
    oracle::ExpectBasis<2>(*trace->Space, own, random);
  }
  EXPECT_GE(surfaces, 40);
  EXPECT_LE(refused, 4);
}

// where creases reach the boundary on both sides of an edge with three cells, and not in the third
TEST(MeshTraces, PolicyMinimalLeavesVolumesTheirBoundaries_PropertyOracle)
{
  int volumes = 0;
  int creased = 0;
  for (unsigned seed = 1; seed <= 200; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const CellMesh<3> mesh = RandomCubes(random, random.Int(8, 40));
    const auto topology = MeshTopology<3>::Make(mesh);
    if (!topology)
    {
      continue; // cubes that meet along an edge only
    }
    UnstructuredParams params;
    params.Degree = random.Int(2, 4);
    params.Policy = CreasePolicy::Minimal;
    oracle::RandomLengths<3>(random, mesh, random.Int(1, 3), params.Lengths);
    for (int i = random.Int(0, 6); i > 0; --i)
    {
      const CellSide feature{ random.Int(0, mesh.NumCells() - 1), random.Int(0, 5) };
      if (!topology->IsBoundary(feature.Cell, feature.Side))
      {
        params.Features.push_back(feature);
      }
    }
    const auto made = MakeUnstructuredSpace<3>(mesh, params);
    ASSERT_TRUE(made) << made.Status.Message();
    const auto facets = BoundaryFacets(topology.Value);
    const auto trace = TraceOnFacets(*made->Space, facets);
    if (!trace && trace.Status.Code == ErrorCode::InvalidTopology)
    {
      continue; // a boundary that meets itself
    }
    ++volumes;
    creased += made->CreasedFacets < made->InnerFacets ? 1 : 0;
    EXPECT_TRUE(trace) << trace.Status.Message();
  }
  EXPECT_GE(volumes, 80);
  EXPECT_GE(creased, 30);
}

TEST(MeshTraces, BoundariesAndCreasesOfSurfacesAreCurves_ExactOracle)
{
  int curves = 0;
  int closed = 0;
  int refused = 0;
  for (unsigned seed = 1; seed <= 150; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    std::vector<int> lengths;
    const Spline<2> surface = oracle::RandomSpline<2>(random, 4, 40, lengths);
    const auto topology = MeshTopology<2>::Make(MeshOf(*surface.Space));
    for (auto facets : { BoundaryFacets(topology.Value), Creases<2>(*surface.Space) })
    {
      const auto traces = TraceOnFacets(*surface.Space, facets);
      if (facets.empty())
      {
        EXPECT_EQ(traces.Status.Code, ErrorCode::EmptyInput);
        continue;
      }
      if (!traces)
      {
        EXPECT_EQ(traces.Status.Code, ErrorCode::NotInSpace) << traces.Status.Message();
        EXPECT_FALSE(topology->IsBoundary(facets[0].Cell, facets[0].Side));
        EXPECT_TRUE(EndsInside(*surface.Space, facets)) << traces.Status.Message();
        ++refused;
        continue;
      }
      std::size_t elements = 0;
      std::set<int> functions;
      for (const MeshTrace<1>& trace : traces.Value)
      {
        ++curves;
        elements += trace.Elements.size();
        functions.insert(trace.Functions.begin(), trace.Functions.end());
        const std::set<int> own(trace.Functions.begin(), trace.Functions.end());
        closed += own.size() < trace.Functions.size() ? 1 : 0;
        ExpectSameValues<1>(random, surface, trace);
      }
      EXPECT_EQ(elements, facets.size());
      EXPECT_EQ(functions, FunctionsOn<2>(*surface.Space, facets));
    }
  }
  EXPECT_GE(curves, 300);
  EXPECT_GE(closed, 20);
  EXPECT_GE(refused, 1);
}

TEST(MeshTraces, EdgesOfVolumesAreTracesOfTraces_ExactOracle)
{
  Random random(4);
  UnstructuredParams params;
  params.Degree = 3;
  const auto made = MakeUnstructuredSpace<3>(Sweep(Star(5, 3), 2), params);
  const Spline<3> volume = oracle::RandomMap<3>(random, made->Space, true);
  const auto faces = TraceOnFacets(
    *volume.Space, BoundaryFacets(MeshTopology<3>::Make(MeshOf(*volume.Space)).Value));
  ASSERT_TRUE(faces) << faces.Status.Message();
  const Spline<2> surface = TraceOf<2>(volume, faces.Value);
  const auto edges = TraceOnFacets(*surface.Space, Creases<2>(*surface.Space));
  ASSERT_TRUE(edges) << edges.Status.Message();
  for (const MeshTrace<1>& edge : edges.Value)
  {
    ExpectSameValues<1>(random, surface, edge);
  }
}

TEST(MeshTraces, EveryFailureIsReachable_ExactOracle)
{
  UnstructuredParams params;
  params.Degree = 2;
  const auto grid = MakeUnstructuredSpace<2>(Grid<2>({ 4, 3 }), params);
  const auto code = [&](const std::vector<CellSide>& facets)
  { return TraceOnFacets(*grid->Space, facets).Status; };
  EXPECT_EQ(code({}).Code, ErrorCode::EmptyInput);
  EXPECT_EQ(code({ { 12, 0 } }).Code, ErrorCode::InvalidParameter);
  EXPECT_EQ(code({ { 0, 4 } }).Code, ErrorCode::InvalidParameter);
  const Status smooth = code({ { 0, 1 } });
  EXPECT_EQ(smooth.Code, ErrorCode::InvalidParameter);
  EXPECT_NE(smooth.Detail.find("side 1 of cell 0 smoothly: mark"), std::string::npos);
  const Status end = code({ { 0, 2 }, { 1, 2 } }); // half of a side
  EXPECT_EQ(end.Code, ErrorCode::NotInSpace);
  EXPECT_NE(end.Detail.find("side 2 of cell"), std::string::npos);
  EXPECT_EQ(code({ { 0, 2 }, { 1, 2 }, { 2, 2 }, { 3, 2 } }).Code, ErrorCode::Ok);
  // three faces at an edge
  params.Features = { { 0, 1 }, { 0, 3 } };
  const auto boxes = MakeUnstructuredSpace<3>(Grid<3>({ 2, 2, 1 }), params);
  const std::vector<CellSide> three{ { 0, 1 }, { 0, 3 }, { 1, 3 } };
  const Status cross = TraceOnFacets(*boxes->Space, three).Status;
  EXPECT_EQ(cross.Code, ErrorCode::InvalidTopology) << cross.Message();
  const auto tensor =
    MakeTensorSpace<2>({ KnotVector::Uniform(2, 2), KnotVector::Uniform(2, 2) }).Value;
  EXPECT_EQ(TraceOnFacets(*tensor, { { 0, 0 } }).Status.Code, ErrorCode::DimensionMismatch);
}
