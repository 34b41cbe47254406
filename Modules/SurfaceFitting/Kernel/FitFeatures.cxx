// SPDX-License-Identifier: BSD-3-Clause
#include "FitFeatures.h"

#include "BezierForm.h"

#include <algorithm>
#include <cmath>

namespace knotwork
{
FitFeatures ComputeFeatures(
  const PointCloud& cloud, const SurfaceFit& fit, int numMeasured, int size, int threads)
{
  const SplineSpace<2>& space = *fit.Surface.Space;
  const ParametricBox<2> domain = space.Domain();
  const auto cells = static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
  const RealArray<2> step{ (domain.Upper[0] - domain.Lower[0]) / size,
    (domain.Upper[1] - domain.Lower[1]) / size };
  FitFeatures features;
  features.Size = size;
  PointMatrix middles(static_cast<Eigen::Index>(cells), 2);
  for (int j = 0; j < size; ++j)
  {
    for (int i = 0; i < size; ++i)
    {
      const Eigen::Index row = Eigen::Index{ j } * size + i;
      middles(row, 0) = domain.Lower[0] + (i + 0.5) * step[0];
      middles(row, 1) = domain.Lower[1] + (j + 0.5) * step[1];
    }
  }
  EvaluationBatch batch;
  EvaluationParams params;
  params.Derivatives = 1;
  params.Threads = threads;
  EvaluateParameters<2>(MakeBezierForm<2>(fit.Surface, threads), middles, params, batch);
  const Eigen::Index height = numMeasured - 1;
  const Eigen::Index columns = fit.Surface.ControlPoints.cols();
  for (std::size_t k = 0; k < cells; ++k)
  {
    const auto row = static_cast<Eigen::Index>(k);
    features.Height.push_back(batch.Values(row, height));
    features.Slope.push_back(
      std::hypot(batch.First(row, height), batch.First(row, columns + height)));
    const ParametricBox<2>& box = space.Elements[static_cast<std::size_t>(batch.Elements[k])].Box;
    features.ElementSize.push_back((box.Upper[0] - box.Lower[0]) * (box.Upper[1] - box.Lower[1]));
  }
  features.Roughness.assign(cells, 0.0);
  features.MaxError.assign(cells, 0.0);
  features.NumPoints.assign(cells, 0);
  features.NumOutside.assign(cells, 0);
  std::vector<double> sums(cells, 0.0);
  const auto cellOf = [&](std::size_t d, double x)
  {
    return static_cast<std::size_t>(
      std::clamp(static_cast<int>((x - domain.Lower[d]) / step[d]), 0, size - 1));
  };
  const auto forPoints = [&](const auto& visit)
  {
    for (std::size_t i = 0; i < fit.Distances.size(); ++i)
    {
      if (fit.Outliers.empty() || fit.Outliers[i] == 0)
      {
        const auto row = static_cast<Eigen::Index>(i);
        visit(i,
          cellOf(1, cloud.Parameters(row, 1)) * static_cast<std::size_t>(size) +
            cellOf(0, cloud.Parameters(row, 0)));
      }
    }
  };
  forPoints(
    [&](std::size_t i, std::size_t k)
    {
      const double distance = fit.Distances[i];
      ++features.NumPoints[k];
      sums[k] += distance;
      features.MaxError[k] = std::max(features.MaxError[k], std::fabs(distance));
      features.NumOutside[k] += std::fabs(distance) > fit.Tolerances[i] ? 1 : 0;
    });
  for (std::size_t k = 0; k < cells; ++k)
  {
    sums[k] /= std::max(1, features.NumPoints[k]);
  }
  forPoints(
    [&](std::size_t i, std::size_t k)
    {
      const double off = fit.Distances[i] - sums[k];
      features.Roughness[k] += off * off;
    });
  for (std::size_t k = 0; k < cells; ++k)
  {
    features.Roughness[k] = std::sqrt(features.Roughness[k] / std::max(1, features.NumPoints[k]));
  }
  return features;
}
}
