// SPDX-License-Identifier: BSD-3-Clause
// Fits of several processes, here threads that exchange as processes do: what one process makes of
// all points is the oracle, bit for bit.
#include "CloudFits.h"
#include <knotwork/SurfaceFitting/FitProcesses.h>
#include <knotwork/SurfaceFitting/PointLayers.h>

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <stdexcept>
#include <thread>

namespace knotwork
{
namespace
{
/// Where all leave what they have, and take what the others have left when all have come.
class Board
{
public:
  explicit Board(std::size_t count) : Left(count) {}

  std::vector<std::vector<std::string>> Meet(std::size_t own, std::vector<std::string> texts)
  {
    std::unique_lock<std::mutex> lock(this->Mutex);
    this->Left[own] = std::move(texts);
    const int round = this->Round;
    if (++this->Come == this->Left.size())
    {
      this->Come = 0;
      this->Taken = this->Left;
      ++this->Round;
      this->All.notify_all();
    }
    this->All.wait(lock, [&] { return this->Round != round; });
    return this->Taken; // the next round ends when this one has left something again
  }

private:
  std::mutex Mutex;
  std::condition_variable All;
  std::vector<std::vector<std::string>> Left;
  std::vector<std::vector<std::string>> Taken;
  std::size_t Come = 0;
  int Round = 0;
};

PointCloud Rows(const PointCloud& cloud, Eigen::Index begin, Eigen::Index end)
{
  PointCloud part;
  part.Parameters = cloud.Parameters.middleRows(begin, end - begin);
  part.Values = cloud.Values.middleRows(begin, end - begin);
  if (cloud.Tolerances.size() > 0)
  {
    part.Tolerances = cloud.Tolerances.segment(begin, end - begin);
  }
  if (!cloud.Significant.empty())
  {
    part.Significant.assign(cloud.Significant.begin() + begin, cloud.Significant.begin() + end);
  }
  return part;
}

/// What every process gets. @param ends  of the parts of the cloud, one a process.
std::vector<Result<SurfaceFit>> FitTogether(const PointCloud& cloud,
  const std::vector<Eigen::Index>& ends, const FitParams& params,
  const std::function<void(std::size_t, FitProcesses&, FitParams&)>& change = {})
{
  Board board(ends.size());
  std::vector<Result<SurfaceFit>> fits(ends.size());
  std::vector<std::thread> threads;
  for (std::size_t p = 0; p < ends.size(); ++p)
  {
    threads.emplace_back(
      [&, p]
      {
        FitProcesses processes;
        processes.Own = static_cast<int>(p);
        processes.Count = static_cast<int>(ends.size());
        processes.Exchange = [&](const std::string& own)
        {
          std::vector<std::string> all;
          for (const auto& texts : board.Meet(p, { own }))
          {
            all.push_back(texts[0]);
          }
          return all;
        };
        processes.Deal = [&](std::vector<std::string> hands)
        {
          std::vector<std::string> all;
          for (const auto& texts : board.Meet(p, std::move(hands)))
          {
            all.push_back(texts[p]);
          }
          return all;
        };
        FitParams own = params;
        own.Threads = 1;
        if (change)
        {
          change(p, processes, own);
        }
        fits[p] = FitSurface(Rows(cloud, p == 0 ? 0 : ends[p - 1], ends[p]), own, processes);
      });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  return fits;
}

void ExpectSame(const FitIteration& a, const FitIteration& b)
{
  EXPECT_EQ(a.NumFunctions, b.NumFunctions);
  EXPECT_EQ(a.NumElements, b.NumElements);
  EXPECT_EQ(a.MaxError, b.MaxError);
  EXPECT_EQ(a.MeanError, b.MeanError);
  EXPECT_EQ(a.RmsError, b.RmsError);
  EXPECT_EQ(a.NumOutside, b.NumOutside);
  EXPECT_EQ(a.NumSignificant, b.NumSignificant);
  EXPECT_EQ(a.MaxSignificantError, b.MaxSignificantError);
  EXPECT_EQ(a.MeanSignificantError, b.MeanSignificantError);
  EXPECT_EQ(a.NumSignificantOutside, b.NumSignificantOutside);
  EXPECT_EQ(a.LogLikelihood, b.LogLikelihood);
  EXPECT_EQ(a.AIC, b.AIC);
}

/// The fit of one process, and of two, three (one without points) and five.
void ExpectSameForAll(const PointCloud& cloud, const FitParams& params)
{
  const SurfaceFit alone = Fit(cloud, params);
  const Eigen::Index n = cloud.Parameters.rows();
  for (const std::vector<Eigen::Index>& ends : std::vector<std::vector<Eigen::Index>>{
         { n / 2, n }, { n / 3, n / 3, n }, { n / 7, n / 5, n / 2, n - 1, n } })
  {
    const std::vector<Result<SurfaceFit>> fits = FitTogether(cloud, ends, params);
    Eigen::Index row = 0;
    for (std::size_t p = 0; p < ends.size(); ++p)
    {
      ASSERT_TRUE(fits[p]) << fits[p].Status.Message();
      const SurfaceFit& fit = fits[p].Value;
      EXPECT_EQ(fit.Surface.ControlPoints, alone.Surface.ControlPoints) << ends.size();
      EXPECT_EQ(fit.DomainPoints, alone.DomainPoints);
      EXPECT_EQ(fit.WithinTolerance, alone.WithinTolerance);
      EXPECT_EQ(fit.End, alone.End);
      ASSERT_EQ(fit.Iterations.size(), alone.Iterations.size());
      for (std::size_t k = 0; k < fit.Iterations.size(); ++k)
      {
        ExpectSame(fit.Iterations[k], alone.Iterations[k]);
      }
      ASSERT_EQ(fit.ElementFeatures.size(), alone.ElementFeatures.size());
      for (std::size_t k = 0; k < fit.ElementFeatures.size(); ++k)
      {
        EXPECT_EQ(fit.ElementFeatures[k].Values, alone.ElementFeatures[k].Values);
      }
      const Eigen::Index own = ends[p] - row;
      ASSERT_EQ(fit.Distances.size(), static_cast<std::size_t>(own));
      for (std::size_t i = 0; i < fit.Distances.size(); ++i)
      {
        ASSERT_EQ(fit.Distances[i], alone.Distances[static_cast<std::size_t>(row) + i]);
        ASSERT_EQ(fit.Tolerances[i], alone.Tolerances[static_cast<std::size_t>(row) + i]);
      }
      row = ends[p];
    }
  }
}

PointCloud Hills(std::size_t n)
{
  return clouds::HeightField(n, 4711, clouds::Terrain());
}
}

TEST(FitProcesses, LeastSquaresAreThoseOfOneProcess_ExactOracle)
{
  FitParams params = WithTolerance(0.02);
  ExpectSameForAll(Hills(6000), params);
  params.Tolerance = 0.0; // a thousandth of the range of all
  params.MaxIterations = 3;
  params.Smoothing = 0.0;
  ExpectSameForAll(Hills(2000), params);
}

TEST(FitProcesses, MultilevelApproximationsAndTHBAreThoseOfOneProcess_ExactOracle)
{
  FitParams params = WithTolerance(0.03);
  params.Method = FitMethod::Combined;
  params.SwitchIteration = 2;
  params.Space = FitSpace::Hierarchical;
  params.Degree = { 3, 1 };
  params.ElementFeatures = true;
  params.FeatureIterations = true;
  ExpectSameForAll(Hills(4000), params);
  params.Method = FitMethod::MultilevelApproximation;
  params.Criterion = FitCriterion::BIC; // the best one may be an earlier one
  params.Tolerance = 1e-4;
  ExpectSameForAll(Hills(1500), params);
}

TEST(FitProcesses, TolerancesSignificantPointsAndSeveralValuesAreThoseOfOneProcess_ExactOracle)
{
  PointCloud cloud = Hills(4000);
  clouds::Random random(5);
  const PointMatrix heights = cloud.Values;
  cloud.Values.resize(heights.rows(), 3);
  cloud.Tolerances.resize(heights.rows());
  for (Eigen::Index i = 0; i < heights.rows(); ++i)
  {
    cloud.Values.row(i) << heights(i, 0), cloud.Parameters(i, 0), random.Uniform();
    cloud.Tolerances[i] = 0.02 + 0.03 * random.Uniform();
    cloud.Significant.push_back(random.Uniform() < 0.1 ? 1 : 0);
  }
  FitParams params;
  params.NumMeasured = 2;
  params.Threshold = FitThreshold::MostPoints;
  params.Directions = FitDirections::Alternating;
  ExpectSameForAll(cloud, params);
}

TEST(FitProcesses, UpdatesOfAStartAreThoseOfOneProcess_ExactOracle)
{
  FitParams params = WithTolerance(0.05);
  params.Domain = { { 0.0, 0.0 }, { 1.0, 1.0 } };
  const SurfaceFit first = Fit(Hills(2000), params);
  params.Tolerance = 0.03;
  params.Start = FitStart{ first.Surface, first.DomainPoints, { FitEdge::Values } };
  PointCloud cloud = Hills(3000);
  cloud.Parameters.col(0) *= 0.4; // nothing changes on the other side
  ExpectSameForAll(cloud, params);
}

TEST(FitProcesses, MoreProcessesThanElements_ExactOracle)
{
  FitParams params = WithTolerance(1.0);
  params.NumInitialElements = { 1, 1 };
  ExpectSameForAll(Hills(50), params);
}

TEST(FitProcesses, FailuresAreThoseOfAll)
{
  const PointCloud cloud = Hills(400);
  const std::vector<Eigen::Index> ends{ 100, 100, 400 };
  const auto codes = [&](const PointCloud& points, const FitParams& params,
                       const std::function<void(std::size_t, FitProcesses&, FitParams&)>& change)
  {
    std::vector<ErrorCode> found;
    for (const auto& fit : FitTogether(points, ends, params, change))
    {
      found.push_back(fit.Status.Code);
    }
    return found;
  };
  const auto allAre = [](ErrorCode code) { return std::vector<ErrorCode>(3, code); };
  PointCloud bad = cloud;
  bad.Values(250, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(codes(bad, WithTolerance(0.1), {}), allAre(ErrorCode::NonFiniteInput));
  for (int k = 0; k < 4; ++k)
  {
    FitParams params = WithTolerance(0.1);
    params.FindOutliers = k == 0;
    params.CorrectParameters = k == 1;
    params.Side = k == 2 ? FitSide::Above : FitSide::Both;
    params.FeatureGridSize = k == 3 ? 4 : 0;
    EXPECT_EQ(codes(cloud, params, {}), allAre(ErrorCode::InvalidParameter)) << k;
  }
  // one is asked to stop, one is out of memory, one has something to say against its points
  EXPECT_EQ(codes(cloud, WithTolerance(1e-3),
              [](std::size_t p, FitProcesses&, FitParams& params)
              { params.Progress = [p](double) { return p != 2; }; }),
    allAre(ErrorCode::Aborted));
  EXPECT_EQ(codes(cloud, WithTolerance(1e-3),
              [](std::size_t p, FitProcesses&, FitParams& params) {
                params.Progress = [p](double) -> bool
                { return p == 0 ? throw std::bad_alloc() : true; };
              }),
    allAre(ErrorCode::TooLarge));
  EXPECT_EQ(codes(cloud, WithTolerance(1e-3),
              [](std::size_t p, FitProcesses&, FitParams& params)
              {
                params.Progress = [p](double) -> bool
                { return p == 1 ? throw std::logic_error("of a library") : true; };
              }),
    allAre(ErrorCode::LibraryError));
  EXPECT_EQ(codes(cloud, WithTolerance(1e-3),
              [](std::size_t p, FitProcesses& processes, FitParams&)
              {
                processes.Check = [p](const PointMatrix&, const PointMatrix&)
                { return p == 1 ? Status(ErrorCode::NotInSpace, "layers") : Status(); };
              }),
    allAre(ErrorCode::NotInSpace));
  std::vector<ErrorCode> empty;
  for (const auto& fit : FitTogether(Rows(cloud, 0, 0), { 0, 0 }, WithTolerance(0.1)))
  {
    empty.push_back(fit.Status.Code);
  }
  EXPECT_EQ(empty, std::vector<ErrorCode>(2, ErrorCode::EmptyInput));
}
}
