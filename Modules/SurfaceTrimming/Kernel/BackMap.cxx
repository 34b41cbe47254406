// SPDX-License-Identifier: BSD-3-Clause
#include "BackMap.h"
#include "GridExtrapolation.h"
#include "PenalizedFit.h"
#include "RadialBackMap.h"

#include <cmath>

namespace knotwork
{
namespace
{
Status CheckParams(const BackMapParams& params)
{
  const auto bad = [](const char* text) { return Status(ErrorCode::InvalidParameter, text); };
  if (params.Degree < 1 || params.Degree > MaxDegree)
  {
    return bad("the degree of a back-map lies in [1, 9]");
  }
  if (params.Elements < 0 || params.Elements > 2000)
  {
    return bad("the spans of a back-map lie in [1, 2000]; 0 is by need");
  }
  if (params.MaxElements < 1 || params.MaxElements > 2000)
  {
    return bad("the most spans of a back-map lie in [1, 2000]");
  }
  if (!(params.Tolerance > 0.0) || !std::isfinite(params.Tolerance))
  {
    return bad("the tolerance of a back-map is not positive");
  }
  if (!(params.Margin >= 0.0 && params.Margin <= 1.0))
  {
    return bad("the margin of a back-map lies in [0, 1]");
  }
  if (!(params.Smoothing > 0.0) || !std::isfinite(params.Smoothing))
  {
    return bad("the smoothing of a back-map is not positive");
  }
  if (params.Centres < 10 || params.Centres > 20000)
  {
    return bad("the centres of a back-map lie in [10, 20000]");
  }
  if (!params.FirstNet.empty() &&
    (params.FirstNet.size() != 2 || params.FirstNet[0].Degree() != params.Degree ||
      params.FirstNet[1].Degree() != params.Degree))
  {
    return bad("the first net of a back-map is two knot vectors of its degree");
  }
  if (params.MaxFunctions < 1)
  {
    return bad("the most control points of a back-map are at least 1");
  }
  if (!(params.Effort > 0.0 && params.Effort <= 1e6))
  {
    return bad("the effort of a back-map lies in (0, 1e6]");
  }
  if (!(params.LaterWork >= 0.0 && std::isfinite(params.LaterWork)))
  {
    return bad("the later work of a back-map is 0 or more");
  }
  if (!(params.TimeLimit >= 0.0))
  {
    return bad("the time limit of a back-map is negative");
  }
  if (params.Threads < 0)
  {
    return bad("a number of threads is negative");
  }
  return {};
}
}

const char* ToString(BackMapMethod method)
{
  switch (method)
  {
    case BackMapMethod::Nurbs:
      return "nurbs";
    case BackMapMethod::Rbf:
      return "rbf";
    case BackMapMethod::Hybrid:
      return "hybrid";
    case BackMapMethod::ContinuedLines:
      return "continued-lines";
    case BackMapMethod::Penalized:
      break;
  }
  return "penalized";
}

const char* ToString(BackMapStop stop)
{
  switch (stop)
  {
    case BackMapStop::Effort:
      return "effort";
    case BackMapStop::Time:
      return "time_limit";
    case BackMapStop::Elements:
      return "elements";
    case BackMapStop::Functions:
      return "functions";
    case BackMapStop::Contradiction:
      return "contradiction";
    case BackMapStop::Finished:
      break;
  }
  return "finished";
}

Result<BackMap> FitBackMap(const ChartMesh& chart, const BackMapParams& params)
{
  Status status = chart.Check();
  if (status)
  {
    status = CheckParams(params);
  }
  if (!status)
  {
    return status;
  }
  switch (params.Method)
  {
    case BackMapMethod::Nurbs:
    case BackMapMethod::ContinuedLines:
      return FitExtrapolated(chart, params);
    case BackMapMethod::Rbf:
    case BackMapMethod::Hybrid:
      return FitRadial(chart, params);
    case BackMapMethod::Penalized:
      break;
  }
  return FitPenalized(chart, params);
}
}
