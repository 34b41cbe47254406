// SPDX-License-Identifier: BSD-3-Clause
// Fits that start from a surface: what must not change does not, what is held is held.
#include "CloudFits.h"
#include <knotwork/SplineCore/HierarchicalSpace.h>
#include <knotwork/SplineCore/LRSpace.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <limits>
#include <map>

namespace knotwork
{
namespace
{
constexpr double Corner = 0.2; // new points lie in [0, Corner]^2

/// New points in a corner, over a bump that the start does not have.
PointCloud CornerCloud(std::size_t n, std::uint64_t seed, double height)
{
  clouds::Random random(seed);
  PointCloud cloud;
  cloud.Parameters.resize(static_cast<Eigen::Index>(n), 2);
  cloud.Values.resize(static_cast<Eigen::Index>(n), 1);
  for (Eigen::Index i = 0; i < cloud.Parameters.rows(); ++i)
  {
    const double x = Corner * random.Uniform();
    const double y = Corner * random.Uniform();
    const double bump = std::exp(-800.0 * ((x - 0.1) * (x - 0.1) + (y - 0.08) * (y - 0.08)));
    cloud.Parameters.row(i) << x, y;
    cloud.Values(i, 0) = clouds::Peaks(x, y) + height * bump;
  }
  return cloud;
}

FitStart StartOf(const SurfaceFit& fit)
{
  return { fit.Surface, fit.DomainPoints, {} };
}

/// A start of each kind, fitted to the peaks; the tensor-product one has uniform knots.
std::map<SpaceKind, FitStart> MakeStarts()
{
  const PointCloud cloud = clouds::HeightField(20000, 51, clouds::Peaks);
  std::map<SpaceKind, FitStart> starts;
  FitParams params = WithTolerance(0.005);
  params.Domain = { { 0.0, 0.0 }, { 1.0, 1.0 } };
  starts[SpaceKind::LocallyRefined] = StartOf(Fit(cloud, params));
  params.Space = FitSpace::Hierarchical;
  starts[SpaceKind::Hierarchical] = StartOf(Fit(cloud, params));
  params.NumInitialElements = { 20, 17 };
  params.MaxIterations = 0;
  starts[SpaceKind::Tensor] = StartOf(Fit(cloud, params));
  return starts;
}

PointMatrix Evaluate(const Spline<2>& surface, const PointMatrix& at, int derivatives = 0)
{
  EvaluationBatch batch;
  EvaluationParams params;
  params.Derivatives = derivatives;
  EXPECT_TRUE(EvaluateParameters<2>(MakeBezierForm<2>(surface), at, params, batch));
  return derivatives == 0 ? batch.Values : batch.First;
}

/// Places in all elements on which no function is alive that has a point in its support.
PointMatrix PlacesApart(const SplineSpace<2>& space, const PointCloud& cloud)
{
  std::vector<bool> hasPoint(static_cast<std::size_t>(space.NumFunctions), false);
  std::vector<bool> isSeen(static_cast<std::size_t>(space.NumElements()), false);
  for (Eigen::Index i = 0; i < cloud.Parameters.rows(); ++i)
  {
    double local[2];
    const auto e = static_cast<std::size_t>(space.Locate(cloud.Parameters.data() + 2 * i, local));
    if (!isSeen[e])
    {
      isSeen[e] = true;
      for (const int f : space.AliveFunctions(static_cast<int>(e)))
      {
        hasPoint[static_cast<std::size_t>(f)] = true;
      }
    }
  }
  std::vector<double> places;
  for (int e = 0; e < space.NumElements(); ++e)
  {
    const std::vector<int> alive = space.AliveFunctions(e);
    if (std::none_of(
          alive.begin(), alive.end(), [&](int f) { return hasPoint[static_cast<std::size_t>(f)]; }))
    {
      const ParametricBox<2>& box = space.Elements[static_cast<std::size_t>(e)].Box;
      for (const double share : { 0.1, 0.5, 0.8 })
      {
        places.push_back(box.Lower[0] + share * (box.Upper[0] - box.Lower[0]));
        places.push_back(box.Lower[1] + (1.0 - share) * (box.Upper[1] - box.Lower[1]));
      }
    }
  }
  return Eigen::Map<PointMatrix>(places.data(), static_cast<Eigen::Index>(places.size() / 2), 2);
}

/// Values on a grid of a box, borders included.
PointMatrix Sample(
  const Spline<2>& surface, const ParametricBox<2>& box, int n, int derivatives = 0)
{
  PointMatrix at(n * n, 2);
  for (int i = 0; i < n * n; ++i)
  {
    at(i, 0) = box.Lower[0] + (box.Upper[0] - box.Lower[0]) * (i % n) / (n - 1.0);
    at(i, 1) = box.Lower[1] + (box.Upper[1] - box.Lower[1]) * (i / n) / (n - 1.0);
  }
  return Evaluate(surface, at, derivatives);
}

/// Functions of an LR space by what defines them.
std::map<std::vector<double>, double> ByKnots(const Spline<2>& surface)
{
  const LRBasis& basis = surface.Space->LocallyRefined->Basis;
  std::map<std::vector<double>, double> functions;
  for (int f = 0; f < basis.NumFunctions(); ++f)
  {
    std::vector<double> key{ basis.Scaling[static_cast<std::size_t>(f)] };
    for (int d = 0; d < 2; ++d)
    {
      for (int k = 0; k < basis.Degree[static_cast<std::size_t>(d)] + 2; ++k)
      {
        key.push_back(
          basis.Knots[static_cast<std::size_t>(d)][static_cast<std::size_t>(basis.Local(f, d)[k])]);
      }
    }
    functions[key] = surface.ControlPoints(f, 0);
  }
  return functions;
}
}

TEST(FitUpdates, NothingChangesAwayFromTheNewPoints_ExactOracle)
{
  for (const auto& [kind, start] : MakeStarts())
  {
    ASSERT_EQ(start.Surface.Space->Kind, kind);
    for (const FitSpace space : { FitSpace::LocallyRefined, FitSpace::Hierarchical })
    {
      for (const FitMethod method : { FitMethod::LeastSquares, FitMethod::Combined })
      {
        const PointCloud cloud = CornerCloud(3000, 52, 0.2);
        FitParams params = WithTolerance(0.005);
        params.Start = start;
        params.Space = space;
        params.Method = method;
        params.SwitchIteration = 2;
        const SurfaceFit fit = Fit(cloud, params);
        ExpectWithin(cloud, fit);
        EXPECT_GT(fit.Surface.Space->NumFunctions, start.Surface.Space->NumFunctions);
        EXPECT_EQ(fit.Surface.Space->Kind,
          kind != SpaceKind::Tensor             ? kind
            : space == FitSpace::LocallyRefined ? SpaceKind::LocallyRefined
                                                : SpaceKind::Hierarchical);
        // evaluation in split elements rounds anew: some units of the last place
        const PointMatrix apart = PlacesApart(*fit.Surface.Space, cloud);
        EXPECT_GT(apart.rows(), 300);
        EXPECT_LE(
          (Evaluate(fit.Surface, apart) - Evaluate(start.Surface, apart)).cwiseAbs().maxCoeff(),
          1e-15);
        EXPECT_GT((Sample(fit.Surface, { { 0.0, 0.0 }, { Corner, Corner } }, 40) -
                    Sample(start.Surface, { { 0.0, 0.0 }, { Corner, Corner } }, 40))
                    .cwiseAbs()
                    .maxCoeff(),
          0.1);
      }
    }
  }
}

TEST(FitUpdates, CoefficientsOfFunctionsWithoutPointsKeepTheirBits_ExactOracle)
{
  const FitStart start = MakeStarts()[SpaceKind::LocallyRefined];
  FitParams params = WithTolerance(0.005);
  params.Start = start;
  const PointCloud cloud = CornerCloud(3000, 53, 0.2);
  const SurfaceFit fit = Fit(cloud, params);
  const auto before = ByKnots(start.Surface);
  int kept = 0;
  for (const auto& [key, coefficient] : ByKnots(fit.Surface))
  {
    // knots of the first direction are key[1 ... 4], of the second key[5 ... 8]
    bool isEmpty = true;
    for (Eigen::Index i = 0; i < cloud.Parameters.rows() && isEmpty; ++i)
    {
      isEmpty = cloud.Parameters(i, 0) < key[1] || cloud.Parameters(i, 0) > key[4] ||
        cloud.Parameters(i, 1) < key[5] || cloud.Parameters(i, 1) > key[8];
    }
    const auto found = before.find(key);
    if (isEmpty && found != before.end())
    {
      EXPECT_EQ(coefficient, found->second);
      ++kept;
    }
  }
  EXPECT_GT(kept, start.Surface.Space->NumFunctions / 2);
}

TEST(FitUpdates, AStartThatMeetsAllPointsIsTheResult_ExactOracle)
{
  const PointCloud cloud = CornerCloud(500, 54, 0.0);
  for (const auto& [kind, start] : MakeStarts())
  {
    if (kind == SpaceKind::Tensor)
    {
      continue; // it does not meet the peaks within the tolerance
    }
    FitParams params = WithTolerance(0.01);
    params.Start = start;
    const SurfaceFit fit = Fit(cloud, params);
    ExpectWithin(cloud, fit);
    EXPECT_EQ(fit.Surface.ControlPoints, start.Surface.ControlPoints);
    EXPECT_EQ(fit.DomainPoints, start.DomainPoints);
    EXPECT_EQ(fit.Iterations.size(), 1U);
  }
}

TEST(FitUpdates, HeldEdgesStay_ExactOracle)
{
  for (const auto& [kind, start] : MakeStarts())
  {
    for (int side = 0; side < 5; ++side) // 4: all of them
    {
      for (const FitEdge edge : { FitEdge::Values, FitEdge::Derivatives })
      {
        FitParams params = WithTolerance(0.01);
        params.Start = start;
        for (int k = 0; k < 4; ++k)
        {
          params.Start->Edges[static_cast<std::size_t>(k)] =
            side == k || side == 4 ? edge : FitEdge::Free;
        }
        // everywhere 0.1 above what the start was fitted to, but not beside the edges
        PointCloud cloud = clouds::HeightField(4000, 55,
          [](double x, double y)
          {
            const double bubble = 256.0 * x * x * (1 - x) * (1 - x) * y * y * (1 - y) * (1 - y);
            return clouds::Peaks(x, y) + 0.1 * bubble;
          });
        const SurfaceFit fit = Fit(cloud, params);
        ExpectWithin(cloud, fit);
        for (int k = 0; k < 4; ++k)
        {
          ParametricBox<2> line{ { 0.0, 0.0 }, { 1.0, 1.0 } };
          const auto d = static_cast<std::size_t>(k / 2);
          line.Lower[d] = line.Upper[d] = k % 2;
          const double moved =
            (Sample(fit.Surface, line, 61) - Sample(start.Surface, line, 61)).cwiseAbs().maxCoeff();
          const double turned =
            (Sample(fit.Surface, line, 61, 1) - Sample(start.Surface, line, 61, 1))
              .cwiseAbs()
              .maxCoeff();
          const bool isHeld = side == k || side == 4;
          if (isHeld)
          {
            EXPECT_LE(moved, 1e-13) << "side " << k;
          }
          else
          {
            EXPECT_GT(moved, 1e-6) << "side " << k;
          }
          if (isHeld && edge == FitEdge::Derivatives)
          {
            EXPECT_LE(turned, 1e-11) << "side " << k; // differences over elements of some 1e-2
          }
          else
          {
            EXPECT_GT(turned, 1e-6) << "side " << k;
          }
        }
      }
    }
  }
}

TEST(FitUpdates, HeldEdgesStayWithEveryMethodAndNumberOfThreads_ExactOracle)
{
  const FitStart start = MakeStarts()[SpaceKind::LocallyRefined];
  PointCloud cloud = clouds::HeightField(20000, 60,
    [](double x, double y) { return clouds::Peaks(x, y) + 0.2 * x * (1.0 - x) * y * (1.0 - y); });
  for (const FitMethod method :
    { FitMethod::LeastSquares, FitMethod::MultilevelApproximation, FitMethod::Combined })
  {
    FitParams params = WithTolerance(0.01);
    params.Start = start;
    params.Start->Edges.fill(FitEdge::Values);
    params.Method = method;
    params.SwitchIteration = 1;
    params.Threads = 1;
    const SurfaceFit one = Fit(cloud, params);
    ExpectWithin(cloud, one);
    for (const ParametricBox<2>& line :
      { ParametricBox<2>{ { 0.0, 0.0 }, { 0.0, 1.0 } }, { { 1.0, 0.0 }, { 1.0, 1.0 } },
        { { 0.0, 0.0 }, { 1.0, 0.0 } }, { { 0.0, 1.0 }, { 1.0, 1.0 } } })
    {
      EXPECT_LE(
        (Sample(one.Surface, line, 61) - Sample(start.Surface, line, 61)).cwiseAbs().maxCoeff(),
        1e-13);
    }
    params.Threads = 3;
    EXPECT_EQ(Fit(cloud, params).Surface.ControlPoints, one.Surface.ControlPoints);
  }
}

TEST(FitUpdates, PointsOnHeldEdgesEndTheFit_PropertyOracle)
{
  PointCloud cloud = clouds::HeightField(2000, 56, clouds::Peaks);
  for (Eigen::Index i = 0; i < 100; ++i)
  {
    cloud.Parameters(i, 0) = 0.0;
    cloud.Values(i, 0) = 0.5;
  }
  for (const auto& [kind, start] : MakeStarts())
  {
    FitParams params = WithTolerance(0.02);
    params.Start = start;
    params.Start->Edges[0] = FitEdge::Values;
    const SurfaceFit fit = Fit(cloud, params);
    EXPECT_FALSE(fit.WithinTolerance);
    EXPECT_EQ(fit.End, FitEnd::HeldEdges);
    EXPECT_EQ(fit.Final.NumOutside, 100U);
    params.Start->Edges[0] = FitEdge::Free;
    params.MaxIterations = 3;
    EXPECT_NE(Fit(cloud, params).End, FitEnd::HeldEdges);
  }
}

TEST(FitUpdates, FurtherComponentsAreCarried_ExactOracle)
{
  FitStart start = MakeStarts()[SpaceKind::LocallyRefined];
  PointMatrix both(start.Surface.ControlPoints.rows(), 2);
  both << start.Surface.ControlPoints, 3.0 * start.DomainPoints.col(1);
  start.Surface.ControlPoints = both;
  FitParams params = WithTolerance(0.005);
  params.Start = start;
  const SurfaceFit fit = Fit(CornerCloud(3000, 57, 0.2), params);
  ASSERT_EQ(fit.Surface.ControlPoints.cols(), 2);
  EXPECT_LE(
    (fit.Surface.ControlPoints.col(1) - 3.0 * fit.DomainPoints.col(1)).cwiseAbs().maxCoeff(),
    1e-14);
}

TEST(FitUpdates, OneSidedUpdatesShiftOnlyWhereThePointsAre_PropertyOracle)
{
  const FitStart start = MakeStarts()[SpaceKind::LocallyRefined];
  const PointCloud cloud = CornerCloud(3000, 58, 0.2);
  FitParams params = WithTolerance(0.01);
  params.Start = start;
  params.Side = FitSide::Above;
  const SurfaceFit fit = Fit(cloud, params);
  ExpectWithin(cloud, fit);
  EXPECT_LE(*std::max_element(fit.Distances.begin(), fit.Distances.end()), 0.0);
  const ParametricBox<2> far{ { 0.6, 0.6 }, { 1.0, 1.0 } };
  EXPECT_LE((Sample(fit.Surface, far, 50) - Sample(start.Surface, far, 50)).cwiseAbs().maxCoeff(),
    1e-15); // rounding of split elements
}

TEST(FitUpdates, StartsThatCannotBeTakenAreErrors_PropertyOracle)
{
  const PointCloud cloud = CornerCloud(100, 59, 0.2);
  const FitStart good = MakeStarts()[SpaceKind::Tensor];
  const auto fail = [&](const FitStart& start, ErrorCode code, FitSide side = FitSide::Both)
  {
    FitParams params = WithTolerance(0.01);
    params.Start = start;
    params.Side = side;
    EXPECT_EQ(FitSurface(cloud, params).Status.Code, code);
  };
  FitStart start = good;
  start.Surface.Space = nullptr;
  fail(start, ErrorCode::DimensionMismatch);
  start = good;
  start.Surface.Weights = Eigen::VectorXd::Ones(start.Surface.Space->NumFunctions);
  fail(start, ErrorCode::InvalidWeight);
  start = good;
  start.DomainPoints.resize(0, 2);
  fail(start, ErrorCode::SizeMismatch);
  start = good;
  start.Surface.ControlPoints(3, 0) = std::numeric_limits<double>::quiet_NaN();
  fail(start, ErrorCode::NonFiniteInput);
  start = good;
  start.Edges[2] = FitEdge::Values;
  fail(start, ErrorCode::InvalidParameter, FitSide::Above);
  start = good;
  const auto open = KnotVector::Create(1, { 0.0, 0.5, 1.0, 1.5, 2.0 });
  ASSERT_TRUE(open);
  const auto space = MakeTensorSpace<2>({ open.Value, open.Value });
  ASSERT_TRUE(space);
  start.Surface.Space = space.Value;
  start.Surface.ControlPoints = PointMatrix::Zero(space.Value->NumFunctions, 1);
  start.DomainPoints = PointMatrix::Zero(space.Value->NumFunctions, 2);
  PointCloud inside = cloud;
  inside.Parameters.array() += 0.6;
  FitParams params = WithTolerance(0.01);
  params.Start = start;
  EXPECT_EQ(FitSurface(inside, params).Status.Code, ErrorCode::InvalidKnots);
  params.Start = good;
  inside.Parameters(7, 0) = 1.5;
  const Status outside = FitSurface(inside, params).Status;
  EXPECT_EQ(outside.Code, ErrorCode::OutsideDomain);
  EXPECT_NE(outside.Detail.find("point 7"), std::string::npos);
}
}
