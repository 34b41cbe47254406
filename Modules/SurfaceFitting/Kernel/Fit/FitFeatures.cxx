// SPDX-License-Identifier: BSD-3-Clause
#include "FitFeatures.h"

#include <knotwork/SplineCore/BezierForm.h>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
/// Cells of the domain, rows upwards.
struct FeatureCells
{
  ParametricBox<2> Domain;
  int Size = 0; ///< cells a direction

  double Step(std::size_t d) const
  {
    return (this->Domain.Upper[d] - this->Domain.Lower[d]) / this->Size;
  }
  std::size_t Count() const
  {
    return static_cast<std::size_t>(this->Size) * static_cast<std::size_t>(this->Size);
  }
  PointMatrix Middles() const
  {
    PointMatrix middles(static_cast<Eigen::Index>(this->Count()), 2);
    for (int j = 0; j < this->Size; ++j)
    {
      for (int i = 0; i < this->Size; ++i)
      {
        const Eigen::Index row = Eigen::Index{ j } * this->Size + i;
        middles(row, 0) = this->Domain.Lower[0] + (i + 0.5) * this->Step(0);
        middles(row, 1) = this->Domain.Lower[1] + (j + 0.5) * this->Step(1);
      }
    }
    return middles;
  }
  std::size_t Of(double u, double v) const
  {
    const auto along = [&](std::size_t d, double x)
    {
      return static_cast<std::size_t>(std::clamp(
        static_cast<int>((x - this->Domain.Lower[d]) / this->Step(d)), 0, this->Size - 1));
    };
    return along(1, v) * static_cast<std::size_t>(this->Size) + along(0, u);
  }
};

/// What the surface has in the middles of the cells.
void AddSurface(const FeatureCells& cells, const Spline<2>& surface, int height, int threads,
  FitFeatures& features)
{
  EvaluationBatch batch;
  EvaluationParams params;
  params.Derivatives = 1;
  params.Threads = threads;
  EvaluateParameters<2>(MakeBezierForm<2>(surface, threads), cells.Middles(), params, batch);
  const Eigen::Index columns = surface.ControlPoints.cols();
  for (std::size_t k = 0; k < cells.Count(); ++k)
  {
    const auto row = static_cast<Eigen::Index>(k);
    features.Height.push_back(batch.Values(row, height));
    features.Slope.push_back(
      std::hypot(batch.First(row, height), batch.First(row, columns + height)));
    const ParametricBox<2>& box =
      surface.Space->Elements[static_cast<std::size_t>(batch.Elements[k])].Box;
    features.ElementSize.push_back((box.Upper[0] - box.Lower[0]) * (box.Upper[1] - box.Lower[1]));
  }
}

/// What the points in the cells have, without outliers.
void AddPoints(
  const FeatureCells& cells, const PointCloud& cloud, const SurfaceFit& fit, FitFeatures& features)
{
  features.Roughness.assign(cells.Count(), 0.0);
  features.MaxError.assign(cells.Count(), 0.0);
  features.NumPoints.assign(cells.Count(), 0);
  features.NumOutside.assign(cells.Count(), 0);
  std::vector<double> means(cells.Count(), 0.0);
  const auto forPoints = [&](const auto& visit)
  {
    for (std::size_t i = 0; i < fit.Distances.size(); ++i)
    {
      if (fit.Outliers.empty() || fit.Outliers[i] == 0)
      {
        const auto row = static_cast<Eigen::Index>(i);
        visit(i, cells.Of(cloud.Parameters(row, 0), cloud.Parameters(row, 1)));
      }
    }
  };
  forPoints(
    [&](std::size_t i, std::size_t k)
    {
      const double distance = fit.Distances[i];
      ++features.NumPoints[k];
      means[k] += distance;
      features.MaxError[k] = std::max(features.MaxError[k], std::fabs(distance));
      features.NumOutside[k] += std::fabs(distance) > fit.Tolerances[i] ? 1 : 0;
    });
  for (std::size_t k = 0; k < cells.Count(); ++k)
  {
    means[k] /= std::max(1, features.NumPoints[k]);
  }
  forPoints(
    [&](std::size_t i, std::size_t k)
    {
      const double off = fit.Distances[i] - means[k];
      features.Roughness[k] += off * off;
    });
  for (std::size_t k = 0; k < cells.Count(); ++k)
  {
    features.Roughness[k] = std::sqrt(features.Roughness[k] / std::max(1, features.NumPoints[k]));
  }
}
}

FitFeatures ComputeFeatures(
  const PointCloud& cloud, const SurfaceFit& fit, int numMeasured, int size, int threads)
{
  const FeatureCells cells{ fit.Surface.Space->Domain(), size };
  FitFeatures features;
  features.Size = size;
  AddSurface(cells, fit.Surface, numMeasured - 1, threads, features);
  AddPoints(cells, cloud, fit, features);
  return features;
}
}
