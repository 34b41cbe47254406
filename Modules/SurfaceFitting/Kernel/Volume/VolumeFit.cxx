// SPDX-License-Identifier: BSD-3-Clause
#include "VolumeFit.h"

#include "VolumePoints.h"
#include <knotwork/SplineCore/FunctionInfo.h>
#include <knotwork/SplineCore/LRVolume.h>
#include <knotwork/SplineCore/Numbers.h>
#include <knotwork/SplineCore/Parallel.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr std::size_t ElementChunk = 32;
constexpr double PointsOfElement = 1000.0; // of the first space
constexpr double MaxFirstElements = 8.0;   // a direction, where they are chosen
constexpr double SmallShare = 0.01;        // of the elements: all that are outside are halved
constexpr double SolveAccuracy = 0.01;     // of the tolerance
constexpr double LargestNumber = 1e100;    // of points and values
constexpr double WidthOfFlat = 1e-3;       // of the longest side, or 1

std::size_t At(std::ptrdiff_t i)
{
  return static_cast<std::size_t>(i);
}

Status CheckParams(const VolumeFitParams& params)
{
  const auto bad = [](const char* name, const std::string& value, const char* range)
  { return Status(ErrorCode::InvalidParameter, std::string(name) + " " + value + ", " + range); };
  if (params.Degree < 1 || params.Degree > MaxDegree)
  {
    return { ErrorCode::InvalidDegree, "degree " + std::to_string(params.Degree) };
  }
  for (const int n : params.NumInitialElements)
  {
    if (n < 0)
    {
      return bad("NumInitialElements", std::to_string(n), "choose at least 0");
    }
  }
  if (!(params.Smoothing > 0.0) || !std::isfinite(params.Smoothing))
  {
    return bad("Smoothing", Digits(params.Smoothing), "choose more than 0");
  }
  if (!(params.Tolerance >= 0.0) || !std::isfinite(params.Tolerance))
  {
    return bad(
      "Tolerance", Digits(params.Tolerance), "choose more than 0, or 0 to have one chosen");
  }
  if (params.MaxIterations < 0 || params.MaxFunctions < 0 || params.SwitchIteration < 0 ||
    params.MultilevelSteps < 1)
  {
    return bad("a number of iterations, functions or steps", "is too small",
      "choose at least 0, and one step");
  }
  if (!(params.ThresholdShare >= 0.0 && params.ThresholdShare <= 1.0))
  {
    return bad("ThresholdShare", Digits(params.ThresholdShare), "choose between 0 and 1");
  }
  if (!(params.MinElementSize > 0.0 && params.MinElementSize < 1.0))
  {
    return bad("MinElementSize", Digits(params.MinElementSize), "choose between 0 and 1");
  }
  return {};
}

Status CheckCloud(const VolumeCloud& cloud)
{
  if (cloud.Points.rows() == 0)
  {
    return { ErrorCode::EmptyInput, "there are no points to fit a volume to" };
  }
  if (cloud.Points.cols() != 3 || cloud.Values.rows() != cloud.Points.rows() ||
    cloud.Values.cols() < 1)
  {
    return { ErrorCode::SizeMismatch,
      "there are " + std::to_string(cloud.Points.rows()) + " points and values of " +
        std::to_string(cloud.Values.rows()) };
  }
  for (Eigen::Index i = 0; i < cloud.Points.rows(); ++i)
  {
    if (!cloud.Points.row(i).allFinite() || !cloud.Values.row(i).allFinite())
    {
      return { ErrorCode::NonFiniteInput, "point " + std::to_string(i) };
    }
    if (cloud.Points.row(i).cwiseAbs().maxCoeff() > LargestNumber ||
      cloud.Values.row(i).cwiseAbs().maxCoeff() > LargestNumber)
    {
      return { ErrorCode::TooLarge, "point " + std::to_string(i) + " has a number above 1e100" };
    }
  }
  return {};
}

Result<ParametricBox<3>> FindDomain(const VolumeCloud& cloud, const ParametricBox<3>& asked)
{
  ParametricBox<3> domain = asked;
  bool isGiven = true;
  bool isAsked = false;
  for (std::size_t d = 0; d < 3; ++d)
  {
    isGiven =
      isGiven && asked.Lower[d] < asked.Upper[d] && std::isfinite(asked.Upper[d] - asked.Lower[d]);
    isAsked = isAsked || asked.Lower[d] != asked.Upper[d];
  }
  if (isAsked && !isGiven)
  {
    return { ErrorCode::InvalidParameter, "the domain has no finite volume" };
  }
  if (!isGiven)
  {
    double longest = 0.0;
    for (std::size_t d = 0; d < 3; ++d)
    {
      const auto column = cloud.Points.col(static_cast<Eigen::Index>(d));
      domain.Lower[d] = column.minCoeff();
      domain.Upper[d] = column.maxCoeff();
      longest = std::max(longest, domain.Upper[d] - domain.Lower[d]);
    }
    for (std::size_t d = 0; d < 3; ++d)
    {
      const double width = WidthOfFlat * (longest > 0.0 ? longest : 1.0);
      if (domain.Upper[d] - domain.Lower[d] < width)
      {
        const double middle = 0.5 * (domain.Lower[d] + domain.Upper[d]);
        domain.Lower[d] = middle - 0.5 * width;
        domain.Upper[d] = middle + 0.5 * width;
      }
    }
    for (std::size_t d = 0; d < 3; ++d)
    {
      if (!(domain.Lower[d] < domain.Upper[d]))
      {
        return { ErrorCode::InvalidParameter,
          "the points are too far from the origin for their distances; move them" };
      }
    }
    return domain;
  }
  for (Eigen::Index i = 0; i < cloud.Points.rows(); ++i)
  {
    for (std::size_t d = 0; d < 3; ++d)
    {
      const double x = cloud.Points(i, static_cast<Eigen::Index>(d));
      if (x < domain.Lower[d] || x > domain.Upper[d])
      {
        return { ErrorCode::OutsideDomain, "point " + std::to_string(i) };
      }
    }
  }
  return domain;
}

Result<Spline<3>> FirstVolume(
  const VolumeCloud& cloud, const VolumeFitParams& params, const ParametricBox<3>& domain)
{
  std::array<KnotVector, 3> knots;
  for (std::size_t d = 0; d < 3; ++d)
  {
    int n = params.NumInitialElements[d];
    if (n == 0)
    {
      const double chosen = std::cbrt(static_cast<double>(cloud.Points.rows()) / PointsOfElement);
      n = static_cast<int>(std::lround(std::clamp(chosen, 1.0, MaxFirstElements)));
    }
    knots[d] = KnotVector::Uniform(params.Degree, n, domain.Lower[d], domain.Upper[d]);
  }
  const auto space = MakeTensorSpace<3>(knots);
  if (!space)
  {
    return space.Status;
  }
  Spline<3> volume;
  volume.Space = space.Value;
  // the domain's own coordinates are carried along
  const auto infos = DescribeFunctions(*space.Value);
  volume.ControlPoints = PointMatrix::Zero(space.Value->NumFunctions, cloud.Values.cols() + 3);
  for (std::size_t f = 0; f < infos.size(); ++f)
  {
    for (std::size_t d = 0; d < 3; ++d)
    {
      volume.ControlPoints(static_cast<Eigen::Index>(f),
        cloud.Values.cols() + static_cast<Eigen::Index>(d)) = infos[f].Greville[d];
    }
  }
  return volume;
}

/// Largest difference of every point in a column, in the order of the points, and by elements.
struct Differences
{
  std::vector<double> OfPoints;
  std::vector<double> OfElements;
  double Squares = 0.0;
};

Differences Measure(const ElementFunctions& functions, const VolumePoints& points, int degree,
  const PointMatrix& coefficients, int threads)
{
  Differences differences;
  const auto numElements = At(functions.NumElements());
  differences.OfPoints.resize(points.Order.size());
  differences.OfElements.assign(numElements, 0.0);
  std::vector<double> squares(numElements, 0.0);
  const auto n = static_cast<Eigen::Index>(functions.PerElement);
  ParallelFor(numElements, ElementChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      Eigen::MatrixXd local(n, coefficients.cols());
      Eigen::VectorXd bernstein(n);
      Eigen::RowVectorXd rest(coefficients.cols());
      for (std::size_t e = begin; e < end; ++e)
      {
        if (points.Count(e) == 0)
        {
          continue;
        }
        functions.LocalCoefficients(static_cast<int>(e), coefficients, local.data());
        for (std::size_t i = points.Start[e]; i < points.Start[e + 1]; ++i)
        {
          EvaluateVolumeBernstein(degree, points.Local.data() + 3 * i, bernstein.data());
          rest.noalias() = bernstein.transpose() * local;
          rest -= points.Values.row(static_cast<Eigen::Index>(i));
          const double size = rest.cwiseAbs().maxCoeff();
          differences.OfPoints[i] = size;
          differences.OfElements[e] = std::max(differences.OfElements[e], size);
          squares[e] += rest.squaredNorm();
        }
      }
    });
  for (const double sum : squares)
  {
    differences.Squares += sum;
  }
  return differences;
}

std::vector<int> MarkElements(const SplineSpace<3>& space, const std::vector<double>& errors,
  double tolerance, const VolumeFitParams& params)
{
  const ParametricBox<3> domain = space.Domain();
  std::vector<int> outside;
  double largest = 0.0;
  for (int e = 0; e < space.NumElements(); ++e)
  {
    const ParametricBox<3>& box = space.Elements[At(e)].Box;
    bool isLarge = true;
    for (std::size_t d = 0; d < 3; ++d)
    {
      isLarge = isLarge &&
        0.5 * (box.Upper[d] - box.Lower[d]) >=
          params.MinElementSize * (domain.Upper[d] - domain.Lower[d]);
    }
    if (errors[At(e)] > tolerance && isLarge)
    {
      outside.push_back(e);
      largest = std::max(largest, errors[At(e)]);
    }
  }
  if (static_cast<double>(outside.size()) <= SmallShare * space.NumElements())
  {
    return outside;
  }
  const double limit = tolerance + params.ThresholdShare * (largest - tolerance);
  std::vector<int> marked;
  for (const int e : outside)
  {
    if (errors[At(e)] >= limit)
    {
      marked.push_back(e);
    }
  }
  return marked;
}

Result<Spline<3>> Refine(const Spline<3>& volume, const std::vector<int>& marked, int maxFunctions,
  const VolumeFitParams& params)
{
  if (params.Space == FitSpace::Hierarchical)
  {
    RefinementParams extended;
    extended.Extension = (params.Degree + 1) / 2; // so that new functions appear
    auto refined = RefineMarkedElements(volume, marked, extended);
    if (!refined)
    {
      return refined.Status;
    }
    return refined->Value.Space->NumFunctions <= maxFunctions
      ? Result<Spline<3>>(std::move(refined->Value))
      : Status(ErrorCode::TooLarge, "the refined space has too many functions");
  }
  LRVolumeStrategyParams strategy;
  strategy.Strategy = params.Strategy;
  auto refined = RefineMarkedLRVolume(volume, marked, strategy, maxFunctions, params.Threads);
  return refined ? Result<Spline<3>>(std::move(refined->Value)) : refined.Status;
}
}

Result<VolumeFit> FitVolume(const VolumeCloud& cloud, const VolumeFitParams& params)
{
  const auto start = std::chrono::steady_clock::now();
  Status status = CheckParams(params);
  status = status ? CheckCloud(cloud) : status;
  if (!status)
  {
    return status;
  }
  const Result<ParametricBox<3>> domain = FindDomain(cloud, params.Domain);
  if (!domain)
  {
    return domain.Status;
  }
  Result<Spline<3>> first = FirstVolume(cloud, params, domain.Value);
  if (!first)
  {
    return first.Status;
  }
  VolumeFit fit;
  fit.Volume = std::move(first.Value);
  fit.Tolerance = params.Tolerance;
  if (fit.Tolerance == 0.0)
  {
    const auto ranges = cloud.Values.colwise().maxCoeff() - cloud.Values.colwise().minCoeff();
    const double range = ranges.maxCoeff();
    fit.Tolerance = range > 0.0 ? 1e-3 * range : 1e-3;
  }
  const int maxFunctions = params.MaxFunctions > 0
    ? params.MaxFunctions
    : std::max(1000, static_cast<int>(cloud.Points.rows()));
  for (int iteration = 0;; ++iteration)
  {
    const SplineSpace<3>& space = *fit.Volume.Space;
    const VolumePoints points = GroupVolumePoints(space, cloud);
    const ElementFunctions functions = FindElementFunctions(space, params.Threads);
    const bool isLeastSquares = params.Method == FitMethod::LeastSquares ||
      (params.Method == FitMethod::Combined && iteration < params.SwitchIteration);
    PointMatrix coefficients = fit.Volume.ControlPoints.leftCols(cloud.Values.cols());
    if (isLeastSquares)
    {
      SolveVolumeLeastSquares(functions, points, params.Degree, params.Smoothing,
        SolveAccuracy * fit.Tolerance, params.Threads, coefficients);
    }
    for (int step = 0; !isLeastSquares && step < params.MultilevelSteps; ++step)
    {
      VolumeMultilevelStep(functions, points, params.Degree, params.Threads, coefficients);
    }
    fit.Volume.ControlPoints.leftCols(cloud.Values.cols()) = coefficients;
    const Differences differences =
      Measure(functions, points, params.Degree, coefficients, params.Threads);
    VolumeFitIteration row;
    row.LeastSquares = isLeastSquares;
    row.NumFunctions = space.NumFunctions;
    row.NumElements = space.NumElements();
    row.MaxError = *std::max_element(differences.OfPoints.begin(), differences.OfPoints.end());
    row.RmsError = std::sqrt(differences.Squares / static_cast<double>(cloud.Values.size()));
    row.NumOutside = static_cast<std::size_t>(std::count_if(differences.OfPoints.begin(),
      differences.OfPoints.end(), [&fit](double x) { return !(x <= fit.Tolerance); }));
    row.Seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    fit.Iterations.push_back(row);
    fit.WithinTolerance = row.NumOutside == 0;
    const auto finish = [&](FitEnd end)
    {
      fit.End = end;
      fit.Distances.resize(points.Order.size());
      for (std::size_t i = 0; i < points.Order.size(); ++i)
      {
        fit.Distances[At(points.Order[i])] = differences.OfPoints[i];
      }
    };
    if (fit.WithinTolerance || iteration == params.MaxIterations)
    {
      finish(fit.WithinTolerance ? FitEnd::Tolerance : FitEnd::Iterations);
      break;
    }
    if (params.Progress &&
      !params.Progress(static_cast<double>(iteration + 1) / (params.MaxIterations + 1)))
    {
      return { ErrorCode::Aborted, "the fit" };
    }
    const std::vector<int> marked =
      MarkElements(space, differences.OfElements, fit.Tolerance, params);
    if (marked.empty())
    {
      finish(FitEnd::Resolution);
      break;
    }
    Result<Spline<3>> refined = Refine(fit.Volume, marked, maxFunctions, params);
    if (refined.Status.Code == ErrorCode::TooLarge)
    {
      finish(FitEnd::Functions);
      break;
    }
    if (!refined)
    {
      return refined.Status;
    }
    fit.Volume = std::move(refined.Value);
  }
  fit.DomainPoints = fit.Volume.ControlPoints.rightCols<3>();
  fit.Volume.ControlPoints = PointMatrix(fit.Volume.ControlPoints.leftCols(cloud.Values.cols()));
  return fit;
}
}
