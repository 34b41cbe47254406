// SPDX-License-Identifier: BSD-3-Clause
#include "FunctionGraph.h"

#include "HierarchicalSpace.h"
#include "Recovery.h"

#include <cmath>

namespace knotwork
{
namespace
{
/// Of the parameters' sizes.
constexpr double Rounding = 1e-14;

/// Turns Bernstein coefficients of two functions into what is missing from them to the parameters.
/// @return whether that is more than rounding.
bool SubtractFromParameters(BezierForm<2>& form)
{
  double largest = 0.0;
  double size = 0.0;
  for (int e = 0; e < form.Space->NumElements(); ++e)
  {
    const auto& element = form.Space->Elements[static_cast<std::size_t>(e)];
    double* value = form.Block(e);
    for (std::size_t d = 0; d < 2; ++d)
    {
      for (int k = 0; k < NumTensorFunctions<2>(element.Degree); ++k, ++value)
      {
        const int index[2] = { k % (element.Degree[0] + 1), k / (element.Degree[0] + 1) };
        const double share = static_cast<double>(index[d]) / element.Degree[d];
        const double wanted = (1.0 - share) * element.Box.Lower[d] + share * element.Box.Upper[d];
        *value = wanted - *value;
        largest = std::max(largest, std::fabs(*value));
        size = std::max(size, std::fabs(wanted));
      }
    }
  }
  return !(largest <= Rounding * size);
}
}

Result<Spline<2>> GraphOfFunction(const Spline<2>& function, int threads)
{
  if (Status status = function.Check(); !status)
  {
    return status;
  }
  if (function.NumComponents() != 1)
  {
    return { ErrorCode::DimensionMismatch,
      "a function has one component, not " + std::to_string(function.NumComponents()) };
  }
  if (function.IsRational())
  {
    return { ErrorCode::InvalidParameter, "the graph of a rational function is not in its space" };
  }
  const auto functions = DescribeFunctions(*function.Space);
  PointMatrix means(function.Space->NumFunctions, 2);
  for (std::size_t f = 0; f < functions.size(); ++f)
  {
    means.row(static_cast<Eigen::Index>(f)) << functions[f].Greville[0], functions[f].Greville[1];
  }
  BezierForm<2> rest = MakeBezierForm(Spline<2>{ function.Space, means, {} }, threads);
  if (SubtractFromParameters(rest))
  {
    const RecoveryResult<2> correction = RecoverField(rest, {}, threads);
    if (!correction)
    {
      return correction.Status;
    }
    means += correction.Value.ControlPoints;
  }
  Spline<2> graph = function;
  graph.ControlPoints.resize(means.rows(), 3);
  graph.ControlPoints << means, function.ControlPoints;
  return graph;
}
}
