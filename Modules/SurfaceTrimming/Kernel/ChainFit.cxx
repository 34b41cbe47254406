// SPDX-License-Identifier: BSD-3-Clause
#include "ChainFit.h"

#include "ParameterFit.h"
#include "SpaceFit.h"

#include <algorithm>

namespace knotwork
{
ChainPolyline MakeChainPolyline(const PointMatrix& points, const std::vector<PointMatrix>& uv)
{
  ChainPolyline chain;
  chain.Points = points;
  const Eigen::Index n = points.rows();
  chain.UV.resize(n, 2 * static_cast<Eigen::Index>(uv.size()));
  for (std::size_t k = 0; k < uv.size(); ++k)
  {
    chain.UV.middleCols(2 * static_cast<Eigen::Index>(k), 2) = uv[k];
  }
  chain.Parameters.assign(1, 0.0);
  for (Eigen::Index i = 1; i < n; ++i)
  {
    double length = 0.0;
    for (const PointMatrix& plane : uv)
    {
      length += (plane.row(i) - plane.row(i - 1)).norm();
    }
    chain.Parameters.push_back(chain.Parameters.back() + length);
  }
  const double total = chain.Parameters.back();
  for (double& t : chain.Parameters)
  {
    t /= total;
  }
  return chain;
}

Result<FittedChain> FitChain(const ChainPolyline& chain,
  const std::vector<const SurfaceBounds*>& surfaces, const ChainFitParams& params)
{
  chains::ParameterFit parameterFit(chain, surfaces, params.Tolerance);
  auto pcurves = parameterFit.Run();
  if (!pcurves)
  {
    return pcurves.Status;
  }
  chains::SpaceFit spaceFit(surfaces, params);
  auto both = spaceFit.Run(pcurves.Value);
  if (!both)
  {
    return both.Status;
  }
  auto gap = spaceFit.BoundGap(both.Value);
  if (!gap)
  {
    return gap.Status;
  }
  FittedChain fitted;
  fitted.TrimDistance = parameterFit.Distance;
  fitted.EdgeGap = gap.Value;
  fitted.Curve = { both->Space, both->ControlPoints.leftCols(3), {} };
  fitted.UV = both->ControlPoints.rightCols(both->ControlPoints.cols() - 3);
  for (const chains::CurvePiece& piece : chains::CutAtCorners(fitted.Curve, chain.Parameters))
  {
    const chains::Cubic difference = chains::Difference(piece, chain.Parameters, chain.Points);
    fitted.BoundaryDistance =
      std::max(fitted.BoundaryDistance, difference.rowwise().norm().maxCoeff());
  }
  return fitted;
}
}
