// SPDX-License-Identifier: BSD-3-Clause
#include "FitChecks.h"

#include "FitUpdate.h"
#include <knotwork/SplineCore/Numbers.h>
#include <knotwork/SplineCore/Parallel.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
constexpr std::size_t PointChunk = 16384;
constexpr double DomainSlack = 1e-12;     // of the domain's size, as SplineSpace::Locate
constexpr double DefaultTolerance = 1e-3; // of the range of the measured values

bool HasArea(const ParametricBox<2>& box)
{
  return box.Upper[0] > box.Lower[0] && box.Upper[1] > box.Lower[1];
}

Status Bad(const std::string& what)
{
  return { ErrorCode::InvalidParameter, what };
}

Status CheckSizes(const PointCloud& cloud, const FitParams& params)
{
  const Eigen::Index n = cloud.Parameters.rows();
  if (n == 0)
  {
    return { ErrorCode::EmptyInput, "there are no points" };
  }
  if (n > std::numeric_limits<int>::max())
  {
    return { ErrorCode::TooLarge, std::to_string(n) + " points" };
  }
  if (cloud.Parameters.cols() != 2 || cloud.Values.rows() != n || cloud.Values.cols() < 1)
  {
    return { ErrorCode::SizeMismatch,
      std::to_string(n) + " x " + std::to_string(cloud.Parameters.cols()) + " parameters and " +
        std::to_string(cloud.Values.rows()) + " x " + std::to_string(cloud.Values.cols()) +
        " values; two parameters and at least one value a point are needed" };
  }
  if (cloud.Tolerances.size() != 0 && cloud.Tolerances.size() != n)
  {
    return { ErrorCode::SizeMismatch,
      std::to_string(cloud.Tolerances.size()) + " tolerances for " + std::to_string(n) +
        " points" };
  }
  if (!cloud.Significant.empty() && cloud.Significant.size() != static_cast<std::size_t>(n))
  {
    return { ErrorCode::SizeMismatch,
      std::to_string(cloud.Significant.size()) + " marks of significant points for " +
        std::to_string(n) + " points" };
  }
  if (params.NumMeasured < 1 || params.NumMeasured > cloud.Values.cols())
  {
    return Bad("NumMeasured is " + std::to_string(params.NumMeasured) + ", choose 1 to " +
      std::to_string(cloud.Values.cols()));
  }
  if (params.CorrectParameters && (params.NumMeasured < 2 || params.NumMeasured > 4))
  {
    return Bad("CorrectParameters needs a surface in space, and NumMeasured is " +
      std::to_string(params.NumMeasured) + ": heights are measured at their parameters");
  }
  return {};
}

Status CheckShape(const FitParams& params)
{
  for (const int p : params.Degree)
  {
    if (p < 1 || p > MaxDegree)
    {
      return { ErrorCode::InvalidDegree, "degree " + std::to_string(p) + ", choose 1 to 9" };
    }
  }
  for (const int n : params.NumInitialElements)
  {
    if (n < 0 || n > 10000)
    {
      return Bad("NumInitialElements is " + std::to_string(n) + ", choose 0 to 10000");
    }
  }
  for (std::size_t d = 0; d < 2; ++d)
  {
    if (!std::isfinite(params.Domain.Lower[d]) || !std::isfinite(params.Domain.Upper[d]))
    {
      return Bad("Domain is not finite");
    }
  }
  if (!(params.MinElementSize > 0.0 && params.MinElementSize < 1.0))
  {
    return Bad("MinElementSize is " + Digits(params.MinElementSize) + ", choose within (0, 1)");
  }
  return {};
}

Status CheckTolerance(const FitParams& params)
{
  if (!(params.Tolerance >= 0.0) || !std::isfinite(params.Tolerance))
  {
    return Bad("Tolerance is " + Digits(params.Tolerance) + ", choose a positive one, or 0");
  }
  for (const ToleranceBox& box : params.ToleranceBoxes)
  {
    if (!(box.Tolerance > 0.0) || !std::isfinite(box.Tolerance) || !HasArea(box.Box))
    {
      return Bad("ToleranceBoxes has a box without an area or a tolerance that is not positive");
    }
  }
  if (!(params.DistanceSlope >= 0.0) || !std::isfinite(params.DistanceSlope))
  {
    return Bad("DistanceSlope is " + Digits(params.DistanceSlope) + ", choose 0 or more");
  }
  if (!(params.DistanceSlope <= LargestNumber) || !(params.Tolerance <= LargestNumber) ||
    !(std::fabs(params.DistanceCentre[0]) <= LargestNumber) ||
    !(std::fabs(params.DistanceCentre[1]) <= LargestNumber))
  {
    return Bad("Tolerance, DistanceSlope or DistanceCentre is not finite or beyond " +
      Digits(LargestNumber) + "; choose a smaller one");
  }
  for (const double factor : { params.ToleranceFactorAbove, params.ToleranceFactorBelow })
  {
    if (!(factor > 0.0) || !(factor <= LargestNumber))
    {
      return Bad("a tolerance factor is " + Digits(factor) + ", choose more than 0");
    }
    if (factor != 1.0 && (params.NumMeasured != 1 || params.Side != FitSide::Both))
    {
      return Bad("a tolerance factor is not 1: only a height has an above and a below, and not "
                 "when Side allows points on one side alone; choose 1");
    }
  }
  if (params.Side != FitSide::Both && params.NumMeasured != 1)
  {
    return Bad("Side needs NumMeasured 1: only a height has an above and a below");
  }
  return {};
}

Status CheckSteps(const FitParams& params)
{
  if (!(params.Smoothing >= 0.0) || !std::isfinite(params.Smoothing))
  {
    return Bad("Smoothing is " + Digits(params.Smoothing) + ", choose 0 or more");
  }
  if (!(params.SignificantWeight >= 1.0) || !std::isfinite(params.SignificantWeight))
  {
    return Bad("SignificantWeight is " + Digits(params.SignificantWeight) + ", choose 1 or more");
  }
  if (!(params.OutlierScale > 0.0))
  {
    return Bad("OutlierScale is " + Digits(params.OutlierScale) + ", choose more than 0");
  }
  if (params.SwitchIteration < 0)
  {
    return Bad("SwitchIteration is negative");
  }
  if (params.StrategySwitch < 0)
  {
    return Bad("StrategySwitch is negative");
  }
  if (params.MaxIterations < 0)
  {
    return Bad("MaxIterations is negative");
  }
  if (params.MaxFunctions < 0)
  {
    return Bad("MaxFunctions is negative");
  }
  if (!(params.MaxSeconds >= 0.0))
  {
    return Bad("MaxSeconds is negative");
  }
  if (!(params.ThresholdShare >= 0.0 && params.ThresholdShare <= 1.0))
  {
    return Bad("ThresholdShare is " + Digits(params.ThresholdShare) + ", choose within [0, 1]");
  }
  if (params.FeatureGridSize < 0 || params.FeatureGridSize > 4096)
  {
    return Bad(
      "FeatureGridSize is " + std::to_string(params.FeatureGridSize) + ", choose 0 to 4096");
  }
  if (params.Threads < 0)
  {
    return Bad("Threads is negative");
  }
  return {};
}

Status CheckPoint(const PointCloud& cloud, const FitParams& params, Eigen::Index i)
{
  bool finite = std::isfinite(cloud.Parameters(i, 0)) && std::isfinite(cloud.Parameters(i, 1));
  double size = std::max(std::fabs(cloud.Parameters(i, 0)), std::fabs(cloud.Parameters(i, 1)));
  for (Eigen::Index c = 0; c < cloud.Values.cols(); ++c)
  {
    finite = finite && std::isfinite(cloud.Values(i, c));
    size = std::max(size, std::fabs(cloud.Values(i, c)));
  }
  if (!finite)
  {
    return { ErrorCode::NonFiniteInput,
      "point " + std::to_string(i) + " has a parameter or value that is not finite" };
  }
  if (size > LargestNumber)
  {
    return { ErrorCode::TooLarge, "point " + std::to_string(i) + ": " + BeyondLimit() };
  }
  if (cloud.Tolerances.size() != 0 &&
    !(cloud.Tolerances[i] > 0.0 && std::isfinite(cloud.Tolerances[i])))
  {
    return Bad("the tolerance of point " + std::to_string(i) + " is " +
      Digits(cloud.Tolerances[i]) + ", it must be positive");
  }
  for (std::size_t d = 0; HasArea(params.Domain) && d < 2; ++d)
  {
    const double x = cloud.Parameters(i, static_cast<Eigen::Index>(d));
    const double slack = DomainSlack * (params.Domain.Upper[d] - params.Domain.Lower[d]);
    if (x < params.Domain.Lower[d] - slack || x > params.Domain.Upper[d] + slack)
    {
      return { ErrorCode::OutsideDomain,
        "point " + std::to_string(i) +
          (params.Start ? " lies outside the domain of the start surface; leave it out"
                        : " lies outside the domain; enlarge the domain or leave it out") };
    }
  }
  return {};
}

/// The first bad point.
Status CheckPoints(const PointCloud& cloud, const FitParams& params)
{
  const auto n = static_cast<std::size_t>(cloud.Parameters.rows());
  std::vector<Status> found((n + PointChunk - 1) / PointChunk);
  ParallelFor(n, PointChunk, params.Threads,
    [&](std::size_t begin, std::size_t end)
    {
      Status& own = found[begin / PointChunk];
      for (std::size_t i = begin; own && i < end; ++i)
      {
        own = CheckPoint(cloud, params, static_cast<Eigen::Index>(i));
      }
    });
  const auto bad =
    std::find_if(found.begin(), found.end(), [](const Status& status) { return !status; });
  return bad == found.end() ? Status() : *bad;
}
}

Status CheckFit(const PointCloud& cloud, const FitParams& params)
{
  Status status = CheckSizes(cloud, params);
  if (status)
  {
    status = CheckShape(params);
  }
  if (status)
  {
    status = CheckTolerance(params);
  }
  if (status)
  {
    status = CheckSteps(params);
  }
  if (status)
  {
    status = CheckStart(cloud, params);
  }
  return status ? CheckPoints(cloud, WithStart(params)) : status;
}

ParametricBox<2> FitDomain(
  const PointCloud& cloud, const FitParams& params, const FitDivision& division)
{
  if (HasArea(params.Domain))
  {
    return params.Domain;
  }
  const auto n = static_cast<std::size_t>(cloud.Parameters.rows());
  constexpr double Infinity = std::numeric_limits<double>::infinity();
  const ParametricBox<2> none{ { Infinity, Infinity }, { -Infinity, -Infinity } };
  std::vector<ParametricBox<2>> boxes((n + PointChunk - 1) / PointChunk, none);
  ParallelFor(n, PointChunk, params.Threads,
    [&](std::size_t begin, std::size_t end)
    {
      ParametricBox<2> own = none;
      for (const double* x = cloud.Parameters.data() + 2 * begin;
           x != cloud.Parameters.data() + 2 * end; x += 2)
      {
        for (std::size_t d = 0; d < 2; ++d)
        {
          own.Lower[d] = std::min(own.Lower[d], x[d]);
          own.Upper[d] = std::max(own.Upper[d], x[d]);
        }
      }
      boxes[begin / PointChunk] = own;
    });
  ParametricBox<2> box = none;
  for (std::size_t d = 0; d < 2; ++d)
  {
    for (const ParametricBox<2>& part : boxes)
    {
      box.Lower[d] = std::min(box.Lower[d], part.Lower[d]);
      box.Upper[d] = std::max(box.Upper[d], part.Upper[d]);
    }
    box.Lower[d] = -division.Largest(-box.Lower[d]);
    box.Upper[d] = division.Largest(box.Upper[d]);
  }
  // points on a line or at one place: a domain with an area around them
  const double size = std::max(box.Upper[0] - box.Lower[0], box.Upper[1] - box.Lower[1]);
  for (std::size_t d = 0; d < 2; ++d)
  {
    const double least =
      std::max(1e-6 * size, 1e-6 * std::max(std::fabs(box.Lower[d]), std::fabs(box.Upper[d])));
    if (!(box.Upper[d] - box.Lower[d] > least * 1e-3))
    {
      const double half = least > 0.0 ? 0.5 * std::max(size, least) : 0.5;
      const double middle = 0.5 * (box.Lower[d] + box.Upper[d]);
      box.Lower[d] = middle - half;
      box.Upper[d] = middle + half;
    }
  }
  return box;
}

std::vector<double> FitTolerances(
  const PointCloud& cloud, const FitParams& params, const FitDivision& division)
{
  const auto n = static_cast<std::size_t>(cloud.Parameters.rows());
  double base = params.Tolerance;
  if (base == 0.0)
  {
    double range = 0.0;
    double size = 0.0;
    for (int c = 0; c < params.NumMeasured; ++c)
    {
      double lower = std::numeric_limits<double>::infinity();
      double upper = -lower;
      for (std::size_t i = 0; i < n; ++i)
      {
        const double value = cloud.Values(static_cast<Eigen::Index>(i), c);
        lower = std::min(lower, value);
        upper = std::max(upper, value);
      }
      lower = -division.Largest(-lower);
      upper = division.Largest(upper);
      range = std::max(range, upper - lower);
      size = std::max({ size, std::fabs(lower), std::fabs(upper) });
    }
    base = range > 0.0 ? DefaultTolerance * range : std::max(DefaultTolerance * size, 1e-12);
  }
  std::vector<double> tolerances(n, base);
  if (params.Distance == FitDistance::None && params.ToleranceBoxes.empty() &&
    cloud.Tolerances.size() == 0)
  {
    return tolerances;
  }
  ParallelFor(n, PointChunk, params.Threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        const auto row = static_cast<Eigen::Index>(i);
        const RealArray<2> x{ cloud.Parameters(row, 0), cloud.Parameters(row, 1) };
        double tolerance = base;
        if (params.Distance == FitDistance::Value)
        {
          tolerance += params.DistanceSlope * std::fabs(cloud.Values(row, params.NumMeasured - 1));
        }
        else if (params.Distance == FitDistance::Point)
        {
          tolerance += params.DistanceSlope *
            std::hypot(x[0] - params.DistanceCentre[0], x[1] - params.DistanceCentre[1]);
        }
        double least = std::numeric_limits<double>::infinity();
        for (const ToleranceBox& box : params.ToleranceBoxes)
        {
          const bool inside = x[0] >= box.Box.Lower[0] && x[0] <= box.Box.Upper[0] &&
            x[1] >= box.Box.Lower[1] && x[1] <= box.Box.Upper[1];
          least = inside ? std::min(least, box.Tolerance) : least;
        }
        tolerances[i] = std::isfinite(least) ? least : tolerance;
        if (cloud.Tolerances.size() != 0)
        {
          tolerances[i] = cloud.Tolerances[row];
        }
      }
    });
  return tolerances;
}
}
