// SPDX-License-Identifier: BSD-3-Clause
#include "SmoothnessOracle.h"
#include <knotwork/SplineCore/Refinement.h>
#include <knotwork/SplineCore/SpaceFamily.h>
#include <knotwork/SplineCore/TensorForm.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <gtest/gtest.h>

#include <set>

using namespace knotwork;
using namespace meshes;
using oracle::RandomMap;
using oracle::RandomSpline;

namespace
{
template <int Dim>
UnstructuredResult<Dim> Make(const CellMesh<Dim>& mesh, int degree, CreasePolicy policy)
{
  UnstructuredParams params;
  params.Degree = degree;
  params.Policy = policy;
  auto made = MakeUnstructuredSpace<Dim>(mesh, params);
  EXPECT_TRUE(made) << made.Status.Message();
  return std::move(made.Value);
}

template <int Dim>
int NumFunctions(const CellMesh<Dim>& mesh, int degree, CreasePolicy policy)
{
  const auto made = Make<Dim>(mesh, degree, policy);
  return made.Space ? made.Space->NumFunctions : -1;
}
}

TEST(UnstructuredSpace, FunctionsAreABasisOfAllSmoothSplines_ExactOracle)
{
  for (unsigned seed = 1; seed <= 400; ++seed)
  {
    oracle::ExpectRandomSpace<2>(seed, 3, 60);
    oracle::ExpectRandomSpace<2>(1000 + seed, 5, 40);
  }
  for (unsigned seed = 1; seed <= 100; ++seed)
  {
    oracle::ExpectRandomSpace<3>(seed, 3, 20);
  }
}

TEST(UnstructuredSpace, CountsOfFunctions_PublishedOracle)
{
  for (int p = 1; p <= 4; ++p)
  {
    for (int n = 1; n <= 4; ++n)
    {
      SCOPED_TRACE("p " + std::to_string(p) + ", n " + std::to_string(n));
      const int k = n + p - 2;
      const CreasePolicy full = CreasePolicy::Full;
      EXPECT_EQ(NumFunctions<2>(CubeSphere(n), p, full), 6 * (k + 1) * (k + 1) + 2);
      EXPECT_EQ(NumFunctions<2>(Blocks<2>(n, n), p, full), 5 * k * k + 12 * k + 8);
      EXPECT_EQ(
        NumFunctions<3>(Blocks<3>(n, n), p, full), 7 * k * k * k + 24 * k * k + 32 * k + 16);
      for (const int v : { 3, 5, 7 })
      {
        EXPECT_EQ(NumFunctions<2>(Star(v, n), p, full), 1 + v * (k + 1) * (k + 2));
        EXPECT_EQ(
          NumFunctions<3>(Sweep(Star(v, n), 2), p, full), (1 + v * (k + 1) * (k + 2)) * (2 + p));
        if (n >= p)
        {
          EXPECT_EQ(NumFunctions<2>(Star(v, n), p, CreasePolicy::Minimal),
            1 + v * (p * (p - 1) / 2 + n * p + n * n));
        }
      }
    }
  }
  for (int n = 3; n <= 6; ++n)
  {
    EXPECT_EQ(NumFunctions<2>(CubeSphere(n), 2, CreasePolicy::Minimal), 6 * n * n + 8);
  }
  for (int n = 5; n <= 7; ++n)
  {
    EXPECT_EQ(NumFunctions<2>(CubeSphere(n), 3, CreasePolicy::Minimal), 6 * n * n + 26);
  }
}

namespace
{
/// The tensor-product space of the same grid, knots 0, 1, 2, ...: the same numbers to the last bit.
template <int Dim>
void ExpectTensorProduct(const std::array<int, Dim>& n, int p, Random& random)
{
  std::array<KnotVector, Dim> knots;
  for (int d = 0; d < Dim; ++d)
  {
    knots[d] = KnotVector::Uniform(p, n[d], 0.0, n[d]);
  }
  const auto tensor = MakeTensorSpace<Dim>(knots).Value;
  const auto made = Make<Dim>(Grid<Dim>(n), p, CreasePolicy::Automatic);
  ASSERT_EQ(made.Space->NumFunctions, tensor->NumFunctions);
  EXPECT_EQ(made.CreasedFacets, 0);
  EXPECT_EQ(made.Policy, CreasePolicy::Full);
  ASSERT_TRUE(made.Space->IsIdentityMap());
  std::vector<int> same(static_cast<std::size_t>(tensor->NumFunctions), -1);
  for (std::size_t i = 0; i < tensor->LocalFunctionIds.size(); ++i)
  {
    int& function = same[static_cast<std::size_t>(made.Space->LocalFunctionIds[i])];
    ASSERT_TRUE(function < 0 || function == tensor->LocalFunctionIds[i]);
    function = tensor->LocalFunctionIds[i];
  }
  Spline<Dim> spline = RandomMap<Dim>(random, made.Space, true);
  Spline<Dim> other = spline;
  other.Space = tensor;
  for (std::size_t f = 0; f < same.size(); ++f)
  {
    other.ControlPoints.row(same[f]) = spline.ControlPoints.row(static_cast<Eigen::Index>(f));
    other.Weights[same[f]] = spline.Weights[static_cast<Eigen::Index>(f)];
  }
  EXPECT_EQ(MakeBezierForm(spline, 1).Data, MakeBezierForm(other, 1).Data);
}

/// Values of two splines at the same places of cells; `children` of the second are a cell of the
/// first.
template <int Dim>
void ExpectSameMap(Random& random, const Spline<Dim>& coarse, const Spline<Dim>& fine, bool halved)
{
  const int count = 50;
  PointMatrix local(count, Dim);
  PointMatrix fineLocal(count, Dim);
  std::vector<int> elements;
  std::vector<int> fineElements;
  for (int i = 0; i < count; ++i)
  {
    elements.push_back(random.Int(0, coarse.Space->NumElements() - 1));
    int child = 0;
    for (int d = 0; d < Dim; ++d)
    {
      local(i, d) = random.Unit();
      const bool upper = halved && local(i, d) >= 0.5;
      child |= upper ? 1 << d : 0;
      fineLocal(i, d) = halved ? 2.0 * local(i, d) - (upper ? 1.0 : 0.0) : local(i, d);
    }
    fineElements.push_back(halved ? elements.back() * (1 << Dim) + child : elements.back());
  }
  EvaluationBatch a;
  EvaluationBatch b;
  ASSERT_TRUE(EvaluateElements<Dim>(MakeBezierForm(coarse, 1), elements, local, {}, a));
  ASSERT_TRUE(EvaluateElements<Dim>(MakeBezierForm(fine, 1), fineElements, fineLocal, {}, b));
  // coefficients below 2, averaged some dozen times
  EXPECT_LE((a.Values - b.Values).cwiseAbs().maxCoeff(), 1e-13);
}

template <int Dim>
void ExpectRefinement(unsigned seed, int mostDegree, int mostCells)
{
  SCOPED_TRACE("seed " + std::to_string(seed));
  Random random(seed);
  std::vector<int> lengths;
  const Spline<Dim> spline = RandomSpline<Dim>(random, mostDegree, mostCells, lengths);
  const auto refined = RefineAllElements(spline);
  ASSERT_TRUE(refined) << refined.Status.Message();
  const SplineSpace<Dim>& fine = *refined->Value.Space;
  ASSERT_EQ(fine.NumElements(), spline.Space->NumElements() << Dim);
  ExpectSameMap<Dim>(random, spline, refined->Value, true);
  const std::vector<int> continuity = ContinuityOf(*spline.Space);
  const std::vector<int> fineContinuity = ContinuityOf(fine);
  std::vector<int> fineLengths; // all halved: the conditions know their ratios only
  for (int e = 0; e < fine.NumElements(); ++e)
  {
    const int parent = refined->Parents[static_cast<std::size_t>(e)];
    ASSERT_EQ(parent, e >> Dim);
    for (int side = 0; side < 2 * Dim; ++side)
    {
      const bool isOld = (e >> (side / 2) & 1) == side % 2;
      EXPECT_EQ(fineContinuity[static_cast<std::size_t>(e * 2 * Dim + side)],
        isOld ? continuity[static_cast<std::size_t>(parent * 2 * Dim + side)]
              : fine.Elements[0].Degree[0] - 1);
    }
    for (int d = 0; d < Dim; ++d)
    {
      fineLengths.push_back(lengths[static_cast<std::size_t>(parent * Dim + d)]);
    }
  }
  oracle::ExpectBasis<Dim>(fine, fineLengths, random);
}

template <int Dim>
void ExpectElevation(unsigned seed, int mostDegree, int mostCells)
{
  SCOPED_TRACE("seed " + std::to_string(seed));
  Random random(seed);
  std::vector<int> lengths;
  const Spline<Dim> spline = RandomSpline<Dim>(random, mostDegree, mostCells, lengths);
  const auto raised = ElevateAllDegrees(spline, 1);
  ASSERT_TRUE(raised) << raised.Status.Message();
  EXPECT_EQ(ContinuityOf(*raised->Space), ContinuityOf(*spline.Space));
  ExpectSameMap<Dim>(random, spline, raised.Value, false);
  oracle::ExpectBasis<Dim>(*raised->Space, lengths, random);
}

/// What is stored makes the same space, and Bernstein points that are one have one value.
template <int Dim>
void ExpectStoredAndNumbered(unsigned seed)
{
  SCOPED_TRACE("seed " + std::to_string(seed));
  Random random(seed);
  std::vector<int> lengths;
  const Spline<Dim> spline = RandomSpline<Dim>(random, 4, 30, lengths);
  const SplineSpace<Dim>& space = *spline.Space;
  const SpaceFamily<Dim>& family = FamilyOf(space);
  const SpaceDefinition definition = family.Describe(space);
  EXPECT_EQ(family.NumRows(definition, space.NumFunctions, 1), definition.Tables[1].Whole.size());
  const auto built = FamilyOf<Dim>(definition.Kind).Build(definition, 1);
  ASSERT_TRUE(built) << built.Status.Message();
  EXPECT_TRUE(family.Describe(*built.Value) == definition);
  EXPECT_EQ(built.Value->LocalFunctionIds, space.LocalFunctionIds);
  EXPECT_EQ(built.Value->FactorData, space.FactorData);
  EXPECT_TRUE(built.Value->RowCoefficient == space.RowCoefficient);

  const ElementPoints points = family.NumberPoints(space);
  const auto form = MakeBezierForm(spline, 1);
  const auto n = static_cast<std::size_t>(NumTensorFunctions<Dim>(space.Elements[0].Degree));
  std::vector<double> values(static_cast<std::size_t>(points.Count), 1e300);
  for (int e = 0; e < space.NumElements(); ++e)
  {
    std::set<std::int64_t> own;
    for (std::size_t i = 0; i < n; ++i)
    {
      const std::int64_t id = points.Ids[static_cast<std::size_t>(e) * n + i];
      EXPECT_TRUE(own.insert(id).second);
      double& value = values[static_cast<std::size_t>(id)];
      value = value == 1e300 ? form.Block(e)[i] : value;
      EXPECT_NEAR(value, form.Block(e)[i], 1e-13);
    }
  }
  EXPECT_EQ(std::count(values.begin(), values.end(), 1e300), 0);
  // points, inner points of edges, of faces and of cells
  std::set<std::vector<int>> edges;
  std::set<std::vector<int>> faces;
  const CellMesh<Dim>& mesh = MeshOf(space);
  for (int c = 0; c < mesh.NumCells(); ++c)
  {
    for (int low = 0; low < (1 << Dim); ++low)
    {
      for (int free = 1; free < (1 << Dim); ++free)
      {
        std::vector<int> key;
        for (int corner = 0; (low & free) == 0 && corner < (1 << Dim); ++corner)
        {
          if ((corner & ~free) == low)
          {
            key.push_back(mesh.Cell(c)[corner]);
          }
        }
        std::sort(key.begin(), key.end());
        if (key.size() == 2)
        {
          edges.insert(key);
        }
        else if (key.size() == 4)
        {
          faces.insert(key);
        }
      }
    }
  }
  const std::int64_t inside = space.Elements[0].Degree[0] - 1;
  const std::int64_t cells = Dim == 3 ? inside * inside * inside * mesh.NumCells() : 0;
  EXPECT_EQ(points.Count,
    mesh.NumPoints + inside * static_cast<std::int64_t>(edges.size()) +
      inside * inside * static_cast<std::int64_t>(faces.size()) + cells);
}

template <int Dim>
void ExpectCode(const CellMesh<Dim>& mesh, const UnstructuredParams& params, ErrorCode code,
  const std::string& words)
{
  const auto made = MakeUnstructuredSpace<Dim>(mesh, params);
  EXPECT_EQ(made.Status.Code, code);
  EXPECT_NE(made.Status.Detail.find(words), std::string::npos) << made.Status.Message();
}
}

TEST(UnstructuredSpace, IsTheTensorProductOnGrids_CrossOracle)
{
  Random random(1);
  for (int p = 1; p <= 5; ++p)
  {
    SCOPED_TRACE("p " + std::to_string(p));
    ExpectTensorProduct<2>({ 7, 4 }, p, random);
    ExpectTensorProduct<2>({ 1, 2 }, p, random);
    ExpectTensorProduct<3>({ 3, 2, 4 }, p, random);
  }
}

TEST(UnstructuredSpace, RefinementKeepsTheMapAndNestsSpaces_ExactOracle)
{
  for (unsigned seed = 1; seed <= 100; ++seed)
  {
    ExpectRefinement<2>(seed, 4, 30);
  }
  for (unsigned seed = 1; seed <= 15; ++seed)
  {
    ExpectRefinement<3>(seed, 2, 12);
  }
}

TEST(UnstructuredSpace, ElevationKeepsTheMapAndContinuity_ExactOracle)
{
  for (unsigned seed = 1; seed <= 100; ++seed)
  {
    ExpectElevation<2>(seed, 4, 30);
  }
  for (unsigned seed = 1; seed <= 20; ++seed)
  {
    ExpectElevation<3>(seed, 2, 12);
  }
}

TEST(UnstructuredSpace, IsStoredAndNumbered_ExactOracle)
{
  for (unsigned seed = 1; seed <= 40; ++seed)
  {
    ExpectStoredAndNumbered<2>(seed);
    ExpectStoredAndNumbered<3>(seed);
  }
}

TEST(UnstructuredSpace, PeriodicStripsAndLargeValence_ExactOracle)
{
  Random random(3);
  for (int p = 1; p <= 4; ++p)
  {
    for (const CellMesh<2>& mesh :
      { Grid<2>({ 3, 4 }, { true, false }), Grid<2>({ 3, 3 }, { true, true }),
        Grid<2>({ 7, 5 }, { true, true }), Twisted(3, 1, false), Twisted(4, 3, true), Star(64, 2) })
    {
      SCOPED_TRACE("p " + std::to_string(p) + ", " + std::to_string(mesh.NumCells()) + " cells");
      const auto made = Make<2>(mesh, p, CreasePolicy::Full);
      ASSERT_TRUE(made.Space);
      const std::vector<int> lengths(static_cast<std::size_t>(mesh.NumCells()) * 2, 1);
      oracle::ExpectBasis<2>(*made.Space, lengths, random);
    }
  }
  // strips of three cells hold splines of degree 2, those of higher degree get a crease
  EXPECT_EQ(Make<2>(Grid<2>({ 3, 3 }, { true, true }), 2, CreasePolicy::Full).Repairs, 0);
  EXPECT_EQ(Make<2>(Grid<2>({ 3, 3 }, { true, true }), 3, CreasePolicy::Full).Repairs, 6);
  EXPECT_EQ(Make<2>(Grid<2>({ 3, 5 }, { true, true }), 3, CreasePolicy::Full).Repairs, 5);
}

namespace
{
/// Random continuities, the same along lines of facets or not: what is accepted is a basis.
template <int Dim>
void TryContinuities(unsigned seed, int mostDegree, int mostCells, std::map<std::string, int>& said)
{
  SCOPED_TRACE("seed " + std::to_string(seed));
  Random random(seed);
  const CellMesh<Dim> mesh = RandomMesh<Dim>(random, mostCells);
  const auto topology = MeshTopology<Dim>::Make(mesh);
  UnstructuredParams params;
  params.Degree = random.Int(2, mostDegree);
  const std::vector<int> lengths =
    oracle::RandomLengths(random, mesh, random.Unit() < 0.5 ? 1 : 3, params.Lengths);
  const auto start = MakeUnstructuredSpace<Dim>(mesh, params);
  ASSERT_TRUE(start) << start.Status.Message();
  std::vector<int> continuity = ContinuityOf(*start->Space);
  for (int changes = random.Int(1, 8); changes > 0; --changes)
  {
    const int c = random.Int(0, mesh.NumCells() - 1);
    const int side = random.Int(0, 2 * Dim - 1);
    if (!topology->IsBoundary(c, side))
    {
      const int r = random.Int(0, params.Degree - 1);
      continuity[static_cast<std::size_t>(c * 2 * Dim + side)] = r;
      continuity[static_cast<std::size_t>(
        topology->Neighbour(c, side) * 2 * Dim + topology->Crossing(c, side).Side)] = r;
    }
  }
  const auto made = MakeUnstructuredSpace<Dim>(mesh, params.Degree, continuity, params.Lengths);
  if (made)
  {
    ++said["accepted"];
    oracle::ExpectBasis<Dim>(*made.Value, lengths, random);
    return;
  }
  ASSERT_EQ(made.Status.Code, ErrorCode::NotInSpace);
  for (const char* words : { "averages", "circle", "more conditions", "not independent" })
  {
    said[words] += made.Status.Detail.find(words) != std::string::npos ? 1 : 0;
  }
}
}

TEST(UnstructuredSpace, WhatIsAcceptedIsABasis_ExactOracle)
{
  std::map<std::string, int> said;
  for (unsigned seed = 1; seed <= 600; ++seed)
  {
    TryContinuities<2>(seed, 5, 50, said);
  }
  for (unsigned seed = 1; seed <= 150; ++seed)
  {
    TryContinuities<3>(seed, 3, 16, said);
  }
  for (const char* words :
    { "accepted", "averages", "circle", "more conditions", "not independent" })
  {
    EXPECT_GE(said[words], 1) << words;
  }
}

TEST(UnstructuredSpace, LargeMeshesInAnyOrder_ExactOracle)
{
  Random random(2);
  const int n = 80;
  const CellMesh<2> mesh = Shuffled(random, CubeSphere(n)); // more cells than a cache holds
  EXPECT_FALSE(MeshTopology<2>::Make(mesh)->LocalOrder().empty());
  EXPECT_TRUE(MeshTopology<2>::Make(CubeSphere(n))->LocalOrder().empty());
  const std::vector<int> lengths(static_cast<std::size_t>(mesh.NumCells()) * 2, 1);
  const auto made = Make<2>(mesh, 2, CreasePolicy::Minimal);
  ASSERT_TRUE(made.Space);
  EXPECT_EQ(made.Space->NumFunctions, 6 * n * n + 8);
  const oracle::SmoothnessConditions<2> conditions(mesh, 2, ContinuityOf(*made.Space), lengths);
  oracle::ExpectFunctions<2>(*made.Space, conditions, random);
  // what is inadmissible is named by the numbers of the given mesh
  const auto refused = MakeUnstructuredSpace<2>(
    mesh, 2, std::vector<int>(static_cast<std::size_t>(mesh.NumCells()) * 4, 1));
  ASSERT_EQ(refused.Status.Code, ErrorCode::NotInSpace);
  const std::string words = refused.Status.Detail;
  const auto topology = MeshTopology<2>::Make(mesh);
  const int cell = std::stoi(words.substr(words.find("cell ") + 5));
  bool isNear = false; // an extraordinary point is on it or on a neighbour
  for (int side = 0; side < 4; ++side)
  {
    for (int corner = 0; corner < 4; ++corner)
    {
      isNear = isNear || topology.Value.IsExtraordinary(cell, corner) ||
        topology.Value.IsExtraordinary(topology.Value.Neighbour(cell, side), corner);
    }
  }
  EXPECT_TRUE(isNear) << words;
}

TEST(UnstructuredSpace, PolicyFollowsThePartThatFullCreases_ExactOracle)
{
  // 3 spokes of n edges among 3 n (n + 1) + 3 n (n - 1) edges that are not on the boundary
  EXPECT_EQ(Make<2>(Star(3, 1), 2, CreasePolicy::Automatic).Policy, CreasePolicy::Motorcycle);
  EXPECT_EQ(Make<2>(Star(3, 3), 2, CreasePolicy::Automatic).Policy, CreasePolicy::Full);
  EXPECT_EQ(Make<3>(Blocks<3>(1, 1), 2, CreasePolicy::Automatic).Policy, CreasePolicy::Minimal);
  const auto star = Make<2>(Star(3, 3), 3, CreasePolicy::Full);
  EXPECT_EQ(star.CreasedFacets, 9);
  EXPECT_EQ(star.ExtraordinaryRidges, 1);
  EXPECT_TRUE(star.IsOrientable);
  EXPECT_FALSE(Make<2>(Twisted(5, 3, true), 2, CreasePolicy::Full).IsOrientable);
  EXPECT_EQ(Make<2>(Star(3, 3), 3, CreasePolicy::Minimal).CreasedFacets, 6); // C^0, C^1, C^2
}

TEST(UnstructuredSpace, EveryFailureIsReachable_ExactOracle)
{
  const CellMesh<2> grid = Grid<2>({ 3, 2 });
  UnstructuredParams params;
  ExpectCode<2>({}, params, ErrorCode::EmptyInput, "no cells");
  params.Degree = 0;
  ExpectCode<2>(grid, params, ErrorCode::InvalidDegree, "degree 0");
  params.Degree = 10;
  ExpectCode<2>(grid, params, ErrorCode::InvalidDegree, "degree 10");
  params.Degree = 2;
  params.Features = { { 0, 0 } };
  ExpectCode<2>(grid, params, ErrorCode::InvalidParameter, "side 0 of cell 0 is no inner facet");
  params.Features = { { 6, 0 } };
  ExpectCode<2>(grid, params, ErrorCode::InvalidParameter, "side 0 of cell 6");
  params.Features.clear();
  params.Lengths = { 1.0, 1.0 };
  ExpectCode<2>(grid, params, ErrorCode::SizeMismatch, "2 lengths for 5 sheets");
  params.Lengths = { 1.0, 1.0, 0.0, 1.0, 1.0 };
  ExpectCode<2>(grid, params, ErrorCode::InvalidParameter, "sheet 2");
  params.Lengths.clear();
  params.Policy = CreasePolicy::Motorcycle;
  ExpectCode<3>(Grid<3>({ 1, 1, 1 }), params, ErrorCode::InvalidParameter, "quadrilaterals");

  const auto code = [&](int degree, std::vector<int> continuity)
  { return MakeUnstructuredSpace<2>(grid, degree, continuity).Status.Code; };
  std::vector<int> smooth(24, 1);
  EXPECT_EQ(code(2, smooth), ErrorCode::Ok);
  EXPECT_EQ(code(1, smooth), ErrorCode::InvalidParameter);
  EXPECT_EQ(code(2, { 1, 1 }), ErrorCode::SizeMismatch);
  smooth[1] = 0;
  EXPECT_EQ(code(2, smooth), ErrorCode::InvalidParameter);
  // C^1 everywhere around a point of three cells
  const auto star = MakeUnstructuredSpace<2>(Star(3, 2), 2, std::vector<int>(48, 1));
  EXPECT_EQ(star.Status.Code, ErrorCode::NotInSpace);
  EXPECT_FALSE(star.Status.Detail.empty());

  Spline<2> spline;
  spline.Space = MakeUnstructuredSpace<2>(grid, 2, std::vector<int>(24, 1)).Value;
  spline.ControlPoints = PointMatrix::Ones(spline.Space->NumFunctions, 1);
  EXPECT_EQ(RefineMarkedElements(spline, { 6 }).Status.Code, ErrorCode::InvalidParameter);
  EXPECT_EQ(ToTensor(spline, 1).Status.Code, ErrorCode::DimensionMismatch);
  const SpaceFamily<2>& family = FamilyOf(*spline.Space);
  SpaceDefinition definition = family.Describe(*spline.Space);
  definition.Tables[0].Whole[0] = -1;
  EXPECT_EQ(family.Build(definition, 1).Status.Code, ErrorCode::InvalidTopology);
  definition.Tables[0].Whole[0] = 1000000000;
  EXPECT_EQ(family.Build(definition, 1).Status.Code, ErrorCode::InvalidTopology);
  definition = family.Describe(*spline.Space);
  definition.Degree[1] = 3;
  EXPECT_EQ(family.Build(definition, 1).Status.Code, ErrorCode::InvalidTopology);
  EXPECT_EQ(FamilyOf<1>(SpaceKind::Unstructured).Build(definition, 1).Status.Code,
    ErrorCode::InvalidTopology);
}

TEST(UnstructuredSpace, MeshesOfFiles_ExactOracle)
{
  if (ReadMesh<2>("bl_rod_764.off").Corners.empty())
  {
    GTEST_SKIP() << "KNOTWORK_UNSTRUCTURED_MESHES names no folder of meshes";
  }
  Random random(1);
  for (const char* name : { "bl_rod_764.off", "gs_bitorus.off", "gs_polycube.off" })
  {
    const auto mesh = ReadMesh<2>(name);
    for (int p = 2; p <= 3; ++p)
    {
      for (const auto policy :
        { CreasePolicy::Automatic, CreasePolicy::Full, CreasePolicy::Minimal })
      {
        SCOPED_TRACE(std::string(name) + ", p " + std::to_string(p));
        const auto made = Make<2>(mesh, p, policy);
        ASSERT_TRUE(made.Space);
        const std::vector<int> lengths(static_cast<std::size_t>(mesh.NumCells()) * 2, 1);
        oracle::ExpectBasis<2>(*made.Space, lengths, random);
      }
    }
  }
  const auto rod = Make<2>(ReadMesh<2>("bl_rod_764.off"), 2, CreasePolicy::Automatic);
  EXPECT_EQ(rod.Policy, CreasePolicy::Motorcycle);
  EXPECT_LE(rod.Space->NumFunctions, 1400);
  EXPECT_EQ(NumFunctions<2>(ReadMesh<2>("bl_rod_764.off"), 2, CreasePolicy::Full), 2958);
  const auto hexes = ReadMesh<3>("cmu_hepta.vtk");
  const auto made = Make<3>(hexes, 2, CreasePolicy::Minimal);
  ASSERT_TRUE(made.Space);
  const std::vector<int> lengths(static_cast<std::size_t>(hexes.NumCells()) * 3, 1);
  oracle::ExpectBasis<3>(*made.Space, lengths, random);
}
