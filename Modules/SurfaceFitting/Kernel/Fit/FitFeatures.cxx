// SPDX-License-Identifier: BSD-3-Clause
#include "FitFeatures.h"

#include <knotwork/SplineCore/BezierForm.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
constexpr std::size_t RegionChunk = 16384;                 // whose samples are evaluated at a time
constexpr double Places[] = { 1.0 / 6.0, 0.5, 5.0 / 6.0 }; // of samples, in both directions
constexpr int Samples = 9;
constexpr double SameBorder = 1e-9; // of a cell: an element that ends there does not go on

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

double& Entry(FitFeatures& features, std::size_t region, FitFeature feature)
{
  return features.Values(static_cast<Eigen::Index>(region), static_cast<Eigen::Index>(feature));
}

/// What the surface has at nine places of every region.
void AddSurface(const FitState& state, const std::vector<ParametricBox<2>>& boxes,
  Eigen::Index height, int threads, FitFeatures& features)
{
  Spline<2> surface;
  surface.Space = state.Space;
  surface.ControlPoints = state.Coefficients.col(height);
  const BezierForm<2> form = MakeBezierForm<2>(surface, threads);
  EvaluationParams params;
  params.Derivatives = 2;
  params.Threads = threads;
  EvaluationBatch batch;
  for (std::size_t first = 0; first < boxes.size(); first += RegionChunk)
  {
    const std::size_t last = std::min(boxes.size(), first + RegionChunk);
    PointMatrix at(static_cast<Eigen::Index>(last - first) * Samples, 2);
    Eigen::Index row = 0;
    for (std::size_t k = first; k < last; ++k)
    {
      for (const double v : Places)
      {
        for (const double u : Places)
        {
          at(row, 0) = (1.0 - u) * boxes[k].Lower[0] + u * boxes[k].Upper[0];
          at(row, 1) = (1.0 - v) * boxes[k].Lower[1] + v * boxes[k].Upper[1];
          ++row;
        }
      }
    }
    EvaluateParameters<2>(form, at, params, batch);
    for (std::size_t k = first; k < last; ++k)
    {
      const auto begin = static_cast<Eigen::Index>(k - first) * Samples;
      const auto values = batch.Values.col(0).segment(begin, Samples);
      const auto slopes = batch.First.middleRows(begin, Samples).rowwise().norm().eval();
      const Eigen::Index middle = Samples / 2;
      Entry(features, k, FitFeature::Height) = values[middle];
      Entry(features, k, FitFeature::MeanHeight) = values.mean();
      Entry(features, k, FitFeature::HeightRange) = values.maxCoeff() - values.minCoeff();
      Entry(features, k, FitFeature::Slope) = slopes[middle];
      Entry(features, k, FitFeature::MeanSlope) = slopes.mean();
      Entry(features, k, FitFeature::Laplacian) =
        (batch.Second.col(0) + batch.Second.col(2)).segment(begin, Samples).mean();
      const ParametricBox<2>& box =
        state.Space->Elements[At(batch.Elements[static_cast<std::size_t>(begin + middle)])].Box;
      Entry(features, k, FitFeature::ElementSize) =
        (box.Upper[0] - box.Lower[0]) * (box.Upper[1] - box.Lower[1]);
    }
  }
}

/// Mean, range and standard deviation of numbers that come one after the other, twice.
struct Numbers
{
  double Count = 0.0;
  double Sum = 0.0;
  double Squares = 0.0; ///< of differences from the mean
  double Least = std::numeric_limits<double>::infinity();
  double Most = -std::numeric_limits<double>::infinity();

  void Add(double x)
  {
    this->Count += 1.0;
    this->Sum += x;
    this->Least = std::min(this->Least, x);
    this->Most = std::max(this->Most, x);
  }
  void AddSquare(double x)
  {
    const double off = x - this->Mean();
    this->Squares += off * off;
  }
  double Mean() const { return this->Count > 0.0 ? this->Sum / this->Count : 0.0; }
  double Range() const { return this->Count > 0.0 ? this->Most - this->Least : 0.0; }
  double Largest() const { return this->Count > 0.0 ? this->Most : 0.0; }
  double Deviation() const
  {
    return this->Count > 0.0 ? std::sqrt(this->Squares / this->Count) : 0.0;
  }
};

/// The points of a region, outliers left out.
struct RegionPoints
{
  Numbers Sizes; ///< of distances
  Numbers Distances;
  Numbers Above;
  Numbers Below;
  Numbers Heights;
  double OutsideAbove = 0.0;
  double OutsideBelow = 0.0;

  void Add(double distance, double limit, double height)
  {
    this->Sizes.Add(std::fabs(distance));
    this->Distances.Add(distance);
    this->Heights.Add(height);
    (distance > 0.0 ? this->Above : this->Below).Add(std::fabs(distance));
    (distance > 0.0 ? this->OutsideAbove : this->OutsideBelow) +=
      std::fabs(distance) > limit ? 1.0 : 0.0;
  }
  void AddSquares(double distance, double height)
  {
    this->Distances.AddSquare(distance);
    this->Heights.AddSquare(height);
    (distance > 0.0 ? this->Above : this->Below).AddSquare(std::fabs(distance));
  }
  void Write(std::size_t k, FitFeatures& features) const
  {
    const auto set = [&](FitFeature feature, double value) { Entry(features, k, feature) = value; };
    set(FitFeature::NumPoints, this->Sizes.Count);
    set(FitFeature::NumOutside, this->OutsideAbove + this->OutsideBelow);
    set(FitFeature::NumAbove, this->Above.Count);
    set(FitFeature::NumBelow, this->Below.Count);
    set(FitFeature::NumOutsideAbove, this->OutsideAbove);
    set(FitFeature::NumOutsideBelow, this->OutsideBelow);
    set(FitFeature::MaxError, this->Sizes.Largest());
    set(FitFeature::MeanError, this->Sizes.Mean());
    set(FitFeature::Roughness, this->Distances.Deviation());
    set(FitFeature::DistanceRange, this->Distances.Range());
    set(FitFeature::MaxAbove, this->Above.Largest());
    set(FitFeature::MeanAbove, this->Above.Mean());
    set(FitFeature::DeviationAbove, this->Above.Deviation());
    set(FitFeature::MaxBelow, this->Below.Largest());
    set(FitFeature::MeanBelow, this->Below.Mean());
    set(FitFeature::DeviationBelow, this->Below.Deviation());
    set(FitFeature::MeanPointHeight, this->Heights.Mean());
    set(FitFeature::PointHeightRange, this->Heights.Range());
    set(FitFeature::PointHeightDeviation, this->Heights.Deviation());
  }
};

/// @param regionOf  of a point by its element and place.
template <typename RegionOf>
void AddPoints(
  const FitPoints& points, Eigen::Index height, RegionOf&& regionOf, FitFeatures& features)
{
  std::vector<RegionPoints> regions(static_cast<std::size_t>(features.Values.rows()));
  const FitPoints::Column& heights = points.Values[static_cast<std::size_t>(height)];
  const auto forPoints = [&](const auto& visit)
  {
    for (std::size_t e = 0; e < points.Ranges.size(); ++e)
    {
      for (std::size_t i = points.Ranges[e].Begin; i < points.Ranges[e].End; ++i)
      {
        if (points.Base[i] > 0.0)
        {
          visit(i, regions[regionOf(e, i)]);
        }
      }
    }
  };
  forPoints([&](std::size_t i, RegionPoints& region)
    { region.Add(points.Distance[i], points.Limit(i), heights[i]); });
  forPoints([&](std::size_t i, RegionPoints& region)
    { region.AddSquares(points.Distance[i], heights[i]); });
  for (std::size_t k = 0; k < regions.size(); ++k)
  {
    regions[k].Write(k, features);
  }
}
}

FitFeatures ElementFeatures(const FitState& state, const FitPoints& points, Eigen::Index height,
  const FitDivision& division, int threads)
{
  FitFeatures features;
  features.Values = PointMatrix::Zero(state.Space->NumElements(), NumFitFeatures);
  for (const SplineSpace<2>::Element& element : state.Space->Elements)
  {
    features.Boxes.push_back(element.Box);
  }
  AddSurface(state, features.Boxes, height, threads, features);
  features.Values.col(static_cast<Eigen::Index>(FitFeature::NumElements)).setOnes();
  AddPoints(
    points, height, [](std::size_t e, std::size_t) { return e; }, features);
  division.ShareAll(
    [&](std::size_t e)
    {
      return std::pair(
        features.Values.row(static_cast<Eigen::Index>(e)).data(), std::size_t{ NumFitFeatures });
    });
  return features;
}

FitFeatures GridFeatures(
  const FitState& state, const FitPoints& points, Eigen::Index height, int size, int threads)
{
  const ParametricBox<2> domain = state.Space->Domain();
  const RealArray<2> step{ (domain.Upper[0] - domain.Lower[0]) / size,
    (domain.Upper[1] - domain.Lower[1]) / size };
  std::vector<ParametricBox<2>> boxes;
  for (int j = 0; j < size; ++j)
  {
    for (int i = 0; i < size; ++i)
    {
      const RealArray<2> lower{ domain.Lower[0] + i * step[0], domain.Lower[1] + j * step[1] };
      boxes.push_back({ lower, { lower[0] + step[0], lower[1] + step[1] } });
    }
  }
  FitFeatures features;
  features.Values = PointMatrix::Zero(static_cast<Eigen::Index>(boxes.size()), NumFitFeatures);
  AddSurface(state, boxes, height, threads, features);
  const auto cell = [&](std::size_t d, double x)
  { return std::clamp(static_cast<int>((x - domain.Lower[d]) / step[d]), 0, size - 1); };
  for (const SplineSpace<2>::Element& element : state.Space->Elements)
  {
    IntArray<2> first;
    IntArray<2> last;
    for (std::size_t d = 0; d < 2; ++d)
    {
      first[d] = cell(d, element.Box.Lower[d] + SameBorder * step[d]);
      last[d] = cell(d, element.Box.Upper[d] - SameBorder * step[d]);
    }
    for (int j = first[1]; j <= last[1]; ++j)
    {
      for (int i = first[0]; i <= last[0]; ++i)
      {
        Entry(features, At(j) * At(size) + At(i), FitFeature::NumElements) += 1.0;
      }
    }
  }
  AddPoints(
    points, height,
    [&](std::size_t, std::size_t i)
    { return At(cell(1, points.V[i])) * At(size) + At(cell(0, points.U[i])); },
    features);
  return features;
}
}
