// SPDX-License-Identifier: BSD-3-Clause
#include "FitSummary.h"

#include "FitLikelihood.h"

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
/// The same of the significant points.
void SummarizeSignificant(
  const PointCloud& cloud, const FitPoints& points, const FitDivision& division, FitIteration& row)
{
  std::vector<ElementErrors> errors(points.Ranges.size());
  for (std::size_t e = 0; !cloud.Significant.empty() && e < errors.size(); ++e)
  {
    for (std::size_t i = points.Ranges[e].Begin; i < points.Ranges[e].End; ++i)
    {
      if (points.Base[i] > 0.0 && cloud.Significant[static_cast<std::size_t>(points.Order[i])] != 0)
      {
        const double size = std::fabs(points.Distance[i]);
        ++errors[e].Count;
        errors[e].Max = std::max(errors[e].Max, size);
        errors[e].Sum += size;
        errors[e].NumOutside += size > points.Limit(i) ? 1 : 0;
      }
    }
  }
  division.ShareAll([&](std::size_t e) { return std::pair(&errors[e], std::size_t{ 1 }); });
  for (const ElementErrors& own : errors)
  {
    row.NumSignificant += own.Count;
    row.MaxSignificantError = std::max(row.MaxSignificantError, own.Max);
    row.MeanSignificantError += own.Sum;
    row.NumSignificantOutside += own.NumOutside;
  }
  row.MeanSignificantError /= static_cast<double>(std::max<std::size_t>(row.NumSignificant, 1));
}
}

FitIteration SummarizeFit(const SplineSpace<2>& space, const PointCloud& cloud,
  const FitPoints& points, const std::vector<ElementErrors>& errors, const FitDivision& division,
  int threads)
{
  FitIteration row;
  row.NumFunctions = space.NumFunctions;
  row.NumElements = space.NumElements();
  std::size_t count = 0;
  double squares = 0.0;
  for (const ElementErrors& own : errors)
  {
    row.MaxError = std::max(row.MaxError, own.Max);
    row.MeanError += own.Sum;
    squares += own.Squares;
    row.NumOutside += own.NumOutside;
    count += own.Count;
  }
  const auto number = static_cast<double>(std::max<std::size_t>(count, 1));
  row.MeanError /= number;
  row.RmsError = std::sqrt(squares / number);
  row.NumOutliers = division.Sum(points.Size()) - count;
  SummarizeSignificant(cloud, points, division, row);
  const TDistribution t = FitTDistribution(points, threads, division);
  row.LogLikelihood = t.LogLikelihood;
  row.DegreesOfFreedom = t.DegreesOfFreedom;
  row.AIC = 2.0 * row.NumFunctions - 2.0 * t.LogLikelihood;
  row.BIC = std::log(number) * row.NumFunctions - 2.0 * t.LogLikelihood;
  return row;
}
}
