// SPDX-License-Identifier: BSD-3-Clause
#include "SplineOracle.h"
#include <knotwork/SplineCore/BezierSpace.h>
#include <knotwork/SplineCore/Parallel.h>
#include <knotwork/SplineCore/Status.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <new>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>

using namespace knotwork;

namespace
{
constexpr double NaN = std::numeric_limits<double>::quiet_NaN();

Spline<2> Surface()
{
  oracle::Random random(30);
  return random.Spline<2>({ KnotVector::Uniform(2, 3), KnotVector::Uniform(3, 2) }, 3, true);
}
}

TEST(Status, EveryCodeHasASentenceOfItsOwn_PropertyOracle)
{
  std::set<std::string> sentences;
  const int count = static_cast<int>(ErrorCode::LibraryError) + 1;
  for (int code = 0; code < count; ++code)
  {
    const std::string sentence = ToString(static_cast<ErrorCode>(code));
    EXPECT_FALSE(sentence.empty());
    EXPECT_NE(sentence.back(), '.');
    sentences.insert(sentence);
  }
  EXPECT_EQ(sentences.size(), static_cast<std::size_t>(count));
  EXPECT_EQ(sentences.count("unknown error"), 0u);
}

TEST(Status, ExceptionsKeepTheirMeaning_ExactOracle)
{
  const auto outcome = [](const std::function<void()>& throwing)
  {
    try
    {
      throwing();
    }
    catch (...)
    {
      return StatusOfException();
    }
    return Status();
  };
  EXPECT_EQ(outcome([] { throw std::bad_alloc(); }).Code, ErrorCode::TooLarge);
  EXPECT_EQ(outcome([] { throw std::length_error("vector"); }).Code, ErrorCode::TooLarge);
  const Status library = outcome([] { throw std::runtime_error("no root found"); });
  EXPECT_EQ(library.Code, ErrorCode::LibraryError);
  EXPECT_EQ(library.Detail, "no root found");
  EXPECT_EQ(outcome([] { throw 7; }).Code, ErrorCode::LibraryError);
  EXPECT_EQ(outcome([] {}).Code, ErrorCode::Ok);
}

TEST(Status, Message_ExactOracle)
{
  EXPECT_EQ(Status().Message(), "ok");
  EXPECT_TRUE(Status());
  const Status status(ErrorCode::InvalidDegree, "cell 3 has degree 10");
  EXPECT_FALSE(status);
  EXPECT_EQ(status.Message(), "the degree is outside [1, 9]: cell 3 has degree 10");
}

TEST(Status, ResultHoldsValueOrReason_ExactOracle)
{
  const Result<int> good(7);
  EXPECT_TRUE(good);
  EXPECT_EQ(good.Value, 7);
  const Result<int> bad(ErrorCode::TooLarge, "n");
  EXPECT_FALSE(bad);
  EXPECT_EQ(bad.Value, 0);
  EXPECT_EQ(bad.Status.Code, ErrorCode::TooLarge);
}

TEST(Status, SplineCheckNamesTheFirstBadRow_ExactOracle)
{
  EXPECT_TRUE(Surface().Check());
  EXPECT_EQ(Spline<2>().Check().Code, ErrorCode::EmptyInput);
  {
    auto spline = Surface();
    spline.ControlPoints.conservativeResize(7, 3);
    EXPECT_EQ(spline.Check().Code, ErrorCode::SizeMismatch);
  }
  {
    auto spline = Surface();
    spline.ControlPoints.resize(25, 0);
    EXPECT_EQ(spline.Check().Code, ErrorCode::SizeMismatch);
  }
  {
    auto spline = Surface();
    spline.Weights.conservativeResize(24);
    EXPECT_EQ(spline.Check().Code, ErrorCode::SizeMismatch);
  }
  {
    auto spline = Surface();
    spline.ControlPoints(5, 2) = NaN;
    EXPECT_EQ(spline.Check().Code, ErrorCode::NonFiniteInput);
    EXPECT_NE(spline.Check().Detail.find("5"), std::string::npos);
  }
  {
    auto spline = Surface();
    spline.ControlPoints(6, 1) = -1e61;
    EXPECT_EQ(spline.Check().Code, ErrorCode::TooLarge);
    EXPECT_NE(spline.Check().Detail.find("6"), std::string::npos);
    spline.ControlPoints(6, 1) = -1e60;
    EXPECT_TRUE(spline.Check());
  }
  for (double weight : { 0.0, -1.0, NaN, std::numeric_limits<double>::infinity() })
  {
    auto spline = Surface();
    spline.Weights[11] = weight;
    EXPECT_EQ(spline.Check().Code, ErrorCode::InvalidWeight);
    EXPECT_NE(spline.Check().Detail.find("11"), std::string::npos);
  }
}

TEST(Status, InsertKnotsReportsEachFault_ExactOracle)
{
  const auto surface = Surface();
  EXPECT_EQ(InsertKnots(Spline<2>(), 0, { 0.5 }).Status.Code, ErrorCode::EmptyInput);
  EXPECT_EQ(InsertKnots(surface, -1, { 0.5 }).Status.Code, ErrorCode::InvalidParameter);
  EXPECT_EQ(InsertKnots(surface, 2, { 0.5 }).Status.Code, ErrorCode::InvalidParameter);
  EXPECT_EQ(InsertKnots(surface, 0, { 0.5, NaN }).Status.Code, ErrorCode::NonFiniteInput);
  EXPECT_EQ(InsertKnots(surface, 0, { 1.5 }).Status.Code, ErrorCode::OutsideDomain);
  EXPECT_EQ(InsertKnots(surface, 0, { -1e-9 }).Status.Code, ErrorCode::OutsideDomain);
  EXPECT_EQ(InsertKnots(surface, 0, { 0.0 }).Status.Code, ErrorCode::InvalidKnots);
  EXPECT_EQ(InsertKnots(surface, 1, { 1.0 }).Status.Code, ErrorCode::InvalidKnots);
  EXPECT_TRUE(InsertKnots(surface, 0, { 0.5, 0.5, 0.5 }));
  EXPECT_EQ(InsertKnots(surface, 0, { 0.5, 0.5, 0.5, 0.5 }).Status.Code, ErrorCode::InvalidKnots);
  auto bad = surface;
  bad.Weights[0] = -1.0;
  EXPECT_EQ(InsertKnots(bad, 0, { 0.5 }).Status.Code, ErrorCode::InvalidWeight);
}

TEST(Status, ElevateDegreeReportsEachFault_ExactOracle)
{
  const auto surface = Surface();
  EXPECT_EQ(ElevateDegree(surface, 0, -1).Status.Code, ErrorCode::InvalidParameter);
  EXPECT_EQ(ElevateDegree(surface, 5, 1).Status.Code, ErrorCode::InvalidParameter);
  EXPECT_TRUE(ElevateDegree(surface, 0, 7));
  EXPECT_EQ(ElevateDegree(surface, 0, 8).Status.Code, ErrorCode::InvalidDegree);
  EXPECT_EQ(ElevateDegree(surface, 0, std::numeric_limits<int>::max()).Status.Code,
    ErrorCode::InvalidDegree);
}

TEST(Status, OperationsNeedATensorSpace_ExactOracle)
{
  Spline<1> spline;
  spline.Space = MakeBezierSpace<1>({ { 2 } }, { 0, 1, 2 }, 3).Value;
  spline.ControlPoints = PointMatrix::Zero(3, 2);
  ASSERT_TRUE(spline.Check());
  EXPECT_EQ(InsertKnots(spline, 0, { 0.5 }).Status.Code, ErrorCode::DimensionMismatch);
  EXPECT_EQ(ElevateDegree(spline, 0, 1).Status.Code, ErrorCode::DimensionMismatch);
}

TEST(Status, SpacesReportTheirLimits_ExactOracle)
{
  const KnotVector k = KnotVector::Uniform(1, 1300);
  EXPECT_EQ((MakeTensorSpace<3>({ k, k, k }).Status.Code), ErrorCode::TooLarge);
  EXPECT_EQ((MakeBezierSpace<1>({ { 10 } }, {}, 1).Status.Code), ErrorCode::InvalidDegree);
  EXPECT_EQ((MakeBezierSpace<1>({ { 0 } }, { 0 }, 1).Status.Code), ErrorCode::InvalidDegree);
  EXPECT_EQ((MakeBezierSpace<1>({ { 1 } }, { 0 }, 1).Status.Code), ErrorCode::SizeMismatch);
  EXPECT_EQ((MakeBezierSpace<1>({ { 1 } }, { 0, 0, 0 }, 1).Status.Code), ErrorCode::SizeMismatch);
  EXPECT_EQ((MakeBezierSpace<1>({ { 1 } }, { 0, 1 }, 1).Status.Code), ErrorCode::InvalidTopology);
  EXPECT_EQ((MakeBezierSpace<1>({ { 1 } }, { -1, 0 }, 1).Status.Code), ErrorCode::InvalidTopology);
  EXPECT_TRUE((MakeBezierSpace<2>({ { 1, 1 } }, { 0, 1, 1, 0 }, 2)));
}

TEST(ParallelFor, CoversTheRangeOnceInFixedChunks_ExactOracle)
{
  for (int threads : { 0, 1, 2, 7 })
  {
    for (std::size_t count : { std::size_t(0), std::size_t(1), std::size_t(10), std::size_t(1001) })
    {
      for (std::size_t chunk :
        { std::size_t(0), std::size_t(1), std::size_t(10), std::size_t(5000) })
      {
        std::vector<int> visits(count, 0);
        std::vector<std::size_t> begins(count, 0);
        ParallelFor(count, chunk, threads,
          [&](std::size_t begin, std::size_t end)
          {
            ASSERT_LT(begin, end);
            for (std::size_t i = begin; i < end; ++i)
            {
              ++visits[i];
              begins[i] = begin;
            }
          });
        for (std::size_t i = 0; i < count; ++i)
        {
          const std::size_t size = std::max<std::size_t>(chunk, 1);
          ASSERT_EQ(visits[i], 1);
          ASSERT_EQ(begins[i], i / size * size);
        }
      }
    }
  }
}

TEST(ParallelFor, ACallFromABodyAddsNoThreads_ExactOracle)
{
  for (const int threads : { 1, 2, 3 })
  {
    std::atomic<int> running{ 0 };
    std::atomic<int> most{ 0 };
    ParallelFor(8, 1, threads,
      [&](std::size_t, std::size_t)
      {
        ParallelFor(50, 1, threads,
          [&](std::size_t, std::size_t)
          {
            const int now = ++running;
            for (int before = most; before < now && !most.compare_exchange_weak(before, now);)
            {
            }
            std::this_thread::yield();
            --running;
          });
      });
    EXPECT_GE(most, 1);
    EXPECT_LE(most, threads);
  }
}

TEST(ParallelFor, ResultsDoNotDependOnThreads_BitOracle)
{
  // sums of a chunk depend on where it begins: equal bits mean equal chunks
  const auto run = [](int threads)
  {
    const std::size_t count = 100000;
    std::vector<double> sums(count);
    ParallelFor(count, 64, threads,
      [&](std::size_t begin, std::size_t end)
      {
        double sum = 0.0;
        for (std::size_t i = begin; i < end; ++i)
        {
          sum += std::sin(static_cast<double>(i)) * 1e-3;
          sums[i] = sum;
        }
      });
    return sums;
  };
  const auto expected = run(1);
  for (int threads : { 0, 2, 3, 8 })
  {
    for (int repeat = 0; repeat < 5; ++repeat)
    {
      ASSERT_EQ(run(threads), expected);
    }
  }
}
